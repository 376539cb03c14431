#include "msds/mesh/mesh_sides.h"

#include "base/mem.h"
#include "msds/mesh/mesh_around.h"
#include "msds/mesh/mesh_shape.h"

#include <stdlib.h>

enum { SIDES = 6, FINEST = 2 /* units: a finest cell */ };

/* Normals that are so near to two sides are of both. */
static const double tie = 1e-9;

/* For each column of finest cells along an axis, the place of the first face from one end; -1: it has no cell. */
typedef struct columns {
    int side, axis, u, v;
    int64_t wide, high;
    int32_t *first;
} columns;

static int32_t face_of(const columns *k, const mesh_cell *of)
{
    return of->at[k->axis] + k->side % 2 * of->side;
}

static bool is_nearer(const columns *k, int32_t at, int32_t than)
{
    return than < 0 || (k->side % 2 ? at > than : at < than);
}

/* Goes through a cell's columns: puts its face there where it is the first (put), or says whether it is one. */
static bool look(const columns *k, const mesh_cell *of, bool put)
{
    const int32_t at = face_of(k, of);
    bool first = false;
    for (int64_t j = of->at[k->v] / FINEST; j < (of->at[k->v] + of->side) / FINEST; j++)
        for (int64_t i = of->at[k->u] / FINEST; i < (of->at[k->u] + of->side) / FINEST; i++) {
            int32_t *place = &k->first[j * k->wide + i];
            if (put && is_nearer(k, at, *place))
                *place = at;
            first |= *place == at;
        }
    return first;
}

static int make_columns(columns *k, const mesh_made *of, int side, err *e)
{
    const int axis = side / 2, u = axis == 0, v = axis == 2 ? 1 : 2;
    *k = (columns){.side = side, .axis = axis, .u = u, .v = v};
    k->wide = of->cells->size[u] / FINEST;
    k->high = of->cells->size[v] / FINEST;
    k->first = mem_array(k->wide * k->high, sizeof *k->first, "columns of cells", e);
    for (int64_t i = 0; k->first && i < k->wide * k->high; i++)
        k->first[i] = -1;
    for (int64_t t = 0; k->first && t < of->g->tets; t++)
        if (!t || of->g->cell[t] != of->g->cell[t - 1])
            look(k, &of->cells->cell[of->g->cell[t]], true);
    return k->first ? 0 : -1;
}

/* Whether a face's normal is nearest to a side. */
static bool faces(const mesh_made *of, const int32_t node[3], int side)
{
    const double *x = of->g->position;
    double u[3], v[3], n[3], along[3], most = 0;
    shape_less(&x[3 * (int64_t)node[1]], &x[3 * (int64_t)node[0]], u);
    shape_less(&x[3 * (int64_t)node[2]], &x[3 * (int64_t)node[0]], v);
    shape_cross(u, v, n);
    for (int a = 0; a < 3; a++) {
        double unit[3];
        memcpy(unit, of->box->edge[a], sizeof unit);
        shape_unit(unit);
        along[a] = shape_dot(n, unit);
        most = fmax(most, fabs(along[a]));
    }
    return (side % 2 ? along[side / 2] : -along[side / 2]) >= (1 - tie) * most;
}

static int mark_side(const mesh_made *of, const mesh_around *around, int side, uint8_t *node, err *e)
{
    columns k;
    int32_t face[3];
    if (make_columns(&k, of, side, e))
        return -1;
    for (int64_t t = 0; t < of->g->tets; t++)
        for (int c = 0; c < 4; c++) {
            mesh_around_face(of->g, t, c, face);
            if (faces(of, face, side) && mesh_around_beyond(of->g, around, t, c) < 0 &&
                look(&k, &of->cells->cell[of->g->cell[t]], false))
                node[face[0]] = node[face[1]] = node[face[2]] = 1;
        }
    free(k.first);
    return 0;
}

int mesh_sides_mark(const mesh_made *of, unsigned sides, uint8_t *node, err *e)
{
    mesh_around around = {0};
    int status = mesh_around_make(&around, of->g, e);
    for (int s = 0; !status && s < SIDES; s++)
        if (sides >> s & 1)
            status = mark_side(of, &around, s, node, e);
    mesh_around_free(&around);
    return status;
}
