/* Cells of a box: a lattice of them, each of which may be halved along all axes, again and again (an octree). Cells
 * that touch, at a corner only too, differ by one halving at most (graded 2:1). What is left out of the mesh is no
 * cell. The creator owns them.
 *
 * Places are in units of half a finest cell, so that the middles of all cells and faces are places too: a cell that
 * was halved n of `levels` times has a side of 2^(levels + 1 - n) units, and the box one of MESH_UNITS(levels) a cell
 * of the lattice.
 */
#ifndef SINEW_MESH_CELLS_H
#define SINEW_MESH_CELLS_H

#include "base/err.h"

#include <stdbool.h>
#include <stdint.h>

enum { MESH_LEVELS = 6 }; /* halvings at most */
#define MESH_UNITS(levels) ((int32_t)2 << (levels))

typedef struct mesh_cell {
    int32_t at[3], side; /* units: its lowest corner, and its side along every axis */
} mesh_cell;

typedef struct mesh_cells {
    int32_t size[3]; /* units: of the box */
    int levels;      /* halvings that there may be */
    mesh_cell *cell; /* count, by z, y, x of their lowest corners */
    int64_t count, capacity;
} mesh_cells;

/* Decides whether a cell that was halved `level` times must be halved again. */
typedef struct mesh_wish {
    bool (*halve)(const void *context, const mesh_cells *c, const mesh_cell *of, int level);
    const void *context;
} mesh_wish;

/* Makes c (zeroed) of nodes[a] - 1 cells along each axis; so that it is graded, more cells are halved than is wished.
 * levels: 0 to MESH_LEVELS. -1 with e filled, and to be freed all the same: more than can be numbered, no memory. */
int mesh_cells_make(mesh_cells *c, const int32_t nodes[3], int levels, mesh_wish wish, err *e);
void mesh_cells_free(mesh_cells *c);

/* Keeps the cells that are marked: bytes, count. */
void mesh_cells_keep(mesh_cells *c, const uint8_t *marked);

#endif
