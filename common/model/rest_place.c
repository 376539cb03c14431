#include "model/rest_place.h"

#include "base/num.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bool rest_place_of(const char *text, double *place)
{
    num_length length[3];
    if (num_lengths_of(text, length, 3) != 3)
        return false;
    for (int a = 0; a < 3; a++)
        place[a] = num_length_in(length[a], num_unit_of("m"), num_unit_of("m"));
    return true;
}

/* The rest position of row i of an axis: its own, or the mean of an element's nodes. */
static void place_of(const model_array *position, const model_array *node, int64_t i, double *place)
{
    if (!node) {
        memcpy(place, position->f64 + 3 * i, 3 * sizeof *place);
        return;
    }
    for (int a = 0; a < 3; a++) {
        place[a] = 0;
        for (int32_t c = 0; c < node->columns; c++)
            place[a] += position->f64[3 * (int64_t)node->i32[i * node->columns + c] + a] / node->columns;
    }
}

int64_t rest_place_row(const model *m, const char *axis, const double *place)
{
    char name[MODEL_NAME + 16];
    bool elements = !strcmp(axis, "element");
    snprintf(name, sizeof name, "%s.position", elements ? "node" : axis);
    const model_array *position = model_find(m, name), *node = elements ? model_find(m, "element.node") : NULL;
    int64_t best = -1;
    double least = INFINITY;
    if (!position || position->type != MODEL_F64 || position->columns != 3 || (elements && !node))
        return -1;
    for (int64_t i = 0; i < (node ? node->rows : position->rows); i++) {
        double at[3], square = 0;
        place_of(position, node, i, at);
        for (int a = 0; a < 3; a++)
            square += (at[a] - place[a]) * (at[a] - place[a]);
        if (square < least) {
            least = square;
            best = i;
        }
    }
    return best;
}
