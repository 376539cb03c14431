#include "msds/cpu/grips.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

int grips_make(grips *g, int64_t nodes, err *e)
{
    g->hold = mem_array(nodes, 3 * sizeof *g->hold, "contact", e);
    g->is = mem_array(nodes, sizeof *g->is, "contact", e);
    g->node = mem_array(nodes, sizeof *g->node, "contact", e);
    return g->hold && g->is && g->node ? 0 : -1;
}

void grips_free(grips *g)
{
    free(g->hold);
    free(g->is);
    free(g->node);
    *g = (grips){0};
}

void grips_clear(grips *g)
{
    for (int64_t i = 0; i < g->count; i++)
        g->is[g->node[i]] = 0;
    g->count = 0;
}

static void to_probe(const probe_placed *at, const double x[3], double own[3])
{
    for (int i = 0; i < 3; i++)
        own[i] = at->axis[i][0] * (x[0] - at->origin[0]) + at->axis[i][1] * (x[1] - at->origin[1]) +
                 at->axis[i][2] * (x[2] - at->origin[2]);
}

static void from_probe(const probe_placed *at, const double own[3], double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = at->origin[a] + at->axis[0][a] * own[0] + at->axis[1][a] * own[1] + at->axis[2][a] * own[2];
}

/* From a node at its place and u, along the contact's plane, to the place that it holds: d, m. Returns the distance. */
static double away(const grips *g, const contact *c, const msds_problem *p, const probe_placed *at, const double u[3],
                   double d[3])
{
    const double *rest = p->position + 3 * (int64_t)c->node;
    double x[3], along = 0, square = 0;
    from_probe(at, g->hold + 3 * (int64_t)c->node, x);
    for (int a = 0; a < 3; a++) {
        d[a] = x[a] - rest[a] - u[a];
        along += d[a] * c->way[a];
    }
    for (int a = 0; a < 3; a++) {
        d[a] -= along * c->way[a];
        square += d[a] * d[a];
    }
    return sqrt(square);
}

/* How far its spring stretches at most, m. */
static double most_of(const contact *c, const msds_problem *p)
{
    return p->options.friction * fmax(c->force, 0) / p->repulsion[c->node];
}

/* The spring of a node. Where it would pull too hard, one as much weaker: in rounds, these come to Coulomb's force. */
static void take(const grips *g, contact *c, const msds_problem *p, const probe_placed *at)
{
    double d[3];
    const double distance = away(g, c, p, at, c->from, d), most = most_of(c, p);
    c->grip = p->repulsion[c->node] * (distance > most ? most / distance : 1);
    for (int a = 0; a < 3; a++)
        c->to[a] = c->from[a] + d[a];
}

void grips_take(grips *g, contacts *c, const msds_problem *p, const probe_placed *at)
{
    if (!(p->options.friction > 0)) {
        grips_clear(g);
        return;
    }
    for (int64_t i = 0; i < c->count; i++)
        if (g->is[c->list[i].node] && c->list[i].force > 0)
            take(g, &c->list[i], p, at);
}

/* The place that a node holds comes after it as far as it slipped; one that holds none yet takes hold. */
static void keep(grips *g, const contact *c, const msds_problem *p, const probe_placed *at, const double u[3])
{
    double x[3], d[3] = {0};
    const double distance = g->is[c->node] ? away(g, c, p, at, u, d) : 0, most = most_of(c, p);
    if (g->is[c->node] && distance <= most)
        return;
    for (int a = 0; a < 3; a++)
        x[a] = p->position[3 * (int64_t)c->node + a] + u[a] + (distance > 0 ? d[a] * most / distance : 0);
    to_probe(at, x, g->hold + 3 * (int64_t)c->node);
}

void grips_keep(grips *g, const contacts *c, const msds_problem *p, const lanes_springs *w)
{
    if (!(p->options.friction > 0))
        return;
    for (int64_t i = 0; i < c->count; i++) {
        const contact *at = &c->list[i];
        double u[3];
        for (int a = 0; a < 3; a++)
            u[a] = (double)w->u.x[a][w->s->own_node[at->node]];
        if (at->force > 0)
            keep(g, at, p, w->probe, u);
    }
    grips_clear(g);
    for (int64_t i = 0; i < c->count; i++)
        if (c->list[i].force > 0) {
            g->is[c->list[i].node] = 1;
            g->node[g->count++] = c->list[i].node;
        }
}
