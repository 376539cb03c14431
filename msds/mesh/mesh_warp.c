#include "msds/mesh/mesh_warp.h"

#include "base/mem.h"
#include "msds/mesh/mesh_shape.h"
#include "msds/mesh/mesh_way.h"

#include <stdlib.h>

enum { PASSES = 5 }; /* of which each goes a further eighth of edges */

static const double pass_reach = .125; /* of an edge */

static const double rounding = 1e-9; /* of the box's edges */

enum { AIR = -1, BORDER = 0, TISSUE = 1 };

/* What tetrahedra and edges are as made. */
static void look_at_rest(const mesh_warp *w)
{
    const mesh_graded *g = w->g;
    for (int64_t n = 0; n < g->nodes; n++)
        w->edge[n] = (double)INFINITY;
    for (int64_t t = 0; t < g->tets; t++) {
        double at[4][3], way[3];
        for (int c = 0; c < 4; c++)
            mesh_graded_place(w->box, w->cells, &g->at[3 * (int64_t)g->node[4 * t + c]], at[c]);
        w->rest[t] = shape_quality(at[0]);
        for (int i = 0; i < 16; i++) {
            const int64_t n = g->node[4 * t + i / 4];
            shape_less(at[i / 4], at[i % 4], way);
            if (i / 4 != i % 4)
                w->edge[n] = fmin(w->edge[n], shape_length(way));
        }
    }
}

int mesh_warp_make(mesh_warp *w, const mesh_box *b, const mesh_cells *c, const mesh_mask *mask, mesh_graded *g, err *e)
{
    *w = (mesh_warp){.box = b, .cells = c, .mask = mask, .g = g};
    if (mask)
        w->finder = volume_finder_of(&mask->place);
    for (int a = 0; a < 3; a++) {
        memcpy(w->unit[a], b->edge[a], sizeof w->unit[a]);
        shape_unit(w->unit[a]);
    }
    w->rest = mem_array(g->tets, sizeof *w->rest, "tetrahedra", e);
    w->edge = w->rest ? mem_array(g->nodes, sizeof *w->edge, "nodes", e) : NULL;
    if (!w->edge)
        return -1;
    look_at_rest(w);
    return mesh_around_make(&w->around, g, e);
}

void mesh_warp_free(mesh_warp *w)
{
    mesh_around_free(&w->around);
    free(w->rest);
    free(w->edge);
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

bool mesh_warp_face_on_side(const mesh_warp *w, const int32_t face[3])
{
    for (int a = 0; a < 3; a++) {
        bool all = true;
        for (int i = 0; i < 3; i++)
            all = all && mesh_warp_on_side(w, face[i], a) &&
                  w->g->at[3 * (int64_t)face[i] + a] == w->g->at[3 * (int64_t)face[0] + a];
        if (all)
            return true;
    }
    return false;
}

double mesh_warp_kept(const mesh_warp *w, int64_t tet)
{
    double now[4][3];
    for (int c = 0; c < 4; c++)
        memcpy(now[c], &w->g->position[3 * (int64_t)w->g->node[4 * tet + c]], sizeof now[c]);
    return shape_quality(now[0]) / w->rest[tet];
}

bool mesh_warp_good(const mesh_warp *w, int64_t tet)
{
    return mesh_warp_kept(w, tet) >= MESH_QUALITY_KEPT;
}

bool mesh_warp_all_good(const mesh_warp *w, int64_t node, double least)
{
    for (int64_t i = w->around.start[node]; i < w->around.start[node + 1]; i++)
        if (!(mesh_warp_kept(w, w->around.element[i]) >= least))
            return false;
    return true;
}

/* ---- edges */

static int is_in_tissue(const void *w, const double place[3])
{
    return mesh_warp_tissue(w, place) > 0;
}

/* The share of the way from p to q at which tissue ends or begins. */
static double crossing(const mesh_warp *w, int64_t p, int64_t q)
{
    const mesh_field tissue = {is_in_tissue, w};
    double edge[3];
    shape_less(&w->g->position[3 * q], &w->g->position[3 * p], edge);
    return mesh_way(&tissue, &w->g->position[3 * p], edge, 1, 1);
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

/* The place on the border that is nearest to a node. way: to some crossing, m. */
static bool foot(const mesh_warp *w, int64_t n, double way, double to[3])
{
    const mesh_field tissue = {is_in_tissue, w};
    bool stays[3];
    for (int a = 0; a < 3; a++)
        stays[a] = mesh_warp_stays(w, n, a);
    return mesh_way_foot(&tissue, w->unit, stays, &w->g->position[3 * n], way, to);
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
