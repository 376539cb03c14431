#include "voxelise/surfaces/weld.h"

#include "base/mem.h"
#include "surface/coincident.h"
#include "voxelise/surfaces/grid.h"

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

/* The positions of the vertices that are used, in their order, into w->position. */
static int take_positions(weld *w, const obj *o, err *e)
{
    int status = 0;
    for (int64_t i = 0, used = 0; !status && i < o->vertices; i++)
        if (w->of[i])
            status = take_position(o, i, &w->position[3 * used++], e);
    return status;
}

/* Keeps the first position at each place, and numbers the vertices by places. place: of those used. */
static void keep_places(weld *w, const obj *o, const int32_t *place)
{
    w->places = 0;
    for (int64_t i = 0, used = 0; i < o->vertices; i++) {
        if (!w->of[i]) {
            w->of[i] = -1;
            continue;
        }
        const double *p = &w->position[3 * used];
        w->of[i] = place[used++];
        if (w->of[i] < w->places)
            continue;
        for (int a = 0; a < 3; a++) {
            w->low[a] = fmin(w->low[a], p[a]);
            w->high[a] = fmax(w->high[a], p[a]);
        }
        memmove(&w->position[3 * w->places++], p, 3 * sizeof *p);
    }
}

int weld_make(weld *w, const obj *o, const int64_t *face, int64_t faces, err *e)
{
    *w = (weld){.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    w->of = mem_array(o->vertices, sizeof *w->of, "vertices", e);
    if (!w->of)
        return -1;
    const int64_t used = mark_used(w, o, face, faces);
    int32_t *place = mem_array(used, sizeof *place, "vertices", e);
    w->position = mem_array(3 * used, sizeof *w->position, "vertices", e);
    const int failed =
        !place || !w->position || take_positions(w, o, e) || coincident_places(w->position, used, place, e) < 0 ? -1
                                                                                                                : 0;
    if (failed)
        weld_free(w);
    else
        keep_places(w, o, place);
    free(place);
    return failed;
}

void weld_free(weld *w)
{
    free(w->of);
    free(w->position);
    *w = (weld){0};
}
