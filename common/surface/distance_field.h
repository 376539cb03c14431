/* Signed distances from triangles that need not be closed, above 0 on the side that they face, and their field at the
 * corners of boxes. The sign is by the pseudonormal of what the nearest point lies on. The creator owns the triangles
 * and what finds the nearest of them; begin with a zeroed one.
 */
#ifndef SINEW_DISTANCE_FIELD_H
#define SINEW_DISTANCE_FIELD_H

#include "base/pool.h"
#include "surface/pseudonormal.h"
#include "surface/triangle_tree.h"

typedef struct distance_triangles {
    double *position; /* triangles x 9, m: corners of their own */
    int32_t *corner;  /* triangles x 3: of position, in the order that says which side they face */
    int32_t *of;      /* triangles: which surface each is of */
    int64_t triangles, position_room, corner_room, of_room;
    triangle_tree *tree;
    pseudonormal side;
} distance_triangles;

/* corner: x 9, m; is_turned: it faces the other side. -1 with e filled on no memory, as of the next. */
int distance_triangles_add(distance_triangles *d, const double *corner, int32_t of, bool is_turned, err *e);

/* Once all are there, of which there is one: d->side.turned tells of edges whose triangles face different sides. */
int distance_triangles_ready(distance_triangles *d, err *e);
void distance_triangles_free(distance_triangles *d);

/* At x, m. guess: a triangle that may be near, or -1; becomes the nearest. */
double distance_at(const distance_triangles *d, const double x[3], int64_t *guess);

/* A box of samples: at origin + spacing (first + i). */
typedef struct distance_box {
    double origin[3], spacing[3];
    int32_t first[3], samples[3];
} distance_box;

/* Samples, x running fastest. */
int64_t distance_box_samples(const distance_box *b);
void distance_sample(const distance_triangles *d, const distance_box *b, pool *threads, float *to);

#endif
