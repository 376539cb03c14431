/* A closed surface of triangles that an OBJ file has, as a region of space: whether a point lies inside of it is
 * winding.h's to say. The caller owns a solid, zeroed to begin with.
 */
#ifndef SINEW_SOLID_H
#define SINEW_SOLID_H

#include "surface/surface.h"

typedef struct solid {
    obj file;
    surface shape;   /* its vertices, m */
    double *metres;  /* vertices x 3 */
    int32_t *corner; /* triangles x 3: vertices */
    double *part;    /* triangles: 1 */
    int64_t triangles, room;
} solid;

/* Reads the OBJ, its coordinates times scale (to metres). -1 with e filled, and b to be freed all the same, where it
 * has no polygons or is not closed. */
int solid_read(solid *b, const char *file, double scale, err *e);
void solid_free(solid *b);

enum { SOLID_OPEN = 140 };

/* Whether triangles are closed: each edge goes one way round as often as the other; vertices at one place count as one.
 * Says how many edges are open, and where the first of them is; nothing where none is. part: .5 for triangles that
 * count by half, else 1. */
int solid_open(const surface *s, const int32_t *corner, const double *part, int64_t triangles, char text[SOLID_OPEN],
               err *e);

#endif
