#include "voxelise/surfaces/meet.h"

#include "base/mem.h"
#include "surface/candidates.h"
#include "voxelise/surfaces/expansion.h"

#include <float.h>
#include <math.h>
#include <pthread.h>
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

/* The side of the plane of a, b, c on which d is: the sign of (b - a) x (c - a) . (d - a). Six products of three
 * differences, each of a few roundings, are summed: 16 epsilon of their magnitudes bound the error. */
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

/* ---- two triangles */

typedef const double *const corners[3];

static bool is_corner(corners t, const double *p)
{
    return t[0] == p || t[1] == p || t[2] == p;
}

/* The sides of a triangle's plane on which another's corners are. */
static void find_sides(corners plane, corners of, int *where)
{
    for (int i = 0; i < 3; i++)
        where[i] = is_corner(plane, of[i]) ? 0 : side(plane[0], plane[1], plane[2], of[i]);
}

static bool on_both(const int *where)
{
    return (where[0] > 0 || where[1] > 0 || where[2] > 0) && (where[0] < 0 || where[1] < 0 || where[2] < 0);
}

/* The corner that is alone on its side, first, then the two others in their order. */
static void alone_first(corners of, const int *where, const double **to)
{
    int above = (where[0] > 0) + (where[1] > 0) + (where[2] > 0), lone = above == 1 ? 1 : -1;
    int first = 0;
    while (first < 2 && where[first] != lone)
        first++;
    for (int i = 0; i < 3; i++)
        to[i] = of[(first + i) % 3];
}

/* Both have corners on either side of the other's plane, so each cuts an interval out of the line in which these meet,
 * whose ends are on the two edges of the corner that is alone. The insides meet where the intervals overlap in more
 * than a point: each begins before the other ends, which two edges of four say (Guigue and Devillers, 2003). */
static bool cross_inside(corners one, const int *of_one, corners other, const int *of_other)
{
    if (!on_both(of_one) || !on_both(of_other))
        return false;
    const double *p[3], *q[3], *swap;
    alone_first(one, of_one, p);
    alone_first(other, of_other, q);
    if (side(q[0], q[1], q[2], p[0]) < 0)
        swap = q[1], q[1] = q[2], q[2] = swap;
    if (side(p[0], p[1], p[2], q[0]) < 0)
        swap = p[1], p[1] = p[2], p[2] = swap;
    return side(p[0], p[1], q[0], q[1]) < 0 && side(p[0], p[2], q[2], q[0]) < 0;
}

/* Whether the edge from corner i of a triangle to the next lies in another's plane, its third corner does not, and the
 * edge runs through the other's inside: neither has the other on one side of it. Sides within the plane are those of
 * planes through the third corner. */
static bool runs_within(corners t, const int *where, int i, corners other)
{
    if (where[i] || where[(i + 1) % 3] || !where[(i + 2) % 3])
        return false;
    const double *p = t[i], *q = t[(i + 1) % 3], *apex = t[(i + 2) % 3];
    if (is_corner(other, p) && is_corner(other, q))
        return false;
    bool left = false, right = false;
    for (int k = 0; k < 3; k++) {
        const double *a = other[k], *b = other[(k + 1) % 3];
        int of_corner = side(p, q, apex, a), inner = side(a, b, apex, other[(k + 2) % 3]);
        left = left || of_corner > 0;
        right = right || of_corner < 0;
        if (side(a, b, apex, p) * inner <= 0 && side(a, b, apex, q) * inner <= 0)
            return false;
    }
    return left && right;
}

static void corners_of(const double *position, const int32_t *triangle, const double **to)
{
    for (int i = 0; i < 3; i++)
        to[i] = &position[3 * (int64_t)triangle[i]];
}

bool meet_triangles(const double *position, const int32_t *one, const int32_t *other)
{
    const double *a[3], *b[3];
    int of_a[3], of_b[3];
    corners_of(position, one, a);
    corners_of(position, other, b);
    find_sides(b, a, of_a);
    find_sides(a, b, of_b);
    return cross_inside(a, of_a, b, of_b);
}

