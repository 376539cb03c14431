/* What iterative solvers of finite elements do with the nodes that a probe presses (contacts.h), for cg.c and tissue.c:
 * fields are in the solver's order. Prescribed contact moves a node along its way, and keeps the search out of that;
 * a penalty stiffens it. Owns nothing.
 */
#ifndef SINEW_PRESSED_H
#define SINEW_PRESSED_H

#include "msds/cpu/contacts.h"

typedef struct pressed {
    const msds_problem *p;
    const sell *s;
    contacts *c;
} pressed;

static inline double pressed_along(const lanes_field *f, int32_t own, const contact *c)
{
    return c->way[0] * (double)f->x[0][own] + c->way[1] * (double)f->x[1][own] + c->way[2] * (double)f->x[2][own];
}

static inline void pressed_add(lanes_field *f, int32_t own, const contact *c, double amount)
{
    for (int a = 0; a < 3; a++)
        f->x[a][own] += (float)(amount * c->way[a]);
}

/* Prescribed: moves nodes in f by what they have to go. */
static inline void pressed_move(const pressed *k, lanes_field *f)
{
    for (int64_t i = 0; i < k->c->count && !k->p->options.penalty; i++)
        pressed_add(f, k->s->own_node[k->c->list[i].node], &k->c->list[i], k->c->list[i].depth);
}

/* Prescribed: takes out of f what it has along the ways. */
static inline void pressed_keep_out(const pressed *k, lanes_field *f)
{
    for (int64_t i = 0; i < k->c->count && !k->p->options.penalty; i++) {
        const int32_t own = k->s->own_node[k->c->list[i].node];
        pressed_add(f, own, &k->c->list[i], -pressed_along(f, own, &k->c->list[i]));
    }
}

/* The part of f at a node that lies in the contact's plane. */
static inline void pressed_beside(const lanes_field *f, int32_t own, const contact *c, double beside[3])
{
    const double along = pressed_along(f, own, c);
    for (int a = 0; a < 3; a++)
        beside[a] = (double)f->x[a][own] - along * c->way[a];
}

/* Friction: adds its springs' stiffness times `way` to `pulled`. Returns what that adds to way . pulled. */
static inline double pressed_grip(const pressed *k, const lanes_field *way, lanes_field *pulled)
{
    double sum = 0, beside[3];
    for (int64_t i = 0; i < k->c->count && k->p->options.friction > 0; i++) {
        const contact *c = &k->c->list[i];
        const int32_t own = k->s->own_node[c->node];
        if (!(c->grip > 0))
            continue;
        pressed_beside(way, own, c, beside);
        for (int a = 0; a < 3; a++) {
            pulled->x[a][own] += (float)(c->grip * beside[a]);
            sum += c->grip * beside[a] * beside[a];
        }
    }
    return sum;
}

/* Friction: what a contact's spring pulls its node with at u. */
static inline void pressed_friction(const pressed *k, const contact *c, const lanes_field *u, double force[3])
{
    const int32_t own = k->s->own_node[c->node];
    double along = 0;
    for (int a = 0; a < 3; a++) {
        force[a] = c->grip > 0 ? c->grip * (c->to[a] - (double)u->x[a][own]) : 0;
        along += force[a] * c->way[a];
    }
    for (int a = 0; a < 3; a++)
        force[a] -= along * c->way[a];
}

/* Notes it after a step, no more than the contact's force allows. */
static inline void pressed_drag(const pressed *k, contact *c, const lanes_field *u)
{
    double square = 0;
    const double most = k->p->options.friction * fmax(c->force, 0);
    pressed_friction(k, c, u, c->drag);
    for (int a = 0; a < 3; a++)
        square += c->drag[a] * c->drag[a];
    for (int a = 0; a < 3 && square > most * most; a++)
        c->drag[a] *= most / sqrt(square);
}

/* Penalty and friction: adds their stiffness times `way` to `pulled`. Returns what that adds to way . pulled. */
static inline double pressed_stiffen(const pressed *k, const lanes_field *way, lanes_field *pulled)
{
    double sum = pressed_grip(k, way, pulled);
    for (int64_t i = 0; i < k->c->count && k->p->options.penalty; i++) {
        const contact *c = &k->c->list[i];
        const int32_t own = k->s->own_node[c->node];
        const double by = pressed_along(way, own, c);
        pressed_add(pulled, own, c, k->p->repulsion[c->node] * by);
        sum += k->p->repulsion[c->node] * by * by;
    }
    return sum;
}

/* How deep a node still is, at u. */
static inline double pressed_depth(const pressed *k, const contact *c, const lanes_field *u)
{
    const int32_t own = k->s->own_node[c->node];
    double gone = 0;
    for (int a = 0; a < 3; a++)
        gone += c->way[a] * ((double)u->x[a][own] - c->from[a]);
    return c->depth - gone;
}

/* Penalty and friction: adds the forces at u to f. */
static inline void pressed_push(const pressed *k, const lanes_field *u, lanes_field *f)
{
    double drag[3];
    for (int64_t i = 0; i < k->c->count && k->p->options.friction > 0; i++) {
        pressed_friction(k, &k->c->list[i], u, drag);
        for (int a = 0; a < 3; a++)
            f->x[a][k->s->own_node[k->c->list[i].node]] += (float)drag[a];
    }
    for (int64_t i = 0; i < k->c->count && k->p->options.penalty; i++) {
        const contact *c = &k->c->list[i];
        pressed_add(f, k->s->own_node[c->node], c, k->p->repulsion[c->node] * pressed_depth(k, c, u));
    }
}

/* What a contact's force, which is known, changes the squares of |left| and of |weight| by; left: gravity less what the
 * elements pull with. */
static inline void pressed_count(const pressed *k, const contact *c, const lanes_field *left, const lanes_field *weight,
                                 double *square, double *load)
{
    const int32_t own = k->s->own_node[c->node];
    for (int a = 0; a < 3; a++) {
        const double rest = (double)left->x[a][own], heavy = (double)weight->x[a][own],
                     by = c->force * c->way[a] + c->drag[a];
        *square += (rest + by) * (rest + by) - rest * rest;
        *load += (heavy + by) * (heavy + by) - heavy * heavy;
    }
}

#endif
