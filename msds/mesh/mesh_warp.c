#include "msds/mesh/mesh_warp.h"

#include "base/mem.h"
#include "msds/mesh/mesh_shape.h"

#include <stdlib.h>

enum {
    PASSES = 5,   /* of which each goes a further eighth of edges */
    STEPS = 8,    /* of a search along a line */
    HALVINGS = 24 /* of an edge that crosses the border */
};

static const double pass_reach = .125; /* of an edge */

static const double rounding = 1e-9; /* of the box's edges */

enum { AIR = -1, BORDER = 0, TISSUE = 1 };

int mesh_warp_make(mesh_warp *w, const mesh_box *b, const mesh_cells *c, const mesh_mask *mask, mesh_graded *g, err *e)
{
    *w = (mesh_warp){.box = b, .cells = c, .mask = mask, .g = g, .finder = volume_finder_of(&mask->place)};
    for (int a = 0; a < 3; a++) {
        memcpy(w->unit[a], b->edge[a], sizeof w->unit[a]);
        shape_unit(w->unit[a]);
    }
    return mesh_around_make(&w->around, g, e);
}

void mesh_warp_free(mesh_warp *w)
{
    mesh_around_free(&w->around);
    *w = (mesh_warp){0};
}

double mesh_warp_tissue(const mesh_warp *w, const double place[3])
{
    double voxel[3];
    volume_voxel(&w->finder, place, voxel);
    return mesh_mask_at(w->mask, voxel) - .5;
}

bool mesh_warp_on_side(const mesh_warp *w, int64_t node, int axis)
{
    const int32_t *at = &w->g->at[3 * node];
    double made[3], off[3];
    if (at[axis] != 0 && at[axis] != w->cells->size[axis])
        return false;
    mesh_graded_place(w->box, w->cells, at, made);
    shape_less(&w->g->position[3 * node], made, off);
    return fabs(shape_dot(off, w->unit[axis])) <= rounding * shape_length(w->box->edge[axis]);
}

bool mesh_warp_stays(const mesh_warp *w, int64_t node, int axis)
{
    return mesh_warp_on_side(w, node, axis) && mesh_warp_tissue(w, &w->g->position[3 * node]) > 0;
}

bool mesh_warp_good(const mesh_warp *w, int64_t tet)
{
    double now[4][3], rest[4][3];
    for (int c = 0; c < 4; c++) {
        const int64_t n = w->g->node[4 * tet + c];
        memcpy(now[c], &w->g->position[3 * n], sizeof now[c]);
        mesh_graded_place(w->box, w->cells, &w->g->at[3 * n], rest[c]);
    }
    return shape_quality(now[0]) >= MESH_QUALITY_KEPT * shape_quality(rest[0]);
}

/* ---- edges */

/* The share of the way from p to q at which tissue ends or begins. */
static double crossing(const mesh_warp *w, int64_t p, int64_t q)
{
    const double *from = &w->g->position[3 * p], *to = &w->g->position[3 * q];
    const bool tissue = mesh_warp_tissue(w, from) > 0;
    double low = 0, high = 1, place[3];
    for (int h = 0; h < HALVINGS; h++) {
        const double middle = .5 * (low + high);
        for (int a = 0; a < 3; a++)
            place[a] = from[a] + middle * (to[a] - from[a]);
        if ((mesh_warp_tissue(w, place) > 0) == tissue)
            low = middle;
        else
            high = middle;
    }
    return .5 * (low + high);
}

/* Whether a node may go along an edge: one that stays on a side of the box, only to a node that is on it too. */
static bool may_go(const mesh_warp *w, int64_t from, int64_t to)
{
    for (int a = 0; a < 3; a++)
        if (mesh_warp_stays(w, from, a) && w->g->at[3 * from + a] != w->g->at[3 * to + a])
            return false;
    return true;
}

/* Whether a tetrahedron may be tissue: it has a corner in it. */
static bool has_tissue(const int8_t *state, const int32_t node[4])
{
    for (int c = 0; c < 4; c++)
        if (state[node[c]] == TISSUE)
            return true;
    return false;
}

static bool stay_good(const mesh_warp *w, const int8_t *state, int64_t n)
{
    for (int64_t i = w->around.start[n]; i < w->around.start[n + 1]; i++) {
        const int64_t t = w->around.element[i];
        if (has_tissue(state, &w->g->node[4 * t]) && !mesh_warp_good(w, t))
            return false;
    }
    return true;
}

/* How far the nearest crossing on an edge of a node is, m, if it is at most `most` of the edge away; infinite: there
 * is none. */
static double nearest(const mesh_warp *w, const int8_t *state, int64_t n, double most)
{
    double least = (double)INFINITY, edge[3];
    for (int64_t i = w->around.start[n]; i < w->around.start[n + 1]; i++)
        for (int c = 0; c < 4; c++) {
            const int64_t other = w->g->node[4 * (int64_t)w->around.element[i] + c];
            if (state[n] * state[other] >= 0 || !may_go(w, n, other))
                continue;
            const double share = crossing(w, n, other);
            shape_less(&w->g->position[3 * other], &w->g->position[3 * n], edge);
            if (share <= most)
                least = fmin(least, share * shape_length(edge));
        }
    return least;
}

