/* Finds gaps between surfaces that elements fill: along each axis, on the lines through the centres of voxels, the
 * places where a line leaves the lowest level by a surface and enters it again by one that faces it, while every voxel
 * in between is an element. What lies on either side then moves as one. Where a gap is narrower than a twentieth of a
 * voxel, the surfaces count as touching. Bone within tissue, whose nodes are fixed anyway, is no gap; nor is what lies
 * inside of a surface twice, nor the end of a gap that is open but for that. The caller owns a gaps.
 */
#ifndef SINEW_GAPS_H
#define SINEW_GAPS_H

#include "voxelise/solids.h"
#include "voxelise/voxels.h"

/* One line across a gap. */
typedef struct gap {
    double width;     /* along the line, over the voxel's side there */
    double middle[3]; /* in cells: cell i is about i */
    int axis;
} gap;

typedef struct gaps {
    gap *gap; /* the narrowest first */
    int64_t count;
} gaps;

/* plan: volumes, of which those of level 0 come first. g: the lattice of voxels. The same for any number of threads. -1
 * with e filled on no memory. */
int gaps_find(gaps *found, const solids *s, const volumes *plan, const voxels *x, const grid *g, pool *threads, err *e);
void gaps_free(gaps *found);

#endif
