/* Marching cubes over a box of samples: the closed surface about where they are at least a level. Outside of
 * the box all is outside, and the surface closes half a sample beyond it. Where a face of a cube can be read
 * in two ways, Nielson and Hamann's asymptotic decider says what bilinear interpolation does there (The
 * asymptotic decider, Visualization '91); a tie keeps the inside's parts apart. Every vertex lies on an edge
 * between two samples, or amid a cube; every edge of the surface is of two triangles, and a vertex has one
 * ring of them. The caller frees what is returned.
 */
#ifndef SINEW_CONTOUR_H
#define SINEW_CONTOUR_H

#include "slice/contour/cubes.h"

/* A vertex comes no nearer to a sample than this share of the edge: samples equal to the
 * level leave no triangles without area. */
#define CONTOUR_NEAREST 1e-3

typedef struct contour {
    double *position; /* vertices x 3: samples from the box's first; x, y, z */
    /* vertices x 3: along its edge towards the outside, of length 1; amid a cube, the mean of its rim's */
    float *outward;
    int64_t vertices, vertex_room;
    int32_t *triangle; /* triangles x 3, anticlockwise as seen from outside */
    int64_t triangles, triangle_room;
} contour;

/* value: size[0] x size[1] x size[2] samples, x fastest; what is not a number is outside. c: zeroed. -1 with e filled
 * where memory does not do, or there would be more than 2^31 - 1 vertices. */
int contour_make(contour *c, const float *value, const int64_t size[3], float level, const cubes *table, err *e);
void contour_free(contour *c);

/* What the surface encloses, in cubes of samples. */
double contour_volume(const contour *c);

/* Taubin's smoothing (A signal processing approach to fair surface design, SIGGRAPH '95): passes of a step of .5
 * towards the mean of the neighbours and one of -.53 back. `outward` is smoothed as well, so that it stays how a vertex
 * moves when all slide along their edges. */
int contour_smooth(contour *c, int passes, err *e);

/* Slides all vertices along `outward` by the one distance (at most `most`) at which the surface encloses `volume`: the
 * volume is a cubic of the distance. Returns the distance; where no distance does, the nearest that is allowed. */
double contour_fill(contour *c, double volume, double most);

#endif
