/* Cells put into the grid of a tile (tiles.h) whose nodes are at the end of a slit: two nodes have one place in the
 * lattice there, so that cells cannot all stand as they lie in it. Each stands where the most of its corners are
 * already, and else where nothing is. So a node may have several places. The struct is plain data, which may be
 * copied.
 */
#ifndef SINEW_TILE_PACK_H
#define SINEW_TILE_PACK_H

#include "tled/cuda/tiles.h"

typedef struct tile_pack {
    int grid[3];
    int32_t node[TILE_PLACES]; /* who is at a place, or -1 */
    bool cell[TILE_PLACES];    /* a cell has its low corner there */
    int32_t places;            /* where nodes are */
} tile_pack;

void tile_pack_begin(tile_pack *k, const int grid[3]);

/* The place of a cell of these nodes, in VTK's order; -1: there is no room for it. Time grows as the places. */
int32_t tile_pack_add(tile_pack *k, const int32_t node[8]);

#endif
