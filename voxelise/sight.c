#include "voxelise/sight.h"

#include "base/mem.h"
#include "surface/edge_side.h"
#include "voxelise/cuts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF = 4, DEPTH = 64, MOST = 64 };

/* Samples are moved by these shares of their distances, as the inside test moves centres by (e, e^2, e^3): what lies
 * in a plane of samples is on the same side of all of them. */
static const double moved[3] = {0x1p-30, 0x1p-34, 0x1p-38};

typedef struct span {
    double low[3], high[3];
} span;

struct sight {
    inside_triangles t;
    const grid *g;
    double touching; /* samples */
    int32_t volumes;
    int32_t *order; /* triangles: along a curve that fills space */
    span *span;     /* of a binary tree over groups of LEAF of them: node n has the children 2 n + 1 and 2 n + 2 */
    int64_t leaves, inner;
};

/* ---- the tree */

typedef struct keyed {
    uint64_t key;
    int32_t triangle;
} keyed;

static int by_key(const void *a, const void *b)
{
    const keyed *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

/* A coordinate from the corner of sample 0, in samples. */
static double place_of(const sight *s, int64_t vertex, int axis)
{
    return grid_local(s->g, axis, s->t.position[3 * vertex + axis]) / s->g->spacing[axis];
}

static span span_of(const sight *s, int64_t triangle)
{
    span b;
    for (int a = 0; a < 3; a++) {
        b.low[a] = INFINITY, b.high[a] = -INFINITY;
        for (int i = 0; i < 3; i++) {
            const double x = place_of(s, s->t.vertex[3 * triangle + i], a);
            b.low[a] = fmin(b.low[a], x);
            b.high[a] = fmax(b.high[a], x);
        }
    }
    return b;
}

static void widen(span *to, const span *by)
{
    for (int a = 0; a < 3; a++) {
        to->low[a] = fmin(to->low[a], by->low[a]);
        to->high[a] = fmax(to->high[a], by->high[a]);
    }
}

/* The bits of a triangle's middle, axis after axis, each of 21 bits of the lattice's longest extent: axes are halved
 * alike, so that thin plates on a row are told apart first along the row. */
static uint64_t key_of(const sight *s, int64_t triangle)
{
    const span b = span_of(s, triangle);
    uint64_t key = 0;
    double cells = 1;
    for (int a = 0; a < 3; a++)
        cells = fmax(cells, (double)grid_cells(s->g, a));
    for (int a = 0; a < 3; a++) {
        const double low = (double)s->g->low[a];
        const double at = ((b.low[a] + b.high[a]) / 2 - low) / cells * 0x1p21;
        const uint64_t bits = (uint64_t)crossing_within(at, 0, 0x1p21 - 1);
        for (int i = 0; i < 21; i++)
            key |= (bits >> i & 1) << (3 * i + a);
    }
    return key;
}

static int sort_triangles(sight *s, err *e)
{
    keyed *list = mem_array(s->t.triangles, sizeof *list, "triangles", e);
    s->order = list ? mem_array(s->t.triangles, sizeof *s->order, "triangles", e) : NULL;
    for (int64_t i = 0; s->order && i < s->t.triangles; i++)
        list[i] = (keyed){key_of(s, i), (int32_t)i};
    if (s->order && s->t.triangles)
        qsort(list, (size_t)s->t.triangles, sizeof *list, by_key);
    for (int64_t i = 0; s->order && i < s->t.triangles; i++)
        s->order[i] = list[i].triangle;
    free(list);
    return s->order ? 0 : -1;
}

static int make_tree(sight *s, err *e)
{
    const span none = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    s->leaves = 1;
    while (s->leaves * LEAF < s->t.triangles)
        s->leaves *= 2;
    s->inner = s->leaves - 1;
    s->span = mem_array(s->inner + s->leaves, sizeof *s->span, "triangles", e);
    if (!s->span)
        return -1;
    for (int64_t n = s->inner + s->leaves - 1; n >= 0; n--) {
        s->span[n] = none;
        if (n < s->inner) {
            widen(&s->span[n], &s->span[2 * n + 1]);
            widen(&s->span[n], &s->span[2 * n + 2]);
            continue;
        }
        for (int64_t i = (n - s->inner) * LEAF; i < (n - s->inner + 1) * LEAF && i < s->t.triangles; i++) {
            const span b = span_of(s, s->order[i]);
            widen(&s->span[n], &b);
        }
    }
    return 0;
}

sight *sight_create(const inside_triangles *t, const grid *g, int samples, err *e)
{
    sight *s = mem_array(1, sizeof *s, "triangles", e);
    if (!s)
        return NULL;
    *s = (sight){.t = *t, .g = g, .touching = CUTS_TOUCHING * samples};
    s->volumes = t->triangles ? t->volume[t->triangles - 1] + 1 : 0;
    if (!sort_triangles(s, e) && !make_tree(s, e))
        return s;
    sight_destroy(s);
    return NULL;
}

void sight_destroy(sight *s)
{
    if (!s)
        return;
    free(s->order);
    free(s->span);
    free(s);
}

/* ---- one line */

/* A line from a place along its longest axis, and what it meets. */
typedef struct line {
    const sight *s;
    double from[3], step[3]; /* samples; for each along `axis` */
    int axis, u, v;
    double length; /* along axis, signed: the line's sense */
    int32_t volume[MOST];
    double at[MOST]; /* as shares of the line: below 0 is before it */
    int count;
} line;

/* Where the line, without end either way, meets a triangle. */
static void meet(line *l, int64_t triangle)
{
    double at[3][3]; /* u, v and along the line */
    for (int i = 0; i < 3; i++) {
        double w[3];
        for (int a = 0; a < 3; a++)
            w[a] = place_of(l->s, l->s->t.vertex[3 * triangle + i], a) - l->from[a];
        at[i][0] = w[l->u] - w[l->axis] * l->step[l->u];
        at[i][1] = w[l->v] - w[l->axis] * l->step[l->v];
        at[i][2] = w[l->axis];
    }
    const int side = edge_side(at[0], at[1]);
    if (!side || edge_side(at[1], at[2]) != side || edge_side(at[2], at[0]) != side || l->count == MOST)
        return;
    double sum = 0, along = 0;
    for (int i = 0; i < 3; i++) {
        const double *p = at[(i + 1) % 3], *q = at[(i + 2) % 3], share = p[0] * q[1] - p[1] * q[0];
        sum += share;
        along += share * at[i][2];
    }
    const double low = fmin(at[0][2], fmin(at[1][2], at[2][2])), high = fmax(at[0][2], fmax(at[1][2], at[2][2]));
    l->at[l->count] = crossing_within(along / sum, low, high) / l->length;
    l->volume[l->count++] = l->s->t.volume[triangle];
}

/* Not fmin and fmax, which are calls. */
static double lower(double a, double b)
{
    return a < b ? a : b;
}

static double higher(double a, double b)
{
    return a > b ? a : b;
}

/* Whether a line from `begin` to `end` of it, as shares, comes into a box. */
static bool comes_into(const line *l, const span *b, double begin, double end)
{
    double first = begin, last = end;
    for (int a = 0; a < 3; a++) {
        const double step = l->step[a] * l->length, low = b->low[a] - 1e-6 - l->from[a],
                     high = b->high[a] + 1e-6 - l->from[a];
        if (step == 0) {
            if (low > 0 || high < 0)
                return false;
            continue;
        }
        const double one = low / step, other = high / step;
        first = higher(first, lower(one, other));
        last = lower(last, higher(one, other));
        if (first > last)
            return false;
    }
    return first <= last;
}

static void meet_all(line *l, double begin, double end)
{
    const sight *s = l->s;
    int64_t waiting[DEPTH] = {0};
    l->count = 0;
    for (int count = 1; count;) {
        const int64_t n = waiting[--count];
        if (!comes_into(l, &s->span[n], begin, end))
            continue;
        if (n < s->inner) {
            waiting[count++] = 2 * n + 2;
            waiting[count++] = 2 * n + 1;
            continue;
        }
        for (int64_t i = (n - s->inner) * LEAF; i < (n - s->inner + 1) * LEAF && i < s->t.triangles; i++)
            meet(l, s->order[i]);
    }
}

static line line_of(const sight *s, const double *from, const double *to)
{
    line l = {.s = s};
    for (int a = 0; a < 3; a++)
        if (fabs(to[a] - from[a]) > fabs(to[l.axis] - from[l.axis]))
            l.axis = a;
    l.u = (l.axis + 1) % 3, l.v = (l.axis + 2) % 3;
    l.length = to[l.axis] - from[l.axis];
    for (int a = 0; a < 3; a++) {
        l.from[a] = from[a] + .5 + moved[a];
        l.step[a] = (to[a] - from[a]) / l.length;
    }
    return l;
}

/* In order of places; of one place, of volumes. */
static void sort(line *l)
{
    for (int i = 1; i < l->count; i++) {
        const double at = l->at[i];
        const int32_t volume = l->volume[i];
        int to = i;
        for (; to && (l->at[to - 1] > at || (l->at[to - 1] == at && l->volume[to - 1] > volume)); to--)
            l->at[to] = l->at[to - 1], l->volume[to] = l->volume[to - 1];
        l->at[to] = at, l->volume[to] = volume;
    }
}

/* Of several volumes: follows the line from outside of all of them. */
static bool leaves_all(line *l)
{
    const double touching = l->s->touching / fabs(l->length);
    int32_t around = 0, left = -1;
    double place = 0;
    bool in[MOST] = {false}; /* by the first crossing of the volume */
    meet_all(l, -INFINITY, INFINITY);
    sort(l);
    for (int i = 0; i < l->count; i++) {
        int first = 0;
        while (l->volume[first] != l->volume[i])
            first++;
        const bool was = around > 0;
        in[first] = !in[first];
        around += in[first] ? 1 : -1;
        if (was && !around)
            left = l->volume[i], place = l->at[i];
        else if (!was && left >= 0 && place >= 0 && l->at[i] <= 1 &&
                 (left == l->volume[i] || l->at[i] - place > touching))
            return true;
    }
    return false;
}

/* How often a line meets a surface. */
static int count_met(line *l)
{
    int met = 0;
    if (l->length == 0)
        return 0;
    meet_all(l, 0, 1);
    for (int i = 0; i < l->count; i++)
        met += l->at[i] > 0 && l->at[i] < 1;
    return met;
}

/* Whether a line meets nothing. */
static bool is_clear(const sight *s, const double *from, const double *to)
{
    line l = line_of(s, from, to);
    return !count_met(&l);
}

/* Whether there is a way by a third place: between the middle and a corner of the box that the two ends span, which is
 * half as wide as it is long where they do not differ. */
static bool has_way(const sight *s, const double *from, const double *to)
{
    enum { STEPS = 2 };
    double longest = 0;
    for (int a = 0; a < 3; a++)
        longest = fmax(longest, fabs(to[a] - from[a]));
    for (int corner = 0; corner < 8; corner++)
        for (int step = 1; step <= STEPS; step++) {
            double by[3];
            for (int a = 0; a < 3; a++) {
                const double half = from[a] != to[a] ? (to[a] - from[a]) / 2 : longest / 4;
                by[a] = (from[a] + to[a]) / 2 + (corner >> a & 1 ? half : -half) * step / STEPS;
            }
            if (is_clear(s, from, by) && is_clear(s, by, to))
                return true;
        }
    return false;
}

bool sight_blocked(const sight *s, const int64_t *from, const int64_t *to)
{
    const double a[3] = {(double)from[0], (double)from[1], (double)from[2]};
    const double b[3] = {(double)to[0], (double)to[1], (double)to[2]};
    line l = line_of(s, a, b);
    /* Once: a place that lies on a surface but for rounding. */
    return count_met(&l) > 1 && (s->volumes < 2 || leaves_all(&l)) && !has_way(s, a, b);
}
