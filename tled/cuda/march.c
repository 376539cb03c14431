#include "tled/cuda/march.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "tled/cuda/march_cells.h"
#include "tled/cuda/march_near.h"
#include "tled/cuda/march_tips.h"
#include "tled/cuda/march_units.h"
#include "tled/tiles/lattice_sheet.h"
#include "tled/tiles/places.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    OWNED = MARCH_SIDE - 1,
    SPOTS = 72 /* the most of a node: one, and of each of its elements one for each of its corners */
};

/* Threads for each element: with more, bricks are taken. On an H200 blocks of 1.20 and 1.21 and faces of 1.43 and 1.72
 * were faster so, the last by a third. (Tests march all the same.) */
#ifndef MARCH_SPARSE
#define MARCH_SPARSE 2.5
#endif

/* What decides for a march in double precision, in ns of one multiprocessor of an H200: an element of bricks (at 132
 * of them 79 to 96 ps measured, from 99,452 elements to 4 million), a unit of march_units.c's cost (predicted: twice
 * single precision's, of which a million elements take 27 us), and what comes with each of a block's units: a layer
 * more, and its start. */
static const double brick_time = 11.2, cost_time = 144, unit_cost = 25;

/* The box around a part, or a sheet of one, in columns and layers. */
typedef struct box {
    int32_t low[3], high[3]; /* along the model's axes */
    int32_t columns[2];      /* along rows, across */
    int64_t first;           /* of its layers, in the arrays below */
    bool further;            /* of a sheet after the first */
} box;

typedef struct cutter {
    march *m;
    const tled_problem *p;
    int32_t *part, *at; /* nodes: its box; nodes x 3: places_find's */
    box *boxes;
    int64_t parts, cells; /* cells: of the arrays below: layers of all columns, filled or not */
    uint8_t *warps;       /* of the layer's warps, those with cells */
    bool *special;        /* the layer has special cells */
    int32_t *slot;        /* its number, or -1; before: 0 where a node is owned */
    int32_t *which;       /* elements: its special cell, from 1 on, or 0 */
    int32_t *sheet;       /* nodes: sheets_find's; NULL: there is one, and part is of all. Else there are: */
    bool *inner;          /* nodes: all corners of its elements are in its sheet */
    int margin;           /* layers around a box: of nodes that its cells have, and it does not */
    bool shared;          /* two nodes or cells have one place */
    err *e;
} cutter;

/* A place in a column: place 0 to 16 along rows and across. */
typedef struct spot {
    int64_t layer; /* of the cutter's */
    int32_t i, j;
} spot;

/* Takes a node into its box, of which it may be the first. */
static void grow_box(const cutter *c, int32_t n, bool is_first)
{
    box *b = &c->boxes[c->part[n]];
    for (int a = 0; a < 3; a++) {
        const int32_t at = c->at[3 * (int64_t)n + a];
        b->low[a] = is_first || at < b->low[a] ? at : b->low[a];
        b->high[a] = is_first || at > b->high[a] ? at : b->high[a];
    }
}

static int find_boxes(cutter *c)
{
    const tled_problem *p = c->p;
    for (int32_t n = 0; n < p->nodes; n++)
        c->parts += c->part[n] == n;
    c->boxes = mem_array(c->parts, sizeof *c->boxes, "the march", c->e);
    if (!c->boxes)
        return -1;
    c->parts = 0;
    for (int32_t n = 0; n < p->nodes; n++) { /* the lowest of a part comes first */
        const bool is_first = c->part[n] == n;
        c->part[n] = is_first ? (int32_t)c->parts++ : c->part[c->part[n]];
        grow_box(c, n, is_first);
    }
    return 0;
}

static int64_t depth(const cutter *c, const box *b)
{
    return (int64_t)b->high[c->m->axis[2]] - b->low[c->m->axis[2]] + 1 + 2 * (int64_t)c->margin;
}

