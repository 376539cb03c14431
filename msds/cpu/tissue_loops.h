/* The loops of tissue.c over groups of elements and slices of nodes (tissue_mesh.h), for lanes_loops.c alone, which
 * includes this once for each instruction set.
 */
#ifndef SINEW_TISSUE_LOOPS_H
#define SINEW_TISSUE_LOOPS_H

#include "msds/cpu/tissue_mesh.h"

typedef v8 stable_number;
typedef int32_t i8 __attribute__((vector_size(32)));

INLINE v8 stable_larger(v8 a, v8 b)
{
    const i8 is = a > b;
    return (v8)((is & (i8)a) | (~is & (i8)b));
}

#include "msds/problem/stable.h"

/* The derivatives of a field of nodes in the elements of a group. */
INLINE void derive(const tissue_mesh *m, int64_t group, const lanes_field *f, v8 d[9])
{
    v8 by[3][3];
    for (int a = 0; a < 3; a++) {
        v8 x[4];
        for (int c = 0; c < 4; c++) {
            const int32_t first = m->first[4 * group + c];
            x[c] = fetch(f->x[a], first != SELL_SCATTERED, first, m->node + (4 * group + c) * LANES);
        }
        for (int c = 0; c < 3; c++)
            by[c][a] = x[c + 1] - x[0];
    }
    for (int b = 0; b < 3; b++) {
        v8 q[3];
        for (int c = 0; c < 3; c++)
            q[c] = load(m->gradient + (9 * group + 3 * c + b) * LANES);
        for (int a = 0; a < 3; a++)
            d[3 * a + b] = (by[0][a] * q[0] + by[1][a] * q[1]) + by[2][a] * q[2];
    }
}

/* What the corners pull with: volume times stress times gradient. */
INLINE void put_forces(const tissue_mesh *m, int64_t group, const v8 stress[9])
{
    const v8 volume = load(m->volume + group * LANES);
    float *to = m->force + group * LANES;
    for (int a = 0; a < 3; a++) {
        v8 sum = {0};
        for (int c = 0; c < 3; c++) {
            const float *q = m->gradient + (9 * group + 3 * c) * LANES;
            const v8 f = volume * ((stress[3 * a] * load(q) + stress[3 * a + 1] * load(q + LANES)) +
                                   stress[3 * a + 2] * load(q + 2 * LANES));
            sum += f;
            store(to + (3 * (c + 1) + a) * m->stride, f);
        }
        store(to + a * m->stride, -sum);
    }
}

/* The mean of the points of a group's elements, as far as these count. */
INLINE v8 point_mean(const tissue_mesh *m, int64_t group, const float *value)
{
    v8 sum = {0};
    for (int c = 0; c < 4 && m->points; c++) {
        const int32_t first = m->first_point[4 * group + c];
        sum += fetch(value, first != SELL_SCATTERED, first, m->point + (4 * group + c) * LANES);
    }
    return .25f * load(m->counted + group * LANES) * sum;
}

static void tissue_measure(const tissue_mesh *m, const lanes_field *u, int64_t from, int64_t to)
{
    for (int64_t i = from; i < to; i++) {
        v8 g[9], c[9];
        derive(m, i, u, g);
        stable_cofactors(g, c);
        for (int k = 0; k < 9; k++)
            store(m->g + (9 * i + k) * LANES, g[k]);
        const v8 swelling = stable_swelling(g, c), counted = stable_counted(swelling);
        store(m->counted + i * LANES, counted);
        store(m->swollen + i * LANES, .25f * load(m->volume + i * LANES) * stable_swelling_counted(swelling, counted));
    }
}

INLINE void take_g(const tissue_mesh *m, int64_t group, v8 g[9])
{
    for (int k = 0; k < 9; k++)
        g[k] = load(m->g + (9 * group + k) * LANES);
}

static void tissue_stress(const tissue_mesh *m, int64_t from, int64_t to)
{
    for (int64_t i = from; i < to; i++) {
        v8 g[9], stress[9];
        float *law = m->law + STABLE_NUMBERS * i * LANES;
        take_g(m, i, g);
        const stable_state at = stable_stress(g, load(m->mu + i * LANES), load(m->kappa + i * LANES),
                                              point_mean(m, i, m->pressure), stress);
        store(law, at.a);
        store(law + LANES, at.b);
        store(law + 2 * LANES, at.q);
        store(law + 3 * LANES, at.r);
        put_forces(m, i, stress);
    }
}

