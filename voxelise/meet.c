#include "voxelise/meet.h"

#include "base/mem.h"
#include "mesh/candidates.h"
#include "voxelise/expansion.h"

#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

enum {
    EDGE = 2,
    CROSS = 16,
    TERM = 64
}; /* components of a difference, of a component of a cross product, and of a term */

static int sign_of(double x)
{
    return (x > 0) - (x < 0);
}

/* h = u[i] v[j] - u[j] v[i] of differences. */
static int exact_minor(double u[3][EDGE], const int *nu, double v[3][EDGE], const int *nv, int i, int j, double *h)
{
    double one[CROSS / 2], other[CROSS / 2];
    int n = expansion_product(nu[i], u[i], nv[j], v[j], one), m = expansion_product(nu[j], u[j], nv[i], v[i], other);
    expansion_negate(m, other);
    return expansion_sum(n, one, m, other, h);
}

static int exact_side(const double *a, const double *b, const double *c, const double *d)
{
    double u[3][EDGE], v[3][EDGE], w[3][EDGE], total[3 * TERM], sum[3 * TERM];
    int nu[3], nv[3], nw[3], count = 0;
    for (int i = 0; i < 3; i++) {
        nu[i] = expansion_of_sum(b[i], -a[i], u[i]);
        nv[i] = expansion_of_sum(c[i], -a[i], v[i]);
        nw[i] = expansion_of_sum(d[i], -a[i], w[i]);
    }
    for (int i = 0; i < 3; i++) {
        double minor[CROSS], term[TERM];
        int n = exact_minor(u, nu, v, nv, (i + 1) % 3, (i + 2) % 3, minor);
        int terms = expansion_product(n, minor, nw[i], w[i], term);
        count = expansion_sum(count, total, terms, term, sum);
        for (int t = 0; t < count; t++)
            total[t] = sum[t];
    }
    return expansion_sign(count, total);
}

/* The side of the plane of a, b, c on which d is: the sign of (b - a) x (c - a) . (d - a). Six products of three differences,
 * each of a few roundings, are summed: 16 epsilon of their magnitudes bound the error. */
static int side(const double *a, const double *b, const double *c, const double *d)
{
    double u[3], v[3], w[3], value = 0, size = 0;
    for (int i = 0; i < 3; i++)
        u[i] = b[i] - a[i], v[i] = c[i] - a[i], w[i] = d[i] - a[i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        value += (u[j] * v[k] - u[k] * v[j]) * w[i];
        size += (fabs(u[j] * v[k]) + fabs(u[k] * v[j])) * fabs(w[i]);
    }
    return fabs(value) > 16 * DBL_EPSILON * size ? sign_of(value) : exact_side(a, b, c, d);
}

/* Whether the edge p q passes through the inside of triangle t: not if it ends in a corner of it. */
static bool passes(const double *p, const double *q, const double *const *t)
{
    for (int i = 0; i < 3; i++)
        if (t[i] == p || t[i] == q)
            return false;
    int of_p = side(t[0], t[1], t[2], p), of_q = side(t[0], t[1], t[2], q);
    if (of_p * of_q >= 0)
        return false;
    int first = side(p, q, t[0], t[1]);
    return first && side(p, q, t[1], t[2]) == first && side(p, q, t[2], t[0]) == first;
}

bool meet_triangles(const double *position, const int32_t *one, const int32_t *other)
{
    const double *a[3], *b[3];
    for (int i = 0; i < 3; i++) {
        a[i] = &position[3 * (int64_t)one[i]];
        b[i] = &position[3 * (int64_t)other[i]];
    }
    for (int i = 0; i < 3; i++)
        if (passes(a[i], a[(i + 1) % 3], b) || passes(b[i], b[(i + 1) % 3], a))
            return true;
    return false;
}

/* ---- pairs whose boxes overlap */

typedef struct work {
    const double *position;
    const int32_t *vertex;
    double middle[3], scale; /* the frame that the tree stands in */
    atomic_llong count;
} work;

static const double reach = 1000; /* of the frame, from its middle */

static void give_box(const void *context, int64_t item, double *low, double *high)
{
    const work *w = context;
    for (int a = 0; a < 3; a++) {
        low[a] = INFINITY, high[a] = -INFINITY;
        for (int i = 0; i < 3; i++) {
            double x = (w->position[3 * (int64_t)w->vertex[3 * item + i] + a] - w->middle[a]) * w->scale;
            low[a] = fmin(low[a], x);
            high[a] = fmax(high[a], x);
        }
    }
}

static void take_pair(void *context, int64_t one, int64_t other)
{
    work *w = context;
    if (meet_triangles(w->position, &w->vertex[3 * one], &w->vertex[3 * other]))
        atomic_fetch_add(&w->count, 1);
}

int meet_count(const double *position, const int32_t *vertex, int64_t triangles, int threads, int64_t *count, err *e)
{
    work w = {.position = position, .vertex = vertex};
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, longest = 0;
    for (int64_t c = 0; c < 3 * triangles; c++)
        for (int a = 0; a < 3; a++) {
            double x = position[3 * (int64_t)vertex[c] + a];
            low[a] = fmin(low[a], x);
            high[a] = fmax(high[a], x);
        }
    for (int a = 0; a < 3; a++) {
        w.middle[a] = triangles ? low[a] / 2 + high[a] / 2 : 0;
        longest = fmax(longest, high[a] - low[a]);
    }
    w.scale = longest > 0 ? 2 * reach / longest : 1;
    candidates *near = candidates_create(triangles, give_box, &w, reach, threads, e);
    if (!near)
        return -1;
    candidates_pairs(near, take_pair, &w);
    candidates_destroy(near);
    *count = atomic_load(&w.count);
    return 0;
}