/* Lays out the layers of all boxes for the axes of now; false where they are out of all proportion to the nodes. */
static bool lay_out(cutter *c)
{
    const int64_t most = 16 * c->p->nodes + (1 << 20);
    c->cells = 0;
    for (int64_t i = 0; i < c->parts; i++) {
        box *b = &c->boxes[i];
        for (int a = 0; a < 2; a++)
            b->columns[a] = (b->high[c->m->axis[a]] - b->low[c->m->axis[a]]) / OWNED + 1;
        b->first = c->cells;
        if ((double)b->columns[0] * b->columns[1] * (double)depth(c, b) > (double)most)
            return false;
        c->cells += (int64_t)b->columns[0] * b->columns[1] * depth(c, b);
        if (c->cells > most)
            return false;
    }
    return true;
}

/* Where along one side a place of the lattice stands: its column, and with `before` (nodes alone) the one before it, or
 * the one after it. Returns how many. */
static int along(int32_t at, int32_t columns, bool before, int32_t column[2], int32_t place[2])
{
    const int32_t rest = at % OWNED;
    int count = 1;
    column[0] = at / OWNED;
    place[0] = rest + 1;
    if (rest == OWNED - 1 && column[0] + 1 < columns) {
        column[count] = column[0] + 1;
        place[count++] = 0;
    } else if (before && rest == 0 && column[0]) {
        column[count] = column[0] - 1;
        place[count++] = OWNED + 1;
    }
    return count;
}

/* Where a node of a box stands, or a cell by its low corner; where it is owned comes first. Returns how many. */
static int spots_of(const cutter *c, int32_t node, bool is_cell, spot *to)
{
    const box *b = &c->boxes[c->part[node]];
    const int *axis = c->m->axis;
    const int32_t *at = c->at + 3 * (int64_t)node;
    int32_t column[2][2], place[2][2];
    int many[2], count = 0;
    for (int a = 0; a < 2; a++)
        many[a] = along(at[axis[a]] - b->low[axis[a]], b->columns[a], !is_cell, column[a], place[a]);
    const int64_t layer = b->first + at[axis[2]] - b->low[axis[2]] + c->margin;
    for (int y = 0; y < many[1]; y++)
        for (int x = 0; x < many[0]; x++)
            to[count++] = (spot){layer + depth(c, b) * (column[0][x] + (int64_t)b->columns[0] * column[1][y]),
                                 place[0][x], place[1][y]};
    return count;
}

/* Where a node that a sheet takes is owned. */
static spot own_spot(const cutter *c, int32_t node)
{
    const box *b = &c->boxes[c->part[node]];
    const int *axis = c->m->axis;
    int32_t way[3];
    for (int a = 0; a < 3; a++)
        way[a] = c->at[3 * (int64_t)node + axis[a]] - b->low[axis[a]];
    const int64_t column = way[0] / OWNED + (int64_t)b->columns[0] * (way[1] / OWNED);
    return (spot){b->first + depth(c, b) * column + way[2] + c->margin, way[0] % OWNED + 1, way[1] % OWNED + 1};
}

/* A step of the lattice from a spot on, or back. */
static spot beside(const cutter *c, spot from, const int32_t way[3], int by)
{
    const int *axis = c->m->axis;
    return (spot){from.layer + by * way[axis[2]], from.i + by * way[axis[0]], from.j + by * way[axis[1]]};
}

/* Adds one to a list, if it is not there: *count. */
static void add_spot(spot *to, int *count, spot s)
{
    for (int i = 0; i < *count; i++)
        if (to[i].layer == s.layer && to[i].i == s.i && to[i].j == s.j)
            return;
    to[(*count)++] = s;
}

/* Whether all corners of an element are in the sheet of a node. */
static bool is_in_sheet(const cutter *c, int64_t element, int32_t node)
{
    for (int k = 0; k < 8; k++)
        if (c->sheet[c->p->element_node[8 * element + k]] != c->sheet[node])
            return false;
    return c->sheet[node] != SHEET_TIP;
}

