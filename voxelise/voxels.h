/* Which voxels become elements, and of which volume: W&M Algorithm 1, column after column. A voxel climbs to a level
 * only if it was taken at the one below; within a level the first volume keeps it. The result is runs of voxels along
 * x, in the order of the elements (k, j, i; i fastest), the same for any number of threads; the caller owns it.
 */
#ifndef SINEW_VOXELS_H
#define SINEW_VOXELS_H

#include "base/pool.h"
#include "base/progress.h"
#include "voxelise/inside.h"

/* Cells from <= i < to of column (j, k). */
typedef struct voxels_run {
    int32_t from, to, j, k, volume;
} voxels_run;

/* Of one volume. */
typedef struct voxels_count {
    int64_t inside;  /* centres in it */
    int64_t reached; /* of them, those taken at the level below (on level 0 all) */
    int64_t kept;    /* its elements */
} voxels_count;

typedef struct voxels {
    voxels_run *run;
    int64_t runs, elements;
    voxels_count *count; /* volumes */
} voxels;

/* in: with rays along y (any axis but that of the runs; its slabs are then whole layers of z). level: of each volume;
 * volumes are in order of level, then of priority. Refuses, before any of it is allocated, what would not fit in
 * memory. progress (may be NULL) counts slabs and has been started. */
enum { VOXELS_RAY = 1 };
int voxels_find(voxels *x, const inside *test, const int32_t *level, int32_t volumes, pool *threads, progress *shown,
                err *e);

void voxels_free(voxels *x);

/* Refuses what would take more memory than there is: `elements` of them, on the lattice g, and slabs of so many bytes.
 * available: bytes. */
int voxels_check_memory(const grid *g, double elements, double slabs, double available, err *e);

#endif
