/* In which order an executor takes tiles that need not stand in the order of their nodes. */
#ifndef SINEW_TILE_PARTS_H
#define SINEW_TILE_PARTS_H

#include "tled/tiles/tiles.h"

/* Puts tiles that have a late node, as their own or in their halo, behind all others, so that an executor may take a
 * pass of the others before; and of both those with the most cells first, so that what is left at the end of a pass is
 * small. late: nodes of the model, nonzero where a node is late. The nodes of t must be in the tiles' order.
 * Returns how many tiles are behind; -1 with e filled: no memory. */
int64_t tiles_part(tiles *t, const uint8_t *late, err *e);

#endif