/* ---- edges within triangles: the surface crosses there if its next triangle is on the other side */

/* An edge of a triangle, or an edge of a triangle within another. */
typedef struct within {
    int32_t low, high; /* ends */
    int32_t apex;      /* the triangle's third corner */
    int32_t other;     /* the triangle that it runs within */
} within;

static int compare_ends(const void *a, const void *b)
{
    const within *x = a, *y = b;
    if (x->low != y->low)
        return (x->low > y->low) - (x->low < y->low);
    return (x->high > y->high) - (x->high < y->high);
}

static within edge_of(const int32_t *triangle, int i, int32_t other)
{
    int32_t p = triangle[i], q = triangle[(i + 1) % 3];
    const int32_t third = triangle[(i + 2) % 3];
    return p < q ? (within){p, q, third, other} : (within){q, p, third, other};
}

typedef struct edges {
    within *edge;
    int64_t count, capacity;
} edges;

/* Every edge of the mesh, in the ends' order. */
static int list_edges(edges *all, const int32_t *vertex, int64_t triangles, err *e)
{
    all->edge = mem_array(3 * triangles, sizeof *all->edge, "edges", e);
    if (!all->edge)
        return -1;
    for (int64_t t = 0; t < triangles; t++)
        for (int i = 0; i < 3; i++)
            all->edge[all->count++] = edge_of(&vertex[3 * t], i, -1);
    qsort(all->edge, (size_t)all->count, sizeof *all->edge, compare_ends);
    return 0;
}

/* The first of an edge's uses. */
static int64_t first_use(const edges *all, const within *of)
{
    int64_t from = 0, to = all->count;
    while (from < to) {
        int64_t middle = from + (to - from) / 2;
        if (compare_ends(&all->edge[middle], of) < 0)
            from = middle + 1;
        else
            to = middle;
    }
    return from;
}

/* Whether an edge that runs within a triangle has another triangle on its other side. */
static bool goes_through(const within *of, const edges *all, const double *position, const int32_t *vertex)
{
    const double *t[3];
    corners_of(position, &vertex[3 * (int64_t)of->other], t);
    int here = side(t[0], t[1], t[2], &position[3 * (int64_t)of->apex]);
    for (int64_t i = first_use(all, of); i < all->count && !compare_ends(&all->edge[i], of); i++)
        if (side(t[0], t[1], t[2], &position[3 * (int64_t)all->edge[i].apex]) == -here)
            return true;
    return false;
}

/* How many of the edges within triangles go through; edges are listed only if there are any. */
static int count_through(const edges *inside, const double *position, const int32_t *vertex, int64_t triangles,
                         int64_t *count, err *e)
{
    edges all = {0};
    if (inside->count && list_edges(&all, vertex, triangles, e))
        return -1;
    for (int64_t i = 0; i < inside->count; i++)
        *count += goes_through(&inside->edge[i], &all, position, vertex);
    free(all.edge);
    return 0;
}

/* ---- how deep */

/* Of two triangles along an axis of any length, in its length: the least way that takes one off the other. */
static double overlap(corners one, corners other, const double *axis)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (int i = 0; i < 6; i++) {
        const double *p = i < 3 ? one[i] : other[i - 3];
        const double along = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
        low[i / 3] = fmin(low[i / 3], along);
        high[i / 3] = fmax(high[i / 3], along);
    }
    return length > 0 ? fmin(high[0] - low[1], high[1] - low[0]) / length : INFINITY;
}

static void cross(const double *u, const double *v, double *to)
{
    for (int a = 0; a < 3; a++)
        to[a] = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
}

