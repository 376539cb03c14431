#include "tled/cpu/rows.h"

#include "base/mem.h"
#include "tled/contact/sliding.h"

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
    int64_t run_capacity, layer_capacity, cell_capacity;
    err *e;
} builder;

void rows_free(rows *r)
{
    free(r->slab);
    free(r->layer);
    free(r->run);
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

/* Which of the four rows of nodes at an element are a slab's own. */
static uint8_t own_rows(const builder *b, int64_t element, int32_t slab)
{
    static const int first[4] = {0, 3, 4, 7}; /* low and high y at low z, then at high z */
    uint8_t mask = 0;
    for (int i = 0; i < 4; i++)
        mask |= (uint8_t)((b->slab_of[b->p->element_node[8 * element + first[i]]] == slab) << i);
    return mask;
}

static bool follows(const builder *b, const rows_run *run, int64_t element, uint8_t mask)
{
    if (run->count == b->r->lanes || run->mask != mask || !run->regular ||
        run->volume != b->p->element_volume[element] || run->mix != tled_mix(b->p, element) ||
        (run->border >= 0) != (tled_border(b->p, element) != NULL))
        return false;
    for (int c = 0; c < 8; c++)
        if (b->r->place[b->p->element_node[8 * element + c]] != run->node[c] + run->count)
            return false;
    return true;
}

static bool is_regular(const rows_run *run)
{
    const int32_t *n = run->node;
    return n[1] == n[0] + 1 && n[2] == n[3] + 1 && n[5] == n[4] + 1 && n[6] == n[7] + 1;
}

/* The last run has this element. */
static void mark_cut(const builder *b, int64_t element)
{
    rows_run *run = &b->r->run[b->r->runs - 1];
    if (run->cut < 0 && tled_cut(b->p, element))
        run->cut = b->r->cuts++;
}

/* Adds an element to the slab's last run, or in a new one, unless a layer begins with it. */
static int add_cell(builder *b, int64_t element, uint8_t mask, bool begins)
{
    rows *r = b->r;
    if (mem_grow(&r->cell_element, &b->cell_capacity, r->cells + 1, sizeof *r->cell_element, "the rows", b->e))
        return -1;
    r->cell_element[r->cells++] = (int32_t)element;
    if (!begins && follows(b, &r->run[r->runs - 1], element, mask)) {
        r->run[r->runs - 1].count++;
        mark_cut(b, element);
        return 0;
    }
    if (r->cells > INT32_MAX - ROWS_PAD ||
        mem_grow(&r->run, &b->run_capacity, r->runs + 1, sizeof *r->run, "the rows", b->e))
        return -1;
    rows_run *run = &r->run[r->runs++];
    *run = (rows_run){.cell = r->cells - 1,
                      .volume = b->p->element_volume[element],
                      .mix = tled_mix(b->p, element),
                      .cut = -1,
                      .border = tled_border(b->p, element) ? r->borders++ : -1,
                      .count = 1,
                      .mask = mask};
    for (int c = 0; c < 8; c++)
        run->node[c] = r->place[b->p->element_node[8 * element + c]];
    run->regular = is_regular(run);
    mark_cut(b, element);
    return 0;
}

static int begin_layer(builder *b)
{
    rows *r = b->r;
    if (mem_grow(&r->layer, &b->layer_capacity, r->layers + 1, sizeof *r->layer, "the rows", b->e))
        return -1;
    r->layer[r->layers++] = (rows_layer){.run = r->runs};
    return 0;
}

/* A slab's layers, from z where its first cells may be to its last nodes: their runs and their nodes. */
static int cut_slab(builder *b, int32_t which, int64_t *node, int64_t *element)
{
    rows *r = b->r;
    rows_slab *s = &r->slab[which];
    const int64_t first = *node;
    while (*node < b->p->nodes && b->slab_of[b->node[*node].index] == which)
        ++*node;
    s->layer = r->layers;
    /* Cells lie from a layer below its first row to its last row, and are in order: a window that moves on. */
    int32_t z = b->node[first].z - 1, last = b->node[*node - 1].z;
    while (*element > 0 && b->element[*element - 1].z >= z)
        --*element;
    while (*element < b->p->elements && b->element[*element].z < z)
        ++*element;
    for (int64_t n = first; z <= last; z++) {
        if (begin_layer(b))
            return -1;
        rows_layer *l = &r->layer[r->layers - 1];
        for (bool begins = true; *element < b->p->elements && b->element[*element].z == z; ++*element) {
            int64_t i = b->element[*element].index;
            uint8_t mask = own_rows(b, i, which);
            if (mask && add_cell(b, i, mask, begins))
                return -1;
            begins &= !mask;
        }
        l->runs = r->runs - l->run;
        l->node = n < *node ? r->place[b->node[n].index] : 0;
        for (; n < *node && b->node[n].z == z; n++)
            l->nodes++;
    }
    s->layers = r->layers - s->layer;
    return 0;
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
    for (int32_t i = s->layer; i < s->layer + s->layers; i++)
        if (r->layer[i].nodes)
            return r->layer[i].node;
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
    int result = find_places(&b) || deal_nodes(&b, slabs) ? -1 : 0;
    int64_t node = 0, element = 0;
    for (int32_t i = 0; !result && i < r->slabs; i++)
        result = cut_slab(&b, i, &node, &element);
    result = result || rows_list_extras(r, p, e) ? -1 : 0;
    free(b.node);
    free(b.element);
    free(b.slab_of);
    return result;
}
