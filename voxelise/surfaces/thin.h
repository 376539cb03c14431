/* Finds where a closed surface is thinner than a voxel: from the middle of each triangle a ray runs in, to the next one
 * that it meets (Embree, in single precision: this is for a warning). Keeps nothing.
 */
#ifndef SINEW_THIN_H
#define SINEW_THIN_H

#include "base/err.h"

/* vertex: triangles x 3, that face out. voxel: its sides, in the unit of position. share: of the area, where the way in
 * is less than a voxel along every axis. -1 with e filled on no memory. */
int thin_share(const double *position, int64_t vertices, const int32_t *vertex, int64_t triangles, const double *voxel,
               int threads, double *share, err *e);

#endif
