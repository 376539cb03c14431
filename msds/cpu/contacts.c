#include "msds/cpu/contacts.h"

#include "base/mem.h"
#include "msds/problem/newton.h"

#include <stdlib.h>
#include <string.h>

typedef struct search {
    contacts *c;
    const lanes *loops;
    const lanes_springs *w;
} search;

int contacts_make(contacts *c, const sell *s, int64_t nodes, err *e)
{
    c->list = mem_array(nodes, sizeof *c->list, "contact", e);
    c->held = mem_array(nodes, sizeof *c->held, "contact", e);
    c->found = mem_array(s->nodes, sizeof *c->found, "contact", e);
    c->amount = mem_array(pool_chunks(s->count, SELL_CHUNK), sizeof *c->amount, "contact", e);
    return c->list && c->held && c->found && c->amount ? 0 : -1;
}

void contacts_free(contacts *c)
{
    free(c->list);
    free(c->held);
    free(c->found);
    free(c->amount);
    *c = (contacts){0};
}

static void search_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    search *s = context;
    s->c->amount[chunk] = s->loops->inside(s->w, from, to, s->c->found + from * LANES);
}

/* Where a node is, m, and by how far moved. */
static void place_of(const lanes_springs *w, const msds_problem *p, const double *u, int64_t node, double moved[3],
                     double x[3])
{
    for (int a = 0; a < 3; a++) {
        moved[a] = u ? u[3 * node + a] : (double)w->u.x[a][w->s->own_node[node]];
        x[a] = p->position[3 * node + a] + moved[a];
    }
}

static void consider(contacts *c, const lanes_springs *w, const msds_problem *p, const double *u, int32_t own,
                     contacts_rule rule)
{
    contact at = {.node = w->s->model_node[own]};
    double x[3];
    place_of(w, p, u, at.node, at.from, x);
    probe_touch t = probe_at(w->probe, x);
    at.depth = t.depth;
    memcpy(at.way, t.way, sizeof at.way);
    at.force = fmax(0, c->held[at.node]);
    double slack = at.force > 0 ? CONTACT_CLINGING : 0;
    if (rule == CONTACTS_NEAR)
        slack = CONTACT_NEAR_BY;
    bool follows = rule == CONTACTS_NEAR && at.force > 0;
    if (!p->fixed[at.node] && (follows || at.depth > -slack * w->probe->shape.size))
        c->list[c->count++] = at;
}

/* Nodes in the ball, to c->found; goes through them in the solver's order, whatever the threads did. */
static void look_for(contacts *c, const lanes *loops, lanes_springs *w, pool *threads)
{
    search s = {c, loops, w};
    float reach = w->reach;
    w->reach = (float)(w->probe->reach + 1.01 * CONTACT_NEAR_BY * w->probe->shape.size);
    pool_run(threads, w->s->count, SELL_CHUNK, search_work, &s);
    w->reach = reach;
}

void contacts_find(contacts *c, const lanes *loops, lanes_springs *w, const msds_problem *p, const double *u,
                   pool *threads, contacts_rule rule)
{
    look_for(c, loops, w, threads);
    c->count = 0;
    for (int64_t chunk = 0; chunk < pool_chunks(w->s->count, SELL_CHUNK); chunk++)
        for (int64_t i = 0; i < c->amount[chunk]; i++)
            consider(c, w, p, u, c->found[chunk * SELL_CHUNK * LANES + i], rule);
}

bool contacts_missed(contacts *c, const lanes *loops, lanes_springs *w, const msds_problem *p, const double *u,
                     pool *threads, double depth)
{
    bool missed = false;
    double x[3];
    contacts_hold(c, p);
    look_for(c, loops, w, threads);
    for (int64_t chunk = 0; chunk < pool_chunks(w->s->count, SELL_CHUNK); chunk++)
        for (int64_t i = 0; i < c->amount[chunk]; i++) {
            int64_t node = w->s->model_node[c->found[chunk * SELL_CHUNK * LANES + i]];
            for (int a = 0; a < 3; a++)
                x[a] = p->position[3 * node + a] + u[3 * node + a];
            missed = missed || (!p->fixed[node] && c->held[node] == 0 && probe_at(w->probe, x).depth > depth);
        }
    return missed;
}

void contacts_hold(contacts *c, const msds_problem *p)
{
    memset(c->held, 0, (size_t)p->nodes * sizeof *c->held);
    for (int64_t i = 0; i < c->count; i++)
        c->held[c->list[i].node] = c->list[i].force > 0 ? c->list[i].force : -1;
}

int64_t contacts_held(const contacts *c, const msds_problem *p)
{
    int64_t held = 0;
    for (int64_t n = 0; n < p->nodes; n++)
        held += c->held[n] > 0;
    return held;
}

int64_t contacts_sum(const contacts *c, double force[3])
{
    int64_t pressed = 0;
    force[0] = force[1] = force[2] = 0;
    for (int64_t i = 0; i < c->count; i++) {
        pressed += c->list[i].force > 0;
        for (int a = 0; a < 3; a++)
            force[a] -= c->list[i].force * c->list[i].way[a] + c->list[i].drag[a];
    }
    return pressed;
}

void contacts_twist(const contacts *c, const lanes_springs *w, const msds_problem *p, const double *u, double torque[3])
{
    double moved[3], x[3], force[3];
    torque[0] = torque[1] = torque[2] = 0;
    for (int64_t i = 0; i < c->count; i++) {
        place_of(w, p, u, c->list[i].node, moved, x);
        for (int a = 0; a < 3; a++)
            force[a] = -c->list[i].force * c->list[i].way[a] - c->list[i].drag[a];
        probe_torque(w->probe, x, force, torque);
    }
}
