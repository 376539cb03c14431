/* A step of PST's skin (msds/run/skin.h), a vertex at a time: one source for the processor and for cards, with the same
 * bytes. A view borrows all that it points to.
 */
#ifndef SINEW_SKIN_STEP_H
#define SINEW_SKIN_STEP_H

#include "probe/probe.h"

#include <stdbool.h>
#include <stdint.h>

#define SKIN_FUNCTION PROBE_FUNCTION

/* A spring that has collapsed counts as this share of its length, at least. */
#define SKIN_LEAST 1e-5

typedef struct skin_options {
    double stiffness; /* N/m: of an edge's spring */
    double anchors;   /* an anchor's stiffness over the sum of its vertex's springs' */
    double tension;   /* how stiff an edge's spring is across itself, as under tension, over its stiffness */
    double damping;   /* s: of a spring over its stiffness */
    double dt;        /* s */
} skin_options;

typedef struct skin_spring { /* as one end sees it */
    int32_t other;
    double rest; /* m */
} skin_spring;

typedef struct skin_view {
    int64_t vertices, edges;
    skin_options options;
    const double *position; /* vertices x 3, m */
    const int64_t *start;   /* vertices + 1: their springs, of twice the edges: */
    const skin_spring *spring;
    const double *inertia, *anchor, *held; /* vertices: kg; N/m; N s/m: the anchor's damping */
    const double *u, *v;                   /* vertices x 3: m, m/s */
    double *next_u, *next_v;
} skin_view;

/* Adds what an edge pulls its vertex v with: its spring and damper (PST equation 1), and, as under tension, a share of
 * both across itself. */
SKIN_FUNCTION void skin_pull(const skin_view *s, int64_t v, const skin_spring *spring, double *force)
{
    const double *x = s->position, *u = s->u, *w = s->v, k = s->options.stiffness;
    const int64_t o = spring->other;
    double d[3], length = 0, speed = 0;
    for (int a = 0; a < 3; a++) {
        d[a] = (x[3 * o + a] - x[3 * v + a]) + (u[3 * o + a] - u[3 * v + a]);
        length += d[a] * d[a];
        speed += d[a] * (w[3 * o + a] - w[3 * v + a]);
    }
    length = fmax(sqrt(length), SKIN_LEAST * spring->rest);
    const double across = s->options.tension * k;
    double by = (k * (length - spring->rest) + s->options.damping * k * speed / length) / length;
    for (int a = 0; a < 3; a++)
        force[a] +=
            by * d[a] + across * ((u[3 * o + a] - u[3 * v + a]) + s->options.damping * (w[3 * o + a] - w[3 * v + a]));
}

/* A vertex that the step would leave in the probe comes to its surface. */
SKIN_FUNCTION void skin_push(const skin_view *s, const probe_placed *at, int64_t v)
{
    double *u = s->next_u + 3 * v, *speed = s->next_v + 3 * v, x[3], away = 0, along = 0;
    for (int a = 0; a < 3; a++) {
        x[a] = s->position[3 * v + a] + u[a];
        away += (x[a] - at->centre[a]) * (x[a] - at->centre[a]);
    }
    if (away > at->reach * at->reach)
        return;
    probe_touch t = probe_at(at, x);
    if (!(t.depth > 0))
        return;
    for (int a = 0; a < 3; a++)
        along += t.way[a] * speed[a];
    for (int a = 0; a < 3; a++) {
        u[a] += t.depth * t.way[a];
        speed[a] -= fmin(0., along) * t.way[a];
    }
}

/* PST equations 3 to 5. A vertex of no triangle stays. at: NULL: there is none. */
SKIN_FUNCTION void skin_step_vertex(const skin_view *s, const probe_placed *at, int64_t v)
{
    double force[3];
    for (int a = 0; a < 3; a++)
        force[a] = -s->anchor[v] * s->u[3 * v + a] - s->held[v] * s->v[3 * v + a];
    for (int64_t i = s->start[v]; i < s->start[v + 1]; i++)
        skin_pull(s, v, &s->spring[i], force);
    for (int a = 0; a < 3; a++) {
        double speed = s->inertia[v] > 0 ? s->v[3 * v + a] + s->options.dt / s->inertia[v] * force[a] : 0;
        s->next_v[3 * v + a] = speed;
        s->next_u[3 * v + a] = s->u[3 * v + a] + s->options.dt * speed;
    }
    if (at && s->inertia[v] > 0)
        skin_push(s, at, v);
}

#endif
