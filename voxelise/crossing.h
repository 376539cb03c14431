/* Where rays along an axis, one through each column of voxel centres, cross triangles: decided exactly. A centre counts as
 * moved by (e, e^2, e^3), e -> 0+, so it is never on a face, and a ray never meets an edge or a vertex: whichever axis
 * the rays run along, the same centres come out inside a closed surface. Each sign is first sought in doubles
 * with a proven bound on their error, and settled by expansions where that leaves it open. Everything is
 * borrowed; nothing is allocated.
 */
#ifndef SINEW_CROSSING_H
#define SINEW_CROSSING_H

#include "voxelise/grid.h"

#include <stdbool.h>

/* Triangles over a lattice. */
typedef struct crossing_mesh {
    const grid *g;
    const double *position; /* vertices x 3, in the grid's unit */
    const double *local;    /* the same from the corner of cell 0, rounded: grid_local of each */
    double error[3];        /* a bound on the error of local and of grid_centre along each axis */
} crossing_mesh;

/* The bound for `error`: of local coordinates up to `local` and of |x - origin| up to `far` along an axis. */
double crossing_error(const grid *g, int axis, double local, double far);

/* A ray: along `axis`, through the centres of cells iu along u = axis + 1 and iv along v = axis + 2 (mod 3). */
typedef struct crossing_ray {
    const crossing_mesh *m;
    int axis, u, v;
    int64_t iu, iv;
    double cu, cv; /* grid_centre of them */
} crossing_ray;

crossing_ray crossing_ray_at(const crossing_mesh *m, int axis, int64_t iu, int64_t iv);

/* Whether the ray crosses the triangle: 1 with the triangle's normal along the axis, -1 against it, 0 not at all. */
int crossing_of(const crossing_ray *r, const int32_t *triangle);

/* The first cell of the grid along the axis whose centre is behind the crossing (the grid's `high` where none is),
 * for a triangle that the ray crosses with the given direction. */
int64_t crossing_cell(const crossing_ray *r, const int32_t *triangle, int direction);

#endif