/* From a node along a unit vector to where tissue ends or begins, m, at most `most`; infinite: it does not. */
static double way_along(const mesh_warp *w, const double from[3], const double along[3], double most)
{
    const bool tissue = mesh_warp_tissue(w, from) > 0;
    double low = 0, high = 0, place[3];
    bool crossed = false;
    for (int i = 1; i <= STEPS && !crossed; i++) {
        low = high;
        high = most * i / STEPS;
        for (int a = 0; a < 3; a++)
            place[a] = from[a] + high * along[a];
        crossed = (mesh_warp_tissue(w, place) > 0) != tissue;
    }
    for (int h = 0; crossed && h < HALVINGS; h++) {
        const double middle = .5 * (low + high);
        for (int a = 0; a < 3; a++)
            place[a] = from[a] + middle * along[a];
        if ((mesh_warp_tissue(w, place) > 0) == tissue)
            low = middle;
        else
            high = middle;
    }
    return crossed ? .5 * (low + high) : (double)INFINITY;
}

/* The place on the border that is nearest to a node, as if the border were the plane through where it crosses the
 * box's axes. way: to some crossing, m. False: no axis crosses it near by. */
static bool foot(const mesh_warp *w, int64_t n, double way, double to[3])
{
    const double *from = &w->g->position[3 * n], far = 3 * way;
    double along[3] = {0};
    for (int a = 0; a < 3; a++) {
        double back[3];
        for (int i = 0; i < 3; i++)
            back[i] = -w->unit[a][i];
        if (mesh_warp_stays(w, n, a))
            continue;
        const double up = way_along(w, from, w->unit[a], far), down = way_along(w, from, back, far);
        for (int i = 0; i < 3; i++)
            along[i] += (up < down ? 1 / up : -1 / down) * w->unit[a][i];
    }
    shape_unit(along);
    const double length = way_along(w, from, along, 1.5 * way);
    for (int i = 0; i < 3; i++)
        to[i] = from[i] + length * along[i];
    return isfinite(length);
}

static void go(const mesh_warp *w, int8_t *state, int64_t n, double most)
{
    double *position = &w->g->position[3 * n], from[3], to[3];
    const int8_t was = state[n];
    const double way = nearest(w, state, n, most);
    if (!isfinite(way) || !foot(w, n, way, to))
        return;
    memcpy(from, position, sizeof from);
    memcpy(position, to, sizeof to);
    state[n] = BORDER;
    if (stay_good(w, state, n))
        return;
    memcpy(position, from, sizeof from);
    state[n] = was;
}

/* Of its corners, some are in tissue and none outside; or some are outside as well, or all on the border, and its
 * middle is in tissue. */
static bool is_tissue(const mesh_warp *w, const int8_t *state, int64_t t)
{
    const int32_t *node = &w->g->node[4 * t];
    int tissue = 0, air = 0;
    double middle[3] = {0};
    for (int c = 0; c < 4; c++) {
        tissue += state[node[c]] == TISSUE;
        air += state[node[c]] == AIR;
        for (int a = 0; a < 3; a++)
            middle[a] += w->g->position[3 * (int64_t)node[c] + a] / 4;
    }
    if (!air != !tissue)
        return tissue > 0;
    return mesh_warp_tissue(w, middle) > 0 && mesh_warp_good(w, t);
}

/* Spikes: tetrahedra that alone have a corner outside. */
static int drop_spikes(const mesh_warp *w, const int8_t *state, uint8_t *tissue, err *e)
{
    uint8_t *count = mem_array(w->g->nodes, 1, "nodes", e);
    for (int64_t i = 0; count && i < 4 * w->g->tets; i++) {
        uint8_t *of = &count[w->g->node[i]];
        *of = (uint8_t)(*of + (tissue[i / 4] && *of < 2));
    }
    for (int64_t i = 0; count && i < 4 * w->g->tets; i++)
        if (state[w->g->node[i]] == AIR && count[w->g->node[i]] == 1)
            tissue[i / 4] = 0;
    free(count);
    return count ? 0 : -1;
}

int mesh_warp_edges(mesh_warp *w, uint8_t *tissue, err *e)
{
    int8_t *state = mem_array(w->g->nodes, sizeof *state, "nodes", e);
    if (!state)
        return -1;
    for (int64_t n = 0; n < w->g->nodes; n++) {
        const double here = mesh_warp_tissue(w, &w->g->position[3 * n]);
        state[n] = here > 0 ? TISSUE : here < 0 ? AIR : BORDER;
    }
    for (int pass = 1; pass <= PASSES; pass++)
        for (int64_t n = 0; n < w->g->nodes; n++)
            if (state[n] != BORDER)
                go(w, state, n, pass * pass_reach);
    for (int64_t t = 0; t < w->g->tets; t++)
        tissue[t] = is_tissue(w, state, t);
    const int status = drop_spikes(w, state, tissue, e);
    free(state);
    return status;
}
