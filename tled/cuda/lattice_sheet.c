#include "tled/cuda/lattice_sheet.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum { TOUCHED = 8 * 9 /* of a node: elements and their corners */ };

int sheet_make(lattice_sheet *s, const tled_problem *p, const int32_t *first, err *e)
{
    *s = (lattice_sheet){.p = p, .first = first};
    s->at_node = mem_array(p->nodes, sizeof *s->at_node, "sheets of nodes", e);
    s->at_cell = mem_array(p->nodes, sizeof *s->at_cell, "sheets of nodes", e);
    return s->at_node && s->at_cell ? 0 : -1;
}

void sheet_free(lattice_sheet *s)
{
    free(s->at_node);
    free(s->at_cell);
    memset(s, 0, sizeof *s);
}

void sheet_begin(lattice_sheet *s)
{
    s->number++;
}

int32_t sheet_corner(const tled_problem *p, int32_t node, int i)
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

bool sheet_take(lattice_sheet *s, int32_t node)
{
    taken t = {.count = 0};
    bool takes = true;
    for (int i = 0; takes && sheet_corner(s->p, node, i) >= 0; i++) {
        const int32_t element = sheet_corner(s->p, node, i) / 8;
        const int32_t *corner = s->p->element_node + 8 * (int64_t)element;
        takes = take(s, &s->at_cell[s->first[corner[0]]], element, &t);
        for (int c = 0; takes && c < 8; c++)
            takes = take(s, &s->at_node[s->first[corner[c]]], corner[c], &t);
    }
    while (!takes && t.count)
        *t.of[--t.count] = 0;
    return takes;
}