/* Where a cell stands by its low corner. Of sheets: in each column that owns one of its corners. Returns how many. */
static int cell_spots(const cutter *c, int64_t element, spot *to)
{
    const int32_t *corner = c->p->element_node + 8 * element;
    int count = 0;
    if (!c->sheet || is_in_sheet(c, element, corner[0]))
        return spots_of(c, corner[0], true, to);
    for (int k = 0; k < 8; k++)
        if (c->sheet[corner[k]] != SHEET_TIP)
            add_spot(to, &count, beside(c, own_spot(c, corner[k]), lattice_vtk[k], -1));
    return count;
}

/* Where a node stands; where it is owned comes first. Of sheets: wherever a cell of it does. Returns how many. */
static int node_spots(const cutter *c, int32_t node, spot *to)
{
    spot cell[8];
    int count = 0;
    if (!c->sheet || c->inner[node])
        return spots_of(c, node, false, to);
    if (c->sheet[node] != SHEET_TIP)
        to[count++] = own_spot(c, node);
    for (int i = 0; i < 8; i++) {
        const int32_t corner = c->p->corner[8 * (int64_t)node + i];
        for (int k = corner < 8 * c->p->elements ? cell_spots(c, corner / 8, cell) : 0; k--;)
            add_spot(to, &count, beside(c, cell[k], lattice_vtk[corner % 8], 1));
    }
    return count;
}

static bool is_tip(const cutter *c, int32_t node)
{
    return c->sheet && c->sheet[node] == SHEET_TIP;
}

/* On all threads, in any order: what several of them mark, each marks alike. */
typedef struct marking {
    cutter *c;
    void (*mark)(cutter *c, int64_t i); /* by node or by element i */
} marking;

static void marking_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const marking *m = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        m->mark(m->c, i);
}

static void mark_all(cutter *c, int64_t count, void (*mark)(cutter *c, int64_t i))
{
    marking m = {c, mark};
    pool_run(c->p->threads, count, 4096, marking_work, &m);
}

static void mark_warp(cutter *c, int64_t element)
{
    spot at[SPOTS];
    for (int k = cell_spots(c, element, at); k--;)
        __atomic_fetch_or(&c->warps[at[k].layer], (uint8_t)(1u << march_warp_of(at[k].i, at[k].j)), __ATOMIC_RELAXED);
}

/* Notes which warps have cells in each layer. Returns how many in all. */
static int64_t mark_warps(cutter *c)
{
    int64_t sum = 0;
    memset(c->warps, 0, (size_t)c->cells);
    mark_all(c, c->p->elements, mark_warp);
    for (int64_t i = 0; i < c->cells; i++)
        sum += march_warps(c->warps[i]);
    return sum;
}

static int make_layers(cutter *c)
{
    free(c->warps);
    c->warps = mem_array(c->cells, sizeof *c->warps, "the march", c->e);
    return c->warps ? 0 : -1;
}

