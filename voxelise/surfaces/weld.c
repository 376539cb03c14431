#include "voxelise/surfaces/weld.h"

#include "base/mem.h"
#include "voxelise/surfaces/grid.h"
#include "voxelise/surfaces/hash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int take_position(const obj *o, int64_t vertex, double *p, err *e)
{
    for (int a = 0; a < 3; a++) {
        double x = o->position[3 * vertex + a];
        if (!(fabs(x) <= GRID_LARGEST))
            return err_set(e, o->name, 0, "vertex %lld has a coordinate of %g; expected magnitudes up to %g",
                           (long long)vertex + 1, x, GRID_LARGEST);
        p[a] = fabs(x) < GRID_SMALLEST ? 0 : x;
    }
    return 0;
}

static int64_t mark_used(weld *w, const obj *o, const int64_t *face, int64_t faces)
{
    int64_t used = 0;
    for (int64_t i = 0; i < faces; i++)
        for (int64_t c = o->face_start[face[i]]; c < o->face_start[face[i] + 1]; c++) {
            int32_t *to = &w->of[o->corner_vertex[c]];
            used += *to == 0;
            *to = 1;
        }
    return used;
}

static uint64_t hash_position(const double *p)
{
    uint64_t h = 0, bits;
    for (int a = 0; a < 3; a++) {
        memcpy(&bits, &p[a], sizeof bits);
        h = hash_next(h, bits);
    }
    return h;
}

static bool same_place(const double *a, const double *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* The number of a place, new or not. table: numbers + 1; 0: free. */
static int32_t place_at(weld *w, int32_t *table, int64_t size, const double *p)
{
    int64_t at = (int64_t)(hash_position(p) & (uint64_t)(size - 1));
    for (; table[at]; at = (at + 1) & (size - 1))
        if (same_place(&w->position[3 * ((int64_t)table[at] - 1)], p))
            return table[at] - 1;
    memcpy(&w->position[3 * w->places], p, 3 * sizeof *p);
    table[at] = (int32_t)++w->places;
    for (int a = 0; a < 3; a++) {
        w->low[a] = fmin(w->low[a], p[a]);
        w->high[a] = fmax(w->high[a], p[a]);
    }
    return (int32_t)w->places - 1;
}

int weld_make(weld *w, const obj *o, const int64_t *face, int64_t faces, err *e)
{
    *w = (weld){.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    w->of = mem_array(o->vertices, sizeof *w->of, "vertices", e);
    if (!w->of)
        return -1;
    int64_t used = mark_used(w, o, face, faces), size = hash_size(used);
    int32_t *table = mem_array(size, sizeof *table, "vertices", e);
    w->position = mem_array(3 * used, sizeof *w->position, "vertices", e);
    int status = table && w->position ? 0 : -1;
    for (int64_t i = 0; !status && i < o->vertices; i++) {
        double p[3] = {0};
        bool is_used = w->of[i] != 0;
        w->of[i] = -1;
        if (!is_used)
            continue;
        status = take_position(o, i, p, e);
        if (!status)
            w->of[i] = place_at(w, table, size, p);
    }
    free(table);
    if (status)
        weld_free(w);
    return status;
}

void weld_free(weld *w)
{
    free(w->of);
    free(w->position);
    *w = (weld){0};
}
