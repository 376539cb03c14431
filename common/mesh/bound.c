#include "mesh/bound.h"

#include "mesh/hexahedron.h"
#include "mesh/weights.h"

#include <string.h>

static bool is_bound(const model *m, const char *name)
{
    return surface_part(m, name, "vertex.element") && surface_part(m, name, "vertex.weight");
}

int bound_of(bound *b, const model *m, const char *name, err *e)
{
    *b = (bound){0};
    if (surface_of(m, name, &b->shape, e))
        return -1;
    if (!is_bound(m, name))
        return 0;
    const model_array *node = model_need(m, "element.node", e), *rest = model_need(m, "node.position", e);
    const model_array *weight = surface_part(m, name, "vertex.weight");
    if (!node || !rest)
        return -1;
    if ((node->columns != 8 || weight->columns != 3) && (node->columns != 4 || weight->columns != 4))
        return err_set(e, NULL, 0,
                       "%s/vertex.weight does not fit element.node: 3 weights in hexahedra, 4 in tetrahedra", name);
    const model_array *blended = surface_part(m, name, "vertex.blended");
    if (blended && node->columns != 8)
        return err_set(e, NULL, 0, "%s/vertex.blended: the elements are tetrahedra; expected the voxels of a lattice",
                       name);
    b->blended = blended ? blended->u8 : NULL;
    b->element = surface_part(m, name, "vertex.element")->i32;
    b->weight = weight->f64;
    b->node = node->i32;
    b->corners = node->columns;
    b->rest = rest->f64;
    return 1;
}

/* The next bound surface's name, as model_surface() has it. */
static const char *next_bound(const model *m, int *at, char *name, size_t size)
{
    while (model_surface(m, at, name, size))
        if (is_bound(m, name))
            return name;
    return NULL;
}

/* No surface of the OBJ's name is bound, and none is this OBJ: what the model has, or what differs. */
static int nothing_fits(const model *m, const char *name, const obj *o, double scale, err *e)
{
    char first[MODEL_NAME], second[MODEL_NAME];
    surface s;
    int at = 0;
    if (!next_bound(m, &at, first, sizeof first))
        return model_surface(m, &(int){0}, second, sizeof second)
                   ? err_set(e, NULL, 0,
                             "the model carries surface %s, but it is not bound; expected a model from sinew bind",
                             second)
                   : err_set(e, NULL, 0, "the model carries no surface; expected a model from sinew bind");
    if (next_bound(m, &at, second, sizeof second))
        return err_set(e, o->name, 0, "is not one of the bound surfaces (%s, %s, ...); expected the OBJ that was bound",
                       first, second);
    (void)name;
    return surface_of(m, first, &s, e) ? -1 : surface_is(&s, o, scale, e);
}

int bound_find(bound *b, const model *m, const char *name, const obj *o, double scale, err *e)
{
    char other[MODEL_NAME];
    err differs = {0};
    surface s;
    if (is_bound(m, name) && !surface_of(m, name, &s, &differs) && !surface_is(&s, o, scale, &differs))
        return bound_of(b, m, s.name, e) < 0 ? -1 : 0;
    for (int at = 0; next_bound(m, &at, other, sizeof other);) {
        err ignored = {0};
        if (surface_of(m, other, &s, e))
            return -1;
        if (!surface_is(&s, o, scale, &ignored))
            return bound_of(b, m, other, e) < 0 ? -1 : 0;
    }
    if (!differs.status)
        return nothing_fits(m, name, o, scale, e);
    *e = differs;
    return -1;
}

int bound_shares(const bound *b, int64_t vertex, double share[8])
{
    if (b->corners == 8)
        weights_shares(&b->weight[3 * vertex], share);
    else
        memcpy(share, &b->weight[4 * vertex], 4 * sizeof *share);
    return b->corners;
}

void bound_displacement(const bound *b, int64_t vertex, const double *u, double *d)
{
    const int32_t *node = &b->node[b->corners * (int64_t)b->element[vertex]];
    weights_displacement(node, b->corners, &b->weight[(b->corners == 8 ? 3 : 4) * vertex], u, d);
}

void bound_gradient(const bound *b, int64_t vertex, const double *u, double *f)
{
    const int32_t *node = &b->node[b->corners * (int64_t)b->element[vertex]];
    double gradient[24];
    if (b->corners == 8) {
        weights_box box = weights_box_of(node, b->rest);
        if (hexahedron_is_box(node, b->rest))
            weights_gradients(&box, &b->weight[3 * vertex], gradient);
        else
            hexahedron_gradients(node, b->rest, &b->weight[3 * vertex], gradient);
    } else {
        weights_tetrahedron_gradients(node, b->rest, gradient);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            f[3 * i + j] = i == j;
            for (int n = 0; n < b->corners; n++)
                f[3 * i + j] += u[3 * (int64_t)node[n] + i] * gradient[3 * n + j];
        }
}

double bound_outside(const bound *b, int64_t vertex)
{
    const int32_t *node = &b->node[b->corners * (int64_t)b->element[vertex]];
    if (b->corners == 4)
        return weights_tetrahedron_outside(node, b->rest, &b->shape.position[3 * vertex]);
    if (!hexahedron_is_box(node, b->rest))
        return hexahedron_outside(node, b->rest, &b->shape.position[3 * vertex]);
    weights_box box = weights_box_of(node, b->rest);
    return weights_outside(&box, &b->weight[3 * vertex]);
}
