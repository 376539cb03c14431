/* A sheet of a problem with slits: nodes such that, with all that their elements touch, a place of the lattice means
 * one node, and a low corner's place one cell. So what is computed from places needs no lists. A node at the end of a
 * slit, a tip, has elements on both sides of it, with different nodes at one place: no sheet takes it. Seen along its
 * edge:
 *
 *      a   a'  slit      sheet 0: a, and all that is not near the slit
 *      |   |             sheet 1: a', and the nodes beside it, whose elements touch a'
 *      +-t-+             tip: t
 *
 * The creator owns a sheet while it is filled; it borrows the problem and `first`.
 */
#ifndef SINEW_LATTICE_SHEET_H
#define SINEW_LATTICE_SHEET_H

#include "tled/problem/state.h"

enum { SHEET_TIP = -1 };

typedef struct lattice_sheet {
    const tled_problem *p;
    const int32_t *first;       /* nodes: the first one at its place: places_shared */
    int32_t number;             /* of the sheets begun so far */
    int64_t *at_node, *at_cell; /* by that: the sheet in the high half, and who is there in it */
} lattice_sheet;

/* -1 with e filled, and s to be freed all the same: no memory. */
int lattice_sheet_make(lattice_sheet *s, const tled_problem *p, const int32_t *first, err *e);
void lattice_sheet_free(lattice_sheet *s);

/* Begins an empty one. */
void lattice_sheet_begin(lattice_sheet *s);

/* Takes a node, if there is room for it and all that its elements touch. */
bool lattice_sheet_take(lattice_sheet *s, int32_t node);

/* Corner i of a node's elements, as 8 x element + corner, or -1 after its last. */
int32_t lattice_sheet_corner(const tled_problem *p, int32_t node, int i);

/* Fills sheets, one after another. group, at: as places_shared takes them. sheet: nodes: which each is in, or
 * SHEET_TIP. Returns how many sheets there are, or -1 with e filled. A node is looked at once for each sheet up to its
 * own: few, as there are few copies of a place. */
int32_t sheets_find(const tled_problem *p, const int32_t *group, const int32_t *at, int32_t *sheet, err *e);

#endif
