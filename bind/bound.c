#include "bind/bound.h"

#include "mesh/weights.h"

static bool is_bound(const model *m, const char *name)
{
    return surface_part(m, name, "vertex.element") && surface_part(m, name, "vertex.weight");
}

static int view(bound *b, const model *m, const char *name, err *e)
{
    const model_array *node = model_need(m, "element.node", e), *rest = model_need(m, "node.position", e);
    if (!node || !rest || surface_of(m, name, &b->shape, e))
        return -1;
    const model_array *weight = surface_part(m, name, "vertex.weight");
    if (node->columns != 8 || weight->columns != 3)
        return err_set(e, NULL, 0, "surface %s is bound to tetrahedra; expected hexahedra", name);
    b->element = surface_part(m, name, "vertex.element")->i32;
    b->weight = weight->f64;
    b->node = node->i32;
    b->rest = rest->f64;
    return 0;
}

/* The i-th bound surface's name, or NULL past the last. */
static const char *bound_name(const model *m, int at, char *name, size_t size)
{
    for (int i = 0; model_surface(m, i, name, size); i++)
        if (is_bound(m, name) && !at--)
            return name;
    return NULL;
}

/* No surface of the OBJ's name is bound, and none is this OBJ: what the model has, or what differs. */
static int nothing_fits(const model *m, const char *name, const obj *o, double scale, err *e)
{
    char first[MODEL_NAME], second[MODEL_NAME];
    surface s;
    if (!bound_name(m, 0, first, sizeof first))
        return model_surface(m, 0, second, sizeof second)
                   ? err_set(e, NULL, 0,
                             "the model carries surface %s, but it is not bound; expected a model from sinew bind",
                             second)
                   : err_set(e, NULL, 0, "the model carries no surface; expected a model from sinew bind");
    if (bound_name(m, 1, second, sizeof second))
        return err_set(e, o->name, 0, "is none of the bound surfaces (%s, %s, ...); expected the OBJ that was bound",
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
        return view(b, m, s.name, e);
    for (int i = 0; bound_name(m, i, other, sizeof other); i++) {
        err ignored = {0};
        if (surface_of(m, other, &s, e))
            return -1;
        if (!surface_is(&s, o, scale, &ignored))
            return view(b, m, other, e);
    }
    if (!differs.status)
        return nothing_fits(m, name, o, scale, e);
    *e = differs;
    return -1;
}

void bound_displacement(const bound *b, int64_t vertex, const double *u, double *d)
{
    const int32_t *node = &b->node[8 * (int64_t)b->element[vertex]];
    weights_displacement(node, 8, &b->weight[3 * vertex], u, d);
}

void bound_gradient(const bound *b, int64_t vertex, const double *u, double *f)
{
    const int32_t *node = &b->node[8 * (int64_t)b->element[vertex]];
    weights_box box = weights_box_of(node, b->rest);
    double gradient[24];
    weights_gradients(&box, &b->weight[3 * vertex], gradient);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            f[3 * i + j] = i == j;
            for (int n = 0; n < 8; n++)
                f[3 * i + j] += u[3 * (int64_t)node[n] + i] * gradient[3 * n + j];
        }
}

double bound_outside(const bound *b, int64_t vertex)
{
    weights_box box = weights_box_of(&b->node[8 * (int64_t)b->element[vertex]], b->rest);
    return weights_outside(&box, &b->weight[3 * vertex]);
}
