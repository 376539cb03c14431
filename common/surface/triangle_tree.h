/* The point of a surface of triangles that is nearest to another, and whether a point lies inside of a closed one: a
 * bounding volume hierarchy in doubles, which is halved at the median of the triangles' middles. A search finds what a
 * look at every triangle would find, the nearest point to the bit, in a time that grows as the logarithm of their
 * number where points lie near the surface. Owns copies of the triangles; once made, any number of threads may search
 * at once.
 */
#ifndef SINEW_TRIANGLE_TREE_H
#define SINEW_TRIANGLE_TREE_H

#include "surface/closest.h"

typedef struct triangle_tree triangle_tree;

/* position: vertices x 3, finite, at most 1e100; corner: triangles x 3, at least one triangle. NULL with e filled on no
 * memory, or where there are 2^30 triangles or more. */
triangle_tree *triangle_tree_create(const double *position, const int32_t *corner, int64_t triangles, err *e);
void triangle_tree_destroy(triangle_tree *t);

typedef struct triangle_hit {
    int64_t triangle; /* of equally near ones the first */
    double point[3];
    double distance2; /* squared */
    closest_feature feature;
} triangle_hit;

/* guess: a triangle that may be near, which makes the search shorter and changes nothing; -1: none. */
triangle_hit triangle_tree_nearest(const triangle_tree *t, const double q[3], int64_t guess);

/* Whether q lies inside of the triangles, which are a closed surface, or on them to rounding: as winding_holds() says,
 * but by those that a ray from q along +z crosses. */
bool triangle_tree_holds(const triangle_tree *t, const double q[3]);

#endif
