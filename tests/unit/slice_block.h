/* A block of tetrahedra, bent, over a volume of noise, for tests of us-slice: and the image of it pixel
 * by pixel, from nothing but the definition.
 */
#ifndef SINEW_SLICE_BLOCK_H
#define SINEW_SLICE_BLOCK_H

#include "msds_block.h"

#include "base/num.h"
#include "slice/image/slice_cutter.h"

#include <string.h>

typedef struct slice_block {
    volume v;
    model m;
    slice_cells cells;
    slice_mesh mesh;
    double *u; /* nodes x 3 */
} slice_block;

static inline uint32_t block_random(uint32_t *seed)
{
    *seed = *seed * 1664525U + 1013904223U;
    return *seed >> 8;
}

/* Noise over a box of 8 x 6 x 5 cm, in an oblique, left-handed grid; the mesh covers most of it and more. */
static inline void block_make(slice_block *b, const int32_t nodes[3], double bend, pool *threads)
{
    err e = {0};
    uint32_t seed = 7;
    tets t = {{nodes[0], nodes[1], nodes[2]}, {.08, .06, .05}, 1e4, .45, 1000, 2, false};
    *b = (slice_block){.v = {.type = VOLUME_U8,
                             .size = {40, 37, 33},
                             .origin = {2, 57, -1},
                             .axis = {{1.9, .2, .1}, {.15, -1.6, .05}, {-.1, .1, 1.5}}}};
    tets_must(!volume_make(&b->v, &e), &e);
    for (int64_t i = 0; i < volume_count(&b->v); i++)
        ((uint8_t *)b->v.data)[i] = (uint8_t)block_random(&seed);
    tets_make(&t, &b->m);
    volume laid = b->v; /* whose voxels the cells take */
    tets_must(!volume_make(&laid, &e), &e);
    memcpy(laid.data, b->v.data, (size_t)volume_count(&laid));
    tets_must(!slice_cells_make(&b->cells, &laid, slice_window_of(&laid), threads, &e) &&
                  !slice_mesh_of(&b->mesh, &b->m, &b->cells, "block", &e),
              &e);
    b->u = calloc((size_t)b->mesh.nodes * 3, sizeof *b->u);
    tets_must(b->u != NULL, &e);
    for (int64_t n = 0; n < b->mesh.nodes; n++) {
        const double *x = b->mesh.rest + 3 * n;
        const double r2 = (x[0] - .04) * (x[0] - .04) + (x[1] - .03) * (x[1] - .03), hat = exp(-r2 / (2 * .015 * .015));
        b->u[3 * n] = bend * .3 * (x[0] - .04) * hat * x[2] / .05;
        b->u[3 * n + 1] = bend * .1 * x[2];
        b->u[3 * n + 2] = -bend * .4 * x[2] * hat;
    }
}

static inline void block_free(slice_block *b)
{
    free(b->u);
    slice_mesh_free(&b->mesh);
    slice_cells_free(&b->cells);
    model_free(&b->m);
    volume_free(&b->v);
}

static inline double block_six(const double a[3], const double b[3], const double c[3], const double d[3])
{
    double e[3][3];
    for (int i = 0; i < 3; i++) {
        e[0][i] = b[i] - a[i];
        e[1][i] = c[i] - a[i];
        e[2][i] = d[i] - a[i];
    }
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) + e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/* The barycentric coordinates of a place in a deformed tetrahedron; returns the least. */
static inline double block_shares(const slice_block *b, int64_t tet, const double place[3], double share[4])
{
    const int32_t *node = model_find(&b->m, "element.node")->i32 + 4 * tet;
    double x[4][3], least = 2;
    for (int k = 0; k < 4; k++)
        for (int a = 0; a < 3; a++)
            x[k][a] = b->mesh.rest[3 * (int64_t)node[k] + a] + b->u[3 * (int64_t)node[k] + a];
    const double all = block_six(x[0], x[1], x[2], x[3]);
    for (int k = 0; k < 4; k++) {
        const double *corner[4] = {x[0], x[1], x[2], x[3]};
        corner[k] = place;
        share[k] = block_six(corner[0], corner[1], corner[2], corner[3]) / all;
        least = share[k] < least ? share[k] : least;
    }
    return least;
}

static inline double block_voxel(const slice_block *b, int64_t i, int64_t j, int64_t k)
{
    const int64_t *n = b->v.size;
    i = num_clamp_int(i, 0, n[0] - 1);
    j = num_clamp_int(j, 0, n[1] - 1);
    k = num_clamp_int(k, 0, n[2] - 1);
    return volume_value(&b->v, (k * n[1] + j) * n[0] + i);
}

/* Linear between voxels at a place of the volume's frame; -1 outside. */
static inline double block_value(const slice_block *b, const double place[3])
{
    const volume_finder f = volume_finder_of(&b->v);
    double at[3], low[3], sum = 0;
    volume_voxel(&f, place, at);
    for (int a = 0; a < 3; a++) {
        if (!(at[a] >= -.5 && at[a] <= (double)b->v.size[a] - .5))
            return -1;
        low[a] = floor(at[a]);
    }
    for (int c = 0; c < 8; c++) {
        double weight = 1;
        for (int a = 0; a < 3; a++)
            weight *= c >> a & 1 ? at[a] - low[a] : 1 - (at[a] - low[a]);
        sum += weight *
               block_voxel(b, (int64_t)low[0] + (c & 1), (int64_t)low[1] + (c >> 1 & 1), (int64_t)low[2] + (c >> 2));
    }
    return sum;
}

/* The tetrahedron that holds a place of the deformed block, the lowest; -1: none. */
static inline int32_t block_find(const slice_block *b, const double place[3], double share[4])
{
    for (int64_t t = 0; t < b->mesh.tets; t++)
        if (block_shares(b, t, place, share) >= -1e-9)
            return (int32_t)t;
    return -1;
}

/* Where it was at rest. */
static inline void block_rest(const slice_block *b, int32_t tet, const double share[4], double place[3])
{
    const int32_t *node = model_find(&b->m, "element.node")->i32 + 4 * (int64_t)tet;
    for (int a = 0; a < 3; a++) {
        place[a] = 0;
        for (int k = 0; k < 4; k++)
            place[a] += share[k] * b->mesh.rest[3 * (int64_t)node[k] + a];
    }
}

#endif