static void edges_of(corners t, double edge[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            edge[i][a] = t[(i + 1) % 3][a] - t[i][a];
}

static double depth_of(corners one, corners other)
{
    double u[3][3], v[3][3], axis[3];
    edges_of(one, u);
    edges_of(other, v);
    cross(u[0], u[1], axis);
    double least = overlap(one, other, axis);
    cross(v[0], v[1], axis);
    least = fmin(least, overlap(one, other, axis));
    for (int i = 0; i < 9; i++) {
        cross(u[i / 3], v[i % 3], axis);
        least = fmin(least, overlap(one, other, axis));
    }
    return fmax(least, 0);
}

double meet_depth(const double *position, const int32_t *one, const int32_t *other)
{
    const double *p[3], *q[3];
    corners_of(position, one, p);
    corners_of(position, other, q);
    return depth_of(p, q);
}

/* ---- pairs whose boxes overlap */

typedef struct work {
    const double *position;
    const int32_t *vertex;
    double middle[3], scale; /* the frame that the tree stands in */
    atomic_llong count;
    pthread_mutex_t lock; /* of what follows */
    edges inside;
    double deepest;
    bool failed;
    err *e;
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

static void keep_edge(work *w, within edge)
{
    pthread_mutex_lock(&w->lock);
    if (!w->failed)
        w->failed = mem_grow(&w->inside.edge, &w->inside.capacity, w->inside.count + 1, sizeof edge, "edges", w->e);
    if (!w->failed)
        w->inside.edge[w->inside.count++] = edge;
    pthread_mutex_unlock(&w->lock);
}

static void keep_depth(work *w, double depth)
{
    pthread_mutex_lock(&w->lock);
    w->deepest = fmax(w->deepest, depth);
    pthread_mutex_unlock(&w->lock);
}

static void take_pair(void *context, int64_t one, int64_t other)
{
    work *w = context;
    const int32_t *a = &w->vertex[3 * one], *b = &w->vertex[3 * other];
    const double *p[3], *q[3];
    corners_of(w->position, a, p);
    corners_of(w->position, b, q);
    int of_p[3], of_q[3];
    find_sides(q, p, of_p);
    find_sides(p, q, of_q);
    if (cross_inside(p, of_p, q, of_q)) {
        atomic_fetch_add(&w->count, 1);
        keep_depth(w, depth_of(p, q));
        return;
    }
    for (int i = 0; i < 3; i++) {
        if (runs_within(p, of_p, i, q))
            keep_edge(w, edge_of(a, i, (int32_t)other));
        if (runs_within(q, of_q, i, p))
            keep_edge(w, edge_of(b, i, (int32_t)one));
    }
}

static void frame(work *w, int64_t triangles)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, longest = 0;
    for (int64_t c = 0; c < 3 * triangles; c++)
        for (int a = 0; a < 3; a++) {
            double x = w->position[3 * (int64_t)w->vertex[c] + a];
            low[a] = fmin(low[a], x);
            high[a] = fmax(high[a], x);
        }
    for (int a = 0; a < 3; a++) {
        w->middle[a] = triangles ? low[a] / 2 + high[a] / 2 : 0;
        longest = fmax(longest, high[a] - low[a]);
    }
    w->scale = longest > 0 ? 2 * reach / longest : 1;
}

int meet_count(const double *position, const int32_t *vertex, int64_t triangles, int threads, int64_t *count,
               double *deepest, err *e)
{
    work w = {.position = position, .vertex = vertex, .e = e};
    frame(&w, triangles);
    candidates *near = candidates_create(triangles, give_box, &w, reach, threads, e);
    if (!near)
        return -1;
    pthread_mutex_init(&w.lock, NULL);
    candidates_pairs(near, take_pair, &w);
    candidates_destroy(near);
    pthread_mutex_destroy(&w.lock);
    *count = atomic_load(&w.count);
    *deepest = w.deepest;
    int status = w.failed ? -1 : count_through(&w.inside, position, vertex, triangles, count, e);
    free(w.inside.edge);
    return status;
}
