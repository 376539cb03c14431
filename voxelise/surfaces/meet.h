/* Finds exactly where a surface meets itself: pairs of its triangles whose insides meet along a line, and edges that
 * run within a triangle with a triangle on either side of it. What only touches (a common vertex or edge, a corner or
 * an edge upon a face, two faces in one plane) does not count, nor does a line along which both have an edge. Embree
 * finds the pairs whose boxes overlap. Keeps nothing.
 */
#ifndef SINEW_MEET_H
#define SINEW_MEET_H

#include "base/err.h"

/* vertex: triangles x 3; those at one place are one. Coordinates as grid.h wants them. threads: to look with. count:
 * the pairs, those of a triangle and one that leaves it by an edge within it too. deepest: of pairs whose insides
 * meet, the most of meet_depth; 0 without any. -1 with e filled. */
int meet_count(const double *position, const int32_t *vertex, int64_t triangles, int threads, int64_t *count,
               double *deepest, err *e);

/* How far one of two triangles that meet has to go, the shortest way, to come off the other: the least overlap along
 * their normals and the directions across an edge of each (the separating axis theorem). */
double meet_depth(const double *position, const int32_t *one, const int32_t *other);

/* Whether the insides of two triangles meet along a line. */
bool meet_triangles(const double *position, const int32_t *one, const int32_t *other);

#endif
