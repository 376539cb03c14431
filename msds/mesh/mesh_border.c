#include "msds/mesh/mesh_border.h"

#include "base/mem.h"
#include "msds/mesh/mesh_shape.h"
#include "msds/mesh/mesh_warp.h"

#include <stdlib.h>

enum {
    SWEEPS = 3,      /* over all nodes: one that its neighbours held back may go on after them */
    STEPS_MOST = 64, /* of a search along a normal */
    HALVINGS = 24    /* of a step that crosses the border */
};

/* Shares of the way to the border that a node tries to go. */
static const double tries[] = {1, .75, .5, .25, .125};

static const double reach = .5;     /* of the shortest edge at a node: how far it goes from where it is */
static const double reach_all = .6; /* and from where it was made */

/* The second step of mesh_warp.h: nodes of the skin that are not on the border yet go there along its normals. */
typedef struct mover {
    mesh_warp w;
    double pace;    /* m: of a search: half a voxel */
    double *normal; /* nodes x 3: outwards, on the box's sides along these; 0: the node stays */
} mover;

/* ---- which nodes, and which way */

static void add_normal(const mover *k, const int32_t face[3])
{
    const double *x = k->w.g->position;
    double u[3], v[3], n[3];
    shape_less(&x[3 * (int64_t)face[1]], &x[3 * (int64_t)face[0]], u);
    shape_less(&x[3 * (int64_t)face[2]], &x[3 * (int64_t)face[0]], v);
    shape_cross(u, v, n);
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            k->normal[3 * (int64_t)face[i] + a] += n[a];
}

/* Nodes that stay on the box's sides: their normals have the components along the other edges alone. */
static void keep_on_sides(const mover *k)
{
    for (int64_t n = 0; n < k->w.g->nodes; n++) {
        double *normal = &k->normal[3 * n], to[3] = {0};
        for (int a = 0; a < 3; a++) {
            const double along = mesh_warp_stays(&k->w, n, a) ? 0 : shape_dot(normal, k->w.unit[a]);
            for (int i = 0; i < 3; i++)
                to[i] += along * k->w.unit[a][i];
        }
        shape_unit(to);
        memcpy(normal, to, sizeof to);
    }
}

static void find_normals(const mover *k)
{
    const mesh_graded *g = k->w.g;
    int32_t face[3];
    for (int64_t t = 0; t < g->tets; t++)
        for (int c = 0; c < 4; c++) {
            mesh_around_face(g, t, c, face);
            if (!mesh_warp_face_on_side(&k->w, face) && mesh_around_beyond(g, &k->w.around, t, c) < 0)
                add_normal(k, face);
        }
    keep_on_sides(k);
}

static bool moves(const mover *k, int64_t n)
{
    return shape_dot(&k->normal[3 * n], &k->normal[3 * n]) > 0;
}

static void place_made(const mover *k, int64_t n, double to[3])
{
    mesh_graded_place(k->w.box, k->w.cells, &k->w.g->at[3 * n], to);
}

/* ---- how far */

static double tissue_along(const mover *k, int64_t n, double way)
{
    double place[3];
    for (int i = 0; i < 3; i++)
        place[i] = k->w.g->position[3 * n + i] + way * k->normal[3 * n + i];
    return mesh_warp_tissue(&k->w, place);
}

/* From a node along its normal to the border, m; nan: it is farther than the node may go. Outwards from in the tissue,
 * else inwards. */
static double way_to_border(const mover *k, int64_t n)
{
    const double here = tissue_along(k, n, 0), sense = here > 0 ? 1 : -1, far = reach * k->w.edge[n];
    const int steps = (int)fmin(fmax(ceil(far / k->pace), 1), STEPS_MOST);
    double low = 0, high = 0;
    int i = 0;
    while (i++ < steps) {
        low = high;
        high = far * i / steps;
        if (tissue_along(k, n, sense * high) * sense <= 0)
            break;
    }
    if (i > steps)
        return (double)NAN;
    for (int h = 0; h < HALVINGS; h++) {
        const double middle = .5 * (low + high);
        if (tissue_along(k, n, sense * middle) * sense > 0)
            low = middle;
        else
            high = middle;
    }
    return sense * .5 * (low + high);
}

/* A thousandth of an edge is on it. */
static bool is_on(double way, double edge)
{
    return fabs(way) < 1e-3 * edge;
}

static double distance_moved(const mover *k, int64_t n)
{
    double made[3], off[3];
    place_made(k, n, made);
    shape_less(&k->w.g->position[3 * n], made, off);
    return shape_length(off);
}

/* As far as its tetrahedra stay good. */
static void move(const mover *k, int64_t n)
{
    double *position = &k->w.g->position[3 * n], from[3];
    const double way = way_to_border(k, n);
    if (!isfinite(way) || is_on(way, k->w.edge[n]))
        return;
    memcpy(from, position, sizeof from);
    for (size_t i = 0; i < sizeof tries / sizeof *tries; i++) {
        for (int a = 0; a < 3; a++)
            position[a] = from[a] + tries[i] * way * k->normal[3 * n + a];
        if (distance_moved(k, n) <= reach_all * k->w.edge[n] && mesh_warp_all_good(&k->w, n, MESH_QUALITY_KEPT))
            return;
    }
    memcpy(position, from, sizeof from);
}

static void count_moved(const mover *k, mesh_moved *to)
{
    for (int64_t n = 0; n < k->w.g->nodes; n++) {
        if (!moves(k, n))
            continue;
        to->nodes++;
        to->off += !is_on(way_to_border(k, n), k->w.edge[n]);
        to->largest = fmax(to->largest, distance_moved(k, n));
    }
}

/* ---- all */

static double pace_of(const mesh_mask *mask)
{
    double least = (double)INFINITY;
    for (int a = 0; a < 3; a++)
        least = fmin(least, volume_spacing(&mask->place, a));
    return least / 2e3;
}

static int move_all(mover *k, mesh_moved *moved, err *e)
{
    const mesh_graded *g = k->w.g;
    k->normal = mem_array(g->nodes, 3 * sizeof *k->normal, "nodes", e);
    if (k->normal) {
        k->pace = pace_of(k->w.mask);
        find_normals(k);
        for (int s = 0; s < SWEEPS; s++)
            for (int64_t n = 0; n < g->nodes; n++)
                if (moves(k, n))
                    move(k, n);
        count_moved(k, moved);
    }
    const int status = k->normal ? 0 : -1;
    free(k->normal);
    return status;
}

static int leave_air(mesh_warp *w, mesh_moved *moved, err *e)
{
    uint8_t *tissue = mem_array(w->g->tets, 1, "tetrahedra", e);
    int status = tissue ? mesh_warp_edges(w, tissue, e) : -1;
    if (!status)
        status = mesh_graded_keep(w->g, tissue, e);
    free(tissue);
    if (!status && !w->g->tets)
        return err_set(e, NULL, 0, "--mask: no tetrahedron is tissue; expected more nodes, or other words");
    return status ? -1 : mesh_around_largest(w->g, &moved->left, e);
}

int mesh_border_fit(mesh_graded *g, const mesh_box *b, const mesh_cells *c, const mesh_mask *mask, mesh_moved *moved,
                    err *e)
{
    mover k = {0};
    *moved = (mesh_moved){0};
    int status = mesh_warp_make(&k.w, b, c, mask, g, e) || leave_air(&k.w, moved, e) ? -1 : 0;
    mesh_warp_free(&k.w);
    if (!status)
        status = mesh_warp_make(&k.w, b, c, mask, g, e) || move_all(&k, moved, e) ? -1 : 0;
    mesh_warp_free(&k.w);
    return status;
}
