/* Where the nodes of a problem stand in its lattice, part by part: what executors on a card cut by. A part
 * hangs together by elements; two parts may lie across each other, so that a place means a node only
 * within one. Fills arrays that the caller owns.
 */
#ifndef SINEW_PLACES_H
#define SINEW_PLACES_H

#include "tled/problem/state.h"

/* part: nodes: the lowest node of its part; at: nodes x 3: its place, from that node. -1 with e filled: an element's
 * corners are not those of a box of the lattice. */
int places_find(const tled_problem *p, int32_t *part, int32_t *at, err *e);

/* That an element has no place of its own in the lattice. Returns -1. */
int places_none(err *e, int64_t element);

#endif
