#include "msds/mesh/mesh_refine.h"

#include "msds/mesh/mesh_shape.h"

#include <math.h>

/* A cell that ends at a depth, but for rounding, does not reach it. */
static const double rounding = 1e-9;

/* ---- around a place */

/* A place as shares of the box's edges: Cramer's rule. */
static void shares_of(const mesh_box *b, const double place[3], double to[3])
{
    double off[3], normal[3];
    shape_less(place, b->origin, off);
    for (int a = 0; a < 3; a++) {
        shape_cross(b->edge[(a + 1) % 3], b->edge[(a + 2) % 3], normal);
        to[a] = shape_dot(off, normal) / shape_dot(b->edge[a], normal);
    }
}

/* From the place to the nearest of the cell, m; where edges are not square to each other, at least that. */
static double distance(const mesh_refine *r, const mesh_cells *c, const mesh_cell *of)
{
    double share[3], way[3] = {0};
    shares_of(r->box, r->around, share);
    for (int a = 0; a < 3; a++) {
        const double low = (double)of->at[a] / c->size[a], high = (double)(of->at[a] + of->side) / c->size[a];
        const double to = fmin(fmax(share[a], low), high) - share[a];
        for (int i = 0; i < 3; i++)
            way[i] += to * r->box->edge[a][i];
    }
    return shape_length(way);
}

/* ---- under the skin */

/* Of the columns of voxels that a cell has: how far down the skin is, at least and at most, m. False: there is none. */
static bool skin_of(const mesh_refine *r, const mesh_cells *c, const mesh_cell *of, double range[2])
{
    range[0] = range[1] = 0;
    if (!r->mask)
        return true;
    const int axis = r->top / 2;
    const double voxel = shape_length(r->box->edge[axis]) / (double)r->mask->place.size[axis];
    const mesh_span least = mesh_mask_skin(r->mask, c, of);
    range[0] = voxel * (double)least.low;
    range[1] = voxel * (double)least.high;
    return least.low <= least.high;
}

static bool is_under(const mesh_refine *r, const mesh_cells *c, const mesh_cell *of, double depth)
{
    const int axis = r->top / 2;
    const double unit = shape_length(r->box->edge[axis]) / c->size[axis];
    const int32_t from = r->top % 2 ? c->size[axis] - of->at[axis] - of->side : of->at[axis];
    double skin[2];
    return skin_of(r, c, of, skin) && unit * from - skin[1] < depth * (1 - rounding) &&
           unit * (from + of->side) - skin[0] > depth * rounding;
}

static bool halve(const void *context, const mesh_cells *c, const mesh_cell *of, int level)
{
    const mesh_refine *r = context;
    return r->around ? distance(r, c, of) < r->within[level] * (1 - rounding) : is_under(r, c, of, r->within[level]);
}

mesh_wish mesh_refine_wish(const mesh_refine *r)
{
    return (mesh_wish){halve, r};
}
