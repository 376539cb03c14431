#include "bind/tetra.h"

#include "base/mem.h"
#include "mesh/hexahedron.h"
#include "mesh/weights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF = 4, WAITING = 96 }; /* elements; parts that wait: one a level, and halves of 2^31 make 31 levels */

/* An element's middle, times its corners. */
typedef struct middle {
    double at[3];
    int32_t element;
} middle;

/* Elements first to last - 1 of the middles on their way into a box; from: whose second half they are, or -1. */
typedef struct part {
    int32_t first, last, from;
} part;

static const double *corner(const tetra *t, int32_t element, int c)
{
    return &t->position[3 * (int64_t)t->node[t->corners * (int64_t)element + c]];
}

static bool is_before(int axis, const middle *a, const middle *b)
{
    return a->at[axis] < b->at[axis] || (a->at[axis] == b->at[axis] && a->element < b->element);
}

/* Moves elements so that none in the first half comes after one in the second, along an axis. (Hoare's selection.) */
static void divide(middle *m, const part *p, int axis)
{
    int32_t low = p->first, high = p->last - 1, half = p->first + (p->last - p->first) / 2;
    while (low < high) {
        middle pivot = m[low + (high - low) / 2];
        int32_t i = low, j = high;
        while (i <= j) {
            while (is_before(axis, &m[i], &pivot))
                i++;
            while (is_before(axis, &pivot, &m[j]))
                j--;
            if (i <= j) {
                middle keep = m[i];
                m[i++] = m[j];
                m[j--] = keep;
            }
        }
        if (half > j)
            low = i;
        if (half < i)
            high = j;
    }
}

/* The axis along which the middles spread most. */
static int longest(const middle *m, const part *p)
{
    double low[3], high[3];
    int axis = 0;
    memcpy(low, m[p->first].at, sizeof low);
    memcpy(high, low, sizeof high);
    for (int32_t i = p->first; i < p->last; i++)
        for (int a = 0; a < 3; a++) {
            low[a] = m[i].at[a] < low[a] ? m[i].at[a] : low[a];
            high[a] = m[i].at[a] > high[a] ? m[i].at[a] : high[a];
        }
    for (int a = 1; a < 3; a++)
        axis = high[a] - low[a] > high[axis] - low[axis] ? a : axis;
    return axis;
}

/* The tree, without what its boxes span. */
static void make_boxes(tetra *t, middle *m, int32_t elements)
{
    part waiting[WAITING] = {{0, elements, -1}};
    for (int count = 1; count;) {
        part p = waiting[--count];
        tetra_box *box = &t->box[t->boxes];
        if (p.from >= 0)
            t->box[p.from].right = t->boxes;
        if (p.last - p.first <= LEAF) {
            box->first = p.first;
            box->count = p.last - p.first;
        } else {
            int32_t half = p.first + (p.last - p.first) / 2;
            divide(m, &p, longest(m, &p));
            waiting[count++] = (part){half, p.last, t->boxes};
            waiting[count++] = (part){p.first, half, -1};
        }
        t->boxes++;
    }
    for (int32_t i = 0; i < elements; i++)
        t->order[i] = m[i].element;
}

static void include(tetra_box *b, const double *low, const double *high)
{
    for (int a = 0; a < 3; a++) {
        b->low[a] = fmin(b->low[a], low[a]);
        b->high[a] = fmax(b->high[a], high[a]);
    }
}

/* What the boxes span: halves come after the whole, so from the last to the first. */
static void span_boxes(tetra *t)
{
    for (int32_t i = t->boxes - 1; i >= 0; i--) {
        tetra_box *b = &t->box[i];
        for (int a = 0; a < 3; a++) {
            b->low[a] = INFINITY;
            b->high[a] = -INFINITY;
        }
        for (int32_t e = b->first; e < b->first + b->count; e++)
            for (int c = 0; c < t->corners; c++)
                include(b, corner(t, t->order[e], c), corner(t, t->order[e], c));
        if (!b->count) {
            include(b, b[1].low, b[1].high);
            include(b, t->box[b->right].low, t->box[b->right].high);
        }
    }
}

/* Of a hexahedron about that: what its box spans, or 0 where that is flat. */
static double volume_of(const tetra *t, int32_t element)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    if (t->corners == 4)
        return weights_tetrahedron_volume(&t->node[4 * (int64_t)element], t->position);
    for (int c = 0; c < 8; c++)
        for (int a = 0; a < 3; a++) {
            low[a] = fmin(low[a], corner(t, element, c)[a]);
            high[a] = fmax(high[a], corner(t, element, c)[a]);
        }
    return (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]);
}

