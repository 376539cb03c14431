#include "tled/cuda/march.h"

#include "base/mem.h"
#include "tled/cuda/march_near.h"
#include "tled/cuda/march_units.h"
#include "tled/cuda/places.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    OWNED = MARCH_SIDE - 1,
    PATCH_X = 8, /* of a warp */
    PATCH_Y = 4
};

/* Threads for each element: with more, bricks are taken. On an H200 blocks of 1.20 and 1.21 and faces of 1.43 and 1.72
 * were faster so, the last by a third. (Tests march all the same.) */
#ifndef MARCH_SPARSE
#define MARCH_SPARSE 2.5
#endif

/* The box around a part, in columns and layers. */
typedef struct box {
    int32_t low[3], high[3]; /* along the model's axes */
    int32_t columns[2];      /* along rows, across */
    int64_t first;           /* of its layers, in the arrays below */
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
    err *e;
} cutter;

/* A place in a column: place 0 to 16 along rows and across. */
typedef struct spot {
    int64_t layer; /* of the cutter's */
    int32_t i, j;
} spot;

void march_free(march *m)
{
    free(m->order);
    free(m->word);
    free(m->unit);
    free(m->near);
    free(m->detail);
    free(m->which);
    free(m->cell);
    memset(m, 0, sizeof *m);
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
        box *b = &c->boxes[c->part[n]];
        for (int a = 0; a < 3; a++) {
            const int32_t at = c->at[3 * (int64_t)n + a];
            b->low[a] = is_first || at < b->low[a] ? at : b->low[a];
            b->high[a] = is_first || at > b->high[a] ? at : b->high[a];
        }
    }
    return 0;
}

