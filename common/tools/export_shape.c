#include "tools/export_shape.h"

#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "mesh/weights.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An array "S/what" of the surface, or NULL. */
static const model_array *part(const export_shape *x, const char *what)
{
    char name[300];
    snprintf(name, sizeof name, "%s/%s", x->s.name, what);
    return model_find(x->m, name);
}

static int no_surface(const model *m, const char *name, err *e)
{
    char all[600] = "", one[300];
    notes names = {0};
    for (int i = 0; model_surface(m, i, one, sizeof one); i++) {
        size_t n = strlen(all);
        snprintf(all + n, sizeof all - n, "%s%s", i ? ", " : "", one);
        notes_add(&names, "%s", one);
    }
    int near = near_name(name, (const char *const *)names.line, names.count);
    if (!names.count)
        err_set(e, NULL, 0, "no surface '%.100s': the model carries none", name);
    else if (near >= 0)
        err_set(e, NULL, 0, "no surface '%.100s'; did you mean '%s'?", name, names.line[near]);
    else
        err_set(e, NULL, 0, "no surface '%.100s'; the model carries %s", name, all);
    notes_free(&names);
    return -1;
}

static int of_surface(export_shape *x, const char *name, err *e)
{
    char axis[300];
    snprintf(axis, sizeof axis, "%.250s/vertex", name);
    if (model_count(x->m, axis) < 0)
        return no_surface(x->m, name, e);
    if (surface_of(x->m, name, &x->s, e))
        return -1;
    x->is_surface = true;
    x->points = x->s.vertices;
    x->cells = x->s.faces;
    x->corners = x->s.faces ? x->s.corners - x->s.start[0] : 0;
    x->rest = x->s.position;
    snprintf(x->point_axis, sizeof x->point_axis, "%s/vertex", name);
    snprintf(x->cell_axis, sizeof x->cell_axis, "%s/face", name);
    return 0;
}

static int of_elements(export_shape *x, err *e)
{
    const model_array *position = model_need(x->m, "node.position", e);
    x->node = position ? model_need(x->m, "element.node", e) : NULL;
    if (!x->node)
        return -1;
    if (x->node->columns != 8 && x->node->columns != 4)
        return err_set(e, NULL, 0, "element.node has %d columns; expected 8 (hexahedra) or 4 (tetrahedra)",
                       (int)x->node->columns);
    x->points = position->rows;
    x->cells = x->node->rows;
    x->corners = x->cells * x->node->columns;
    x->rest = position->f64;
    strcpy(x->point_axis, "node");
    strcpy(x->cell_axis, "element");
    return 0;
}

int export_shape_of(export_shape *x, const model *m, const char *name, err *e)
{
    *x = (export_shape){.m = m};
    return name ? of_surface(x, name, e) : of_elements(x, e);
}

/* A vertex moves with its element by W&M's equation (1), or by the barycentric weights of a tetrahedron. */
static void move_vertices(export_shape *x, const model_array *element, const model_array *weight, const double *u)
{
    const model_array *node = model_find(x->m, "element.node");
    for (int64_t v = 0; v < x->points; v++) {
        const int32_t *of = &node->i32[(int64_t)element->i32[v] * node->columns];
        double hexahedron[8];
        const double *share = &weight->f64[v * weight->columns];
        if (node->columns == 8) {
            weights_shares(share, hexahedron);
            share = hexahedron;
        }
        for (int n = 0; n < node->columns; n++)
            for (int a = 0; a < 3; a++)
                x->displacement[3 * v + a] += share[n] * u[3 * (int64_t)of[n] + a];
    }
}

static int move_surface(export_shape *x, const double *u, err *e)
{
    const model_array *element = part(x, "vertex.element"), *weight = part(x, "vertex.weight");
    const model_array *node = model_find(x->m, "element.node");
    if (!element || !weight)
        return 0;
    if (!node || weight->columns != (node->columns == 8 ? 3 : 4))
        return err_set(e, NULL, 0,
                       "%s/vertex.weight does not fit element.node: 3 weights in hexahedra, 4 in tetrahedra",
                       x->s.name);
    x->displacement = mem_array(3 * x->points, sizeof *x->displacement, "displacements", e);
    if (!x->displacement)
        return -1;
    move_vertices(x, element, weight, u);
    return 0;
}

int export_shape_move(export_shape *x, const frame *f, err *e)
{
    const model_array *u = f ? frame_find(f, "node.displacement") : NULL;
    free(x->displacement);
    x->displacement = NULL;
    x->f = f;
    if (!u)
        return 0;
    if (x->is_surface)
        return move_surface(x, u->f64, e);
    x->displacement = mem_array(3 * x->points, sizeof *x->displacement, "displacements", e);
    if (!x->displacement)
        return -1;
    memcpy(x->displacement, u->f64, 3 * (size_t)x->points * sizeof *x->displacement);
    return 0;
}

void export_shape_free(export_shape *x)
{
    free(x->displacement);
    *x = (export_shape){0};
}

const int32_t *export_shape_cell(const export_shape *x, int64_t cell, int64_t *corners)
{
    if (!x->is_surface) {
        *corners = x->node->columns;
        return &x->node->i32[cell * x->node->columns];
    }
    *corners = surface_end(&x->s, cell) - x->s.start[cell];
    return &x->s.vertex[x->s.start[cell]];
}

void export_shape_point(const export_shape *x, int64_t point, bool moved, double *at)
{
    for (int a = 0; a < 3; a++)
        at[a] = x->rest[3 * point + a] + (moved && x->displacement ? x->displacement[3 * point + a] : 0);
}
