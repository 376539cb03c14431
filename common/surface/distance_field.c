#include "surface/distance_field.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS_CHUNK = 16 };

int distance_triangles_add(distance_triangles *d, const double *corner, int32_t of, bool is_turned, err *e)
{
    const int64_t t = d->triangles;
    if (mem_grow(&d->position, &d->position_room, 9 * (t + 1), sizeof *d->position, "the triangles", e) ||
        mem_grow(&d->corner, &d->corner_room, 3 * (t + 1), sizeof *d->corner, "the triangles", e) ||
        mem_grow(&d->of, &d->of_room, t + 1, sizeof *d->of, "the triangles", e))
        return -1;
    memcpy(d->position + 9 * t, corner, 9 * sizeof *corner);
    for (int i = 0; i < 3; i++)
        d->corner[3 * t + i] = (int32_t)(3 * t + (is_turned && i ? 3 - i : i));
    d->of[d->triangles++] = of;
    return 0;
}

int distance_triangles_ready(distance_triangles *d, err *e)
{
    if (pseudonormal_of(&d->side, d->position, 3 * d->triangles, d->corner, d->triangles, e))
        return -1;
    d->tree = triangle_tree_create(d->position, d->corner, d->triangles, e);
    return d->tree ? 0 : -1;
}

void distance_triangles_free(distance_triangles *d)
{
    triangle_tree_destroy(d->tree);
    pseudonormal_free(&d->side);
    free(d->position);
    free(d->corner);
    free(d->of);
    *d = (distance_triangles){.tree = NULL};
}

double distance_at(const distance_triangles *d, const double x[3], int64_t *guess)
{
    const triangle_hit hit = triangle_tree_nearest(d->tree, x, *guess);
    *guess = hit.triangle;
    return pseudonormal_outside(&d->side, &hit, x) ? sqrt(hit.distance2) : -sqrt(hit.distance2);
}

int64_t distance_box_samples(const distance_box *b)
{
    return (int64_t)b->samples[0] * b->samples[1] * b->samples[2];
}

typedef struct sampling {
    const distance_triangles *by;
    const distance_box *box;
    float *to;
} sampling;

static void sample_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const sampling *s = context;
    const distance_box *b = s->box;
    (void)chunk;
    for (int64_t row = from; row < to; row++) {
        const int64_t across[2] = {b->first[1] + row % b->samples[1], b->first[2] + row / b->samples[1]};
        int64_t guess = -1;
        double x[3];
        for (int a = 1; a < 3; a++)
            x[a] = b->origin[a] + b->spacing[a] * (double)across[a - 1];
        for (int32_t i = 0; i < b->samples[0]; i++) {
            x[0] = b->origin[0] + b->spacing[0] * (double)(b->first[0] + (int64_t)i);
            s->to[row * b->samples[0] + i] = (float)distance_at(s->by, x, &guess);
        }
    }
}

void distance_sample(const distance_triangles *d, const distance_box *b, pool *threads, float *to)
{
    sampling work = {.by = d, .box = b};
    work.to = to;
    pool_run(threads, (int64_t)b->samples[1] * b->samples[2], ROWS_CHUNK, sample_work, &work);
}
