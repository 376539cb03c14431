#include "tled/problem/boxes.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "tled/problem/cut.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { ELEMENTS = 4096, NODES = 32768 }; /* a chunk has */

/* ---- boxes */

static bool is_box(const tled_problem *p, int64_t element)
{
    const int32_t *node = p->element_node + 8 * element;
    const double *first = p->position + 3 * (int64_t)node[0];
    bool good = true;
    for (int c = 0; c < 8; c++) {
        const double *corner = p->position + 3 * (int64_t)node[c];
        for (int a = 0; a < 3; a++) {
            const double gap = corner[a] - first[a] - p->side[a] * lattice_vtk[c][a];
            good &= fabs(gap) <= 1e-6 * p->side[a];
        }
    }
    return good;
}

/* Of all chunks: the first of what is wrong, INT64_MAX where nothing is. */
static void note_first(atomic_llong *first, int64_t at)
{
    long long before = atomic_load(first);
    while (at < before && !atomic_compare_exchange_weak(first, &before, at))
        ;
}

typedef struct check {
    const tled_problem *p;
    atomic_llong wrong; /* the first element that is not a box */
} check;

static void check_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    check *c = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        if (!is_box(c->p, i)) {
            note_first(&c->wrong, i);
            return;
        }
}

int boxes_check(const tled_problem *p, err *e)
{
    check c = {.p = p};
    atomic_init(&c.wrong, INT64_MAX);
    pool_run(p->threads, p->elements, ELEMENTS, check_work, &c);
    const int64_t wrong = atomic_load(&c.wrong);
    if (wrong == INT64_MAX)
        return 0;
    return err_set(e, NULL, 0, "element %lld is not a box of %g x %g x %g m; expected all to be the lattice's",
                   (long long)wrong, p->side[0], p->side[1], p->side[2]);
}

/* ---- corners */

typedef struct span {
    int32_t low, high;
} span;

/* Nodes gather their corners, since sums must be made in the elements' order: a chunk of nodes goes through those
 * chunks of elements that have nodes of its own. These are few where a model is numbered as its lattice. */
typedef struct corners {
    tled_problem *p;
    span *span; /* of each chunk of elements: from its lowest to its highest node */
    int64_t spans;
    atomic_llong crowded; /* the first corner that finds no room at its node */
    atomic_llong bare;    /* the first node that is in no element */
} corners;

static void span_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const corners *c = context;
    span s = {INT32_MAX, -1};
    for (int64_t i = 8 * from; i < 8 * to; i++) {
        const int32_t n = c->p->element_node[i];
        s.low = n < s.low ? n : s.low;
        s.high = n > s.high ? n : s.high;
    }
    c->span[chunk] = s;
}

/* Where among a node's elements, by their places in the lattice, the one is that has the node for this corner. */
static int corner_rank(int32_t corner)
{
    const int32_t *offset = lattice_vtk[corner % 8];
    return 7 - (offset[0] + 2 * offset[1] + 4 * offset[2]);
}

/* Into its place among the node's. false: they are 8 already. */
static bool add_corner(int32_t *list, int32_t corner, int32_t none)
{
    int at = 7;
    if (list[at] != none)
        return false;
    for (; at && (list[at - 1] == none || corner_rank(list[at - 1]) > corner_rank(corner)); at--)
        list[at] = list[at - 1];
    list[at] = corner;
    return true;
}

/* What an element gives to those of its nodes that are in [from, to). false: one of these has no room. */
static bool give(corners *c, int64_t element, int64_t from, int64_t to)
{
    tled_problem *p = c->p;
    const double share = p->side[0] * p->side[1] * p->side[2] / 8;
    const int32_t *node = p->element_node + 8 * element, none = (int32_t)p->elements * 8;
    bool any = false;
    for (int k = 0; k < 8; k++)
        any |= (node[k] >= from) & (node[k] < to);
    if (!any)
        return true;
    const double mass = tled_law_of(p, element).density * share * cut_inertia(p, element);
    for (int k = 0; k < 8; k++) {
        const int64_t n = node[k];
        if (n < from || n >= to)
            continue;
        if (!add_corner(p->corner + 8 * n, (int32_t)(8 * element) + k, none)) {
            note_first(&c->crowded, 8 * element + k);
            return false;
        }
        p->mass[n] += mass;
    }
    return true;
}

static bool give_chunk(corners *c, int64_t chunk, int64_t from, int64_t to)
{
    const int64_t first = chunk * ELEMENTS, left = c->p->elements - first;
    for (int64_t i = first; i < first + (left < ELEMENTS ? left : ELEMENTS); i++)
        if (!give(c, i, from, to))
            return false;
    return true;
}

static bool meets(const span *s, int64_t from, int64_t to)
{
    return s->high >= from && s->low < to;
}

static void gather_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    corners *c = context;
    const int32_t none = (int32_t)c->p->elements * 8;
    (void)chunk;
    for (int64_t i = 8 * from; i < 8 * to; i++)
        c->p->corner[i] = none;
    for (int64_t k = 0; k < c->spans; k++)
        if (meets(&c->span[k], from, to) && !give_chunk(c, k, from, to))
            return;
    for (int64_t n = from; n < to; n++)
        if (c->p->corner[8 * n] == none) {
            note_first(&c->bare, n);
            return;
        }
}

/* How many nodes to take at a time: all at once where the model's numbers jump, so that chunks of nodes would each go
 * through most elements. */
static int64_t choose_size(const corners *c)
{
    int64_t visits = 0;
    for (int64_t from = 0; from < c->p->nodes; from += NODES)
        for (int64_t k = 0; k < c->spans; k++)
            visits += meets(&c->span[k], from, from + NODES);
    return visits <= 4 * c->spans ? NODES : c->p->nodes;
}

int boxes_corners(tled_problem *p, err *e)
{
    corners c = {.p = p, .spans = pool_chunks(p->elements, ELEMENTS)};
    c.span = mem_array(c.spans, sizeof *c.span, "the nodes", e);
    if (!c.span)
        return -1;
    atomic_init(&c.crowded, INT64_MAX);
    atomic_init(&c.bare, INT64_MAX);
    pool_run(p->threads, p->elements, ELEMENTS, span_work, &c);
    pool_run(p->threads, p->nodes, choose_size(&c), gather_work, &c);
    free(c.span);
    const int64_t crowded = atomic_load(&c.crowded), bare = atomic_load(&c.bare);
    if (crowded < INT64_MAX)
        return err_set(e, NULL, 0, "node %lld is in more than 8 elements", (long long)p->element_node[crowded]);
    return bare < INT64_MAX ? err_set(e, NULL, 0, "node %lld is in no element", (long long)bare) : 0;
}
