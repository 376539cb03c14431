#include "surface/corner_tree.h"

#include "base/mem.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A box about corners that lies as they do, so that a row of them has a thin one in whatever direction it runs: the
 * corners are at p + t d + w n, where n is d turned left, and all t and w are in their ranges. */
typedef struct strip {
    double p[2], q[2]; /* two of the corners, far apart */
    double d[2];       /* from p to q, of length 1 */
    double low_t, high_t, low_w, high_w;
} strip;

/* Node 1 is the root, 2 n and 2 n + 1 are below node n; the last `leaves` nodes have one corner each, or none. A node
 * without corners has a box that nothing is in. */
typedef struct node {
    double low_u, high_u, low_v, high_v;
    double area; /* of the smallest triangle */
    int32_t smallest;
} node;

struct corner_tree {
    const corner *corner;
    node *node;    /* 2 leaves */
    strip *strip;  /* leaves: of nodes that are none; one without corners has any */
    int32_t *leaf; /* corners */
    int64_t leaves;
};

static const node nothing = {INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY, -1};

/* ---- strips ---- */

/* As fmin() and fmax(), but one instruction each; of a number and none, b. */
static double less(double a, double b)
{
    return a < b ? a : b;
}

static double more(double a, double b)
{
    return a > b ? a : b;
}

static bool is_empty(const node *n)
{
    return n->low_u > n->high_u;
}

/* The longest way between ends of a and of b becomes s's. */
static void choose_ends(strip *s, const strip *a, const strip *b)
{
    const double *end[] = {a->p, a->q, b->p, b->q};
    double most = -1;
    for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++) {
            double u = end[j][0] - end[i][0], v = end[j][1] - end[i][1], square = u * u + v * v;
            if (!(square > most))
                continue;
            most = square;
            memcpy(s->p, end[i], sizeof s->p);
            memcpy(s->q, end[j], sizeof s->q);
        }
    bool any = most > DBL_MIN && most < INFINITY;
    double length = any ? sqrt(most) : 1;
    s->d[0] = any ? (s->q[0] - s->p[0]) / length : 1;
    s->d[1] = any ? (s->q[1] - s->p[1]) / length : 0;
}

/* Widens s until it holds a, and by more than is lost to rounding. */
static void widen(strip *s, const strip *a)
{
    double u = a->p[0] - s->p[0], v = a->p[1] - s->p[1];
    double cosine = s->d[0] * a->d[0] + s->d[1] * a->d[1], sine = s->d[0] * a->d[1] - s->d[1] * a->d[0];
    double t = s->d[0] * u + s->d[1] * v, w = s->d[0] * v - s->d[1] * u;
    double long_t = more(-a->low_t, a->high_t), long_w = more(-a->low_w, a->high_w);
    double lost = 16 * DBL_EPSILON * (fabs(u) + fabs(v) + long_t + long_w) + DBL_MIN;
    double t_low = cosine * a->low_t, t_high = cosine * a->high_t, s_low = sine * a->low_t, s_high = sine * a->high_t;
    double c_low = cosine * a->low_w, c_high = cosine * a->high_w, w_low = -sine * a->low_w, w_high = -sine * a->high_w;
    s->low_t = less(s->low_t, t + less(t_low, t_high) + less(w_low, w_high) - lost);
    s->high_t = more(s->high_t, t + more(t_low, t_high) + more(w_low, w_high) + lost);
    s->low_w = less(s->low_w, w + less(s_low, s_high) + less(c_low, c_high) - lost);
    s->high_w = more(s->high_w, w + more(s_low, s_high) + more(c_low, c_high) + lost);
}

/* Whether all that the strip holds is to the right of the line from a to b, as corner_area() sees it: by more than both
 * may be wrong by rounding. */
static bool strip_is_right(const corner *a, const corner *b, const strip *s)
{
    double u = b->u - a->u, v = b->v - a->v, pu = s->p[0] - a->u, pv = s->p[1] - a->v;
    double along = u * s->d[1] - v * s->d[0], across = u * s->d[0] + v * s->d[1];
    double most =
        u * pv - v * pu + more(along * s->low_t, along * s->high_t) + more(across * s->low_w, across * s->high_w);
    double size = fabs(pu) + fabs(pv) + more(-s->low_t, s->high_t) + more(-s->low_w, s->high_w);
    return most < -(64 * DBL_EPSILON * (fabs(u) + fabs(v)) * size + DBL_MIN);
}

/* ---- building ---- */

