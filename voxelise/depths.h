/* Finds how deep voxels lie below a surface, in steps: which of some depths each centre is above. The lattice is halved
 * along each axis again and again. A box hands on only the triangles that may be nearest to some centre in it, and is
 * done when all its centres are between the same two depths, whatever they are exactly. Everything is borrowed.
 */
#ifndef SINEW_DEPTHS_H
#define SINEW_DEPTHS_H

#include "voxelise/voxels.h"

enum { DEPTHS_MOST = 100 };

/* Triangles in the grid's unit, from the corner of its cell 0. */
typedef struct depths_surface {
    const double *corner; /* triangles x 9 */
    int64_t triangles;
} depths_surface;

/* depth: ascending. step: of each voxel whose volume is below `volumes`: 1 + the first depth that its centre's distance
 * from the surface is less than, or 0; of others it stays. The same for any number of threads. */
int depths_find(uint8_t *step, const double *depth, int64_t depths, const voxels *x, const voxels_layers *layer,
                int32_t volumes, const depths_surface *s, const grid *g, pool *threads, err *e);

#endif
