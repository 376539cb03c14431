/* Which nodes a tile owns where two nodes of one part, or two elements, have one place in the lattice: a brick where
 * some that a tile would know do so is split into a tile for each sheet (lattice_sheet.h) of its nodes, and listed
 * tiles (tiles.h) for those that none takes. The creator owns the split; it holds no pointer into the problem.
 */
#ifndef SINEW_TILE_SPLIT_H
#define SINEW_TILE_SPLIT_H

#include "tled/cuda/tiles.h"

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