typedef struct key {
    double along;
    uint64_t code;
    int32_t corner;
} key;

static int by_place(const void *a, const void *b)
{
    const key *p = a, *q = b;
    return (p->along > q->along) - (p->along < q->along);
}

static int by_code(const void *a, const void *b)
{
    const key *p = a, *q = b;
    return (p->code > q->code) - (p->code < q->code);
}

/* The bits of x, each with a zero above it. */
static uint64_t spread(uint32_t x)
{
    uint64_t s = x;
    s = (s | s << 16) & 0x0000ffff0000ffff;
    s = (s | s << 8) & 0x00ff00ff00ff00ff;
    s = (s | s << 4) & 0x0f0f0f0f0f0f0f0f;
    s = (s | s << 2) & 0x3333333333333333;
    return (s | s << 1) & 0x5555555555555555;
}

/* Sorts by `along`, and shifts the rank there into the code: corners that are equally far have one rank. */
static void add_ranks(key *k, int32_t count, int shift)
{
    uint32_t rank = 0;
    qsort(k, (size_t)count, sizeof *k, by_place);
    for (int32_t i = 0; i < count; i++) {
        rank += i && k[i].along > k[i - 1].along;
        k[i].code |= spread(rank) << shift;
    }
}

/* The corners in their order in the tree. */
static key *order(const corner *c, int32_t count, err *e)
{
    key *k = mem_array(count, sizeof *k, "a polygon's corners", e);
    if (!k)
        return NULL;
    for (int32_t i = 0; i < count; i++)
        k[i] = (key){.along = c[i].u, .corner = i};
    add_ranks(k, count, 0);
    for (int32_t i = 0; i < count; i++)
        k[i].along = c[k[i].corner].v;
    add_ranks(k, count, 1);
    qsort(k, (size_t)count, sizeof *k, by_code);
    return k;
}

static strip strip_of(const corner_tree *t, int64_t n)
{
    const node *c = &t->node[n];
    if (n < t->leaves)
        return t->strip[n];
    return (strip){.p = {c->low_u, c->low_v}, .q = {c->low_u, c->low_v}, .d = {1, 0}};
}

static strip joined_strips(const corner_tree *t, int64_t n)
{
    strip s = {0}, a = strip_of(t, 2 * n), b = strip_of(t, 2 * n + 1);
    if (is_empty(&t->node[2 * n]))
        return b;
    if (is_empty(&t->node[2 * n + 1]))
        return a;
    choose_ends(&s, &a, &b);
    widen(&s, &a);
    widen(&s, &b);
    return s;
}

/* Node n gets what the two below have. Returns whether its box or its strip is another than before. */
static bool join_places(corner_tree *t, int64_t n)
{
    const node *a = &t->node[2 * n], *b = &t->node[2 * n + 1];
    node *to = &t->node[n], was = *to;
    strip s = joined_strips(t, n);
    bool other = memcmp(&s, &t->strip[n], sizeof s) != 0;
    t->strip[n] = s;
    to->low_u = fmin(a->low_u, b->low_u), to->high_u = fmax(a->high_u, b->high_u);
    to->low_v = fmin(a->low_v, b->low_v), to->high_v = fmax(a->high_v, b->high_v);
    return other || to->low_u != was.low_u || to->high_u != was.high_u || to->low_v != was.low_v ||
           to->high_v != was.high_v;
}

/* The same of its smallest triangle. */
static bool join_areas(corner_tree *t, int64_t n)
{
    const node *a = &t->node[2 * n], *b = &t->node[2 * n + 1];
    const node *s = b->area < a->area || (b->area == a->area && b->smallest >= 0 && b->smallest < a->smallest) ? b : a;
    node *to = &t->node[n];
    bool other = to->area != s->area || to->smallest != s->smallest;
    to->area = s->area;
    to->smallest = s->smallest;
    return other;
}

static node of_corner(const corner_tree *t, int32_t i)
{
    const corner *c = &t->corner[i];
    double area = fabs(corner_area(&t->corner[c->before], c, &t->corner[c->next]));
    bool any = area < INFINITY;
    if (!any)
        area = INFINITY;
    return (node){c->u, c->u, c->v, c->v, area, any ? i : -1};
}

static int fill(corner_tree *t, int32_t count, err *e)
{
    key *k = order(t->corner, count, e);
    if (!k)
        return -1;
    for (int64_t i = 0; i < t->leaves; i++)
        t->node[t->leaves + i] = nothing;
    for (int32_t i = 0; i < count; i++) {
        t->leaf[k[i].corner] = i;
        t->node[t->leaves + i] = of_corner(t, k[i].corner);
    }
    for (int64_t n = t->leaves - 1; n > 0; n--) {
        join_places(t, n);
        join_areas(t, n);
    }
    free(k);
    return 0;
}