static int64_t depth(const cutter *c, const box *b)
{
    return (int64_t)b->high[c->m->axis[2]] - b->low[c->m->axis[2]] + 1;
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

/* Everywhere that a node stands, or a cell by its low corner; where it is owned comes first. Returns how many. */
static int spots_of(const cutter *c, int32_t node, bool is_cell, spot to[4])
{
    const box *b = &c->boxes[c->part[node]];
    const int *axis = c->m->axis;
    const int32_t *at = c->at + 3 * (int64_t)node;
    int32_t column[2][2], place[2][2];
    int many[2], count = 0;
    for (int a = 0; a < 2; a++)
        many[a] = along(at[axis[a]] - b->low[axis[a]], b->columns[a], !is_cell, column[a], place[a]);
    const int64_t layer = b->first + at[axis[2]] - b->low[axis[2]];
    for (int y = 0; y < many[1]; y++)
        for (int x = 0; x < many[0]; x++)
            to[count++] = (spot){layer + depth(c, b) * (column[0][x] + (int64_t)b->columns[0] * column[1][y]),
                                 place[0][x], place[1][y]};
    return count;
}

/* A multiprocessor has four schedulers, and every fourth warp is one's: neighbours are of
 * different ones, along rows and across. */
static int warp_of(int32_t i, int32_t j)
{
    const int half = i / PATCH_X;
    return 4 * half + (j / PATCH_Y + 2 * half) % 4;
}

/* The word of a place in its layer. */
static int word_of(int32_t i, int32_t j)
{
    if (i == MARCH_SIDE)
        return MARCH_THREADS + j;
    if (j == MARCH_SIDE)
        return MARCH_THREADS + MARCH_SIDE + 1 + i;
    return 32 * warp_of(i, j) + PATCH_X * (j % PATCH_Y) + i % PATCH_X;
}

/* Notes which warps have cells in each layer. Returns how many in all. */
static int64_t mark_warps(cutter *c)
{
    spot at[4];
    int64_t sum = 0;
    memset(c->warps, 0, (size_t)c->cells);
    for (int64_t i = 0; i < c->p->elements; i++)
        for (int k = spots_of(c, c->p->element_node[8 * i], true, at); k--;)
            c->warps[at[k].layer] |= (uint8_t)(1u << warp_of(at[k].i, at[k].j));
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

/* What a cell has of a volume's muscle, if that may contract; share: of the cell. */
static void add_muscle(const cutter *c, march_cell *to, const float *fibre, int32_t volume, double share)
{
    const tled_volume *v = &c->p->volume[volume];
    const bool second = to->muscle[0].curve >= 0;
    march_muscle *muscle = &to->muscle[second];
    if (!fibre || v->contract < 0)
        return;
    if (second)
        to->muscle[0].curve |= MARCH_SECOND;
    muscle->curve = (int32_t)v->contract;
    *(second ? &to->second_peak : &to->peak) = (float)(share * v->peak);
    for (int a = 0; a < 3; a++)
        muscle->fibre[a] = fibre[c->m->axis[a]];
}

static march_cell cell_of(const cutter *c, int64_t element)
{
    const tled_problem *p = c->p;
    const tled_law law = tled_law_of(p, element);
    const double share = tled_fraction(p, element), other = tled_mixture(p, element);
    march_cell cell = {.mu = (float)(share * law.c[0]),
                       .bulk = (float)(share * law.c[1]),
                       .hourglass = (float)(share * law.hourglass[HOURGLASS_K]),
                       .muscle = {{.curve = -1}, {.curve = -1}}};
    add_muscle(c, &cell, p->fibre ? p->fibre + 3 * element : NULL, p->element_volume[element], share * (1 - other));
    if (tled_mix(p, element) >= 0)
        add_muscle(c, &cell, p->mixfibre ? p->mixfibre + 3 * element : NULL, tled_mix(p, element), share * other);
    return cell;
}

static bool is_special(const cutter *c, const march_cell *cell)
{
    const tled_law *plain = &c->p->volume[c->m->plain].law;
    return cell->muscle[0].curve >= 0 || cell->mu != (float)plain->c[0] || cell->bulk != (float)plain->c[1] ||
           cell->hourglass != (float)plain->hourglass[HOURGLASS_K];
}

static int mark_special(cutter *c)
{
    const tled_problem *p = c->p;
    spot at[4];
    for (int32_t i = 1; i < p->volumes; i++)
        if (p->volume[i].elements > p->volume[c->m->plain].elements)
            c->m->plain = i;
    c->special = mem_array(c->cells, sizeof *c->special, "the march", c->e);
    if (!c->special)
        return -1;
    for (int64_t i = 0; i < p->elements; i++) {
        const march_cell cell = cell_of(c, i);
        for (int k = is_special(c, &cell) ? spots_of(c, p->element_node[8 * i], true, at) : 0; k--;)
            c->special[at[k].layer] = true;
    }
    return 0;
}

/* Numbers the layers that have owned nodes, and the empty ones before and after each
 * run of them; a list of the runs. */
static int number_layers(cutter *c, march_runs *runs)
{
    spot at[4];
    c->slot = mem_array(c->cells, sizeof *c->slot, "the march", c->e);
    if (!c->slot)
        return -1;
    memset(c->slot, 0xff, (size_t)c->cells * sizeof *c->slot);
    for (int32_t n = 0; n < c->p->nodes; n++) {
        spots_of(c, n, false, at);
        c->slot[at[0].layer] = 0;
    }
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
        if (march_runs_add(runs, base, c->warps + first, c->special + first, i - first, c->e))
            return -1;
    }
    return 0;
}

static int put_words(cutter *c)
{
    march *m = c->m;
    spot at[4];
    m->word = mem_array(m->layers + MARCH_AHEAD, MARCH_WORDS * sizeof *m->word, "the march", c->e);
    if (!m->word)
        return -1;
    for (int32_t n = 0; n < c->p->nodes; n++)
        for (int k = spots_of(c, n, false, at); k--;)
            if (c->slot[at[k].layer] >= 0)
                m->word[MARCH_WORDS * (int64_t)c->slot[at[k].layer] + word_of(at[k].i, at[k].j)] =
                    (uint32_t)n | MARCH_THERE | (k ? 0 : MARCH_OWN);
    for (int64_t i = 0; i < c->p->elements; i++)
        for (int k = spots_of(c, c->p->element_node[8 * i], true, at); k--;)
            m->word[MARCH_WORDS * (int64_t)c->slot[at[k].layer] + word_of(at[k].i, at[k].j)] |= MARCH_CELL;
    return 0;
}

/* Orders the nodes as words own them, and says in all words where theirs stands. */
static int order_nodes(cutter *c)
{
    march *m = c->m;
    int32_t count = 0;
    m->order = mem_array(c->p->nodes, sizeof *m->order, "the march", c->e);
    if (!m->order)
        return -1;
    for (const uint32_t *layer = m->word; layer < m->word + MARCH_WORDS * m->layers; layer += MARCH_WORDS)
        for (int32_t j = 1; j <= OWNED; j++)
            for (int32_t i = 1; i <= OWNED; i++)
                if (layer[word_of(i, j)] & MARCH_OWN)
                    m->order[layer[word_of(i, j)] & MARCH_NODE] = count++;
    for (uint32_t *word = m->word; word < m->word + MARCH_WORDS * m->layers; word++)
        if (*word & MARCH_THERE)
            *word = (*word & ~(uint32_t)MARCH_NODE) | (uint32_t)m->order[*word & MARCH_NODE];
    return 0;
}

/* The special cells: first counted, then, with their arrays made, filled. */
static void list_special(cutter *c)
{
    march *m = c->m;
    spot at[4];
    m->cells = 0;
    for (int64_t i = 0; i < c->p->elements; i++) {
        const march_cell cell = cell_of(c, i);
        if (!is_special(c, &cell))
            continue;
        const int64_t number = m->cells++;
        if (m->cell)
            m->cell[number] = cell;
        for (int k = spots_of(c, c->p->element_node[8 * i], true, at); k--;) {
            const int64_t layer = c->slot[at[k].layer];
            const int word = word_of(at[k].i, at[k].j);
            if (m->detail[layer] < 0)
                m->detail[layer] = (int32_t)m->details++;
            if (!m->cell)
                continue;
            m->word[MARCH_WORDS * layer + word] |= MARCH_SPECIAL;
            m->which[MARCH_THREADS * (int64_t)m->detail[layer] + word] = (int32_t)number + 1;
        }
    }
}

static int put_special(cutter *c)
{
    march *m = c->m;
    m->detail = mem_array(m->layers + MARCH_AHEAD, sizeof *m->detail, "the march", c->e);
    if (!m->detail)
        return -1;
    memset(m->detail, 0xff, (size_t)(m->layers + MARCH_AHEAD) * sizeof *m->detail);
    list_special(c);
    m->which = mem_array(m->details, MARCH_THREADS * sizeof *m->which, "the march", c->e);
    m->cell = mem_array(m->cells, sizeof *m->cell, "the march", c->e);
    if (!m->which || !m->cell)
        return -1;
    if (m->cells)
        list_special(c);
    return 0;
}

static void mark_units(march *m)
{
    for (int64_t i = 0; i < m->units; i++)
        for (int32_t k = 0; k < m->unit[i].cells; k++)
            m->unit[i].special |= m->detail[m->unit[i].base + k] >= 0;
}

int march_make(march *m, const tled_problem *p, int64_t slots, err *e)
{
    memset(m, 0, sizeof *m);
    cutter c = {.m = m, .p = p, .e = e};
    march_runs runs = {0};
    int result = -1;
    if (p->nodes > MARCH_NODE)
        return 0;
    c.part = mem_array(p->nodes, sizeof *c.part, "the march", e);
    c.at = mem_array(p->nodes, 3 * sizeof *c.at, "the march", e);
    if (!c.part || !c.at || places_find(p, c.part, c.at, e) || find_boxes(&c) || choose_axes(&c))
        goto out;
    result = 0;
    if (m->computed == 0 || m->computed > MARCH_SPARSE)
        goto out;
    result = mark_special(&c) || number_layers(&c, &runs) || put_words(&c) || order_nodes(&c) || put_special(&c) ||
                     march_runs_cut(&runs, slots, &m->unit, &m->units, e) || march_near_find(m, p->nodes, e)
                 ? -1
                 : 0;
    if (!result)
        mark_units(m);
out:
    free(c.part);
    free(c.at);
    free(c.boxes);
    free(c.warps);
    free(c.special);
    free(c.slot);
    march_runs_free(&runs);
    return result;
}
