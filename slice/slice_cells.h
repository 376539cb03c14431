/* A volume laid out for sampling: 8 bits a voxel, and for each cell between voxels the eight around it in one word, so that a sample is one
 * load, from one place: eight bytes a voxel, for a third of the time. Half a voxel around the outermost centres belongs to the volume and goes on as they do, as the extent of a
 * voxel has it; what lies beyond is black. Owns its words.
 *
 * Places are in cells: those of voxels (the centre of 0 0 0 is 0 0 0) plus 1; the volume is what lies within .5 and size + .5.
 */
#ifndef SINEW_SLICE_CELLS_H
#define SINEW_SLICE_CELLS_H

#include "base/pool.h"
#include "volume/volume.h"

enum { SLICE_ONE = 65536 }; /* of a place in fixed point: a cell */

typedef struct slice_cells {
    int32_t size[3]; /* voxels */
    int32_t row;     /* words from a row of cells to the next; */
    int32_t layer;   /* and from a layer to the next */
    uint64_t
        *word; /* low byte to high: voxels (x - 1, y - 1), (x, y - 1), (x - 1, y), (x, y) of layer z - 1, then of z */
    int32_t black;                /* the z, in fixed point, of cells whose words are 0 */
    double origin[3], axis[3][3]; /* m to cells: axis[a] . (p - origin) + 1 */
} slice_cells;

/* Which values of the volume are 0 and 255; in between it is linear, and rounded to the nearest. */
typedef struct slice_window {
    double low, high;
} slice_window;

/* 0 to 255 for whole numbers that are within them; otherwise the lowest and highest value that there are. */
slice_window slice_window_of(const volume *v);

/* -1 with e filled: too large to be numbered, or no memory. */
int slice_cells_make(slice_cells *c, const volume *v, slice_window w, pool *threads, err *e);
void slice_cells_free(slice_cells *c);

/* A place in metres (the volume's frame), in cells. */
static inline void slice_cells_place(const slice_cells *c, const double metres[3], double to[3])
{
    for (int a = 0; a < 3; a++) {
        to[a] = 1;
        for (int b = 0; b < 3; b++)
            to[a] += c->axis[a][b] * (metres[b] - c->origin[b]);
    }
}

#endif
