/* Which nodes a tile owns where two nodes of one part, or two elements, have one place in the lattice: a brick where
 * some that a tile would know do so is split into a tile for each sheet (lattice_sheet.h) of its nodes, and listed
 * tiles (tiles.h) for those that none takes. The creator owns the split; it holds no pointer into the problem.
 */
#ifndef SINEW_TILE_SPLIT_H
#define SINEW_TILE_SPLIT_H

#include "tled/tiles/tiles.h"

/* Cells put into the grid of a tile whose nodes are at the end of a slit: two nodes have one place in the lattice
 * there, so that cells cannot all stand as they lie in it. Each stands where the most of its corners are already, and
 * else where nothing is. So a node may have several places. Plain data, which may be copied. */
typedef struct tile_pack {
    int grid[3];
    int32_t node[TILE_PLACES]; /* who is at a place, or -1 */
    bool cell[TILE_PLACES];    /* a cell has its low corner there */
    int32_t places;            /* where nodes are */
} tile_pack;

void tile_pack_begin(tile_pack *k, const int grid[3]);

/* The place of a cell of these nodes, in VTK's order; -1: there is no room for it. Time grows as the places. */
int32_t tile_pack_add(tile_pack *k, const int32_t node[8]);

typedef struct tile_piece {
    int32_t brick; /* that the tile is of */
    bool listed;
} tile_piece;

typedef struct tile_split {
    tile_piece *tile; /* count: the first are of the bricks in order */
    int64_t count, capacity;
} tile_split;

/* t: cut in bricks: brick, grid, count, tile's node and nodes, node, whose order is lost. first: nodes: the first one
 * at its place (places_shared). tile_of: nodes: the brick of each; becomes its tile. Time grows as the nodes. -1 with
 * e filled, and s to be freed all the same: no memory, or a node that no tile has room for. */
int tile_split_make(tile_split *s, const tled_problem *p, const tiles *t, const int32_t *first, int32_t *tile_of,
                    err *e);
void tile_split_free(tile_split *s);

#endif
