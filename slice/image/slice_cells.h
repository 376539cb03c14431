/* A volume laid out for sampling: 8 bits a voxel, in bricks, so that the eight voxels around a place lie within 16
 * bytes: a sample is one load. A brick is two by two cells along y and z, so three by three voxels, all along x: 9
 * bytes for every 4 cells, 2.25 a voxel. Half a voxel around the outermost centres belongs to the volume and goes on as
 * they do, as the extent of a voxel has it; what lies beyond is black. Owns its bricks, which are made in the volume's
 * own memory.
 *
 * Places are in cells: those of voxels (the centre of 0 0 0 is 0 0 0) plus 1; the volume is what lies within .5 and
 * size + .5. Cell (x, y, z) is between voxels x - 1 and x, and so on; voxels past the ends are those at the ends. Its
 * bytes, from the first of the cell:
 *
 *              x - 1           x
 *            y - 1   y     y - 1   y
 *     z - 1    0     1       9     10
 *     z        3     4       12    13
 */
#ifndef SINEW_SLICE_CELLS_H
#define SINEW_SLICE_CELLS_H

#include "base/pool.h"
#include "volume/volume.h"

enum { SLICE_ONE = 65536 }; /* of a place in fixed point: a cell */

typedef struct slice_cells {
    int32_t size[3]; /* voxels */
    uint32_t row;    /* bytes from a brick to the next along y: 9 (size[0] + 2); */
    uint64_t layer;  /* and along z */
    uint8_t *byte;
    int32_t black;                /* the z, in fixed point, of cells whose words are 0 */
    double origin[3], axis[3][3]; /* m to cells: axis[a] . (p - origin) + 1 */
} slice_cells;

/* Which values of the volume are 0 and 255; in between it is linear, and rounded to the nearest. */
typedef struct slice_window {
    double low, high;
} slice_window;

/* 0 to 255 for whole numbers that are within them; otherwise the lowest and highest value that there are. */
slice_window slice_window_of(const volume *v);

/* Refuses a volume that is too large to be numbered, by its sizes: -1 with e filled. place: the file; NULL: none. */
int slice_cells_check(const volume *v, const char *place, err *e);

/* v's voxels become the cells', v->data NULL. -1 with e filled: too large to be numbered, or no memory. */
int slice_cells_make(slice_cells *c, volume *v, slice_window w, pool *threads, err *e);

/* The most bytes that are taken at once for the voxels of such a volume and its cells. */
double slice_cells_peak(const volume *v);

/* What they take once they are made. */
double slice_cells_bytes(const slice_cells *c);
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
