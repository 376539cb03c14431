/* Which units of a march have to do with each other: one has nodes that the other moves. march.h says what for. */
#ifndef SINEW_MARCH_NEAR_H
#define SINEW_MARCH_NEAR_H

#include "tled/cuda/march.h"

/* owner: nodes, in the march's order: the unit that moves each, of units that there are so far. */
void march_owners(const march *m, int32_t *owner);

/* Fills `near` and `nears`; nodes: of the problem. -1 with e filled. */
int march_near_find(march *m, int64_t nodes, err *e);

#endif
