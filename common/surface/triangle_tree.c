#include "surface/triangle_tree.h"

#include "base/mem.h"
#include "surface/edge_side.h"
#include "surface/winding.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEAF = 4,     /* triangles of a leaf, at most */
    WAITING = 64, /* nodes: of two halves one waits, and there are fewer than MOST triangles */
    MOST = 1 << 30
};

/* A box about some triangles, in their order in the tree: two halves, which are neighbours, or a leaf. */
typedef struct node {
    double low[3], high[3];
    int32_t first, count; /* triangles */
    int32_t half;         /* the first half's node; 0: a leaf */
} node;

struct triangle_tree {
    int64_t triangles;
    double *point;  /* triangles x 9, in the tree's order */
    int32_t *order; /* triangles: the caller's number of each */
    int32_t *place; /* triangles: the tree's number of the caller's */
    node *nodes;
    int32_t node_count;
    double near;   /* how far past its box a triangle's computed point may lie for rounding */
    winding whole; /* of point */
};

/* As fmin and fmax are where no number is nan, without a call. */
static inline double lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double greater(double a, double b)
{
    return a > b ? a : b;
}

/* ---- Making it */

static void widen(node *n, const double *corner)
{
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++) {
            n->low[a] = lesser(n->low[a], corner[3 * i + a]);
            n->high[a] = greater(n->high[a], corner[3 * i + a]);
        }
}

/* Three times the middle of a triangle. */
static double middle_of(const double *corner, int axis)
{
    return corner[axis] + corner[3 + axis] + corner[6 + axis];
}

static int longest_axis(const node *n)
{
    int best = 0;
    for (int a = 1; a < 3; a++)
        if (n->high[a] - n->low[a] > n->high[best] - n->low[best])
            best = a;
    return best;
}

typedef struct builder {
    const double *corner; /* triangles x 9, in the caller's order */
    int32_t *order;
    double *middle; /* triangles, by their places in order: along the axis at hand */
} builder;

static void swap(builder *b, int64_t i, int64_t j)
{
    const int32_t order = b->order[i];
    const double middle = b->middle[i];
    b->order[i] = b->order[j];
    b->middle[i] = b->middle[j];
    b->order[j] = order;
    b->middle[j] = middle;
}

/* Moves triangles [low, high] so that none before `half` is above one from there on (Hoare's selection). */
static void divide(builder *b, int64_t low, int64_t high, int64_t half)
{
    while (low < high) {
        const double pivot = b->middle[low + (high - low) / 2];
        int64_t i = low, j = high;
        while (i <= j) {
            while (b->middle[i] < pivot)
                i++;
            while (b->middle[j] > pivot)
                j--;
            if (i <= j)
                swap(b, i++, j--);
        }
        if (half > j)
            low = i;
        if (half < i)
            high = j;
    }
}

static void grow(triangle_tree *t, builder *b, node *n)
{
    const int64_t end = (int64_t)n->first + n->count;
    for (int a = 0; a < 3; a++) {
        n->low[a] = INFINITY;
        n->high[a] = -INFINITY;
    }
    for (int64_t i = n->first; i < end; i++)
        widen(n, b->corner + 9 * (int64_t)b->order[i]);
    if (n->count <= LEAF)
        return;
    const int axis = longest_axis(n);
    for (int64_t i = n->first; i < end; i++)
        b->middle[i] = middle_of(b->corner + 9 * (int64_t)b->order[i], axis);
    const int32_t lower = n->count / 2;
    divide(b, n->first, end - 1, n->first + lower);
    n->half = t->node_count;
    t->nodes[t->node_count++] = (node){.first = n->first, .count = lower};
    t->nodes[t->node_count++] = (node){.first = n->first + lower, .count = n->count - lower};
}

static void build(triangle_tree *t, builder *b)
{
    double largest = 0;
    for (int64_t i = 0; i < 9 * t->triangles; i++)
        largest = greater(largest, fabs(b->corner[i]));
    for (int64_t i = 0; i < t->triangles; i++)
        b->order[i] = (int32_t)i;
    t->near = 4e-15 * largest;
    t->nodes[t->node_count++] = (node){.count = (int32_t)t->triangles};
    for (int32_t n = 0; n < t->node_count; n++)
        grow(t, b, &t->nodes[n]);
    for (int64_t i = 0; i < t->triangles; i++) {
        t->place[t->order[i]] = (int32_t)i;
        memcpy(t->point + 9 * i, b->corner + 9 * (int64_t)t->order[i], 9 * sizeof *t->point);
    }
    t->whole = winding_of(t->point, NULL, t->triangles);
}

triangle_tree *triangle_tree_create(const double *position, const int32_t *corner, int64_t triangles, err *e)
{
    static const char what[] = "the tree of triangles";
    if (triangles >= MOST) {
        err_set(e, NULL, 0, "%" PRId64 " triangles of a surface; expected fewer than %d", triangles, MOST);
        return NULL;
    }
    triangle_tree *t = mem_array(1, sizeof *t, what, e);
    double *copy = t ? mem_array(triangles, 9 * sizeof *copy, what, e) : NULL;
    double *middle = copy ? mem_array(triangles, sizeof *middle, what, e) : NULL;
    bool made = false;
    /* A node with halves has more than LEAF triangles, so that no node has fewer than two. */
    if (middle && (t->point = mem_array(triangles, 9 * sizeof *t->point, what, e)) &&
        (t->order = mem_array(triangles, sizeof *t->order, what, e)) &&
        (t->place = mem_array(triangles, sizeof *t->place, what, e)) &&
        (t->nodes = mem_array(triangles + 1, sizeof *t->nodes, what, e))) {
        for (int64_t i = 0; i < 3 * triangles; i++)
            memcpy(copy + 3 * i, position + 3 * (int64_t)corner[i], 3 * sizeof *copy);
        t->triangles = triangles;
        build(t, &(builder){copy, t->order, middle});
        made = true;
    }
    free(copy);
    free(middle);
    if (made)
        return t;
    triangle_tree_destroy(t);
    return NULL;
}

