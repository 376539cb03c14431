/* Opens slits that are narrower than voxels: lattice points whose voxels do not hang together get a node for each
 * connected part of them (virtual nodes: Molino, Bao and Fedkiw, A virtual node algorithm for changing mesh topology
 * during simulation, 2004), and a voxel whose samples are of parts that do not share all nodes becomes an element for
 * each. The caller owns a slits.
 */
#ifndef SINEW_SLITS_H
#define SINEW_SLITS_H

#include "voxelise/joins.h"

/* A lattice point of several nodes. */
typedef struct slits_point {
    int32_t place[3];
    int32_t nodes;    /* 2 and more */
    int64_t from, to; /* the corners of elements that are there */
} slits_point;

typedef struct slits_corner {
    int64_t element;
    int32_t node; /* of the point's, 0 to nodes - 1 */
    int8_t corner;
} slits_corner;

typedef struct slits {
    slits_point *point; /* by k, j, i */
    slits_corner *corner;
    int64_t points, corners, point_capacity, corner_capacity;
    int64_t nodes;    /* more than without slits */
    int64_t elements; /* likewise */
    float *inside;    /* elements x 3, by shares: a place in each that is inside, in sides of a voxel; NULL: no slits */
} slits;

/* Finds the points, and splits voxels in x, whose lists of parts are freed. t: the triangles of level 0. g: the lattice
 * of samples, `samples` along each side of a voxel; 1: by centres. volumes: how many there are. */
int slits_find(slits *s, voxels *x, const cuts *cut, const inside_triangles *t, const grid *g, int samples,
               int32_t volumes, err *e);
void slits_free(slits *s);

#endif
