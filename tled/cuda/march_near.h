/* Which units of a march have to do with each other: one has nodes that the other moves. march.h says what for. And the
 * order in which blocks take them, where it is cut into sheets: a unit waits for those near it in the pass before; a
 * pass has hardly more units than blocks take at once (march_units.c), so that each is to have its turn long after
 * theirs. Those of one sheet do, in the order of its columns and layers. A unit of a further sheet, or of tips, after
 * all of these, would be waited for by the first of the next pass: it is put among those near it.
 */
#ifndef SINEW_MARCH_NEAR_H
#define SINEW_MARCH_NEAR_H

#include "tled/cuda/march.h"

/* owner: nodes, in the march's order: the unit that moves each, of units that there are so far. */
void march_owners(const march *m, int32_t *owner);

/* Fills `near` and `nears`; nodes: of the problem. -1 with e filled. */
int march_near_find(march *m, int64_t nodes, err *e);

/* Puts units in that order. sheet: nodes: sheets_find's. -1 with e filled: no memory. */
int march_turns_order(march *m, const int32_t *sheet, int64_t nodes, err *e);

#endif