static void tissue_swell(const tissue_mesh *m, const lanes_field *way, int64_t from, int64_t to)
{
    for (int64_t i = from; i < to; i++) {
        v8 g[9], d[9], c[9];
        take_g(m, i, g);
        derive(m, i, way, d);
        for (int k = 0; k < 9; k += 4)
            g[k] += 1;
        stable_cofactors(g, c);
        store(m->swollen + i * LANES,
              .25f * load(m->volume + i * LANES) * load(m->counted + i * LANES) * stable_dot(c, d));
    }
}

static void tissue_tangent(const tissue_mesh *m, const lanes_field *way, int64_t from, int64_t to)
{
    for (int64_t i = from; i < to; i++) {
        v8 g[9], d[9], stress[9];
        const float *law = m->law + STABLE_NUMBERS * i * LANES;
        const stable_state at = {load(law), load(law + LANES), load(law + 2 * LANES), load(law + 3 * LANES)};
        take_g(m, i, g);
        derive(m, i, way, d);
        stable_tangent(g, d, &at, point_mean(m, i, m->pressed), stress);
        put_forces(m, i, stress);
    }
}

/* The lanes of a slot that have a summand. */
INLINE i8 lanes_of(const tissue_sums *s, int64_t slot)
{
    const i8 bits = {1, 2, 4, 8, 16, 32, 64, 128};
    return (bits & (int32_t)s->has[slot]) != 0;
}

INLINE v8 summand(const tissue_sums *s, int64_t slot, i8 has, const float *from)
{
    return (v8)((i8)fetch(from, s->first[slot] != SELL_SCATTERED, s->first[slot], s->list + slot * LANES) & has);
}

static void tissue_points(const tissue_mesh *m, float *value, int64_t from, int64_t to)
{
    for (int64_t i = from; i < to; i++) {
        v8 sum = {0};
        for (int64_t slot = m->swells.start[i]; slot < m->swells.start[i + 1]; slot++)
            sum += summand(&m->swells, slot, lanes_of(&m->swells, slot), m->swollen);
        sum *= load(m->bulk + i * LANES);
        if (value == m->pressure)
            sum += load(m->held + i * LANES);
        store(value + i * LANES, sum);
    }
}

static double tissue_gather(const tissue_mesh *m, const lanes_field *way, lanes_field *y, int64_t from, int64_t to)
{
    double dot = 0;
    for (int64_t i = from; i < to; i++) {
        v8 sum[3] = {{0}, {0}, {0}};
        for (int64_t slot = m->corners.start[i]; slot < m->corners.start[i + 1]; slot++) {
            const i8 has = lanes_of(&m->corners, slot);
            for (int a = 0; a < 3; a++)
                sum[a] += summand(&m->corners, slot, has, m->force + a * m->stride);
        }
        const i8 is_free = load(m->inverse + i * LANES) > 0;
        v8 along = {0};
        for (int a = 0; a < 3; a++) {
            sum[a] = (v8)((i8)sum[a] & is_free);
            store(y->x[a] + i * LANES, sum[a]);
            if (way)
                along += load(way->x[a] + i * LANES) * sum[a];
        }
        for (int l = 0; l < LANES; l++)
            dot += (double)along[l];
    }
    return dot;
}

static double tissue_advance(const tissue_mesh *m, lanes_field *d, lanes_field *r, const lanes_field *way,
                             const lanes_field *y, float alpha, int64_t from, int64_t to)
{
    double sum = 0;
    for (int64_t i = from * LANES; i < to * LANES; i += LANES) {
        v8 square = {0};
        for (int a = 0; a < 3; a++) {
            const v8 left = load(r->x[a] + i) - alpha * load(y->x[a] + i);
            store(d->x[a] + i, load(d->x[a] + i) + alpha * load(way->x[a] + i));
            store(r->x[a] + i, left);
            square += left * left;
        }
        square *= load(m->inverse + i);
        for (int l = 0; l < LANES; l++)
            sum += (double)square[l];
    }
    return sum;
}

static void tissue_turn(const tissue_mesh *m, lanes_field *way, const lanes_field *r, float beta, int64_t from,
                        int64_t to)
{
    for (int64_t i = from * LANES; i < to * LANES; i += LANES) {
        const v8 inverse = load(m->inverse + i);
        for (int a = 0; a < 3; a++)
            store(way->x[a] + i, inverse * load(r->x[a] + i) + beta * load(way->x[a] + i));
    }
}

#endif
