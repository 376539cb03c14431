/* Connected components of a mask of voxels, through faces of voxels: by runs of voxels along x, of which those that
 * touch in neighbouring rows are joined. Time and memory are linear in voxels and runs. The mask is the caller's.
 */
#ifndef SINEW_MESH_RUNS_H
#define SINEW_MESH_RUNS_H

#include "base/err.h"

#include <stdint.h>

/* mask: size[0] x size[1] x size[2] bytes, x fastest, 0 or 1. -1 with e filled: no memory, more than INT32_MAX runs.
 *
 * largest: the voxels of 1 but those of the largest component (the first of equals) become 0. fill: the voxels of 0
 * that are not joined to the outside of the mask become 1. */
int mesh_runs_largest(uint8_t *mask, const int64_t size[3], err *e);
int mesh_runs_fill(uint8_t *mask, const int64_t size[3], err *e);

#endif
