/* The triangles of a closed surface in columns along z, which answer for many points, each from the triangles near it:
 * whether a point lies inside, and how far from the surface it is. Borrows the triangles; the creator owns the rest.
 */
#ifndef SINEW_COLUMNS_H
#define SINEW_COLUMNS_H

#include "surface/trimesh.h"
#include "surface/winding.h"

typedef struct columns {
    const trimesh *of;
    winding whole; /* asked where a ray passes an edge, to rounding */
    double low[2], side;
    int64_t count[2];
    int64_t *start;    /* columns + 1 */
    int32_t *triangle; /* of column i: triangle[start[i]] and on */
} columns;

/* side (m): of a column, at least; also the most that columns_away tells. -1 with e filled, c to be freed all the
 * same. */
int columns_make(columns *c, const trimesh *of, double side, err *e);
void columns_free(columns *c);

/* Whether the point lies inside or, to rounding, on the surface. */
bool columns_hold(const columns *c, const double point[3]);

/* The distance from the surface, m; infinite where it is more than the side. */
double columns_away(const columns *c, const double point[3]);

#endif
