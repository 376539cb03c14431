#include "slice/import/crop.h"

#include <string.h>

void crop_to(volume *v, const samples_box *box)
{
    size_t one = volume_type_size(v->type);
    int64_t wide = box->high[0] - box->low[0];
    char *to = v->data;
    for (int64_t z = box->low[2]; z < box->high[2]; z++)
        for (int64_t y = box->low[1]; y < box->high[1]; y++) {
            const char *from = (const char *)v->data + (size_t)((z * v->size[1] + y) * v->size[0] + box->low[0]) * one;
            memmove(to, from, (size_t)wide * one);
            to += (size_t)wide * one;
        }
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++)
            v->origin[b] += v->axis[a][b] * (double)box->low[a];
        v->size[a] = box->high[a] - box->low[a];
    }
}
