#include "slice/image/slice_grey.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

static double tgc_at(const slice_knobs *k, double share)
{
    if (k->slides < 2)
        return k->slides ? k->tgc[0] : 0;
    const double at = fmin(fmax(share, 0), 1) * (k->slides - 1);
    const int slide = at < k->slides - 1 ? (int)at : k->slides - 2;
    return k->tgc[slide] + (at - slide) * (k->tgc[slide + 1] - k->tgc[slide]);
}

int slice_grey_make(slice_grey *g, const slice_view *v, const slice_knobs *k, err *e)
{
    *g = (slice_grey){0};
    if (k->gain == 0 && !k->slides && k->shown == k->recorded)
        return 0;
    g->offset = mem_array((int64_t)v->size.columns * v->size.rows, sizeof *g->offset, "gains", e);
    if (!g->offset)
        return -1;
    g->slope = (int32_t)lrint(65536 * k->recorded / k->shown);
    for (int32_t r = 0; r < v->size.rows; r++)
        for (int32_t c = 0; c < v->size.columns; c++) {
            const double more = k->gain + tgc_at(k, slice_view_range(v, c, r) / v->depth);
            const double offset = 255 * (1 + (more - k->recorded) / k->shown) + .5;
            g->offset[(int64_t)r * v->size.columns + c] = (int32_t)lrint(65536 * fmin(fmax(offset, -16000), 16000));
        }
    return 0;
}

void slice_grey_free(slice_grey *g)
{
    free(g->offset);
    *g = (slice_grey){0};
}

void slice_grey_apply(const slice_grey *g, uint8_t *image, int64_t at, int64_t count)
{
    if (!g->slope)
        return;
    for (int64_t i = at; i < at + count; i++) {
        int32_t level = (image[i] * g->slope + g->offset[i]) >> 16;
        level = level < 0 ? 0 : level;
        level = level > 255 ? 255 : level;
        image[i] = image[i] ? (uint8_t)level : 0;
    }
}
