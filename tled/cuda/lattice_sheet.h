/* A sheet of a problem with slits, while it is filled: nodes such that, with all that their elements touch, a place of
 * the lattice means one node, and a low corner's place one cell. So what is computed from places needs no lists. A node
 * at the end of a slit has elements on both sides of it, with different nodes at one place: no sheet takes it. The
 * creator owns the sheet, which borrows the problem and `first`.
 */
#ifndef SINEW_LATTICE_SHEET_H
#define SINEW_LATTICE_SHEET_H

#include "tled/problem/state.h"

typedef struct lattice_sheet {
    const tled_problem *p;
    const int32_t *first;       /* nodes: the first one at its place: places_shared */
    int32_t number;             /* of the sheets begun so far */
    int64_t *at_node, *at_cell; /* by that: the sheet in the high half, and who is there in it */
} lattice_sheet;

/* -1 with e filled, and s to be freed all the same: no memory. */
int sheet_make(lattice_sheet *s, const tled_problem *p, const int32_t *first, err *e);
void sheet_free(lattice_sheet *s);

/* Begins an empty one. */
void sheet_begin(lattice_sheet *s);

/* Takes a node, if there is room for it and all that its elements touch. */
bool sheet_take(lattice_sheet *s, int32_t node);

/* Corner i of a node's elements, as 8 x element + corner, or -1 after its last. */
int32_t sheet_corner(const tled_problem *p, int32_t node, int i);

#endif
