/* The loops of tissue.c over groups of elements and slices of nodes (tissue_mesh.h), for lanes_loops.c alone, which
 * includes this once for each instruction set.
 */
#ifndef SINEW_TISSUE_LOOPS_H
#define SINEW_TISSUE_LOOPS_H

#include "msds/cpu/tissue_mesh.h"
#include "msds/cpu/tissue_walls.h"

typedef v8 stable_number;
typedef int32_t i8 __attribute__((vector_size(32)));

INLINE v8 stable_larger(v8 a, v8 b)
{
    const i8 is = a > b;
    return (v8)((is & (i8)a) | (~is & (i8)b));
}

INLINE v8 stable_root(v8 a)
{
    v8 to = a;
    for (int l = 0; l < LANES; l++)
        to[l] = __builtin_sqrtf(a[l]);
    return to;
}

#include "msds/problem/stable.h"
#include "msds/problem/wall.h"

/* The gradients of corners 1 to 3 of a group's elements. */
INLINE void take_gradients(const tissue_mesh *m, int64_t group, v8 q[9])
{
    const float *from = m->gradient + m->shape[group];
    if (m->shape[group + 1] - m->shape[group] == 9)
        for (int k = 0; k < 9; k++)
            q[k] = (v8){0} + from[k];
    else
        for (int k = 0; k < 9; k++)
            q[k] = load(from + k * LANES);
}

