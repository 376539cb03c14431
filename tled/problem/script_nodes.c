#include "base/near.h"
#include "mesh/lattice.h"
#include "surface/surface.h"
#include "tled/problem/script.h"

#include "base/mem.h"

#include <math.h>

static int node_add(script *s, int64_t node, err *e)
{
    if (s->nodes >= INT32_MAX)
        return err_set(e, NULL, 0, "the script's targets have more than %d nodes in all", INT32_MAX);
    if (mem_grow(&s->node, &s->node_capacity, s->nodes + 1, sizeof *s->node, "the script's nodes", e))
        return -1;
    s->node[s->nodes++] = (int32_t)node;
    s->curve[s->curves - 1].node_count++;
    return 0;
}

int script_nodes_in_ball(script *s, const model *m, const keyfile *k, const double near[3], const script_curve *c,
                         err *e)
{
    const model_array *position = model_need(m, "node.position", e);
    if (!position)
        return -1;
    double nearest = INFINITY, *p = position->f64;
    int64_t found = 0;
    for (int64_t i = 0; i < position->rows; i++, p += 3) {
        double away = hypot(hypot(p[0] - c->box[0], p[1] - c->box[1]), p[2] - c->box[2]);
        nearest = away < nearest ? away : nearest;
        if (away > c->box[3] + fmax(near[0], fmax(near[1], near[2])))
            continue;
        if (node_add(s, i, e))
            return -1;
        found++;
    }
    if (!found)
        return keyfile_error(k, e, "no node lies within %g m of %g,%g,%g; the nearest is %g m away", c->box[3],
                             c->box[0], c->box[1], c->box[2], nearest);
    return 0;
}

int script_nodes_in_box(script *s, const model *m, const keyfile *k, const double near[3], const script_curve *c,
                        err *e)
{
    const model_array *position = model_need(m, "node.position", e);
    int64_t found = 0;
    for (int64_t i = 0; position && i < position->rows; i++) {
        const double *p = position->f64 + 3 * i, *low = c->box, *high = c->box + 3;
        bool outside = false;
        for (int a = 0; a < 3; a++)
            outside |= p[a] < low[a] - near[a] || p[a] > high[a] + near[a];
        if (outside)
            continue;
        if (node_add(s, i, e))
            return -1;
        found++;
    }
    if (position && !found)
        return keyfile_error(k, e,
                             "no node lies in the box %s; expected X0,Y0,Z0,X1,Y1,Z1 around some, in metres "
                             "or with suffixes",
                             c->target);
    return position ? 0 : -1;
}

/* Bone that films hang on has no nodes, but rows of films (films.h), which count on from the nodes. */
static int add_films(script *s, const model *m, const char *name, const char *target, int32_t body, int64_t *found,
                     err *e)
{
    const model_array *of = model_find(m, name), *names = model_find(m, "anchor.name");
    for (int64_t i = 0; of && i < of->rows; i++) {
        const bool mine =
            target ? of->i32[i] >= 0 && surface_in_group(names->str[of->i32[i]], target) : of->i32[i] == body;
        if (mine && node_add(s, model_count(m, "node") + i, e))
            return -1;
        *found += mine;
    }
    return 0;
}

static bool is_by_films(const model *m)
{
    return model_find(m, "bone.element") != NULL;
}

int script_nodes_of_surface(script *s, const model *m, const keyfile *k, const script_curve *c, err *e)
{
    const model_array *anchor = model_need(m, "node.anchor", e), *names = model_need(m, "anchor.name", e);
    if (!anchor || !names)
        return -1;
    bool known = false;
    for (int64_t i = 0; i < names->rows; i++)
        known = known || surface_in_group(names->str[i], c->target);
    if (!known)
        return near_unknown(e, k->name, k->line, "rigid surface", c->target, (const char *const *)names->str,
                            names->rows < INT32_MAX ? (int)names->rows : INT32_MAX);
    int64_t found = 0;
    if (is_by_films(m) && add_films(s, m, "bone.anchor", c->target, -1, &found, e))
        return -1;
    for (int64_t i = 0; !is_by_films(m) && i < anchor->rows; i++) {
        int32_t a = anchor->i32[i];
        if (a < 0 || !surface_in_group(names->str[a], c->target))
            continue;
        if (node_add(s, i, e))
            return -1;
        found++;
    }
    return found ? 0
                 : keyfile_error(k, e, "no node is held by '%.200s'; expected a surface that holds some", c->target);
}

/* Whether nodes slide on a body, which then need not hold any. */
static bool slides_on(const model *m, int32_t body)
{
    const model_array *of = model_find(m, "field.body");
    for (int64_t i = 0; of && i < of->rows; i++)
        if (of->i32[i] == body)
            return true;
    return false;
}

int script_nodes_of_body(script *s, const model *m, const keyfile *k, int32_t body, err *e)
{
    const model_array *of = model_need(m, "node.body", e);
    int64_t found = slides_on(m, body);
    if (is_by_films(m) && add_films(s, m, "bone.body", NULL, body, &found, e))
        return -1;
    for (int64_t i = 0; of && !is_by_films(m) && i < of->rows; i++) {
        if (of->i32[i] != body)
            continue;
        if (node_add(s, i, e))
            return -1;
        found++;
    }
    if (of && !found)
        return keyfile_error(k, e, "body '%.200s' has no node; expected one that holds some",
                             model_find(m, "body.name")->str[body]);
    return of ? 0 : -1;
}

/* Sides of voxels are seldom whole in binary: 3 x 1.1 mm is more than 3.3 mm by a rounding. */
void script_near(const model *m, double near[3])
{
    lattice l;
    err none = {0};
    bool known = model_meta_of(m, "lattice.spacing") && !lattice_of(m, &l, &none);
    for (int a = 0; a < 3; a++)
        near[a] = known ? 1e-9 * l.spacing[a] : 0;
}
