#include "voxelise/surfaces/grid.h"

#include "base/num.h"
#include "voxelise/surfaces/expansion.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static const char *const axis_name[3] = {"x", "y", "z"};

/* What a whole number of cells may miss of the extent before one more is taken. */
static const double cover_slack = 1e-6;

int grid_difference(const grid *g, int axis, int64_t i, double x, double *h)
{
    double a[GRID_PARTS], b[GRID_PARTS];
    int n = expansion_of_product((double)(2 * i + 1), g->spacing[axis] / 2, a);
    n = expansion_add(n, a, g->offset[axis], b);
    n = expansion_add(n, b, g->origin[axis], a);
    return expansion_add(n, a, -x, h);
}

static int side(const grid *g, int axis, int64_t i, double x)
{
    double h[GRID_PARTS];
    int n = grid_difference(g, axis, i, x, h);
    return expansion_sign(n, h);
}

static int refuse_index(int axis, double index, err *e)
{
    return err_set(
        e, NULL, 0,
        "the lattice would reach index %.3g along %s; indices up to %d can be kept: use larger voxels, or an "
        "origin nearer to the surfaces",
        index, axis_name[axis], GRID_INDEX);
}

/* The first cell whose centre is at x or beyond. */
static int first_at(const grid *g, int axis, double x, int64_t *at, err *e)
{
    double guess = ceil(grid_local(g, axis, x) / g->spacing[axis] - 0.5);
    if (!(fabs(guess) < GRID_INDEX))
        return refuse_index(axis, guess, e);
    int64_t i = (int64_t)guess;
    while (side(g, axis, i, x) < 0)
        i++;
    while (side(g, axis, i - 1, x) >= 0)
        i--;
    *at = i;
    return 0;
}

static bool within_limits(double x)
{
    return x == 0 || (fabs(x) >= GRID_SMALLEST && fabs(x) <= GRID_LARGEST);
}

static int check_lengths(const double *spacing, const double *origin, err *e)
{
    for (int a = 0; a < 3; a++) {
        if (!(spacing[a] >= GRID_SMALLEST && spacing[a] <= GRID_LARGEST))
            return err_set(e, NULL, 0, "a voxel of %g along %s; expected a length above 0 (%g to %g)", spacing[a],
                           axis_name[a], GRID_SMALLEST, GRID_LARGEST);
        if (!within_limits(origin[a]))
            return err_set(e, NULL, 0, "an origin of %g along %s; expected 0, or a magnitude of %g to %g", origin[a],
                           axis_name[a], GRID_SMALLEST, GRID_LARGEST);
    }
    return 0;
}

int grid_cover(grid *g, const double *low, const double *high, const double *spacing, err *e)
{
    *g = (grid){0};
    if (check_lengths(spacing, low, e))
        return -1;
    for (int a = 0; a < 3; a++) {
        double extent = high[a] - low[a], cells = ceil(extent / spacing[a] - cover_slack);
        if (cells < 1)
            cells = 1;
        if (!(cells < GRID_INDEX))
            return refuse_index(a, cells, e);
        double offset = (extent - cells * spacing[a]) / 2;
        g->origin[a] = low[a];
        g->offset[a] = within_limits(offset) ? offset : 0;
        g->spacing[a] = spacing[a];
        g->high[a] = (int64_t)cells;
    }
    return 0;
}

int grid_fix(grid *g, const double *low, const double *high, const double *spacing, const double *origin, err *e)
{
    *g = (grid){0};
    if (check_lengths(spacing, origin, e))
        return -1;
    for (int a = 0; a < 3; a++) {
        g->origin[a] = origin[a];
        g->spacing[a] = spacing[a];
        if (first_at(g, a, low[a], &g->low[a], e) || first_at(g, a, high[a], &g->high[a], e))
            return -1;
    }
    return 0;
}

/* The same, kept to the cells looked at: x may be anywhere. */
static int first_kept(const grid *g, int axis, double x, int64_t *at, err *e)
{
    double cell = grid_local(g, axis, x) / g->spacing[axis];
    int64_t low = g->low[axis], high = g->high[axis];
    *at = cell < (double)low - 1 ? low : high;
    if (cell < (double)low - 1 || cell > (double)high + 1)
        return 0;
    if (first_at(g, axis, x, at, e))
        return -1;
    *at = num_clamp_int(*at, low, high);
    return 0;
}

int grid_clip(grid *g, const double *low, const double *high, err *e)
{
    for (int a = 0; a < 3; a++) {
        int64_t from, to;
        if (first_kept(g, a, low[a], &from, e) || first_kept(g, a, high[a], &to, e))
            return -1;
        g->low[a] = from;
        g->high[a] = to < from ? from : to;
    }
    return 0;
}

int grid_divide(grid *g, const grid *whole, int parts, err *e)
{
    *g = *whole;
    for (int a = 0; a < 3; a++) {
        g->spacing[a] = whole->spacing[a] / parts;
        g->low[a] = whole->low[a] * parts;
        g->high[a] = whole->high[a] * parts;
        if (g->low[a] < -GRID_INDEX || g->high[a] > GRID_INDEX)
            return refuse_index(a, (double)(g->high[a] > GRID_INDEX ? g->high[a] : g->low[a]), e);
    }
    return check_lengths(g->spacing, g->origin, e);
}

int grid_widen(grid *g, err *e)
{
    for (int a = 0; a < 3; a++) {
        g->low[a]--;
        g->high[a]++;
        if (g->low[a] < -GRID_INDEX || g->high[a] > GRID_INDEX)
            return refuse_index(a, (double)(g->high[a] > GRID_INDEX ? g->high[a] : g->low[a]), e);
    }
    return 0;
}

double grid_count(const grid *g)
{
    return (double)grid_cells(g, 0) * (double)grid_cells(g, 1) * (double)grid_cells(g, 2);
}
