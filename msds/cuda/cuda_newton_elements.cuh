/* The loops of the method tissue over elements, points of pressure and what nodes sum, on the card: tissue_loops.h's, a
 * lane a thread, number for number. Everything is static.
 */
#ifndef SINEW_CUDA_NEWTON_ELEMENTS_CUH
#define SINEW_CUDA_NEWTON_ELEMENTS_CUH

#include "msds/cuda/cuda_newton.cuh"

typedef float stable_number;

static __device__ inline float stable_larger(float a, float b)
{
    return a > b ? a : b;
}

#include "msds/problem/stable.h"

/* Where an element's corners, or its points, stand. */
typedef struct newton_corners {
    int32_t at[4];
} newton_corners;

/* What the elements of a group share: loaded for the next element while one is computed. */
typedef struct newton_group {
    int4 first;
    int32_t shape;
} newton_group;

static __device__ inline newton_group take_group(const tissue_newton *x, int32_t i)
{
    return {x->first[i / LANES], x->shape[i / LANES]};
}

/* Lanes that only fill up a row may stand past the end. */
static __device__ inline newton_corners corners_of(int4 first, const int32_t *each, bool row, int32_t i, int32_t most)
{
    const int32_t from[4] = {first.x, first.y, first.z, first.w};
    newton_corners c;
    for (int k = 0; k < 4; k++)
        c.at[k] = min(from[k] + i % LANES, most - 1);
    if (!row)
        for (int k = 0; k < 4; k++)
            c.at[k] = each[(4 * (i / LANES) + k) * LANES + i % LANES];
    return c;
}

/* The gradients of corners 1 to 3. */
static __device__ inline void take_gradients(const tissue_newton *x, int32_t shape, int32_t i, float q[9])
{
    const bool one = shape >= 0;
    const float *at = x->gradient + (one ? 9 * (int64_t)shape : 9 * (int64_t)~shape + i % LANES);
    for (int k = 0; k < 9; k++)
        q[k] = at[one ? k : k * LANES];
}

/* The derivatives of a field of nodes. */
static __device__ inline void derive(const newton_corners *c, const float4 *field, const float q[9], float d[9])
{
    const float4 own = field[c->at[0]],
                 f[3] = {minus(field[c->at[1]], own), minus(field[c->at[2]], own), minus(field[c->at[3]], own)};
    for (int b = 0; b < 3; b++) {
        d[b] = (f[0].x * q[b] + f[1].x * q[3 + b]) + f[2].x * q[6 + b];
        d[3 + b] = (f[0].y * q[b] + f[1].y * q[3 + b]) + f[2].y * q[6 + b];
        d[6 + b] = (f[0].z * q[b] + f[1].z * q[3 + b]) + f[2].z * q[6 + b];
    }
}

/* What the corners pull with: volume times stress times gradient. */
static __device__ inline void put_forces(const tissue_newton *x, int32_t i, float volume, const float q[9],
                                         const float stress[9])
{
    for (int a = 0; a < 3; a++) {
        float sum = 0;
        for (int c = 0; c < 3; c++) {
            const float f = volume * ((stress[3 * a] * q[3 * c] + stress[3 * a + 1] * q[3 * c + 1]) +
                                      stress[3 * a + 2] * q[3 * c + 2]);
            sum += f;
            x->force[(3 * (c + 1) + a) * x->stride + i] = f;
        }
        x->force[a * x->stride + i] = -sum;
    }
}

static __device__ inline float *group_of(float *numbers, int32_t i, int count)
{
    return numbers + (int64_t)(i / LANES) * count * LANES + i % LANES;
}

/* An element, as each loop over elements needs it. The displacement's derivatives are worked out anew each time: what
 * nodes have is in the card's cache, which the derivatives of half a million nodes' elements are not. */
typedef struct newton_element {
    newton_corners at;
    bool row;
    float q[9], g[9];
} newton_element;

static __device__ inline newton_element take_element(const tissue *t, const tissue_newton *x, int32_t i,
                                                     newton_group group)
{
    newton_element e;
    e.row = group.first.x != SELL_SCATTERED;
    take_gradients(x, group.shape, i, e.q);
    e.at = corners_of(group.first, x->node, e.row, i, t->nodes);
    derive(&e.at, t->u, e.q, e.g);
    return e;
}

