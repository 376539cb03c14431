/* In which order the nodes of tiles stand, and in which an executor takes tiles that need not stand in that order. */
#ifndef SINEW_TILE_PARTS_H
#define SINEW_TILE_PARTS_H

#include "tled/tiles/tiles.h"

/* Puts tiles that have a late node, as their own or in their halo, behind all others, so that an executor may take a
 * pass of the others before; and of both those with the most cells first, so that what is left at the end of a pass is
 * small. late: nodes of the model, nonzero where a node is late. The nodes of t must be in the tiles' order.
 * Returns how many tiles are behind; -1 with e filled: no memory. */
int64_t tiles_part(tiles *t, const uint8_t *late, err *e);

/* Puts the nodes of new tiles in another order: where each of the model's is to stand. -1 with e filled: no memory. */
int tiles_reorder(tiles *t, const int32_t *order, pool *threads, err *e);

#endif
