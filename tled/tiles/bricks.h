/* The bricks of the lattice that a problem's nodes are in: those of another part are in another brick, though it
 * lies in the same place. Fills arrays that the caller owns.
 */
#ifndef SINEW_BRICKS_H
#define SINEW_BRICKS_H

#include "tled/problem/state.h"

/* at: nodes x 3, and part: nodes: places_find's; part becomes each node's brick, numbered as their first nodes come.
 * size: of a brick, in nodes. *brick gets bricks x 4, part and brick's place, the caller's also where this fails;
 * *count (0 before) how many there are. -1 with e filled. */
int bricks_find(const tled_problem *p, const int32_t *at, const int size[3], int32_t *part, int32_t **brick,
                int64_t *count, err *e);

#endif