corner_tree *corner_tree_create(const corner *corners, int32_t count, err *e)
{
    corner_tree *t = mem_array(1, sizeof *t, "a polygon's corners", e);
    if (!t)
        return NULL;
    t->corner = corners;
    for (t->leaves = 2; t->leaves < count;)
        t->leaves *= 2;
    t->node = mem_array(2 * t->leaves, sizeof *t->node, "a polygon's corners", e);
    t->leaf = mem_array(count, sizeof *t->leaf, "a polygon's corners", e);
    t->strip = mem_array(t->leaves, sizeof *t->strip, "a polygon's corners", e);
    if (!t->node || !t->leaf || !t->strip || fill(t, count, e)) {
        corner_tree_destroy(t);
        return NULL;
    }
    return t;
}

void corner_tree_destroy(corner_tree *t)
{
    if (!t)
        return;
    free(t->node);
    free(t->strip);
    free(t->leaf);
    free(t);
}

/* ---- asking ---- */

/* What is above a leaf that changed (placed: a leaf whose corner is gone), as far up as it changes. */
static void change_above(corner_tree *t, int64_t n, bool placed)
{
    for (bool area = true; (n /= 2) && (placed || area);) {
        placed = placed && join_places(t, n);
        area = area && join_areas(t, n);
    }
}

static void change(corner_tree *t, int32_t i, node is, bool placed)
{
    int64_t n = t->leaves + t->leaf[i];
    t->node[n] = is;
    change_above(t, n, placed);
}

void corner_tree_cut(corner_tree *t, int32_t i)
{
    const corner *c = &t->corner[i];
    change(t, i, nothing, true);
    change(t, c->before, of_corner(t, c->before), false);
    change(t, c->next, of_corner(t, c->next), false);
}

int32_t corner_tree_smallest(const corner_tree *t)
{
    return t->node[1].smallest;
}

/* Whether the whole box is to the right of the line from a to b. The area is largest at one of the box's corners,
 * rounded too: every operation that it is made of keeps the order of what it is given. */
static bool is_right(const corner *a, const corner *b, const node *n)
{
    const bool up = b->v - a->v >= 0, on = b->u - a->u >= 0;
    corner most = {.u = n->high_u, .v = n->low_v};
    if (up)
        most.u = n->low_u;
    if (on)
        most.v = n->high_v;
    return corner_area(a, b, &most) < 0;
}

/* The box about the triangle. */
static node box_of(const corner *a, const corner *b, const corner *c)
{
    return (node){.low_u = fmin(a->u, fmin(b->u, c->u)),
                  .high_u = fmax(a->u, fmax(b->u, c->u)),
                  .low_v = fmin(a->v, fmin(b->v, c->v)),
                  .high_v = fmax(a->v, fmax(b->v, c->v))};
}

/* Whether nothing of node n is in the triangle, whose box is given. */
static bool is_outside(const corner_tree *t, int64_t at, const corner *a, const corner *b, const corner *c,
                       const node *box)
{
    const node *n = &t->node[at];
    if (n->high_u < box->low_u || n->low_u > box->high_u || n->high_v < box->low_v || n->low_v > box->high_v ||
        is_right(a, b, n) || is_right(b, c, n) || is_right(c, a, n))
        return true;
    const strip *s = &t->strip[at < t->leaves ? at : 0];
    return at < t->leaves && (strip_is_right(a, b, s) || strip_is_right(b, c, s) || strip_is_right(c, a, s));
}

/* Corners at one place are one box of no size, at whatever level of the tree: they are asked once. */
bool corner_tree_blocks(const corner_tree *t, const corner *a, const corner *b, const corner *c)
{
    enum { DEEP = 64 };
    int64_t waiting[DEEP] = {1};
    node box = box_of(a, b, c);
    for (int count = 1; count > 0;) {
        int64_t at = waiting[--count];
        const node *n = &t->node[at];
        if (is_outside(t, at, a, b, c, &box))
            continue;
        if (n->low_u < n->high_u || n->low_v < n->high_v) {
            waiting[count++] = 2 * at + 1;
            waiting[count++] = 2 * at;
        } else if (corner_blocks(a, b, c, &(corner){.u = n->low_u, .v = n->low_v})) {
            return true;
        }
    }
    return false;
}
