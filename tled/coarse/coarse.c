#include "tled/coarse/coarse.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "tled/coarse/coarse_loads.h"
#include "tled/coarse/coarse_merge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool has_pressure(const script *s)
{
    for (int64_t i = 0; i < s->curves; i++)
        if (s->curve[i].verb == SCRIPT_PRESSURE)
            return true;
    return false;
}

const char *coarse_lacks(const tled_problem *fine, const model *m)
{
    if (fine->conforming || !model_find(m, "element.lattice") || !model_find(m, "node.lattice"))
        return "elements of any shape";
    if (fine->collider)
        return "a probe";
    if (fine->sliding || fine->self_contact)
        return "contact with bone or skin";
    if (fine->films)
        return "films on bone";
    if (fine->borders.count)
        return "laminates";
    if (fine->serial)
        return "muscles whose force depends on their velocity";
    if (fine->own_values)
        return "elements with values of their own";
    if (fibres_angled(&fine->fibres))
        return "families of fibres at an angle";
    return has_pressure(fine->script) ? "pressure on a surface" : NULL;
}

/* ---- Where its cells and nodes are */

static int64_t place_of(const coarse *c, const int64_t at[3], int more)
{
    return (at[2] * (c->size[1] + more) + at[1]) * (c->size[0] + more) + at[0];
}

/* The coarse cell that holds a cell of the finer lattice, from `low`. */
static int64_t cell_place(const coarse *c, const int32_t *ijk)
{
    int64_t at[3];
    for (int a = 0; a < 3; a++)
        at[a] = (int64_t)floor(ijk[a] / 2.) - c->low[a];
    return place_of(c, at, 0);
}

/* The coarse node at a corner, v, of what a finer node lies between, by its place in the finer lattice; -1: none. */
static int32_t parent_at(const coarse *c, const int32_t *at, int v)
{
    int64_t to[3];
    for (int a = 0; a < 3; a++) {
        to[a] = (int64_t)floor(((double)at[a] + lattice_vtk[v][a]) / 2) - c->low[a];
        if (to[a] < 0 || to[a] > c->size[a])
            return -1;
    }
    return c->node[place_of(c, to, 1)];
}

/* Which coarse nodes finer ones lie between. A model's node.lattice need not be that of its elements. */
static int find_parents(coarse *c, err *e)
{
    c->parent = mem_array(c->fine->nodes, 8 * sizeof *c->parent, "the coarser model", e);
    for (int64_t i = 0; c->parent && i < 8 * c->fine->nodes; i++) {
        c->parent[i] = parent_at(c, c->lattice + 3 * (i / 8), (int)(i % 8));
        if (c->parent[i] < 0)
            return err_set(e, NULL, 0, "nodes that are off the lattice of the elements");
    }
    return c->parent ? 0 : -1;
}

static int find_box(coarse *c, const int32_t *cells, int64_t count, err *e)
{
    int32_t low[3] = {INT32_MAX, INT32_MAX, INT32_MAX}, high[3] = {INT32_MIN, INT32_MIN, INT32_MIN};
    for (int64_t i = 0; i < 3 * count; i++) {
        low[i % 3] = cells[i] < low[i % 3] ? cells[i] : low[i % 3];
        high[i % 3] = cells[i] > high[i % 3] ? cells[i] : high[i % 3];
    }
    for (int a = 0; a < 3; a++) {
        c->low[a] = (int32_t)floor(low[a] / 2.);
        c->size[a] = (int64_t)floor(high[a] / 2.) - c->low[a] + 1;
    }
    const double box = (double)c->size[0] * (double)c->size[1] * (double)c->size[2];
    if (box > 64. * (double)count + 1e6)
        return err_set(e, NULL, 0, "elements too far apart in their lattice for a coarser one");
    return 0;
}

/* Numbers what is marked, in order. Returns how many. */
static int64_t number_marked(int32_t *mark, int64_t count)
{
    int32_t next = 0;
    for (int64_t i = 0; i < count; i++)
        mark[i] = mark[i] ? next++ : -1;
    return next;
}

