/* Finds exactly where rays along an axis, one through each column of voxel centres, cross triangles. A centre counts as
 * moved by (e, e^2, e^3), e -> 0+, so it is never on a face, and a ray never meets an edge or a vertex: whichever axis
 * the rays run along, the same centres come out inside a closed surface. Each place is first sought in doubles with a
 * proven bound on the error, and settled by expansions where that leaves it open. Everything is borrowed; nothing is
 * allocated.
 *
 * Coordinates are counted in cells, so that the centre of cell i is at i. A triangle is cut into rows of cells across
 * the rays, a row into columns: a line says where an edge crosses a row, a plane where a triangle crosses a column.
 */
#ifndef SINEW_CROSSING_H
#define SINEW_CROSSING_H

#include "base/num.h"
#include "voxelise/surfaces/grid.h"

#include <stdbool.h>

/* Triangles over a lattice. */
typedef struct crossing_mesh {
    const grid *g;
    const double *position; /* vertices x 3, in the grid's unit */
    const double *cell;     /* the same in cells, rounded: crossing_cells of each */
    const int32_t
        *first;      /* vertices x 3: the first cell of the grid whose centre is past the vertex; `high`: none is */
    double error[3]; /* a bound on the error of cell along each axis: crossing_error */
    int ray, row, column; /* the axes that rays run along, that rows are counted along, and columns in a row */
} crossing_mesh;

/* A coordinate in cells, and the bound on its error: of such that reach as far as `local` from the corner of cell 0,
 * and `far` from the origin (in the grid's unit). */
static inline double crossing_cells(const grid *g, int axis, double x)
{
    return grid_local(g, axis, x) / g->spacing[axis] - 0.5;
}
double crossing_error(const grid *g, int axis, double local, double far);

enum { CROSSING_OPEN = INT32_MIN }; /* no cell: cells are numbered from -GRID_INDEX */

static inline double crossing_within(double x, double low, double high)
{
    x = x > low ? x : low; /* a nan becomes low */
    return x < high ? x : high;
}

/* The first cell whose centre is past x, which is known to within bound, among low to high, where it is known to be; or
 * CROSSING_OPEN where the bound leaves that open. */
static inline int32_t crossing_first(double x, double bound, int32_t low, int32_t high)
{
    double from = x - ((double)low - 2), most = (double)high - low + 2.5, least = 0;
    double down = crossing_within(from - bound, least, most), up = from + bound;
    up = up < most ? up : most; /* a nan becomes most, and so leaves it open */
    up = up > least ? up : least;
    int64_t below = (int64_t)down, above = (int64_t)up; /* floors, for none is negative */
    if (below != above)
        return CROSSING_OPEN;
    int64_t at = low - 1 + above;
    return (int32_t)num_clamp_int(at, low, high);
}

/* What `first` holds for a coordinate: x of the grid's unit, cell the same in cells. */
int32_t crossing_of_point(const crossing_mesh *m, int axis, double x, double cell);

/* An edge from vertex a to b, where b comes in a later row. */
typedef struct crossing_line {
    const crossing_mesh *m;
    int32_t a, b;
    int32_t low, high;   /* where it can cross: columns */
    double row, column;  /* of a */
    double slope, bound; /* columns a row; a bound on the error of what they give */
} crossing_line;

crossing_line crossing_line_of(const crossing_mesh *m, int32_t a, int32_t b);
int32_t crossing_line_exact(const crossing_line *l, int32_t row);

/* The first column of a row whose centre is past the edge. */
static inline int32_t crossing_line_at(const crossing_line *l, int32_t row)
{
    if (l->low == l->high)
        return l->low;
    int32_t at = crossing_first(l->column + (row - l->row) * l->slope, l->bound, l->low, l->high);
    return at != CROSSING_OPEN ? at : crossing_line_exact(l, row);
}

/* A triangle's plane. */
typedef struct crossing_plane {
    const crossing_mesh *m;
    const int32_t *triangle;
    int32_t low, high;               /* where it can be crossed: cells along the ray */
    double row, column, ray;         /* of its first corner */
    double by_row, by_column, bound; /* cells along the ray for each; a bound on the error of what they give */
} crossing_plane;

crossing_plane crossing_plane_of(const crossing_mesh *m, const int32_t *triangle);
int32_t crossing_plane_exact(const crossing_plane *p, int32_t row, int32_t column);

/* The first cell of a column whose centre is past the triangle, which the column's ray crosses. */
static inline int32_t crossing_plane_at(const crossing_plane *p, int32_t row, int32_t column)
{
    double x = p->ray + ((row - p->row) * p->by_row + (column - p->column) * p->by_column);
    int32_t at = crossing_first(x, p->bound, p->low, p->high);
    return at != CROSSING_OPEN ? at : crossing_plane_exact(p, row, column);
}

#endif
