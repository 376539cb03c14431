/* Finds what is wrong with a surface, and what it encloses, for voxelise --check. Everything is borrowed but the
 * result, which is plain numbers.
 */
#ifndef SINEW_CHECK_SURFACES_H
#define SINEW_CHECK_SURFACES_H

#include "surface/obj.h"

typedef struct check_result {
    int64_t polygons, triangles, vertices; /* vertices at one place count once */
    int64_t repeated;                      /* polygons given before: these are left out of all that follows */
    int64_t degenerate;                    /* triangles without area */
    int64_t open, crowded;                 /* edges of one polygon, and of three or more */
    int64_t turned;                        /* edges of two polygons that do not face the same way */
    int64_t shells;                        /* parts that edges join */
    int64_t met;                           /* pairs of triangles that pass through each other: meet.h */
    double deepest;                        /* of these, the most that one would have to move: meet_depth */
    double volume, area;                   /* enclosed by an odd number of shells; 0 where an edge is open */
    double thin; /* of the area: the share where less than a voxel is behind it; nan: not asked, or open */
    double low[3], high[3];
} check_result;

/* face: polygons of the OBJ. voxel (NULL: not asked): its sides. Lengths are in the OBJ's unit. threads: for Embree. -1
 * with e filled on no memory, or where a coordinate is past what grid.h allows. */
int check_surface(check_result *r, const obj *o, const int64_t *face, int64_t faces, const double *voxel, int threads,
                  err *e);

#endif
