/* Finds how deep voxels lie below a surface, in steps: which of some depths each centre is above. The lattice is halved
 * along each axis again and again. A box hands on only the triangles that may be nearest to some centre in it, and is
 * done when all its centres are between the same two depths, whatever they are exactly. Everything is borrowed.
 */
#ifndef SINEW_DEPTHS_H
#define SINEW_DEPTHS_H

#include "voxelise/voxels.h"

enum { DEPTHS_MOST = 100, DEPTHS_SAMPLES = SHARES_MOST };

/* Triangles in the grid's unit, from the corner of its cell 0. */
typedef struct depths_surface {
    const double *corner; /* triangles x 9 */
    int64_t triangles;
} depths_surface;

/* depth: ascending. step: of each voxel whose volume is below `volumes`: 1 + the first depth that its centre's distance
 * from the surface is less than, or 0; of others it stays. The same for any number of threads. */
int depths_find(uint8_t *step, const double *depth, int64_t count, const voxels *x, const voxels_layers *layer,
                int32_t volumes, const depths_surface *s, const grid *g, pool *threads, err *e);

/* The same of samples of voxels, `samples` along a side, some at a time: the surface and the depths, looked up once. g:
 * the lattice of samples. A step's depth may end within a sample: then so many of such samples are above it that all
 * have the volume that is. NULL with e filled. */
typedef struct depths depths;
depths *depths_create(const double *depth, int64_t count, const depths_surface *s, const grid *g, int samples, err *e);
void depths_destroy(depths *d);

/* step: of each sample low <= i < high of the grid, x fastest, in: 0, or DEPTHS_UNWANTED, where it stays; out: as
 * above. For many threads. */
enum { DEPTHS_UNWANTED = 255 };
int depths_look(const depths *d, const int64_t low[3], const int64_t high[3], uint8_t *step, err *e);

#endif
