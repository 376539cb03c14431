/* Triangles cut by the voxels of a lattice: each piece lies in one voxel. Sutherland and Hodgman's clipping, plane by
 * plane, in units of voxels. Owns nothing.
 */
#ifndef SINEW_VOXEL_CUT_H
#define SINEW_VOXEL_CUT_H

#include "mesh/lattice.h"

enum { VOXEL_CUT_MOST = 12 }; /* corners of a piece: 3, and one more for each side of the voxel at most */

typedef struct voxel_piece {
    int64_t cell[3];
    double corner[VOXEL_CUT_MOST][3]; /* m, in order */
    int corners;
    double area;      /* m2 */
    double middle[3]; /* m: its centroid */
} voxel_piece;

/* Calls take for each piece of the triangle, but for those without area, in the order of cells, x fastest. Until take
 * returns other than 0, which is then returned. A triangle in a side of voxels is in the upper one. */
int voxel_cut(const lattice *l, double triangle[3][3], int (*take)(void *context, const voxel_piece *piece),
              void *context);

#endif
