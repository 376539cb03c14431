#include "mesh/surface.h"

#include <math.h>
#include <string.h>

/* A polygon seen along the axis that its normal is nearest to: u and v are the other two, in the order that
 * makes it run anticlockwise. Dropping a coordinate rounds nothing. */
typedef struct view {
    const double *position;
    const int32_t *corner;
    int u, v;
} view;

static const double *point(const view *w, int32_t corner)
{
    return w->position + 3 * (int64_t)w->corner[corner];
}

/* Newell's normal: twice the vector area. Taken about the first corner, so that far offsets cost no digits. */
static view look(const double *position, const int32_t *corner, int64_t count)
{
    view w = {position, corner, 0, 1};
    double n[3] = {0};
    const double *o = point(&w, 0);
    for (int32_t i = 1; i + 1 < count; i++) {
        const double *a = point(&w, i), *b = point(&w, i + 1);
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            n[k] += (a[p] - o[p]) * (b[q] - o[q]) - (a[q] - o[q]) * (b[p] - o[p]);
        }
    }
    int k = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
    k = fabs(n[2]) >= fabs(n[k]) ? 2 : k;
    w.u = (k + (n[k] < 0 ? 2 : 1)) % 3;
    w.v = (k + (n[k] < 0 ? 1 : 2)) % 3;
    return w;
}

/* Twice the signed area of a triangle of corners. */
static double area(const view *w, int32_t a, int32_t b, int32_t c)
{
    const double *p = point(w, a), *q = point(w, b), *r = point(w, c);
    return (q[w->u] - p[w->u]) * (r[w->v] - p[w->v]) - (q[w->v] - p[w->v]) * (r[w->u] - p[w->u]);
}

static bool same_place(const view *w, int32_t a, int32_t b)
{
    const double *p = point(w, a), *q = point(w, b);
    return p[w->u] == q[w->u] && p[w->v] == q[w->v];
}

/* Whether corner d lies in the closed triangle, but not on one of its corners (where a polygon touches itself). */
static bool blocks(const view *w, int32_t a, int32_t b, int32_t c, int32_t d)
{
    return area(w, a, b, d) >= 0 && area(w, b, c, d) >= 0 && area(w, c, a, d) >= 0 && !same_place(w, a, d) &&
           !same_place(w, b, d) && !same_place(w, c, d);
}

/* Of the n corners left, whether the triangle at place i can be cut off: convex, with no other corner in it. */
static bool is_ear(const view *w, const int32_t *left, int64_t n, int64_t i)
{
    int32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
    if (!(area(w, a, b, c) > 0))
        return false;
    for (int64_t j = (i + 2) % n; left[j] != a; j = (j + 1) % n)
        if (blocks(w, a, b, c, left[j]))
            return false;
    return true;
}

/* Where no ear is left (the polygon crosses itself, or what is left is flat): the corner whose triangle covers least,
 * so that little is covered twice. */
static int64_t least_bad(const view *w, const int32_t *left, int64_t n)
{
    int64_t best = 0;
    double least = INFINITY;
    for (int64_t i = 0; i < n; i++) {
        double s = fabs(area(w, left[(i + n - 1) % n], left[i], left[(i + 1) % n]));
        if (s < least)
            best = i, least = s;
    }
    return best;
}

/* From place `at` on, the next ear. */
static int64_t next_ear(const view *w, const int32_t *left, int64_t n, int64_t at)
{
    for (int64_t k = 0; k < n; k++)
        if (is_ear(w, left, n, (at + k) % n))
            return (at + k) % n;
    return least_bad(w, left, n);
}

/* The corners left are kept at the end of the triangles' own array: each triangle takes 3 places and frees 1, and the
 * two meet with the last triangle. */
void surface_triangulate(const double *position, const int32_t *corner, int64_t count, int32_t *triangle)
{
    if (count < 3)
        return;
    view w = look(position, corner, count);
    int64_t at = 1;
    int32_t *left = triangle + 3 * (count - 2) - count;
    for (int32_t i = 0; i < count; i++)
        left[i] = i;
    for (int64_t n = count; n > 3; n--, left++) {
        int64_t i = next_ear(&w, left, n, at);
        int32_t ear[3] = {left[(i + n - 1) % n], left[i], left[(i + 1) % n]};
        memmove(left + 1, left, (size_t)i * sizeof *left);
        memcpy(triangle, ear, sizeof ear);
        triangle += 3;
        at = i % (n - 1);
    }
    /* the last triangle is where it belongs: left == triangle */
}
