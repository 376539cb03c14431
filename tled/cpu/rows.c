#include "tled/cpu/rows.h"

#include "base/mem.h"
#include "tled/contact/sliding.h"
#include "tled/cpu/rows_groups.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A node or an element, by its place in the lattice. */
typedef struct placed {
    int32_t z, y, x, index;
} placed;

typedef struct builder {
    rows *r;
    const tled_problem *p;
    placed *node;     /* nodes, in order */
    placed *element;  /* elements, by their low corner, in order */
    int32_t *slab_of; /* the model's nodes */
    int64_t *start;   /* slabs + 1: where their elements begin in: */
    int32_t *list;
    int32_t *last; /* the model's nodes: the last block so far that has elements at them */
    err *e;
} builder;

void rows_free(rows *r)
{
    free(r->slab);
    free(r->block);
    free(r->group);
    free(r->stretch);
    free(r->sum);
    free(r->term);
    free(r->place);
    free(r->cell_element);
    free(r->extra);
    free(r->extra_node);
    memset(r, 0, sizeof *r);
}

static int by_place(const void *a, const void *b)
{
    const placed *p = a, *q = b;
    if (p->z != q->z)
        return p->z < q->z ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index);
}

static void sort(placed *list, int64_t count)
{
    for (int64_t i = 1; i < count; i++)
        if (by_place(&list[i - 1], &list[i]) > 0) { /* as voxelise writes them they are in order */
            qsort(list, (size_t)count, sizeof *list, by_place);
            return;
        }
}

/* Rounded so that parts which stand apart by a fraction of a cell keep the order of their own nodes. */
static int find_places(builder *b)
{
    const tled_problem *p = b->p;
    double low[3] = {INFINITY, INFINITY, INFINITY};
    b->node = mem_array(p->nodes, sizeof *b->node, "the rows", b->e);
    b->element = mem_array(p->elements, sizeof *b->element, "the rows", b->e);
    b->slab_of = mem_array(p->nodes, sizeof *b->slab_of, "the rows", b->e);
    if (!b->node || !b->element || !b->slab_of)
        return -1;
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        low[i % 3] = fmin(low[i % 3], p->position[i]);
    for (int64_t n = 0; n < p->nodes; n++) {
        int32_t at[3];
        for (int a = 0; a < 3; a++)
            at[a] = (int32_t)floor((p->position[3 * n + a] - low[a]) / p->side[a] + .25);
        b->node[n] = (placed){at[2], at[1], at[0], (int32_t)n};
    }
    for (int64_t i = 0; i < p->elements; i++) {
        b->element[i] = b->node[p->element_node[8 * i]];
        b->element[i].index = (int32_t)i;
    }
    sort(b->node, p->nodes);
    sort(b->element, p->elements);
    return 0;
}

static bool same_row(const placed *a, const placed *b)
{
    return a->z == b->z && a->y == b->y;
}

/* Deals whole rows of nodes to slabs, as evenly as goes, and gives nodes their places. */
static int deal_nodes(builder *b, int slabs)
{
    rows *r = b->r;
    int64_t nodes = b->p->nodes, at = 0;
    int32_t slab = -1;
    r->place = mem_array(nodes, sizeof *r->place, "the rows", b->e);
    if (!r->place)
        return -1;
    for (int64_t i = 0; i < nodes; i++, at++) {
        bool begins = i == 0 || !same_row(&b->node[i - 1], &b->node[i]);
        if (begins && slab + 1 < slabs && i >= nodes * (slab + 1) / slabs) {
            slab++;
            at += ROWS_PAD;
        }
        r->place[b->node[i].index] = (int32_t)at;
        b->slab_of[b->node[i].index] = slab;
    }
    r->slabs = slab + 1;
    r->nodes = at + ROWS_PAD;
    if (r->nodes > INT32_MAX)
        return err_set(b->e, NULL, 0, "%lld nodes are too many", (long long)nodes);
    r->slab = mem_array(r->slabs, sizeof *r->slab, "the rows", b->e);
    return r->slab ? 0 : -1;
}

/* Which slabs an element has nodes of, each once. Returns how many. */
static int slabs_at(const builder *b, int64_t element, int32_t at[8])
{
    int count = 0;
    for (int c = 0; c < 8; c++) {
        const int32_t slab = b->slab_of[b->p->element_node[8 * element + c]];
        int i = 0;
        while (i < count && at[i] != slab)
            i++;
        if (i == count)
            at[count++] = slab;
    }
    return count;
}

/* Lists the elements of each slab, in their order. */
static int deal_elements(builder *b)
{
    const int64_t elements = b->p->elements;
    int32_t at[8];
    int64_t total = 0;
    b->start = mem_array(b->r->slabs + 1, sizeof *b->start, "the rows", b->e);
    if (!b->start)
        return -1;
    for (int64_t i = 0; i < elements; i++)
        for (int k = slabs_at(b, i, at) - 1; k >= 0; k--)
            b->start[at[k]]++;
    for (int32_t i = 0; i <= b->r->slabs; i++) {
        total += b->start[i];
        b->start[i] = total; /* where it ends, until it is filled from there downwards */
    }
    b->list = mem_array(total, sizeof *b->list, "the rows", b->e);
    if (!b->list)
        return -1;
    for (int64_t i = elements - 1; i >= 0; i--) {
        const int32_t element = b->element[i].index;
        for (int k = slabs_at(b, element, at) - 1; k >= 0; k--)
            b->list[--b->start[at[k]]] = element;
    }
    return 0;
}