static void mark_nodes(coarse *c)
{
    for (int64_t k = 0; k < c->size[2]; k++)
        for (int64_t j = 0; j < c->size[1]; j++)
            for (int64_t i = 0; i < c->size[0]; i++)
                for (int v = 0; v < 8 && c->cell[place_of(c, (int64_t[]){i, j, k}, 0)]; v++)
                    c->node[place_of(
                        c, (int64_t[]){i + lattice_vtk[v][0], j + lattice_vtk[v][1], k + lattice_vtk[v][2]}, 1)] = 1;
}

static int find_places(coarse *c, const model *m, int64_t *elements, int64_t *nodes, err *e)
{
    const int32_t *cells = model_find(m, "element.lattice")->i32;
    c->lattice = model_find(m, "node.lattice")->i32;
    if (find_box(c, cells, c->fine->elements, e))
        return -1;
    const int64_t box = c->size[0] * c->size[1] * c->size[2];
    const int64_t corners = (c->size[0] + 1) * (c->size[1] + 1) * (c->size[2] + 1);
    c->cell = mem_array(box, sizeof *c->cell, "the coarser model", e);
    c->node = mem_array(corners, sizeof *c->node, "the coarser model", e);
    if (!c->cell || !c->node)
        return -1;
    for (int64_t i = 0; i < c->fine->elements; i++)
        c->cell[cell_place(c, cells + 3 * i)] = 1;
    mark_nodes(c);
    *elements = number_marked(c->cell, box);
    *nodes = number_marked(c->node, corners);
    return find_parents(c, e);
}

/* ---- Its model */

static int copy_array(model *to, const model_array *a, err *e)
{
    model_array *b = model_add_as(to, a->name, a->type, a->unit, a->axis, a->columns, e);
    if (!b)
        return -1;
    if (a->type != MODEL_STR) {
        memcpy(b->data, a->data, (size_t)(a->rows * a->columns) * model_type_size(a->type));
        return 0;
    }
    for (int64_t i = 0; i < a->rows * a->columns; i++)
        if (model_set_text(b, i, a->str[i], e))
            return -1;
    return 0;
}

/* Materials and volumes, as they are. */
static int copy_materials(model *to, const model *m, err *e)
{
    if (model_axis_add(to, "material", model_count(m, "material"), e) ||
        model_axis_add(to, "volume", model_count(m, "volume"), e))
        return -1;
    for (int i = 0; i < m->arrays.count; i++) {
        const model_array *a = &m->arrays.v[i];
        if ((!strcmp(a->axis, "material") || !strcmp(a->axis, "volume")) && copy_array(to, a, e))
            return -1;
    }
    return 0;
}

static void fill_mesh(coarse *c, const lattice *l, model_array *position, model_array *element)
{
    for (int64_t k = 0; k <= c->size[2]; k++)
        for (int64_t j = 0; j <= c->size[1]; j++)
            for (int64_t i = 0; i <= c->size[0]; i++) {
                const int64_t at[3] = {i, j, k};
                const int32_t ijk[3] = {(int32_t)i + c->low[0], (int32_t)j + c->low[1], (int32_t)k + c->low[2]};
                const int32_t n = c->node[place_of(c, at, 1)];
                if (n >= 0)
                    lattice_corner(l, ijk, position->f64 + 3 * (int64_t)n);
                const bool inside = i < c->size[0] && j < c->size[1] && k < c->size[2];
                const int32_t cell = inside ? c->cell[place_of(c, at, 0)] : -1;
                for (int v = 0; cell >= 0 && v < 8; v++)
                    element->i32[8 * (int64_t)cell + v] = c->node[place_of(
                        c, (int64_t[]){i + lattice_vtk[v][0], j + lattice_vtk[v][1], k + lattice_vtk[v][2]}, 1)];
            }
}