/* The derivatives of a field of nodes in the elements of a group. */
INLINE void derive(const tissue_mesh *m, int64_t group, bool row, const lanes_field *f, const v8 q[9], v8 d[9])
{
    v8 by[3][3];
    for (int a = 0; a < 3; a++) {
        v8 x[4];
        for (int c = 0; c < 4; c++) {
            x[c] = fetch(f->x[a], row, m->first[4 * group + c], m->node + (4 * group + c) * LANES);
        }
        for (int c = 0; c < 3; c++)
            by[c][a] = x[c + 1] - x[0];
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            d[3 * a + b] = (by[0][a] * q[b] + by[1][a] * q[3 + b]) + by[2][a] * q[6 + b];
}

/* What the corners pull with: volume times stress times gradient. */
INLINE void put_forces(const tissue_mesh *m, int64_t group, const v8 q[9], const v8 stress[9])
{
    const v8 volume = load(m->volume + group * LANES);
    float *to = m->force + group * LANES;
    for (int a = 0; a < 3; a++) {
        v8 sum = {0};
        for (int c = 0; c < 3; c++) {
            const v8 f = volume * ((stress[3 * a] * q[3 * c] + stress[3 * a + 1] * q[3 * c + 1]) +
                                   stress[3 * a + 2] * q[3 * c + 2]);
            sum += f;
            store(to + (3 * (c + 1) + a) * m->stride, f);
        }
        store(to + a * m->stride, -sum);
    }
}

/* The mean of the points of a group's elements, as far as these count. */
INLINE v8 point_mean(const tissue_mesh *m, int64_t group, bool row, const float *value)
{
    v8 sum = {0};
    for (int c = 0; c < 4 && m->points; c++)
        sum += fetch(value, row, m->first_point[4 * group + c], m->point + (4 * group + c) * LANES);
    return .25f * load(m->counted + group * LANES) * sum;
}

INLINE void take_g(const tissue_mesh *m, int64_t group, v8 g[9])
{
    for (int k = 0; k < 9; k++)
        g[k] = load(m->g + (9 * group + k) * LANES);
}

/* m->g of a group's elements at u. Returns J - 1. */
INLINE v8 measure_elements(const tissue_mesh *m, int64_t i, bool row, const lanes_field *u)
{
    v8 q[9], g[9], c[9];
    take_gradients(m, i, q);
    derive(m, i, row, u, q, g);
    stable_cofactors(g, c);
    for (int k = 0; k < 9; k++)
        store(m->g + (9 * i + k) * LANES, g[k]);
    return stable_swelling(g, c);
}

INLINE void measure_group(const tissue_mesh *m, int64_t i, bool row, const lanes_field *u)
{
    const v8 swelling = measure_elements(m, i, row, u), counted = stable_counted(swelling);
    store(m->counted + i * LANES, counted);
    store(m->swollen + i * LANES, .25f * load(m->volume + i * LANES) * stable_swelling_counted(swelling, counted));
}

/* Adds a matrix times the prestress, which is symmetric. */
INLINE void add_prestress(const tissue_mesh *m, int64_t i, const v8 f[9], v8 stress[9])
{
    static const int at[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
    v8 s[6];
    for (int k = 0; k < 6; k++)
        s[k] = load(m->prestress + (6 * i + k) * LANES);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            stress[3 * a + b] += (f[3 * a] * s[at[b]] + f[3 * a + 1] * s[at[3 + b]]) + f[3 * a + 2] * s[at[6 + b]];
}

INLINE void put_law(const tissue_mesh *m, int64_t i, v8 a, v8 b, v8 c, v8 d)
{
    float *law = m->law + STABLE_NUMBERS * i * LANES;
    store(law, a);
    store(law + LANES, b);
    store(law + 2 * LANES, c);
    store(law + 3 * LANES, d);
}

INLINE stable_state take_law(const tissue_mesh *m, int64_t i)
{
    const float *law = m->law + STABLE_NUMBERS * i * LANES;
    return (stable_state){load(law), load(law + LANES), load(law + 2 * LANES), load(law + 3 * LANES)};
}

INLINE void stress_group(const tissue_mesh *m, int64_t i, bool row)
{
    v8 q[9], g[9], stress[9];
    take_gradients(m, i, q);
    take_g(m, i, g);
    const stable_state at = stable_stress(g, load(m->mu + i * LANES), load(m->kappa + i * LANES),
                                          point_mean(m, i, row, m->pressure), stress);
    put_law(m, i, at.a, at.b, at.q, at.r);
    for (int k = 0; m->prestress && k < 9; k += 4)
        g[k] += 1;
    if (m->prestress)
        add_prestress(m, i, g, stress);
    put_forces(m, i, q, stress);
}

INLINE void swell_group(const tissue_mesh *m, int64_t i, bool row, const lanes_field *way)
{
    v8 q[9], g[9], d[9], c[9];
    take_gradients(m, i, q);
    take_g(m, i, g);
    derive(m, i, row, way, q, d);
    for (int k = 0; k < 9; k += 4)
        g[k] += 1;
    stable_cofactors(g, c);
    store(m->swollen + i * LANES, .25f * load(m->volume + i * LANES) * load(m->counted + i * LANES) * stable_dot(c, d));
}

INLINE void tangent_group(const tissue_mesh *m, int64_t i, bool row, const lanes_field *way)
{
    v8 q[9], g[9], d[9], stress[9];
    const stable_state at = take_law(m, i);
    take_gradients(m, i, q);
    take_g(m, i, g);
    derive(m, i, row, way, q, d);
    stable_tangent(g, d, &at, point_mean(m, i, row, m->pressed), stress);
    if (m->prestress)
        add_prestress(m, i, d, stress);
    put_forces(m, i, q, stress);
}

/* ---- cavities: all groups are scattered */

INLINE void measure_lumen(const tissue_mesh *m, int64_t i, const lanes_field *u)
{
    store(m->swollen + i * LANES, load(m->volume + i * LANES) * measure_elements(m, i, false, u));
}

/* Takes what acts on corners that lie on a wall off them, and adds what keeps walls from crossing: b. */
INLINE void push_lumen(const tissue_mesh *m, int64_t i, const v8 q[9], const v8 cofactors[9], v8 pressure)
{
    const v8 push = -load(m->volume + i * LANES) * pressure;
    for (int a = 0; a < 3; a++) {
        v8 sum = {0};
        for (int k = 0; k < 4; k++) {
            float *at = m->force + (3 * k + a) * m->stride + i * LANES;
            v8 own = {0};
            for (int d = 0; d < 3 && k; d++)
                own += push * cofactors[3 * a + d] * q[3 * (k - 1) + d];
            sum += own;
            store(at, load(at) * load(m->within + (4 * (i - m->lumens) + k) * LANES) + own);
        }
        float *first = m->force + a * m->stride + i * LANES;
        store(first, load(first) - sum);
    }
}

/* What keeps walls from crossing acts on all corners; what keeps a cavity's elements in shape acts on nodes within it
 * alone, so that these go along with the walls, but do not hold them. */
INLINE void stress_lumen(const tissue_mesh *m, int64_t i)
{
    v8 q[9], g[9], c[9], stress[9];
    const v8 nothing = {0}, thin = nothing + (float)TISSUE_WALLS_THIN, mu = load(m->mu + i * LANES);
    const stable_barrier none = {nothing, nothing};
    take_gradients(m, i, q);
    take_g(m, i, g);
    stable_cofactors(g, c);
    const stable_barrier b = stable_meeting(stable_swelling(g, c), thin, load(m->kappa + i * LANES));
    const stable_state at = stable_stress_of(g, mu, mu, nothing, &none, stress);
    put_law(m, i, at.a, at.b, nothing, at.r + b.stiffness);
    put_forces(m, i, q, stress);
    for (int k = 0; k < 9; k += 4)
        g[k] += 1;
    stable_cofactors(g, c);
    push_lumen(m, i, q, c, b.pressure);
}

/* What a cavity's content gives way by is what its walls do. */
INLINE void swell_lumen(const tissue_mesh *m, int64_t i)
{
    store(m->swollen + i * LANES, (v8){0});
}

INLINE void tangent_lumen(const tissue_mesh *m, int64_t i, const lanes_field *way)
{
    v8 q[9], g[9], d[9], stress[9];
    const stable_state at = take_law(m, i);
    take_gradients(m, i, q);
    take_g(m, i, g);
    derive(m, i, false, way, q, d);
    stable_tangent(g, d, &at, (v8){0}, stress);
    put_forces(m, i, q, stress);
}

INLINE v8 fetch_point(const tissue_mesh *m, int64_t i, const float *value)
{
    return fetch(value, false, 0, m->point + 4 * i * LANES);
}

/* A field at the corners of triangles, and its two columns of derivatives. n: the group's numbers (tissue_walls.h). */
INLINE void derive_wall(const tissue_mesh *m, int64_t i, const lanes_field *f, const v8 n[9], v8 x[9], v8 g[6])
{
    for (int c = 0; c < 3; c++)
        for (int a = 0; a < 3; a++)
            x[3 * c + a] = fetch(f->x[a], false, 0, m->node + (4 * i + c) * LANES);
    for (int a = 0; a < 3; a++) {
        g[a] = (x[3 + a] - x[a]) / n[6];
        g[3 + a] = (x[6 + a] - x[a] - n[7] * g[a]) / n[8];
    }
}

/* F, and the edges from corner 0. */
INLINE void place_wall(const tissue_mesh *m, int64_t i, const v8 n[9], v8 f[6], v8 edge[6])
{
    for (int k = 0; k < 6; k++)
        f[k] = n[k] + load(m->g + (9 * i + k) * LANES);
    for (int a = 0; a < 3; a++) {
        edge[a] = n[6] * f[a];
        edge[3 + a] = n[7] * f[a] + n[8] * f[3 + a];
    }
}

/* Forces of the corners: of a stress of the membrane, and as `corner` has them, per m2 at rest. */
INLINE void put_wall(const tissue_mesh *m, int64_t i, const v8 n[9], const v8 stress[6], const v8 corner[9])
{
    const v8 area = load(m->volume + i * LANES);
    float *to = m->force + i * LANES;
    for (int a = 0; a < 3; a++) {
        const v8 second = stress[3 + a] / n[8], first = (stress[a] - n[7] * second) / n[6];
        store(to + a * m->stride, area * (corner[a] - (first + second)));
        store(to + (3 + a) * m->stride, area * (corner[3 + a] + first));
        store(to + (6 + a) * m->stride, area * (corner[6 + a] + second));
    }
}

INLINE void measure_wall(const tissue_mesh *m, int64_t i, const lanes_field *u)
{
    v8 n[9], x[9], g[6];
    take_gradients(m, i, n);
    derive_wall(m, i, u, n, x, g);
    for (int k = 0; k < 6; k++)
        store(m->g + (9 * i + k) * LANES, g[k]);
    store(m->swollen + i * LANES, (v8){0});
}

INLINE void stress_wall(const tissue_mesh *m, int64_t i)
{
    v8 n[9], g[6], f[6], edge[6], s[3], s0[3] = {{0}, {0}, {0}}, stress[6], normal[3], corner[9];
    take_gradients(m, i, n);
    place_wall(m, i, n, f, edge);
    for (int k = 0; k < 6; k++)
        g[k] = load(m->g + (9 * i + k) * LANES);
    for (int k = 0; m->prestress && k < 3; k++)
        s0[k] = load(m->prestress + (6 * i + k) * LANES);
    wall_stress(n, g, load(m->mu + i * LANES), s0, s, stress);
    const v8 p = fetch_point(m, i, m->pressure);
    put_law(m, i, s[0], s[1], s[2], p);
    wall_cross(f, f + 3, normal);
    for (int k = 0; k < 9; k++)
        corner[k] = p * normal[k % 3] * (1.f / 3);
    put_wall(m, i, n, stress, corner);
}

/* What goes through it. */
INLINE void swell_wall(const tissue_mesh *m, int64_t i, const lanes_field *way)
{
    v8 n[9], f[6], edge[6], x[9], g[6], normal[3], mean[3];
    take_gradients(m, i, n);
    place_wall(m, i, n, f, edge);
    derive_wall(m, i, way, n, x, g);
    wall_cross(f, f + 3, normal);
    for (int a = 0; a < 3; a++)
        mean[a] = (x[a] + x[3 + a] + x[6 + a]) * (1.f / 3);
    store(m->swollen + i * LANES, load(m->volume + i * LANES) * wall_dot(normal, mean));
}

INLINE void tangent_wall(const tissue_mesh *m, int64_t i, const lanes_field *way)
{
    v8 n[9], f[6], edge[6], x[9], d[6], stress[6], normal[3], corner[9];
    const float *law = m->law + STABLE_NUMBERS * i * LANES;
    const v8 s[3] = {load(law), load(law + LANES), load(law + 2 * LANES)}, p = load(law + 3 * LANES);
    take_gradients(m, i, n);
    place_wall(m, i, n, f, edge);
    derive_wall(m, i, way, n, x, d);
    wall_tangent(f, d, s, load(m->mu + i * LANES), stress);
    wall_follow(edge, x, p, corner);
    wall_cross(f, f + 3, normal);
    const v8 both = n[6] * n[8] * .5f, more = fetch_point(m, i, m->pressed);
    for (int k = 0; k < 9; k++)
        corner[k] = corner[k] / both + more * normal[k % 3] * (1.f / 3);
    put_wall(m, i, n, stress, corner);
}

/* How much of a prestress an element can bear: at a corner of a wall that is not smooth it may be such that the element
 * would give way. Its least eigenvalue, which is not below its mean less sqrt(2/3) of the norm of its deviator, stays
 * above half a shear modulus of compression. */
INLINE v8 prestress_share(const v8 s[6], v8 mu)
{
    const v8 mean = (s[0] + s[1] + s[2]) * (1.f / 3), x = s[0] - mean, y = s[1] - mean, z = s[2] - mean;
    const v8 square = (x * x + y * y + z * z) + 2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
    const v8 pressed = stable_root(square * (2.f / 3)) - mean, most = mu * .5f;
    return most / stable_larger(pressed, most + 1e-30f);
}

/* The prestress that a strain of linear elasticity would give: of the displacement `of`. */
INLINE void prestress_group(const tissue_mesh *m, int64_t i, const lanes_field *of)
{
    v8 q[9], g[9];
    take_gradients(m, i, q);
    derive(m, i, false, of, q, g);
    const v8 mu = load(m->mu + i * LANES) * .75f;
    const v8 mean = (load(m->kappa + i * LANES) - mu * (5.f / 6)) * (g[0] + g[4] + g[8]);
    const v8 s[6] = {mean + 2 * mu * g[0], mean + 2 * mu * g[4], mean + 2 * mu * g[8],
                     mu * (g[1] + g[3]),   mu * (g[2] + g[6]),   mu * (g[5] + g[7])};
    const v8 share = prestress_share(s, mu);
    for (int k = 0; k < 6; k++)
        store(m->prestress + (6 * i + k) * LANES, share * s[k]);
}

INLINE void prestress_wall(const tissue_mesh *m, int64_t i, const lanes_field *of)
{
    v8 n[9], x[9], g[6], s[3];
    take_gradients(m, i, n);
    derive_wall(m, i, of, n, x, g);
    const v8 strain[3] = {wall_dot(n, g), wall_dot(n + 3, g + 3), (wall_dot(n, g + 3) + wall_dot(n + 3, g)) * .5f};
    wall_law(strain, load(m->mu + i * LANES), s);
    for (int k = 0; k < 3; k++)
        store(m->prestress + (6 * i + k) * LANES, s[k]);
}

/* Groups whose corners are loaded in a row have code of their own, without a branch for each. */
#define TISSUE_GROUPS(call_row, call_scattered, call_lumen, call_wall)                                                 \
    for (int64_t i = from; i < to; i++)                                                                                \
        if (i >= m->walls)                                                                                             \
            (call_wall);                                                                                               \
        else if (i >= m->lumens)                                                                                       \
            (call_lumen);                                                                                              \
        else if (m->first[4 * i] != SELL_SCATTERED)                                                                    \
            (call_row);                                                                                                \
        else                                                                                                           \
            (call_scattered)

static void tissue_measure(const tissue_mesh *m, const lanes_field *u, int64_t from, int64_t to)
{
    TISSUE_GROUPS(measure_group(m, i, true, u), measure_group(m, i, false, u), measure_lumen(m, i, u),
                  measure_wall(m, i, u));
}

static void tissue_stress(const tissue_mesh *m, int64_t from, int64_t to)
{
    TISSUE_GROUPS(stress_group(m, i, true), stress_group(m, i, false), stress_lumen(m, i), stress_wall(m, i));
}

static void tissue_swell(const tissue_mesh *m, const lanes_field *way, int64_t from, int64_t to)
{
    TISSUE_GROUPS(swell_group(m, i, true, way), swell_group(m, i, false, way), swell_lumen(m, i),
                  swell_wall(m, i, way));
}

static void tissue_tangent(const tissue_mesh *m, const lanes_field *way, int64_t from, int64_t to)
{
    TISSUE_GROUPS(tangent_group(m, i, true, way), tangent_group(m, i, false, way), tangent_lumen(m, i, way),
                  tangent_wall(m, i, way));
}

static void tissue_prestress(const tissue_mesh *m, const lanes_field *of, int64_t from, int64_t to)
{
    for (int64_t i = from; i < to; i++)
        if (i >= m->walls)
            prestress_wall(m, i, of);
        else if (i < m->lumens)
            prestress_group(m, i, of);
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

enum { AHEAD = 12 }; /* slots: what they load comes from far */

INLINE void fetch_ahead(const tissue_mesh *m, int64_t slot)
{
    const int32_t first = slot < m->corners.slots ? m->corners.first[slot] : SELL_SCATTERED;
    for (int a = 0; a < 3 && first != SELL_SCATTERED; a++)
        __builtin_prefetch(m->force + a * m->stride + first);
}

static double tissue_gather(const tissue_mesh *m, const lanes_field *way, lanes_field *y, int64_t from, int64_t to)
{
    double dot = 0;
    for (int64_t i = from; i < to; i++) {
        v8 sum[3] = {{0}, {0}, {0}};
        for (int64_t slot = m->corners.start[i]; slot < m->corners.start[i + 1]; slot++) {
            fetch_ahead(m, slot + AHEAD);
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
