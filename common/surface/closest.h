/* The point of a vertex, line or polygon that is nearest to another. A polygon is cut into triangles first, so that
 * concave ones come out right; one that is not flat is the triangles that it was cut into. A shape owns its memory and
 * can be filled again for the next primitive; begin with a zeroed one.
 */
#ifndef SINEW_CLOSEST_H
#define SINEW_CLOSEST_H

#include "base/err.h"

/* The point of segment ab nearest to q goes into p. Returns the squared distance. */
double closest_segment(const double *a, const double *b, const double *q, double *p);

/* The same for triangle abc, which may have no area. */
double closest_triangle(const double *a, const double *b, const double *c, const double *q, double *p);

/* What of a triangle abc a point of it lies on. */
typedef enum closest_feature {
    CLOSEST_A,
    CLOSEST_B,
    CLOSEST_C,
    CLOSEST_AB,
    CLOSEST_BC,
    CLOSEST_CA,
    CLOSEST_INSIDE
} closest_feature;

/* closest_triangle() that says also what p lies on. */
double closest_triangle_on(const double *a, const double *b, const double *c, const double *q, double *p,
                           closest_feature *feature);

typedef struct closest_shape {
    int corners;            /* of one part: 1 point, 2 segment, 3 triangle */
    int64_t parts;          /* 1, or a polygon's triangles */
    double *point;          /* parts x corners x 3 */
    double normal[3];       /* a polygon's unit Newell normal; 0 0 0 where it has no area, and for points and lines */
    double low[3], high[3]; /* bounding box */
    int32_t *triangle;      /* scratch */
    int64_t point_capacity, triangle_capacity;
} closest_shape;

/* Takes the primitive of `count` corners: 1 = point, 2 = line, more = polygon. position: vertices x 3; vertex: its
 * corners' vertices. -1 with e filled on no memory. */
int closest_shape_of(closest_shape *s, const double *position, const int32_t *vertex, int64_t count, err *e);
void closest_shape_free(closest_shape *s);

/* The point of one part nearest to q goes into p. Returns the distance. */
double closest_part(const closest_shape *s, int64_t part, const double *q, double *p);

/* The distance from q to the whole shape. */
double closest_distance(const closest_shape *s, const double *q);

#endif