static int make_places(coarse *c, err *e)
{
    model_array *node = model_find(&c->m, "node.lattice"), *element = model_find(&c->m, "element.lattice");
    if (!node || !element)
        return err_set(e, NULL, 0, "no places for the coarser model");
    for (int64_t k = 0; k <= c->size[2]; k++)
        for (int64_t j = 0; j <= c->size[1]; j++)
            for (int64_t i = 0; i <= c->size[0]; i++) {
                const int64_t at[3] = {i, j, k};
                const bool inside = i < c->size[0] && j < c->size[1] && k < c->size[2];
                const int32_t n = c->node[place_of(c, at, 1)], cell = inside ? c->cell[place_of(c, at, 0)] : -1;
                for (int a = 0; a < 3; a++) {
                    if (n >= 0)
                        node->i32[3 * (int64_t)n + a] = (int32_t)at[a] + c->low[a];
                    if (cell >= 0)
                        element->i32[3 * (int64_t)cell + a] = (int32_t)at[a] + c->low[a];
                }
            }
    return 0;
}

static int make_model(coarse *c, const model *m, err *e)
{
    lattice l;
    int64_t elements, nodes;
    if (find_places(c, m, &elements, &nodes, e) || lattice_of(m, &l, e) || copy_materials(&c->m, m, e))
        return -1;
    for (int a = 0; a < 3; a++)
        l.spacing[a] *= 2;
    if (lattice_save(&l, &c->m, e) || model_axis_add(&c->m, "node", nodes, e) ||
        model_axis_add(&c->m, "element", elements, e) || !model_add(&c->m, "node.lattice", e) ||
        !model_add(&c->m, "element.lattice", e) || !model_add(&c->m, "node.position", e) ||
        !model_add_as(&c->m, "element.node", MODEL_I32, "@node", "element", 8, e) ||
        coarse_merge(c->fine, m, elements, c->cell, cell_place, c, &c->m, e))
        return -1;
    fill_mesh(c, &l, model_find(&c->m, "node.position"), model_find(&c->m, "element.node"));
    return make_places(c, e);
}

/* ---- Its script */

/* Curves of 1 from time 0 on, for loads of its own. */
static void add_own(coarse *c)
{
    script *s = &c->script;
    c->own = s->curves;
    for (int a = 0; a < 3; a++) {
        s->time[s->keys] = 0;
        s->value[3 * s->keys + a] = 1;
        s->curve[s->curves++] = (script_curve){.verb = SCRIPT_FORCE,
                                               .volume = -1,
                                               .key_first = (int32_t)s->keys++,
                                               .key_count = 1,
                                               .from = SCRIPT_OF_FILE};
    }
}

static int make_script(coarse *c, err *e)
{
    const script *s = c->fine->script;
    c->script = *s;
    c->script.curve = mem_array(s->curves + 3, sizeof *s->curve, "the coarser model", e);
    c->script.time = mem_array(s->keys + 3, sizeof *s->time, "the coarser model", e);
    c->script.value = mem_array(s->keys + 3, 3 * sizeof *s->value, "the coarser model", e);
    if (!c->script.curve || !c->script.time || !c->script.value)
        return -1;
    memcpy(c->script.curve, s->curve, (size_t)s->curves * sizeof *s->curve);
    memcpy(c->script.time, s->time, (size_t)s->keys * sizeof *s->time);
    memcpy(c->script.value, s->value, (size_t)s->keys * 3 * sizeof *s->value);
    for (int64_t i = 0; i < s->curves; i++) {
        script_curve *curve = &c->script.curve[i];
        curve->node_count = curve->triangle_count = 0; /* what they push at is the loads' to say */
        curve->verb = curve->verb == SCRIPT_TRACTION ? SCRIPT_FORCE : curve->verb;
    }
    add_own(c);
    return 0;
}

coarse *coarse_make(const tled_problem *fine, const model *m, err *e)
{
    coarse *c = mem_array(1, sizeof *c, "the coarser model", e);
    if (!c)
        return NULL;
    c->fine = fine;
    c->problem.threads = fine->threads;
    if (make_model(c, m, e) || make_script(c, e) ||
        tled_problem_make(&c->problem, &c->m, &c->script, fine->control, e) || coarse_holds(c, e) ||
        coarse_loads(c, e)) {
        coarse_free(c);
        return NULL;
    }
    return c;
}

