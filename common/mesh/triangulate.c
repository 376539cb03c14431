#include "mesh/triangulate.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

/* A polygon of as many corners needs no memory of its own. */
enum { SMALL = 32 };

/* A corner seen along the axis that the polygon's normal is nearest to: u and v are its coordinates along the other two,
 * in the order that makes the polygon run anticlockwise. Dropping a coordinate rounds nothing. */
typedef struct corner {
    double u, v;
    int32_t before, next;
    bool maybe; /* perhaps an ear: it is to be tested */
} corner;

/* What is left of a polygon. */
typedef struct polygon {
    corner *corner;
    int32_t left, first;
    int32_t doubted; /* corners that were left when all of them last were to be tested */
} polygon;

/* The two axes to look along, from Newell's normal: twice the vector area. Taken about the first corner, so that far
 * offsets cost no digits. */
static void choose_axes(const double *position, const int32_t *vertex, int32_t count, int *u, int *v)
{
    double n[3] = {0};
    const double *o = &position[3 * (int64_t)vertex[0]];
    for (int32_t i = 1; i + 1 < count; i++) {
        const double *a = &position[3 * (int64_t)vertex[i]], *b = &position[3 * (int64_t)vertex[i + 1]];
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            n[k] += (a[p] - o[p]) * (b[q] - o[q]) - (a[q] - o[q]) * (b[p] - o[p]);
        }
    }
    int k = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
    k = fabs(n[2]) >= fabs(n[k]) ? 2 : k;
    *u = (k + (n[k] < 0 ? 2 : 1)) % 3;
    *v = (k + (n[k] < 0 ? 1 : 2)) % 3;
}

/* Twice the signed area of a triangle of corners. */
static inline double area(const corner *a, const corner *b, const corner *c)
{
    return (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
}

static inline bool same_place(const corner *a, const corner *b)
{
    return a->u == b->u && a->v == b->v;
}

/* Whether corner d lies in the closed triangle, but not on one of its corners (where a polygon touches itself). */
static inline bool blocks(const corner *a, const corner *b, const corner *c, const corner *d)
{
    return area(a, b, d) >= 0 && area(b, c, d) >= 0 && area(c, a, d) >= 0 && !same_place(a, d) && !same_place(b, d) &&
           !same_place(c, d);
}

/* Whether the triangle at corner i can be cut off: convex, with no other corner in it. */
static bool is_ear(const polygon *p, int32_t i)
{
    const corner *b = &p->corner[i], *a = &p->corner[b->before], *c = &p->corner[b->next];
    if (!(area(a, b, c) > 0))
        return false;
    double low_u = fmin(a->u, fmin(b->u, c->u)), high_u = fmax(a->u, fmax(b->u, c->u));
    double low_v = fmin(a->v, fmin(b->v, c->v)), high_v = fmax(a->v, fmax(b->v, c->v));
    for (const corner *d = &p->corner[c->next]; d != a; d = &p->corner[d->next])
        if (d->u >= low_u && d->u <= high_u && d->v >= low_v && d->v <= high_v && blocks(a, b, c, d))
            return false;
    return true;
}

/* Every corner that is left is to be tested again. */
static void doubt_all(polygon *p)
{
    int32_t i = p->first;
    for (int32_t k = 0; k < p->left; k++, i = p->corner[i].next)
        p->corner[i].maybe = true;
    p->doubted = p->left;
}

/* Where no ear is left (the polygon crosses itself, or what is left is flat): the corner whose triangle covers least,
 * so that little is covered twice. */
static int32_t least_bad(const polygon *p)
{
    int32_t best = p->first, i = best;
    double least = INFINITY;
    for (int32_t k = 0; k < p->left; k++, i = p->corner[i].next) {
        const corner *c = &p->corner[i];
        double s = fabs(area(&p->corner[c->before], c, &p->corner[c->next]));
        if (s < least)
            best = i, least = s;
    }
    return best;
}

/* From corner i on, the next ear. A cut changes its two neighbours only, unless the polygon crosses itself: then others
 * may have become ears, but to look for those after every cut would take cubic time. */
static int32_t next_ear(polygon *p, int32_t i)
{
    for (;;) {
        for (int32_t k = 0; k < p->left; k++, i = p->corner[i].next) {
            corner *c = &p->corner[i];
            if (c->maybe && is_ear(p, i))
                return i;
            c->maybe = false;
        }
        if (p->left >= p->doubted - p->doubted / 16)
            return least_bad(p);
        doubt_all(p);
    }
}

/* Cuts corner i off. */
static void cut(polygon *p, int32_t i)
{
    const corner *c = &p->corner[i];
    corner *before = &p->corner[c->before], *next = &p->corner[c->next];
    before->next = c->next;
    next->before = c->before;
    before->maybe = next->maybe = true;
    p->first = p->first == i ? c->next : p->first;
    p->left--;
}

static void begin(polygon *p, const double *position, const int32_t *vertex)
{
    int u, v;
    choose_axes(position, vertex, p->left, &u, &v);
    for (int32_t i = 0; i < p->left; i++) {
        const double *at = &position[3 * (int64_t)vertex[i]];
        p->corner[i] = (corner){at[u], at[v], i ? i - 1 : p->left - 1, i + 1 < p->left ? i + 1 : 0, true};
    }
    p->doubted = p->left;
}

/* Cuts p, which has `left` corners, into triangles. */
static void cut_all(polygon *p, int32_t *triangle)
{
    for (int32_t at = 1; p->left > 2; triangle += 3) {
        int32_t i = p->left > 3 ? next_ear(p, at) : p->corner[p->first].next;
        triangle[0] = p->corner[i].before;
        triangle[1] = i;
        triangle[2] = at = p->corner[i].next;
        cut(p, i);
    }
}

int triangulate(const double *position, const int32_t *vertex, int64_t count, int32_t *triangle, err *e)
{
    corner small[SMALL], *large = NULL;
    polygon p = {.corner = small, .left = (int32_t)count};
    if (count < 3)
        return 0;
    if (count > INT32_MAX)
        return err_set(e, NULL, 0, "a polygon of %lld corners; expected at most %d", (long long)count, INT32_MAX);
    if (count > SMALL) {
        large = mem_array(count, sizeof *large, "a polygon's corners", e);
        if (!large)
            return -1;
        p.corner = large;
    }
    begin(&p, position, vertex);
    cut_all(&p, triangle);
    free(large);
    return 0;
}
