/* The CPU executor for meshes without a lattice: its memory and its passes; part of cpu_loops.h. Nodes are in the
 * model's order. Elements lie in groups of as many as the pass has lanes; the last group is filled with elements of no
 * volume and no law, at the last element's nodes.
 */
#include "physics/element_any.h"

enum { MESH_GROUPS = 32, MESH_NODES = 512 }; /* to a chunk; the latter a multiple of any number of lanes */

static int64_t mesh_groups(const cpu_state *s)
{
    return (s->p->elements + s->pass->lanes - 1) / s->pass->lanes;
}

/* Rows that are none: places, cells and extras only. */
static int mesh_rows(cpu_state *s, err *e)
{
    const tled_problem *p = s->p;
    rows *r = &s->rows;
    *r = (rows){.lanes = s->pass->lanes, .cells = (int32_t)p->elements, .nodes = p->nodes + ROWS_PAD};
    r->place = mem_array(p->nodes, sizeof *r->place, "the solver", e);
    r->cell_element = mem_array(p->elements, sizeof *r->cell_element, "the solver", e);
    if (!r->place || !r->cell_element)
        return -1;
    for (int64_t i = 0; i < p->elements; i++)
        r->cell_element[i] = (int32_t)i;
    for (int64_t n = 0; n < p->nodes; n++)
        r->place[n] = (int32_t)n;
    return rows_list_extras(r, p, e);
}

/* Numbers that an element has of shape and law. */
static int64_t mesh_numbers(const cpu_state *s)
{
    return cpu_mesh_numbers(s->p->form, s->p->control.kind);
}

static int mesh_allocate(cpu_state *s, err *e)
{
    const int64_t places = mesh_groups(s) * s->pass->lanes;
    s->mesh_bytes = places * ((mesh_numbers(s) + 24) * (int64_t)sizeof(number) + 8 * (int64_t)sizeof *s->group_node);
    s->shape = mem_array(places, (size_t)mesh_numbers(s) * sizeof *s->shape, "the solver", e);
    s->force = mem_array(places, 24 * sizeof *s->force, "the solver", e);
    s->group_node = mem_array(places, 8 * sizeof *s->group_node, "the solver", e);
    return s->shape && s->force && s->group_node ? 0 : -1;
}

/* What element i has of shape and law. */
static void mesh_element(const cpu_state *s, int64_t i, double *own)
{
    const conforming_element *c = &s->p->conforming->element[i];
    const tled_law law = tled_law_of(s->p, i);
    const conforming_hold hold = conforming_hold_of(s->p, i);
    const double share = tled_fraction(s->p, i);
    memcpy(own, c->slope, sizeof c->slope);
    memcpy(own + 3 * ELEMENT_MODES, c->twist, sizeof c->twist);
    own[CPU_SHAPE - 1] = c->volume;
    own += CPU_SHAPE;
    if (s->p->control.kind == HOURGLASS_PHYSICAL) {
        memcpy(own, hold.basis, sizeof hold.basis);
        for (int k = 0; k < HOURGLASS_NUMBERS; k++)
            own[9 + k] = share * hold.law[k];
    } else {
        own[0] = share * hold.law[HOURGLASS_K];
    }
    own += cpu_hold_numbers(s->p->control.kind);
    for (int k = 0; k < form_numbers(s->p->form); k++)
        own[k] = (k < form_moduli(s->p->form) ? share : 1) * law.c[k];
}

static void mesh_fill(cpu_state *s)
{
    const tled_problem *p = s->p;
    const int64_t lanes = s->pass->lanes, places = mesh_groups(s) * lanes, numbers = mesh_numbers(s);
    for (int64_t i = 0; i < places; i++) {
        const int64_t element = i < p->elements ? i : p->elements - 1, group = i / lanes, lane = i % lanes;
        double own[CPU_SHAPE + 9 + HOURGLASS_NUMBERS + FORM_NUMBERS] = {0};
        if (i < p->elements)
            mesh_element(s, i, own);
        for (int k = 0; k < numbers; k++)
            s->shape[(group * numbers + k) * lanes + lane] = (number)own[k];
        for (int c = 0; c < 8; c++)
            s->group_node[(group * 8 + c) * lanes + lane] = p->element_node[8 * element + c];
    }
}

static int mesh_make(cpu_state *s, err *e)
{
    if (mesh_rows(s, e) || mesh_allocate(s, e))
        return -1;
    mesh_fill(s);
    return 0;
}

static void mesh_element_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    (void)chunk;
    s->pass->elements(&s->work, from, to);
}

static void mesh_node_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    (void)chunk;
    s->pass->nodes(&s->work, from, to);
}

static void mesh_pass(cpu_state *s)
{
    pool_run(s->threads, mesh_groups(s), MESH_GROUPS, mesh_element_work, s);
    pool_run(s->threads, s->p->nodes, MESH_NODES, mesh_node_work, s);
}
