#include "mesh/corner_tree.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

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
    int32_t *leaf; /* corners */
    int64_t leaves;
};

static const node nothing = {INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY, -1};

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

/* What the two nodes below have. */
static node joined(const node *a, const node *b)
{
    const node *s = b->area < a->area || (b->area == a->area && b->smallest >= 0 && b->smallest < a->smallest) ? b : a;
    return (node){fmin(a->low_u, b->low_u),
                  fmax(a->high_u, b->high_u),
                  fmin(a->low_v, b->low_v),
                  fmax(a->high_v, b->high_v),
                  s->area,
                  s->smallest};
}

static node of_corner(const corner_tree *t, int32_t i)
{
    const corner *c = &t->corner[i];
    double area = fabs(corner_area(&t->corner[c->before], c, &t->corner[c->next]));
    bool any = area < INFINITY;
    return (node){c->u, c->u, c->v, c->v, any ? area : INFINITY, any ? i : -1};
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
    for (int64_t n = t->leaves - 1; n > 0; n--)
        t->node[n] = joined(&t->node[2 * n], &t->node[2 * n + 1]);
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
    if (!t->node || !t->leaf || fill(t, count, e)) {
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
    free(t->leaf);
    free(t);
}

/* ---- asking ---- */

static void put(corner_tree *t, int32_t i, node is)
{
    int64_t n = t->leaves + t->leaf[i];
    t->node[n] = is;
    while (n /= 2)
        t->node[n] = joined(&t->node[2 * n], &t->node[2 * n + 1]);
}

void corner_tree_cut(corner_tree *t, int32_t i)
{
    const corner *c = &t->corner[i];
    put(t, i, nothing);
    put(t, c->before, of_corner(t, c->before));
    put(t, c->next, of_corner(t, c->next));
}

int32_t corner_tree_smallest(const corner_tree *t)
{
    return t->node[1].smallest;
}

/* Whether the whole box is to the right of the line from a to b. The area is largest at one of the box's corners,
 * rounded too: every operation that it is made of keeps the order of what it is given. */
static bool is_right(const corner *a, const corner *b, const node *n)
{
    const corner most = {.u = b->v - a->v >= 0 ? n->low_u : n->high_u, .v = b->u - a->u >= 0 ? n->high_v : n->low_v};
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

/* Corners at one place are one box of no size, at whatever level of the tree: they are asked once. */
bool corner_tree_blocks(const corner_tree *t, const corner *a, const corner *b, const corner *c)
{
    enum { DEEP = 64 };
    int64_t waiting[DEEP] = {1};
    node box = box_of(a, b, c);
    for (int count = 1; count > 0;) {
        int64_t at = waiting[--count];
        const node *n = &t->node[at];
        if (n->high_u < box.low_u || n->low_u > box.high_u || n->high_v < box.low_v || n->low_v > box.high_v ||
            is_right(a, b, n) || is_right(b, c, n) || is_right(c, a, n))
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
