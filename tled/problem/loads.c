#include "tled/problem/loads.h"

#include "base/mem.h"
#include "mesh/bound.h"
#include "surface/triangle.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct load {
    int32_t node, curve, spring;
    double share;
} load;

typedef struct loads {
    load *list; /* by curve */
    int64_t count, room;
} loads;

static int add_load(loads *l, int64_t node, int64_t curve, int64_t spring, double share, err *e)
{
    if (l->count >= INT32_MAX)
        return err_set(e, NULL, 0, "forces on more than %d nodes in all", INT32_MAX);
    if (MEM_ROOM(&l->list, &l->room, l->count + 1, "the forces", e))
        return -1;
    l->list[l->count++] = (load){(int32_t)node, (int32_t)curve, (int32_t)spring, share};
    return 0;
}

/* An equal share for each node. spring: the curve of a spring's factor, or -1. */
static int add_force(loads *l, const script *s, int64_t curve, int64_t spring, double whole, err *e)
{
    const script_curve *c = &s->curve[curve];
    for (int32_t i = 0; i < c->node_count; i++)
        if (add_load(l, s->node[c->node_first + i], curve, spring, whole / c->node_count, e))
            return -1;
    return 0;
}

/* Adds a third of a triangle's area at rest to the nodes of each vertex. area: nodes, m2. */
static void add_area(const bound *b, const int32_t *corner, double part, double *area)
{
    double twice[3], share[8];
    triangle_normal(b->shape.position + 3 * (int64_t)corner[0], b->shape.position + 3 * (int64_t)corner[1],
                    b->shape.position + 3 * (int64_t)corner[2], twice);
    const double third = part * triangle_length(twice) / 6;
    for (int i = 0; i < 3; i++) {
        const int32_t *node = b->node + 8 * (int64_t)b->element[corner[i]];
        bound_shares(b, corner[i], share);
        for (int k = 0; k < 8; k++)
            area[node[k]] += third * share[k];
    }
}

static int add_traction(loads *l, const tled_problem *p, const model *m, int64_t curve, err *e)
{
    const script_curve *c = &p->script->curve[curve];
    bound b;
    double *area = mem_array(p->nodes, sizeof *area, "the forces", e);
    int status = area && bound_of(&b, m, c->surface, e) >= 0 ? 0 : -1;
    for (int32_t i = 0; i < c->triangle_count && !status; i++)
        add_area(&b, p->script->corner + 3 * (int64_t)(c->triangle_first + i), p->script->part[c->triangle_first + i],
                 area);
    for (int64_t n = 0; n < p->nodes && !status; n++)
        if (area[n] != 0)
            status = add_load(l, n, curve, -1, area[n], e);
    free(area);
    return status;
}

/* Each curve's shares, listed by node in the order of the curves. */
static int sort_loads(tled_problem *p, const loads *l, err *e)
{
    p->force_start = mem_array(p->nodes + 2, sizeof *p->force_start, "the forces", e);
    p->force_curve = mem_array(l->count, sizeof *p->force_curve, "the forces", e);
    p->force_spring = mem_array(l->count, sizeof *p->force_spring, "the forces", e);
    p->force_share = mem_array(l->count, sizeof *p->force_share, "the forces", e);
    if (!p->force_start || !p->force_curve || !p->force_spring || !p->force_share)
        return -1;
    if (!l->count)
        return 0;
    /* Counts two places on, so that filling moves each start to where it belongs. */
    for (int64_t i = 0; i < l->count; i++)
        p->force_start[l->list[i].node + 2]++;
    for (int64_t n = 0; n < p->nodes; n++)
        p->force_start[n + 2] += p->force_start[n + 1];
    for (int64_t i = 0; i < l->count; i++) {
        const int32_t at = p->force_start[l->list[i].node + 1]++;
        p->force_curve[at] = l->list[i].curve;
        p->force_spring[at] = l->list[i].spring;
        p->force_share[at] = l->list[i].share;
    }
    return 0;
}

int loads_make(tled_problem *p, const model *m, err *e)
{
    const script *s = p->script;
    loads l = {.count = 0};
    int status = 0;
    for (int64_t c = 0; c < s->curves && !status; c++) {
        if (s->curve[c].verb == SCRIPT_FORCE)
            status = add_force(&l, s, c, -1, 1, e);
        if (s->curve[c].verb == SCRIPT_PULL)
            status = add_force(&l, s, c, c + 1, s->curve[c].stiffness, e);
        if (s->curve[c].verb == SCRIPT_TRACTION)
            status = add_traction(&l, p, m, c, e);
    }
    if (!status)
        status = sort_loads(p, &l, e);
    free(l.list);
    return status;
}

static bool has_springs(const script *s)
{
    for (int64_t i = 0; i < s->curves; i++)
        if (s->curve[i].verb == SCRIPT_PULL)
            return true;
    return false;
}

double loads_square(const tled_problem *p, const double *value)
{
    double most = 0;
    if (!has_springs(p->script))
        return 0;
    for (int64_t n = 0; n < p->nodes; n++) {
        double sum = 0;
        for (int32_t i = p->force_start[n]; i < p->force_start[n + 1]; i++)
            if (p->force_spring[i] >= 0)
                sum += p->force_share[i] * (value ? value[3 * (int64_t)p->force_spring[i]] : 1);
        most = fmax(most, sum / p->mass[n]);
    }
    return most;
}

static double longest_edge(const surface *from, const int32_t *corner, int64_t triangles)
{
    double longest = 0;
    for (int64_t i = 0; i < 3 * triangles; i++) {
        const double *a = from->position + 3 * (int64_t)corner[i];
        const double *b = from->position + 3 * (int64_t)corner[i % 3 == 2 ? i - 2 : i + 1];
        longest = fmax(longest, triangle_distance(a, b));
    }
    return longest;
}

void loads_check(const tled_problem *p, const model *m, notes *warnings)
{
    const script *s = p->script;
    const double side = fmax(p->side[0], fmax(p->side[1], p->side[2]));
    for (int64_t i = 0; i < s->curves; i++) {
        const script_curve *c = &s->curve[i];
        surface from;
        err none = {0};
        if (!c->surface || surface_of(m, c->surface, &from, &none))
            continue;
        const double edge = longest_edge(&from, s->corner + 3 * (int64_t)c->triangle_first, c->triangle_count);
        if (edge > 2 * side)
            notes_add(warnings,
                      "%s:%" PRId64 ": triangles of '%.100s' are up to %.3g mm wide, elements %.3g mm: the load acts "
                      "at their corners alone; expected a finer surface",
                      s->file, c->line, c->surface, 1e3 * edge, 1e3 * side);
    }
}