void coarse_free(coarse *c)
{
    if (!c)
        return;
    tled_problem_free(&c->problem);
    free(c->script.curve);
    free(c->script.time);
    free(c->script.value);
    model_free(&c->m);
    free(c->cell);
    free(c->node);
    free(c->parent);
    free(c);
}

/* ---- Back to the finer one */

/* Whether the three edges at each corner keep their sense. */
static bool is_upright(const tled_problem *p, int64_t element, const double *u)
{
    const int32_t *node = p->element_node + 8 * element;
    for (int v = 0; v < 8; v++) {
        double edge[3][3];
        for (int w = 0; w < 8; w++) {
            int differs = 0, axis = 0;
            for (int a = 0; a < 3; a++)
                if (lattice_vtk[v][a] != lattice_vtk[w][a]) {
                    differs++;
                    axis = a;
                }
            if (differs != 1)
                continue;
            const int sign = lattice_vtk[w][axis] - lattice_vtk[v][axis];
            for (int a = 0; a < 3; a++) {
                const double at_rest = a == axis ? p->side[a] : 0;
                const double moved = u[3 * (int64_t)node[w] + a] - u[3 * (int64_t)node[v] + a];
                edge[axis][a] = at_rest + sign * moved;
            }
        }
        const double volume = edge[0][0] * (edge[1][1] * edge[2][2] - edge[1][2] * edge[2][1]) -
                              edge[0][1] * (edge[1][0] * edge[2][2] - edge[1][2] * edge[2][0]) +
                              edge[0][2] * (edge[1][0] * edge[2][1] - edge[1][1] * edge[2][0]);
        if (!(volume > 0))
            return false;
    }
    return true;
}

bool coarse_is_upright(const coarse *c, const double *displacement)
{
    for (int64_t i = 0; i < c->fine->elements; i++)
        if (!is_upright(c->fine, i, displacement))
            return false;
    return true;
}

/* Its mean over what a finer node lies between. */
static void interpolate_node(const coarse *c, int64_t n, const double *from, double to[3])
{
    const int32_t *parent = coarse_parents(c, n);
    for (int a = 0; a < 3; a++) {
        double sum = 0;
        for (int v = 0; v < 8; v++)
            sum += from[3 * (int64_t)parent[v] + a];
        to[a] = sum / 8;
    }
}

int coarse_prolong(const coarse *c, const double *from, double time, double *to, err *e)
{
    const tled_problem *p = c->fine;
    double *value = mem_array(p->script->curves, 3 * sizeof *value, "the coarser model", e);
    if (!value)
        return -1;
    tled_curves(p, time, value);
    for (int64_t n = 0; n < p->nodes; n++) {
        double at[3];
        interpolate_node(c, n, from, at);
        for (int a = 0; a < 3; a++) {
            const int32_t hold = p->hold[3 * n + a];
            to[3 * n + a] = hold == HOLD_FREE    ? at[a]
                            : hold == HOLD_STILL ? p->at_start.of[TLED_DISPLACEMENT][3 * n + a]
                                                 : moves_to(value, hold, a, p->position + 3 * n);
        }
    }
    free(value);
    return coarse_is_upright(c, to) ? 0 : 1;
}

void coarse_interpolate(const coarse *c, const double *from, double *to)
{
    for (int64_t n = 0; n < c->fine->nodes; n++) {
        interpolate_node(c, n, from, to + 3 * n);
        for (int a = 0; a < 3; a++)
            if (c->fine->hold[3 * n + a] != HOLD_FREE)
                to[3 * n + a] = 0;
    }
}

void coarse_restrict(const coarse *c, const double *from, double *to)
{
    const int32_t *hold = c->problem.hold;
    memset(to, 0, 3 * (size_t)c->problem.nodes * sizeof *to);
    for (int64_t n = 0; n < c->fine->nodes; n++) {
        const int32_t *parent = coarse_parents(c, n);
        for (int v = 0; v < 8; v++)
            for (int a = 0; a < 3; a++) {
                const int64_t i = 3 * (int64_t)parent[v] + a;
                if (c->fine->hold[3 * n + a] == HOLD_FREE && hold[i] == HOLD_FREE)
                    to[i] += from[3 * n + a] / 8;
            }
    }
}
