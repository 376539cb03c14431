/* A problem cut into tiles, for an executor whose threads work in blocks with little memory of their own. A tile
 * owns the nodes in one brick of the lattice and computes every element that touches one of them (a cell), some
 * of which its neighbours compute too; in return a step is one pass in which no tile waits for another. Corners
 * of its cells that others own are its halo.
 *
 * In a tile all stand in a grid of places, one more than the brick on each side: a node's place is i + gx (j + gy k),
 * with i, j, k from 1 where owned; a cell's place is that of its low corner. So a cell finds its corners, and a node
 * its cells, by adding constants. For that a place must mean one node, and one cell.
 *
 * Where a slit comes to a brick, two nodes of one part may have the same place, or two elements the same cell. Such a
 * brick is cut into several tiles: one for each sheet (lattice_sheet.h) of its nodes, and listed ones for the nodes at
 * the end of the slit. A listed tile's cells find their corners by the same constants, but stand where there is room
 * in the grid (tile_split.h); so a node may have several places, one of which is its own, and the others are as a halo
 * node's, even if the tile owns it. A list says which cells a node has, and which of their corners it is. Seen along
 * the slit's edge:
 *
 *      d --- e --- f        in the grid:  d e f .    pull: t: D1 C2 B0 A3
 *      |  A  |  B  |                      a t g .    a node's cells and which of their corners it is,
 *      a === t --- g                      b t g .    in the order of its sum: the lattice's
 *      b === t --- g                      h i k .
 *      |  C  |  D  |
 *      h --- i --- k        of the two t, one is its own place
 *
 * No list is longer than it is in a tile of a whole brick: so kernels need no more room.
 *
 * Arrays over nodes are in the tiles' order, tile by tile, or in one that tiles_reorder is given: then those that a
 * tile owns stand where `order` says. The creator owns the tiles; they hold no pointer into the problem.
 */
#ifndef SINEW_TILES_H
#define SINEW_TILES_H

#include "tled/problem/state.h"

/* What one tile has of each list below. */
typedef struct tile {
    int32_t node, nodes;       /* owned: the first, in the tiles' order, and how many */
    int32_t halo, halos;       /* in halo_node, halo_place */
    int32_t cell, cells;       /* in cell */
    int32_t fibred, direction; /* the first `fibred` of its cells have fibres that act: fibre from row `direction` on */
} tile;

enum {
    TILE_PLACE = 0x7ff,     /* of a node or a cell: its place */
    TILE_CORNERS = 11,      /* of a node: bit TILE_CORNERS + c: it is corner c of an element */
    TILE_FREE = 19,         /* of a node: bit TILE_FREE + a: nothing holds component a */
    TILE_EXTRA = 22,        /* of a node: displaced by the script, or forces act on it */
    TILE_APART = 23,        /* of a node that slides on bone: its step is another kernel's; then none of the above */
    TILE_OWN = 11,          /* of a cell: its low corner is owned here: of all tiles this is so in one */
    TILE_VOLUME = 12,       /* of a cell: its volume, from this bit on */
    TILE_VOLUMES = 1 << 20, /* as many volumes as that can tell */
    TILE_PLACES = 1000,     /* the most that there may be: (8 + 2)^3 */
    TILE_PULL = 11,         /* of an entry of `pull`: which corner, from this bit on; below, the cell's place */
    TILE_NO_PULL = 0xffff   /* there is none, nor one after it */
};

/* What the script does to a node, apart from gravity. */
typedef struct tile_extra {
    int32_t node; /* where it stands */
    int32_t hold[3];
    int32_t force, forces; /* in force_curve, force_share of the problem */
    double rest[3];        /* m: its place, for moves.h */
} tile_extra;

typedef struct tiles {
    int brick[3], grid[3];       /* owned places, all places, along x, y, z */
    int64_t count, halos, cells; /* sums over all */
    int64_t nodes, directions, extras;
    int64_t listed; /* nodes of listed tiles */
    tile *tile;
    int32_t *list;       /* count: a listed tile's first row of `pull`, or -1; NULL: no tile is listed, nor is there: */
    uint16_t *pull;      /* listed x 8: of each node of listed tiles, in the tiles' order: TILE_PULL */
    int32_t *node;       /* nodes: which of the model's it is */
    uint32_t *node_info; /* nodes: TILE_* */
    int32_t *order;      /* nodes, in the tiles' order: where each stands; NULL: there */
    int32_t *halo_node;  /* halos: where it stands */
    uint16_t *halo_place;  /* halos */
    uint32_t *cell;        /* cells: TILE_*: those with fibres first; of both, those alike together; then by place */
    int32_t *cell_element; /* cells: which of the model's elements it is */
    float *fibre;          /* directions x 3 */
    float *share;          /* cells: the problem's fraction; NULL where that is */
    int32_t *mixed;        /* cells: the problem's; NULL where that is */
    int32_t *cut;          /* cells: which of the problem's cut elements each is, or -1; NULL: none is */
    float *mixfibre;       /* directions x 3: of cells' second volumes; or NULL */
    tile_extra *extra;     /* extras, by where their nodes stand */
} tiles;

/* brick: 2 to 8 each. -1 with e filled, and t to be freed all the same: no memory, or elements that are not boxes of
 * the lattice. */
int tiles_make(tiles *t, const tled_problem *p, const int brick[3], err *e);
void tiles_free(tiles *t);

/* Takes over what tled_problem_reload changed: what the script does to nodes. -1 with e filled: no memory. */
int tiles_reload(tiles *t, const tled_problem *p, err *e);

#endif
