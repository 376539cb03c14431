#include "exchange/export_shape.h"

#include "base/mem.h"
#include "base/near.h"
#include "mesh/bone.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The names of the surfaces are gathered only for the message. */
static int no_surface(const model *m, const char *name, err *e)
{
    char one[MODEL_NAME];
    notes names = {0};
    for (int at = 0; model_surface(m, &at, one, sizeof one);)
        notes_add(&names, "%s", one);
    near_option(e, NULL, "surface", name, (const char *const *)names.line, names.count);
    notes_free(&names);
    return -1;
}

static int of_surface(export_shape *x, const char *name, err *e)
{
    if (!surface_there(x->m, name))
        return no_surface(x->m, name, e);
    if (surface_of(x->m, name, &x->s, e))
        return -1;
    x->is_surface = true;
    x->points = x->s.vertices;
    x->cells = x->s.faces;
    x->corners = x->s.faces ? x->s.corners : 0;
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

/* A vertex moves with its element, or with the bone that carries it, as in sinew deform. A
 * surface that is not bound stays where it is. */
static int move_surface(export_shape *x, const double *u, err *e)
{
    bound b;
    bone carried = {0};
    motion moves = {0};
    int is_bound = bound_of(&b, x->m, x->s.name, e);
    if (is_bound <= 0)
        return is_bound;
    if (bone_find(&carried, &b, x->m, e) ||
        motion_open(&moves, &b, model_count(x->m, "node"), model_count(x->m, "element"), e)) {
        bone_free(&carried);
        return -1;
    }
    motion_set(&moves, u, NULL);
    bone_set(&carried, x->f);
    x->displacement = mem_array(3 * x->points, sizeof *x->displacement, "displacements", e);
    for (int64_t v = 0; v < x->points && x->displacement; v++)
        bone_displacement(&carried, &moves, v, &x->displacement[3 * v]);
    bone_free(&carried);
    motion_free(&moves);
    return x->displacement ? 0 : -1;
}

/* Finds the surface's displacement that a solver computed. NULL: the frame has none. */
static const model_array *own_displacement(const export_shape *x, const frame *f)
{
    char name[MODEL_NAME + 20];
    snprintf(name, sizeof name, "%s/vertex.displacement", x->s.name);
    return f && x->is_surface ? frame_find(f, name) : NULL;
}

int export_shape_move(export_shape *x, const frame *f, err *e)
{
    const model_array *nodes = f ? frame_find(f, "node.displacement") : NULL;
    const model_array *u = nodes ? nodes : own_displacement(x, f);
    free(x->displacement);
    x->displacement = NULL;
    x->f = f;
    if (!u)
        return 0;
    if (x->is_surface && nodes)
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