/* Each node of a slab is in the first block that has all before it and its own last element in it or before it. */
static void end_nodes(builder *b, int32_t which, int64_t *node)
{
    rows *r = b->r;
    const rows_slab *s = &r->slab[which];
    for (int32_t at = s->block; *node < b->p->nodes && b->slab_of[b->node[*node].index] == which; ++*node) {
        const int32_t n = b->node[*node].index;
        at = b->last[n] > at ? b->last[n] : at;
        if (!r->block[at].nodes++)
            r->block[at].node = r->place[n];
    }
}

/* A slab's blocks: their elements, of about as many each, and their nodes. */
static int cut_slab(builder *b, rows_groups *groups, int32_t which, int64_t *node)
{
    rows *r = b->r;
    rows_slab *s = &r->slab[which];
    const int64_t from = b->start[which], count = b->start[which + 1] - from;
    const int64_t blocks = count ? (count - 1) / ROWS_BLOCK + 1 : 1;
    s->block = r->blocks;
    groups->seat = r->seats;
    groups->node = r->place[b->node[*node].index];
    groups->nodes = 0;
    for (int64_t i = *node; i < b->p->nodes && b->slab_of[b->node[i].index] == which; i++)
        groups->nodes++;
    for (int64_t i = 0; i < blocks; i++) {
        const int32_t *element = b->list + from + count * i / blocks;
        const int32_t of = (int32_t)(count * (i + 1) / blocks - count * i / blocks);
        for (int32_t k = 0; k < 8 * of; k++)
            b->last[b->p->element_node[8 * (int64_t)element[k / 8] + k % 8]] = r->blocks;
        if (rows_add_block(groups, element, of))
            return -1;
    }
    s->blocks = r->blocks - s->block;
    end_nodes(b, which, node);
    return 0;
}

static int cut_slabs(builder *b)
{
    rows_groups groups = {.r = b->r, .p = b->p, .e = b->e};
    int64_t node = 0;
    b->last = mem_array(b->p->nodes, sizeof *b->last, "the rows", b->e);
    int result = !b->last || deal_elements(b) || rows_groups_make(&groups) ? -1 : 0;
    for (int32_t i = 0; !result && i < b->r->slabs; i++)
        result = cut_slab(b, &groups, i, &node);
    rows_groups_free(&groups);
    return result;
}

bool rows_is_extra(const tled_problem *p, int64_t n)
{
    const int32_t *hold = p->hold + 3 * n;
    if (p->sliding && p->sliding->row[n] >= 0)
        return false;
    return p->force_start[n + 1] > p->force_start[n] || hold[0] >= 0 || hold[1] >= 0 || hold[2] >= 0;
}

static int by_row(const void *a, const void *b)
{
    const int32_t *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* Where a slab's nodes begin. */
static int32_t begins_at(const rows *r, const rows_slab *s)
{
    for (int32_t i = s->block; i < s->block + s->blocks; i++)
        if (r->block[i].nodes)
            return r->block[i].node;
    return INT32_MAX;
}

static void deal_extras(rows *r)
{
    int32_t slab = 0;
    for (int32_t i = 0; i < r->slabs; i++)
        r->slab[i].extra = r->slab[i].extras = 0;
    for (int32_t i = 0; r->slabs && i < r->extras; i++) { /* a mesh has none */
        while (slab + 1 < r->slabs && begins_at(r, &r->slab[slab + 1]) <= r->extra[i])
            slab++;
        rows_slab *s = &r->slab[slab];
        s->extra = s->extras++ ? s->extra : i;
    }
}

/* Sorted as pairs of a place and a node. */
static void sort_extras(rows *r, const tled_problem *p, int32_t *pair)
{
    int64_t at = 0;
    for (int64_t n = 0; n < p->nodes; n++)
        if (rows_is_extra(p, n)) {
            pair[2 * at] = r->place[n];
            pair[2 * at++ + 1] = (int32_t)n;
        }
    qsort(pair, (size_t)at, 2 * sizeof *pair, by_row);
    for (int64_t i = 0; i < at; i++) {
        r->extra[i] = pair[2 * i];
        r->extra_node[i] = pair[2 * i + 1];
    }
}

int rows_list_extras(rows *r, const tled_problem *p, err *e)
{
    r->extras = 0;
    for (int64_t n = 0; n < p->nodes; n++)
        r->extras += rows_is_extra(p, n);
    free(r->extra);
    free(r->extra_node);
    r->extra = mem_array(r->extras, sizeof *r->extra, "the rows", e);
    r->extra_node = mem_array(r->extras, sizeof *r->extra_node, "the rows", e);
    int32_t *pair = mem_array(r->extras, 2 * sizeof *pair, "the rows", e);
    const bool whole = r->extra && r->extra_node && pair;
    if (whole) {
        sort_extras(r, p, pair);
        deal_extras(r);
    }
    free(pair);
    return whole ? 0 : -1;
}

int rows_make(rows *r, const tled_problem *p, int lanes, int slabs, err *e)
{
    memset(r, 0, sizeof *r);
    r->lanes = lanes;
    builder b = {.r = r, .p = p, .e = e};
    const int result = find_places(&b) || deal_nodes(&b, slabs) || cut_slabs(&b) || rows_list_extras(r, p, e) ? -1 : 0;
    free(b.node);
    free(b.element);
    free(b.slab_of);
    free(b.start);
    free(b.list);
    free(b.last);
    return result;
}