/* The elements that have a volume. */
static int32_t collect(tetra *t, middle *m, int64_t elements)
{
    int32_t found = 0;
    double size = 0;
    for (int32_t i = 0; i < elements; i++) {
        double volume = volume_of(t, i);
        if (!(volume > 0))
            continue;
        size += cbrt(volume);
        m[found].element = i;
        for (int a = 0; a < 3; a++)
            for (int c = 0; c < t->corners; c++)
                m[found].at[a] += corner(t, i, c)[a];
        found++;
    }
    t->flat = elements - found;
    t->tie = found ? 1e-9 * size / found : 0;
    return found;
}

int tetra_build(tetra *t, const model *m, err *e)
{
    const model_array *node = model_need(m, "element.node", e), *position = model_need(m, "node.position", e);
    int rc = -1;
    middle *middles = NULL;
    *t = (tetra){0};
    if (!node || !position)
        return -1;
    if (node->rows > INT32_MAX / 2)
        return err_set(e, NULL, 0, "%lld elements; at most %d are possible", (long long)node->rows, INT32_MAX / 2);
    t->node = node->i32;
    t->corners = node->columns;
    t->position = position->f64;
    t->order = mem_array(node->rows, sizeof *t->order, "elements", e);
    t->box = t->order ? mem_array(node->rows, sizeof *t->box, "boxes of elements", e) : NULL;
    middles = t->box ? mem_array(node->rows, sizeof *middles, "elements", e) : NULL;
    if (!middles)
        goto out;
    int32_t elements = collect(t, middles, node->rows);
    if (!elements) {
        err_set(e, NULL, 0, "no %s of the model has a volume; expected elements to bind to",
                t->corners == 4 ? "tetrahedron" : "hexahedron");
        goto out;
    }
    make_boxes(t, middles, elements);
    span_boxes(t);
    rc = 0;
out:
    free(middles);
    if (rc)
        tetra_free(t);
    return rc;
}

void tetra_free(tetra *t)
{
    free(t->order);
    free(t->box);
    *t = (tetra){0};
}

static double distance_to(const tetra_box *b, const double *p)
{
    double sum = 0;
    for (int a = 0; a < 3; a++) {
        double below = b->low[a] - p[a], above = p[a] - b->high[a], d = below > above ? below : above;
        sum += d > 0 ? d * d : 0;
    }
    return sqrt(sum);
}

/* A search: for the least distance, then for the lowest index within it and a tie's width. */
typedef struct search {
    const tetra *t;
    const double *point;
    double limit;    /* m: what is further is not looked at */
    int32_t element; /* -1: none yet */
} search;

static void look_at(search *s, const tetra_box *leaf, bool by_index)
{
    for (int32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
        int32_t element = s->t->order[i];
        if (by_index && s->element >= 0 && element > s->element)
            continue;
        const int32_t *node = &s->t->node[s->t->corners * (int64_t)element];
        double d = s->t->corners == 8 ? hexahedron_outside(node, s->t->position, s->point)
                                      : weights_tetrahedron_outside(node, s->t->position, s->point);
        if (by_index && d <= s->limit)
            s->element = element;
        else if (!by_index)
            s->limit = fmin(s->limit, d);
    }
}

/* The nearer half is looked at first. */
static void look_through(search *s, bool by_index)
{
    int32_t waiting[WAITING] = {0};
    for (int count = 1; count;) {
        int32_t at = waiting[--count];
        const tetra_box *b = &s->t->box[at];
        if (distance_to(b, s->point) > s->limit)
            continue;
        if (b->count) {
            look_at(s, b, by_index);
            continue;
        }
        bool right = distance_to(&s->t->box[b->right], s->point) < distance_to(b + 1, s->point);
        waiting[count++] = right ? at + 1 : b->right;
        waiting[count++] = right ? b->right : at + 1;
    }
}

int32_t tetra_element(const tetra *t, const double *point)
{
    search s = {.t = t, .point = point, .limit = INFINITY, .element = -1};
    look_through(&s, false);
    s.limit += t->tie + 4e-15 * s.limit; /* the second: what rounding does to a distance far outside */
    look_through(&s, true);
    return s.element;
}