/* The axes by which the fewest warps have cells, of those that lay_out takes; of several, the first. */
static int choose_axes(cutter *c)
{
    static const int all[][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    enum { CHOICES = sizeof all / sizeof *all };
    int64_t least = INT64_MAX;
    int best = -1;
    for (int k = 0; k <= CHOICES; k++) {
        const bool last = k == CHOICES;
        if (last && best < 0)
            return 0;
        memcpy(c->m->axis, all[last ? best : k], sizeof c->m->axis);
        if (!lay_out(c))
            continue;
        if (make_layers(c))
            return -1;
        const int64_t warps = mark_warps(c);
        if (warps < least) {
            least = warps;
            best = k;
        }
    }
    c->m->computed = 32. * (double)least / (double)c->p->elements;
    return 0;
}

static void mark_if_special(cutter *c, int64_t element)
{
    spot at[SPOTS];
    const march_cell cell = march_cell_of(c->m, c->p, element);
    c->which[element] = march_cell_special(c->m, c->p, element, &cell);
    for (int k = c->which[element] ? cell_spots(c, element, at) : 0; k--;)
        __atomic_store_n(&c->special[at[k].layer], true, __ATOMIC_RELAXED);
}

static int mark_special(cutter *c)
{
    const tled_problem *p = c->p;
    c->m->plain = march_plain_of(p);
    c->special = mem_array(c->cells, sizeof *c->special, "the march", c->e);
    if (!c->which)
        c->which = mem_array(p->elements, sizeof *c->which, "the march", c->e);
    if (!c->special || !c->which)
        return -1;
    mark_all(c, p->elements, mark_if_special);
    return 0;
}

static void mark_owned(cutter *c, int64_t node)
{
    spot at[SPOTS];
    const int many = node_spots(c, (int32_t)node, at);
    for (int k = 0; k < (c->sheet && !c->inner[node] ? many : 1); k++)
        __atomic_store_n(&c->slot[at[k].layer], 0, __ATOMIC_RELAXED);
}

/* Numbers the layers that have owned nodes, and the empty ones before and after each
 * run of them; a list of the runs. */
static int number_layers(cutter *c, march_runs *runs)
{
    c->slot = mem_array(c->cells, sizeof *c->slot, "the march", c->e);
    if (!c->slot)
        return -1;
    memset(c->slot, 0xff, (size_t)c->cells * sizeof *c->slot);
    mark_all(c, c->p->nodes, mark_owned);
    for (int64_t i = 0, part = 0; i < c->cells;) { /* a run ends with its column */
        while (part + 1 < c->parts && c->boxes[part + 1].first <= i)
            part++;
        const int64_t deep = depth(c, &c->boxes[part]), end = i + deep - (i - c->boxes[part].first) % deep;
        if (c->slot[i] < 0) {
            i++;
            continue;
        }
        if (c->m->layers > INT32_MAX - deep - 2)
            return err_set(c->e, NULL, 0, "%lld elements are too many for this device", (long long)c->p->elements);
        const int32_t base = (int32_t)c->m->layers++;
        const int64_t first = i;
        for (; i < end && c->slot[i] >= 0; i++)
            c->slot[i] = (int32_t)c->m->layers++;
        c->m->layers++;
        if (march_runs_add(runs, base, c->warps + first, c->special + first, i - first, c->boxes[part].further, c->e))
            return -1;
    }
    return 0;
}

/* Puts bits into a word that has none of them yet. */
static void put_word(cutter *c, const spot *at, uint32_t bits)
{
    uint32_t *word = &c->m->word[MARCH_WORDS * (int64_t)c->slot[at->layer] + march_word_of(at->i, at->j)];
    if (__atomic_fetch_or(word, bits, __ATOMIC_RELAXED) & bits & (MARCH_THERE | MARCH_CELL))
        __atomic_store_n(&c->shared, true, __ATOMIC_RELAXED);
}

static void put_node(cutter *c, int64_t n)
{
    spot at[SPOTS];
    for (int k = node_spots(c, (int32_t)n, at); k--;)
        if (c->slot[at[k].layer] >= 0)
            put_word(c, &at[k], (uint32_t)n | MARCH_THERE | (k || is_tip(c, (int32_t)n) ? 0 : MARCH_OWN));
}

static void put_cell(cutter *c, int64_t element)
{
    spot at[SPOTS];
    for (int k = cell_spots(c, element, at); k--;)
        put_word(c, &at[k], MARCH_CELL);
}

static int put_words(cutter *c)
{
    march *m = c->m;
    m->word = mem_array(m->layers + MARCH_AHEAD, MARCH_WORDS * sizeof *m->word, "the march", c->e);
    if (!m->word)
        return -1;
    mark_all(c, c->p->nodes, put_node);
    mark_all(c, c->p->elements, put_cell);
    return 0;
}

/* Numbers the special cells, those that are cut first, and the layers that have any. */
static void number_special(cutter *c)
{
    march *m = c->m;
    int32_t cuts = 0, others = (int32_t)c->p->cut.count;
    for (int64_t i = 0; i < c->p->elements; i++)
        if (c->which[i])
            c->which[i] = 1 + (tled_cut(c->p, i) ? cuts++ : others++);
    m->cuts = c->p->cut.count;
    m->cells = cuts + others - m->cuts;
    for (int64_t i = 0; i < c->cells; i++)
        if (c->special[i])
            m->detail[c->slot[i]] = (int32_t)m->details++;
}

static void put_if_special(cutter *c, int64_t element)
{
    march *m = c->m;
    spot at[SPOTS];
    const int32_t which = c->which[element];
    if (!which)
        return;
    m->cell[which - 1] = march_cell_of(m, c->p, element);
    if (which <= m->cuts)
        m->cut[which - 1] = march_cut_of(m, tled_cut(c->p, element));
    for (int k = cell_spots(c, element, at); k--;) {
        const int64_t layer = c->slot[at[k].layer];
        const int word = march_word_of(at[k].i, at[k].j);
        m->word[MARCH_WORDS * layer + word] |= MARCH_SPECIAL;
        m->which[MARCH_THREADS * (int64_t)m->detail[layer] + word] = which;
    }
}

static int put_special(cutter *c)
{
    march *m = c->m;
    m->detail = mem_array(m->layers + MARCH_AHEAD, sizeof *m->detail, "the march", c->e);
    if (!m->detail)
        return -1;
    memset(m->detail, 0xff, (size_t)(m->layers + MARCH_AHEAD) * sizeof *m->detail);
    number_special(c);
    m->which = mem_array(m->details, MARCH_THREADS * sizeof *m->which, "the march", c->e);
    m->cut = mem_array(m->cuts, sizeof *m->cut, "the march", c->e);
    m->cell = mem_array(m->cells, sizeof *m->cell, "the march", c->e);
    if (!m->which || !m->cut || !m->cell)
        return -1;
    mark_all(c, c->p->elements, put_if_special);
    return 0;
}

/* The directions of fibres, where there are any. */
static int put_along(cutter *c)
{
    march *m = c->m;
    spot at[SPOTS];
    if (!m->families)
        return 0;
    m->along = march_along_make(m, c->e);
    for (int64_t i = 0; m->along && i < c->p->elements; i++)
        for (int k = cell_spots(c, i, at); k--;)
            march_along_put(m, c->p, i,
                            MARCH_THREADS * (int64_t)c->slot[at[k].layer] + march_word_of(at[k].i, at[k].j));
    return m->along ? 0 : -1;
}

/* Notes which nodes have all that their elements touch in their own sheet. */
static void find_inner(cutter *c)
{
    const tled_problem *p = c->p;
    for (int32_t n = 0; n < p->nodes; n++) {
        c->inner[n] = c->sheet[n] != SHEET_TIP;
        for (int i = 0; i < 8 && p->corner[8 * (int64_t)n + i] < 8 * p->elements; i++)
            c->inner[n] &= is_in_sheet(c, p->corner[8 * (int64_t)n + i] / 8, n);
    }
}

/* Cuts the parts, where some of their nodes share places, into sheets: a box for each that has nodes. */
static int part_sheets(cutter *c)
{
    const tled_problem *p = c->p;
    c->sheet = mem_array(p->nodes, sizeof *c->sheet, "the march", c->e);
    c->inner = mem_array(p->nodes, sizeof *c->inner, "the march", c->e);
    const int32_t sheets = c->sheet && c->inner ? sheets_find(p, c->part, c->at, c->sheet, c->e) : -1;
    if (sheets < 0)
        return -1;
    int32_t *number = mem_array(c->parts * sheets, sizeof *number, "the march", c->e); /* of its box, from 1 on */
    free(c->boxes);
    c->boxes = mem_array(c->parts * sheets, sizeof *c->boxes, "the march", c->e);
    c->parts = 0;
    c->margin = 1;
    for (int32_t n = 0; number && c->boxes && n < p->nodes; n++) {
        if (is_tip(c, n))
            continue;
        int32_t *its = &number[(int64_t)c->part[n] * sheets + c->sheet[n]];
        const bool is_first = !*its;
        *its = is_first ? (int32_t)++c->parts : *its;
        c->part[n] = *its - 1;
        c->boxes[*its - 1].further = c->sheet[n] > 0;
        grow_box(c, n, is_first);
    }
    const int result = number && c->boxes ? 0 : -1;
    free(number);
    find_inner(c);
    return result;
}

/* Lays out the layers, and what stands in them. */
static int cut_layers(cutter *c, march_runs *runs)
{
    march_runs_free(runs);
    free(c->special), free(c->slot), free(c->m->word);
    c->special = NULL, c->slot = NULL, c->m->word = NULL;
    c->m->layers = 0;
    c->shared = false;
    return mark_special(c) || number_layers(c, runs) || put_words(c) ? -1 : 0;
}

/* As cut_layers, by sheets. *suited: they have room, and fill enough threads. */
static int cut_sheets(cutter *c, march_runs *runs, bool *suited)
{
    *suited = false;
    if (part_sheets(c))
        return -1;
    if (!lay_out(c))
        return 0;
    if (make_layers(c))
        return -1;
    c->m->computed = 32. * (double)mark_warps(c) / (double)c->p->elements;
    *suited = c->m->computed > 0 && c->m->computed <= MARCH_SPARSE;
    if (!*suited)
        return 0;
    if (cut_layers(c, runs))
        return -1;
    return c->shared ? err_set(c->e, NULL, 0, "two nodes of one sheet share a place of the lattice") : 0;
}

/* What is left to be made of layers. */
static int finish(cutter *c, const march_runs *runs, int64_t slots)
{
    march *m = c->m;
    if (march_order_nodes(m, c->p->nodes, c->sheet, c->p->threads, c->e) || put_special(c) || put_along(c) ||
        march_runs_cut(runs, slots, &m->unit, &m->units, c->e) || march_tips_list(m, c->p, c->sheet, c->which, c->e) ||
        march_tips_add(m, c->e) || (c->sheet && march_turns_order(m, c->sheet, c->p->nodes, c->e)) ||
        march_near_find(m, c->p->nodes, c->e))
        return -1;
    m->cost = runs->all;
    m->computed += 8. * (double)m->tips / (double)c->p->elements;
    march_units_mark(m);
    return 0;
}

bool march_pays(const march *m, int64_t cells, int64_t slots)
{
    const double each = (m->cost + unit_cost * (double)m->units) / (double)slots;
    const double longest = fmax(each, m->cost / (double)m->units + unit_cost);
    return longest * cost_time < brick_time * (double)cells / (double)slots || MARCH_SPARSE > 1e6;
}

int march_make(march *m, const tled_problem *p, int64_t slots, err *e)
{
    memset(m, 0, sizeof *m);
    cutter c = {.m = m, .p = p, .e = e};
    march_runs runs = {0};
    bool suited;
    int result = -1;
    m->families = march_families_of(p);
    if (p->nodes > MARCH_NODE || m->families < 0)
        return 0;
    c.part = mem_array(p->nodes, sizeof *c.part, "the march", e);
    c.at = mem_array(p->nodes, 3 * sizeof *c.at, "the march", e);
    if (!c.part || !c.at || places_find(p, c.part, c.at, e) || find_boxes(&c) || choose_axes(&c))
        goto out;
    suited = m->computed > 0 && m->computed <= MARCH_SPARSE;
    if (suited && (cut_layers(&c, &runs) || (c.shared && cut_sheets(&c, &runs, &suited))))
        goto out;
    result = suited ? finish(&c, &runs, slots) : 0;
out:
    free(c.part), free(c.at), free(c.boxes);
    free(c.warps), free(c.special), free(c.slot);
    free(c.sheet), free(c.which), free(c.inner);
    march_runs_free(&runs);
    return result;
}
