/* The lattice in the source file's own unit, where its centres are exact real numbers: the centre of cell i
 * along an axis is origin + offset + (2 i + 1) spacing / 2, summed without rounding. The offset is there so that
 * a lattice placed by the surfaces moves with them to the last bit; it is 0 where the user fixed a corner. A
 * plain struct, owned by whoever declares it.
 *
 * Limits: cells' indices within GRID_INDEX; lengths 0 or of a magnitude from GRID_SMALLEST to GRID_LARGEST, so that
 * products of three of their parts neither overflow nor fall below the smallest double: then all signs in
 * crossing.h are exact.
 */
#ifndef SINEW_GRID_H
#define SINEW_GRID_H

#include "base/err.h"

#include <stdint.h>

#define GRID_SMALLEST 1e-90
#define GRID_LARGEST  1e90
#define GRID_INDEX    2147483646 /* so that corners fit an int32 too */

typedef struct grid {
    double origin[3], offset[3], spacing[3];
    int64_t low[3], high[3]; /* the cells looked at: low <= i < high along each axis */
} grid;

/* The lattice that covers a box with ceil(extent / spacing - 1e-6) cells a side, at least one, centred on it. */
int grid_cover(grid *g, const double *low, const double *high, const double *spacing, err *e);

/* The lattice with a corner at origin; its cells are those whose centres could be
 * inside the box: low <= centre < high. */
int grid_fix(grid *g, const double *low, const double *high, const double *spacing, const double *origin, err *e);

/* Keeps the cells whose centres are in a box, its low sides included, its high sides not. */
int grid_clip(grid *g, const double *low, const double *high, err *e);

/* The same region in cells of which `parts` along each axis make one of these: their centres are
 * samples of it. (A part's side is rounded once, where parts is no power of 2; then a sample may be off
 * by as much as that, times its number.) */
int grid_divide(grid *g, const grid *whole, int parts, err *e);

/* One cell more at either end: those that a surface may cut though none of their centres can be inside. */
int grid_widen(grid *g, err *e);

/* Cells along an axis, and all of them (a double: they may be many). */
static inline int64_t grid_cells(const grid *g, int axis)
{
    return g->high[axis] - g->low[axis];
}
double grid_count(const grid *g);

/* The longest side of a cell. */
static inline double grid_longest(const grid *g)
{
    double side = g->spacing[0] > g->spacing[1] ? g->spacing[0] : g->spacing[1];
    return side > g->spacing[2] ? side : g->spacing[2];
}

/* The centre of cell i, rounded; i may be between cells. */
static inline double grid_place(const grid *g, int axis, double i)
{
    return g->origin[axis] + g->offset[axis] + (i + .5) * g->spacing[axis];
}

/* A coordinate from the corner of cell 0, rounded: within 2^-52 (|x - origin| + |offset|) of the exact one. */
static inline double grid_local(const grid *g, int axis, double x)
{
    return (x - g->origin[axis]) - g->offset[axis];
}

/* The centre of cell i from the same corner, rounded once. */
static inline double grid_centre(const grid *g, int axis, int64_t i)
{
    return (double)(2 * i + 1) * (g->spacing[axis] / 2);
}

enum { GRID_PARTS = 5 };

/* centre of cell i - x, exactly: an expansion of up to GRID_PARTS components in h, whose count it returns. */
int grid_difference(const grid *g, int axis, int64_t i, double x, double *h);

#endif