void triangle_tree_destroy(triangle_tree *t)
{
    if (!t)
        return;
    free(t->point);
    free(t->order);
    free(t->place);
    free(t->nodes);
    free(t);
}

/* ---- Searching */

/* The least squared distance from q to a point that is computed of a triangle in the box. */
static double least_of(const triangle_tree *t, const node *n, const double *q)
{
    double sum = 0;
    for (int a = 0; a < 3; a++) {
        const double off = greater(greater(n->low[a] - q[a], q[a] - n->high[a]) - t->near, 0);
        sum += off * off;
    }
    return sum;
}

static void look_at(const triangle_tree *t, int64_t place, const double *q, triangle_hit *best)
{
    const double *at = t->point + 9 * place;
    triangle_hit hit = {.triangle = t->order[place]};
    hit.distance2 = closest_triangle_on(at, at + 3, at + 6, q, hit.point, &hit.feature);
    if (hit.distance2 < best->distance2 || (hit.distance2 == best->distance2 && hit.triangle < best->triangle))
        *best = hit;
}

typedef struct waiting {
    int32_t node;
    double least; /* nothing in it is nearer, squared */
} waiting;

/* Sums of squares have roundings of some 1e-16. */
static bool may_hold(double least, const triangle_hit *best)
{
    return least <= best->distance2 * (1 + 1e-14);
}

triangle_hit triangle_tree_nearest(const triangle_tree *t, const double q[3], int64_t guess)
{
    triangle_hit best = {.triangle = INT64_MAX, .distance2 = INFINITY};
    waiting list[WAITING];
    int count = 0;
    if (guess >= 0)
        look_at(t, t->place[guess], q, &best);
    list[count++] = (waiting){0, 0};
    while (count) {
        const waiting w = list[--count];
        const node *n = &t->nodes[w.node];
        if (!may_hold(w.least, &best))
            continue;
        if (!n->half) {
            for (int32_t i = 0; i < n->count; i++)
                look_at(t, n->first + i, q, &best);
            continue;
        }
        waiting one = {n->half, least_of(t, &t->nodes[n->half], q)};
        waiting other = {n->half + 1, least_of(t, &t->nodes[n->half + 1], q)};
        const bool swapped = other.least < one.least;
        list[count++] = swapped ? one : other; /* the nearer half comes first */
        list[count++] = swapped ? other : one;
    }
    return best;
}

/* ---- Inside */

/* What a ray from a point upward crosses. */
typedef struct ray {
    const triangle_tree *t;
    const double *from;
    int crossed;  /* how often, the sense counted */
    bool is_on;   /* the point lies on the surface */
    bool is_open; /* rounding does not let tell whether it lies below a triangle */
} ray;

/* Six times the volume of the origin and a triangle, and a bound on its error (Shewchuk 1997, orient3d). */
static double volume_of(double at[3][3], double *error)
{
    const double *a = at[0], *b = at[1], *c = at[2];
    const double bc = b[0] * c[1], cb = b[1] * c[0], ca = c[0] * a[1], ac = c[1] * a[0], ab = a[0] * b[1],
                 ba = a[1] * b[0];
    *error = 1e-15 * ((fabs(bc) + fabs(cb)) * fabs(a[2]) + (fabs(ca) + fabs(ac)) * fabs(b[2]) +
                      (fabs(ab) + fabs(ba)) * fabs(c[2]));
    return a[2] * (bc - cb) + b[2] * (ca - ac) + c[2] * (ab - ba);
}

/* Corners are rounded once, and alike in each triangle that has them: what is crossed stays closed. */
static void cross(ray *r, int64_t place)
{
    const double *p = r->t->point + 9 * place, *const corner[3] = {p, p + 3, p + 6};
    double at[3][3], error;
    if (winding_meets(&r->t->whole, corner, r->from)) {
        r->is_on = true;
        return;
    }
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            at[i][a] = corner[i][a] - r->from[a];
    const int side = edge_side(at[0], at[1]);
    if (!side || edge_side(at[1], at[2]) != side || edge_side(at[2], at[0]) != side)
        return;
    const double volume = side * volume_of(at, &error);
    if (!(fabs(volume) > error))
        r->is_open = true;
    else if (volume > 0)
        r->crossed += side;
}

/* Whether the ray comes into a box, or begins on it. */
static bool comes_into(const ray *r, const node *n)
{
    const double near = r->t->whole.near, *q = r->from;
    for (int a = 0; a < 3; a++)
        if (q[a] > n->high[a] + near || (a < 2 && q[a] < n->low[a] - near))
            return false;
    return true;
}

bool triangle_tree_holds(const triangle_tree *t, const double q[3])
{
    ray r = {.t = t, .from = q};
    int32_t list[WAITING] = {0};
    for (int a = 0; a < 3; a++)
        if (!(q[a] >= t->whole.low[a] && q[a] <= t->whole.high[a]))
            return false;
    for (int count = 1; count && !r.is_on;) {
        const node *n = &t->nodes[list[--count]];
        if (!comes_into(&r, n))
            continue;
        for (int32_t i = 0; !n->half && i < n->count; i++)
            cross(&r, n->first + i);
        if (n->half) {
            list[count++] = n->half;
            list[count++] = n->half + 1;
        }
    }
    return r.is_on || (r.is_open ? winding_holds(&t->whole, q) : r.crossed != 0);
}
