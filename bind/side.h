/* Binds a place to an element on its own side of a slit. Where voxelise has opened slits, an element of the nearest
 * voxel may be of the other lip, and a voxel may have elements of both. The element that is taken is the nearest, of
 * those in the voxels about, of which a place that the surfaces enclose sees the point: no surface of level 0 lies
 * between. The metadata slits.surface and slits.groups name these. Away from slits the nearest element stays. Owns its
 * tables; may be asked by several threads.
 */
#ifndef SINEW_SIDE_H
#define SINEW_SIDE_H

#include "bind/nearest.h"
#include "mesh/cut_moments.h"
#include "surface/embree.h"
#include "surface/surface.h"

typedef struct side {
    const nearest *to;   /* borrowed, as are the arrays of the model */
    const int32_t *cell; /* where the model has slits or not, as is: */
    const float *inside; /* elements x 3; NULL: the middles of what is enclosed of them: */
    cut_moments cut;
    bool *beside; /* elements: a slit is at one of their nodes; NULL: the model has none */
    embree *surface;
} side;

/* -1 with e filled on no memory, and where metadata names a surface that the model does not carry. */
int side_create(side *s, const model *m, const nearest *to, int threads, err *e);
void side_free(side *s);

/* Normals of a surface's vertices that point inward, m2 (vertices x 3), 0 where no face of level 0 is: by them two
 * sheets at one place are told apart. The caller frees them. NULL with e filled. */
double *side_normals(const side *s, const surface *of, const model *m, err *e);

/* A place of an element that the surfaces enclose, m: element.inside, or else the middle of the enclosed part. */
void side_place(const side *s, int32_t element, double place[3]);

/* Whether no face lies between a place and a point; what is as near to the point as `near` (m) is its own. */
bool side_sees(const embree *faces, const double place[3], const double point[3], double near);

/* The element for a point, of which this one is the nearest. normal: one of side_normals, or NULL. */
int32_t side_element(const side *s, const double *point, const double *normal, int32_t element);

#endif
