/* Which tiles have some of the nodes, so that an executor may take a pass of the others before. */
#ifndef SINEW_TILE_PARTS_H
#define SINEW_TILE_PARTS_H

#include "tled/tiles/tiles.h"

/* Puts tiles that have one of these nodes of the model, as their own or in their halo, behind all others; both stay in
 * their order. The nodes of t must be in the tiles' order. Returns how many tiles are behind; -1 with e filled: no
 * memory. */
int64_t tiles_part(tiles *t, const int32_t *node, int64_t count, err *e);

#endif
