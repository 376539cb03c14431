/* Lists lattice points at which slits may part voxels: the corners of faces that may be cut, of voxels of several
 * parts, and of voxels that touch at an edge or a corner only. The caller owns the list.
 */
#ifndef SINEW_TOUCHING_H
#define SINEW_TOUCHING_H

#include "voxelise/joins.h"

typedef struct touching {
    int32_t (*point)[3]; /* by k, j, i; each once */
    int64_t count, capacity;
} touching;

int touching_find(touching *c, joins *j, err *e);
void touching_free(touching *c);

#endif
