/* Closed surfaces of triangles as regions of space: an OBJ file that must be one, and whether triangles are. Whether a
 * point lies inside is triangle_tree.h's to say. Owns nothing.
 */
#ifndef SINEW_SOLID_H
#define SINEW_SOLID_H

#include "surface/surface.h"
#include "surface/trimesh.h"

/* The triangles of an OBJ file, its coordinates times scale (to metres). t: zeroed, owned by the caller. -1 with e
 * filled, and t to be freed all the same, where it cannot be read, has no polygons or is not closed. */
int solid_read(trimesh *t, const char *file, double scale, err *e);

enum { SOLID_OPEN = 140 };

/* Whether triangles are closed: each edge goes one way round as often as the other; vertices at one place count as one.
 * Says how many edges are open, and where the first of them is; nothing where none is. part: .5 for triangles that
 * count by half, else 1; NULL: all count. */
int solid_open(const surface *s, const int32_t *corner, const double *part, int64_t triangles, char text[SOLID_OPEN],
               err *e);

#endif
