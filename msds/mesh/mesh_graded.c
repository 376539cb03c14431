#include "msds/mesh/mesh_graded.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "msds/mesh/mesh_keys.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EDGES = 12, FACES = 6 };

/* Corners in VTK's order. Faces: counter-clockwise, seen from outside. */
static const int8_t edge_corner[EDGES][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                             {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
static const int8_t face_corner[FACES][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                             {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};

/* A mesh on its way: nodes are numbered as they come; the first are corners of cells. */
typedef struct maker {
    const mesh_cells *c;
    mesh_keys nodes;
    int64_t corners;
    int32_t of;          /* the cell that is divided */
    int32_t *tet, *cell; /* tets x 4; tets */
    int64_t tets, capacity, cell_capacity;
    bool mirrored;
} maker;

/* A cell that is divided: its corners and its middle, as places and as nodes. */
typedef struct divided {
    int32_t corner[8][3], middle[3];
    int32_t node[8], centre;
    int even; /* the parity of corners at which diagonals begin: of the first, the cell's own */
} divided;

static void middle_of(const int32_t a[3], const int32_t b[3], int32_t to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = (a[i] + b[i]) / 2;
}

static void corners_of(const mesh_cell *of, divided *d)
{
    for (int v = 0; v < 8; v++)
        for (int a = 0; a < 3; a++)
            d->corner[v][a] = of->at[a] + lattice_vtk[v][a] * of->side;
    middle_of(d->corner[0], d->corner[6], d->middle);
    d->even = (of->at[0] / of->side + of->at[1] / of->side + of->at[2] / of->side) & 1;
}

/* The corner of a cell that is there, or -1. */
static int64_t corner_at(const maker *k, const int32_t at[3])
{
    const int64_t n = mesh_keys_find(&k->nodes, mesh_key(at));
    return n < k->corners ? n : -1;
}

static int put_corners(maker *k, err *e)
{
    divided d;
    for (int64_t i = 0; i < k->c->count; i++) {
        corners_of(&k->c->cell[i], &d);
        for (int v = 0; v < 8; v++)
            if (mesh_keys_put(&k->nodes, mesh_key(d.corner[v]), e) < 0)
                return -1;
    }
    k->corners = k->nodes.count;
    return 0;
}

static int add_tet(maker *k, int64_t p, int64_t q, int64_t r, int64_t s, err *e)
{
    if (MEM_ROOM(&k->tet, &k->capacity, 4 * (k->tets + 1), "tetrahedra", e) ||
        MEM_ROOM(&k->cell, &k->cell_capacity, k->tets + 1, "tetrahedra", e))
        return -1;
    if (k->tets >= INT32_MAX)
        return err_set(e, NULL, 0, "more tetrahedra than can be numbered; expected at most %d", INT32_MAX);
    k->cell[k->tets] = k->of;
    int32_t *to = &k->tet[4 * k->tets++];
    to[0] = (int32_t)p;
    to[1] = (int32_t)q;
    to[2] = (int32_t)(k->mirrored ? s : r);
    to[3] = (int32_t)(k->mirrored ? r : s);
    return 0;
}

/* A triangle that is seen counter-clockwise from outside, and the cell's middle. */
static int add_cone(maker *k, const divided *d, int64_t p, int64_t q, int64_t r, err *e)
{
    return add_tet(k, p, r, q, d->centre, e);
}

/* From the face's middle to its edges, whole or in halves. half: the nodes in the middles of edges, or -1. */
static int add_fan(maker *k, const divided *d, const int32_t node[4], const int64_t half[4], int64_t hub, err *e)
{
    for (int i = 0; i < 4; i++) {
        const int64_t from = node[i], to = node[(i + 1) % 4];
        if (half[i] < 0 ? add_cone(k, d, hub, from, to, e)
                        : add_cone(k, d, hub, from, half[i], e) || add_cone(k, d, hub, half[i], to, e))
            return -1;
    }
    return 0;
}

static int add_face(maker *k, const divided *d, int face, err *e)
{
    const int8_t *of = face_corner[face];
    int32_t node[4], at[3];
    int64_t half[4];
    bool halves = false;
    for (int i = 0; i < 4; i++) {
        node[i] = d->node[of[i]];
        middle_of(d->corner[of[i]], d->corner[of[(i + 1) % 4]], at);
        half[i] = corner_at(k, at);
        halves |= half[i] >= 0;
    }
    if (halves) {
        middle_of(d->corner[of[0]], d->corner[of[2]], at);
        const int64_t hub = mesh_keys_put(&k->nodes, mesh_key(at), e);
        return hub < 0 ? -1 : add_fan(k, d, node, half, hub, e);
    }
    const int32_t *o = lattice_vtk[of[0]];
    const int from = (d->even + o[0] + o[1] + o[2]) & 1, to = from + 2;
    return add_cone(k, d, node[from], node[from + 1], node[to], e) ||
                   add_cone(k, d, node[from], node[to], node[(to + 1) % 4], e)
               ? -1
               : 0;
}

static bool has_finer(const maker *k, const divided *d)
{
    int32_t at[3];
    for (int i = 0; i < EDGES; i++) {
        middle_of(d->corner[edge_corner[i][0]], d->corner[edge_corner[i][1]], at);
        if (corner_at(k, at) >= 0)
            return true;
    }
    return false;
}

static int add_five(maker *k, const divided *d, err *e)
{
    for (int t = 0; t < MESH_TETS; t++) {
        const int8_t *of = mesh_five[d->even][t];
        if (add_tet(k, d->node[of[0]], d->node[of[1]], d->node[of[2]], d->node[of[3]], e))
            return -1;
    }
    return 0;
}

static int add_cell(maker *k, const mesh_cell *of, err *e)
{
    divided d;
    corners_of(of, &d);
    for (int v = 0; v < 8; v++)
        d.node[v] = (int32_t)corner_at(k, d.corner[v]);
    if (!has_finer(k, &d))
        return add_five(k, &d, e);
    const int64_t centre = mesh_keys_put(&k->nodes, mesh_key(d.middle), e);
    d.centre = (int32_t)centre;
    for (int f = 0; centre >= 0 && f < FACES; f++)
        if (add_face(k, &d, f, e))
            return -1;
    return centre < 0 ? -1 : 0;
}

/* ---- numbers */

static int by_key(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* Nodes in the order of their places: fills `at`, and gives the tetrahedra their numbers. */
static int number_nodes(maker *k, int32_t **at, err *e)
{
    const int64_t count = k->nodes.count;
    int64_t *key = mem_array(count, sizeof *key, "nodes", e);
    int32_t *number = key ? mem_array(count, sizeof *number, "nodes", e) : NULL;
    *at = number ? mem_array(count, 3 * sizeof **at, "nodes", e) : NULL;
    if (*at) {
        memcpy(key, k->nodes.key, (size_t)count * sizeof *key);
        qsort(key, (size_t)count, sizeof *key, by_key);
        for (int64_t n = 0; n < count; n++) {
            mesh_key_place(key[n], *at + 3 * n);
            number[mesh_keys_find(&k->nodes, key[n])] = (int32_t)n;
        }
        for (int64_t i = 0; i < 4 * k->tets; i++)
            k->tet[i] = number[k->tet[i]];
    }
    free(key);
    free(number);
    return *at ? 0 : -1;
}

void mesh_graded_place(const mesh_box *b, const mesh_cells *c, const int32_t at[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = b->origin[i] + b->edge[0][i] * ((double)at[0] / c->size[0]) +
                b->edge[1][i] * ((double)at[1] / c->size[1]) + b->edge[2][i] * ((double)at[2] / c->size[2]);
}

static int make(maker *k, int32_t **at, err *e)
{
    if (put_corners(k, e))
        return -1;
    for (int64_t i = 0; i < k->c->count; i++) {
        k->of = (int32_t)i;
        if (add_cell(k, &k->c->cell[i], e))
            return -1;
    }
    return number_nodes(k, at, e);
}

int mesh_graded_make(mesh_graded *g, const mesh_box *b, const mesh_cells *c, err *e)
{
    maker k = {.c = c};
    int status = mesh_box_check(b, &k.mirrored, e) || make(&k, &g->at, e) ? -1 : 0;
    g->nodes = k.nodes.count;
    g->tets = k.tets;
    g->node = k.tet;
    g->cell = k.cell;
    g->position = status ? NULL : mem_array(g->nodes, 3 * sizeof *g->position, "nodes", e);
    for (int64_t n = 0; g->position && n < g->nodes; n++)
        mesh_graded_place(b, c, &g->at[3 * n], &g->position[3 * n]);
    mesh_keys_free(&k.nodes);
    return g->position ? 0 : -1;
}

void mesh_graded_free(mesh_graded *g)
{
    free(g->position);
    free(g->at);
    free(g->node);
    free(g->cell);
    *g = (mesh_graded){0};
}

/* ---- a part of it, and a model */

static void keep_tets(mesh_graded *g, const uint8_t *marked)
{
    int64_t kept = 0;
    for (int64_t t = 0; t < g->tets; t++)
        if (marked[t]) {
            memmove(&g->node[4 * kept], &g->node[4 * t], 4 * sizeof *g->node);
            g->cell[kept++] = g->cell[t];
        }
    g->tets = kept;
}

int mesh_graded_keep(mesh_graded *g, const uint8_t *marked, err *e)
{
    int32_t *number = mem_array(g->nodes, sizeof *number, "nodes", e);
    int64_t kept = 0;
    if (!number)
        return -1;
    keep_tets(g, marked);
    for (int64_t i = 0; i < 4 * g->tets; i++)
        number[g->node[i]] = 1;
    for (int64_t n = 0; n < g->nodes; n++) {
        if (!number[n])
            continue;
        memmove(&g->position[3 * kept], &g->position[3 * n], 3 * sizeof *g->position);
        memmove(&g->at[3 * kept], &g->at[3 * n], 3 * sizeof *g->at);
        number[n] = (int32_t)kept++;
    }
    g->nodes = kept;
    for (int64_t i = 0; i < 4 * g->tets; i++)
        g->node[i] = number[g->node[i]];
    free(number);
    return 0;
}

int mesh_graded_add(const mesh_graded *g, model *m, err *e)
{
    if (model_axis_add(m, "node", g->nodes, e) || model_axis_add(m, "element", g->tets, e) ||
        !model_add(m, "node.position", e) || !model_add_as(m, "element.node", MODEL_I32, "@node", "element", 4, e))
        return -1;
    memcpy(model_find(m, "node.position")->f64, g->position, (size_t)g->nodes * 3 * sizeof *g->position);
    memcpy(model_find(m, "element.node")->i32, g->node, (size_t)g->tets * 4 * sizeof *g->node);
    return 0;
}