/* The mean of the points of an element, as far as it counts. */
static __device__ inline float pressure_of(const tissue_newton *x, int32_t i, bool row, float counted,
                                           const float *value)
{
    float sum = 0;
    if (x->points) {
        const newton_corners c = corners_of(x->first_point[i / LANES], x->point, row, i, x->points);
        for (int k = 0; k < 4; k++)
            sum += value[c.at[k]];
    }
    return .25f * counted * sum;
}

static __device__ inline void measure_element(const tissue *t, const tissue_newton *x, int32_t i, newton_group group)
{
    float c[9];
    const float volume = x->volume[i];
    const newton_element e = take_element(t, x, i, group);
    stable_cofactors(e.g, c);
    const float swelling = stable_swelling(e.g, c), counted = stable_counted(swelling);
    x->counted[i] = counted;
    x->swollen[i] = .25f * volume * stable_swelling_counted(swelling, counted);
}

static __device__ inline void stress_element(const tissue *t, const tissue_newton *x, int32_t i, newton_group group)
{
    float stress[9], *law = group_of(x->law, i, STABLE_NUMBERS);
    const float volume = x->volume[i], mu = x->mu[i], kappa = x->kappa[i], counted = x->counted[i];
    const newton_element e = take_element(t, x, i, group);
    const stable_state at = stable_stress(e.g, mu, kappa, pressure_of(x, i, e.row, counted, x->pressure), stress);
    law[0] = at.a;
    law[LANES] = at.b;
    law[2 * LANES] = at.q;
    law[3 * LANES] = at.r;
    put_forces(x, i, volume, e.q, stress);
}

static __device__ inline void swell_element(const tissue *t, const tissue_newton *x, int32_t i, newton_group group)
{
    float d[9], c[9];
    const float volume = x->volume[i], counted = x->counted[i];
    newton_element e = take_element(t, x, i, group);
    derive(&e.at, x->way, e.q, d);
    for (int k = 0; k < 9; k += 4)
        e.g[k] += 1;
    stable_cofactors(e.g, c);
    x->swollen[i] = .25f * volume * counted * stable_dot(c, d);
}

static __device__ inline void tangent_element(const tissue *t, const tissue_newton *x, int32_t i, newton_group group)
{
    float d[9], stress[9];
    const float *law = group_of(x->law, i, STABLE_NUMBERS);
    const stable_state state = {law[0], law[LANES], law[2 * LANES], law[3 * LANES]};
    const float volume = x->volume[i], counted = x->counted[i];
    const newton_element e = take_element(t, x, i, group);
    derive(&e.at, x->way, e.q, d);
    stable_tangent(e.g, d, &state, pressure_of(x, i, e.row, counted, x->pressed), stress);
    put_forces(x, i, volume, e.q, stress);
}

/* Where a lane's summand of a slot stands; below 0: it has none. Only what does not stand in a row is looked up. */
static __device__ inline int32_t summand_at(const newton_sums *s, int32_t slot, int32_t lane)
{
    const int2 row = s->slot[slot];
    int32_t at = row.x + lane;
    if (row.x == SELL_SCATTERED)
        at = s->list[slot * LANES + lane];
    return row.y >> lane & 1 ? at : -1;
}

/* What a point's pressure, or what that changes by, is of what is swollen about it. */
static __device__ inline float point_sum(const tissue_newton *x, int32_t i)
{
    const newton_sums *s = &x->swells;
    const int32_t last = s->start[i / LANES + 1];
    float sum = 0;
#pragma unroll 8
    for (int32_t slot = s->start[i / LANES]; slot < last; slot++) {
        const int32_t at = summand_at(s, slot, i % LANES);
        sum += at >= 0 ? x->swollen[at] : 0;
    }
    return sum * x->bulk[i];
}

/* What the elements pull a node with; nothing where it is fixed. */
static __device__ inline float4 node_sum(const tissue_newton *x, int32_t n)
{
    const newton_sums *s = &x->corners;
    const int32_t last = s->start[n / LANES + 1];
    const bool is_free = x->inverse[n] > 0;
    float4 sum = {0, 0, 0, 0};
#pragma unroll 8
    for (int32_t slot = s->start[n / LANES]; slot < last; slot++) {
        const int32_t at = summand_at(s, slot, n % LANES);
        const float *from = x->force + at;
        const bool has = at >= 0;
        sum = {sum.x + (has ? from[0] : 0), sum.y + (has ? from[x->stride] : 0),
               sum.z + (has ? from[2 * x->stride] : 0), 0};
    }
    return is_free ? sum : float4{0, 0, 0, 0};
}

#endif
