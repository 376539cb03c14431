/* Where the nodes of a problem stand in its lattice, part by part: what executors on a card cut by. A part
 * hangs together by elements; two parts may lie across each other, and within a part several nodes share a place where
 * there is a slit. Fills arrays that the caller owns.
 */
#ifndef SINEW_PLACES_H
#define SINEW_PLACES_H

#include "tled/problem/state.h"

/* part: nodes: the lowest node of its part; at: nodes x 3: its place, from that node. -1 with e filled: an element's
 * corners are not those of a box of the lattice. */
int places_find(const tled_problem *p, int32_t *part, int32_t *at, err *e);

/* Which nodes share a place: first: nodes: the lowest at its place among those of the same group (a number of nodes:
 * part, or one that tells parts apart). Takes memory for a table beside. -1 with e filled. */
int places_shared(int64_t nodes, const int32_t *group, const int32_t *at, int32_t *first, err *e);

/* Sorts items, and their keys with them, by key, ascending; those of one key stay in their order. For few: no more than
 * a brick has places. */
void places_sort(int32_t *item, uint32_t *key, int32_t count);

#endif
