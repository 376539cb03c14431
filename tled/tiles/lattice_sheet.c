#include "tled/tiles/lattice_sheet.h"

#include "base/mem.h"
#include "tled/tiles/places.h"

#include <stdlib.h>
#include <string.h>

enum { TOUCHED = 8 * 9 /* of a node: elements and their corners */ };

int lattice_sheet_make(lattice_sheet *s, const tled_problem *p, const int32_t *first, err *e)
{
    *s = (lattice_sheet){.p = p, .first = first};
    s->at_node = mem_array(p->nodes, sizeof *s->at_node, "sheets of nodes", e);
    s->at_cell = mem_array(p->nodes, sizeof *s->at_cell, "sheets of nodes", e);
    return s->at_node && s->at_cell ? 0 : -1;
}

void lattice_sheet_free(lattice_sheet *s)
{
    free(s->at_node);
    free(s->at_cell);
    memset(s, 0, sizeof *s);
}

void lattice_sheet_begin(lattice_sheet *s)
{
    s->number++;
}

int32_t lattice_sheet_corner(const tled_problem *p, int32_t node, int i)
{
    const int32_t corner = i < 8 ? p->corner[8 * (int64_t)node + i] : -1;
    return corner < 8 * p->elements ? corner : -1;
}

/* What a node has taken, to be given back where it cannot have all. */
typedef struct taken {
    int64_t *of[TOUCHED];
    int count;
} taken;

static bool take(const lattice_sheet *s, int64_t *place, int32_t who, taken *t)
{
    const int64_t mine = (int64_t)s->number << 32 | who;
    if (*place >> 32 != s->number) {
        *place = mine;
        t->of[t->count++] = place;
    }
    return *place == mine;
}

bool lattice_sheet_take(lattice_sheet *s, int32_t node)
{
    taken t = {.count = 0};
    bool takes = true;
    for (int i = 0; takes && lattice_sheet_corner(s->p, node, i) >= 0; i++) {
        const int32_t element = lattice_sheet_corner(s->p, node, i) / 8;
        const int32_t *corner = s->p->element_node + 8 * (int64_t)element;
        takes = take(s, &s->at_cell[s->first[corner[0]]], element, &t);
        for (int c = 0; takes && c < 8; c++)
            takes = take(s, &s->at_node[s->first[corner[c]]], corner[c], &t);
    }
    while (!takes && t.count)
        *t.of[--t.count] = 0;
    return takes;
}

typedef struct sheets {
    const tled_problem *p;
    int32_t *first;         /* nodes: the first at its place */
    int32_t *nodes, *cells; /* by that: how many nodes there are, and elements with their low corner */
    lattice_sheet filled;   /* the one that is being filled */
    int32_t *near;          /* nodes that have to do with a place that is shared */
    int64_t count;          /* of those that no sheet has yet */
} sheets;

static int allocate(sheets *s, err *e)
{
    const int64_t nodes = s->p->nodes;
    int32_t **of[] = {&s->first, &s->nodes, &s->cells, &s->near};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++)
        if (!(*of[i] = mem_array(nodes, sizeof **of[i], "sheets of nodes", e)))
            return -1;
    return lattice_sheet_make(&s->filled, s->p, s->first, e);
}

static void free_all(sheets *s)
{
    free(s->first);
    free(s->nodes);
    free(s->cells);
    free(s->near);
    lattice_sheet_free(&s->filled);
}

static bool is_near(const sheets *s, int32_t node)
{
    for (int i = 0; lattice_sheet_corner(s->p, node, i) >= 0; i++) {
        const int32_t *corner = s->p->element_node + lattice_sheet_corner(s->p, node, i) / 8 * 8;
        if (s->cells[s->first[corner[0]]] > 1)
            return true;
        for (int c = 0; c < 8; c++)
            if (s->nodes[s->first[corner[c]]] > 1)
                return true;
    }
    return false;
}

static int list_near(sheets *s, const int32_t *group, const int32_t *at, int32_t *sheet, err *e)
{
    const tled_problem *p = s->p;
    if (places_shared(p->nodes, group, at, s->first, e))
        return -1;
    for (int32_t n = 0; n < p->nodes; n++)
        s->nodes[s->first[n]]++;
    for (int64_t i = 0; i < p->elements; i++)
        s->cells[s->first[p->element_node[8 * i]]]++;
    for (int32_t n = 0; n < p->nodes; n++) {
        sheet[n] = 0;
        if (is_near(s, n))
            s->near[s->count++] = n;
    }
    return 0;
}

/* Gives a sheet the nodes that it has room for, in their order. Returns how many. */
static int64_t fill_sheet(sheets *s, int32_t number, int32_t *sheet)
{
    int64_t left = 0;
    lattice_sheet_begin(&s->filled);
    for (int64_t i = 0; i < s->count; i++) {
        const int32_t node = s->near[i];
        sheet[node] = number;
        if (!lattice_sheet_take(&s->filled, node))
            s->near[left++] = node;
    }
    const int64_t gone = s->count - left;
    s->count = left;
    return gone;
}

int32_t sheets_find(const tled_problem *p, const int32_t *group, const int32_t *at, int32_t *sheet, err *e)
{
    sheets s = {.p = p};
    int32_t count = -1;
    if (!allocate(&s, e) && !list_near(&s, group, at, sheet, e)) {
        for (count = 0; fill_sheet(&s, count, sheet);)
            count++;
        for (int64_t i = 0; i < s.count; i++) /* an empty sheet has no room for them */
            sheet[s.near[i]] = SHEET_TIP;
        count += count == 0;
    }
    free_all(&s);
    return count;
}
