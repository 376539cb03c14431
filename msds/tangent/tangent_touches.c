#include "msds/tangent/tangent_touches.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* The share of the probe's size over which the way out is taken to change. */
static const double near = 1e-4;

static void cross(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void axis_of(int j, double axis[3])
{
    for (int a = 0; a < 3; a++)
        axis[a] = a == j % 3;
}

void tangent_touches_rigid(const tangent_touch *c, int j, double d[3])
{
    double axis[3];
    axis_of(j, axis);
    if (j < 3)
        memcpy(d, axis, sizeof axis);
    else
        cross(axis, c->arm, d);
}

void tangent_touches_turned(const tangent_touch *c, int j, double f[3])
{
    double axis[3];
    axis_of(j, axis);
    cross(axis, c->way, f);
    for (int a = 0; a < 3; a++)
        f[a] *= j < 3 ? 0 : c->force;
}

double tangent_touches_energy(const tangent_touch *c, int i, const double wi[3], int j, const double wj[3])
{
    double sum = 0, ti[3], tj[3], di[3], dj[3];
    for (int a = 0; a < 3; a++)
        sum += wi[a] * dot(c->stiff[a], wj);
    /* lambda n . (theta x w) = -w . (lambda theta x n); and half of each lambda n . (theta x (theta' x arm)) */
    tangent_touches_turned(c, i, ti);
    tangent_touches_turned(c, j, tj);
    tangent_touches_rigid(c, i, di);
    tangent_touches_rigid(c, j, dj);
    sum -= dot(wj, ti) + dot(wi, tj);
    if (i >= 3 && j >= 3)
        sum -= (dot(dj, ti) + dot(di, tj)) / 2;
    return sum;
}

void tangent_touches_torque(const tangent_touches *t, double torque[3])
{
    double one[3];
    torque[0] = torque[1] = torque[2] = 0;
    for (int64_t i = 0; i < t->count; i++) {
        cross(t->list[i].arm, t->list[i].way, one);
        for (int a = 0; a < 3; a++)
            torque[a] -= t->list[i].force * one[a];
    }
}

/* What the way out changes by with the place: the curvature of the surface at the same depth. A convex probe's planes
 * have none, and what its edges have is no number. */
static void curvature(const probe_placed *at, const double x[3], double h[3][3])
{
    const double step = near * at->shape.size;
    memset(h, 0, 9 * sizeof h[0][0]);
    for (int b = 0; b < 3 && at->shape.kind != PROBE_CONVEX; b++) {
        double more[3] = {x[0], x[1], x[2]}, less[3] = {x[0], x[1], x[2]};
        more[b] += step;
        less[b] -= step;
        const probe_touch there = probe_at(at, more), back = probe_at(at, less);
        for (int a = 0; a < 3; a++) {
            const double change = (there.way[a] - back.way[a]) / (4 * step);
            h[a][b] += change;
            h[b][a] += change;
        }
    }
}

static void stiffen(tangent_touch *t, const contact *c, const msds_parts *from, bool held, double h[3][3])
{
    const double spring = held ? 0 : from->p->repulsion[c->node];
    /* A node that slips has a weaker spring than one that sticks (grips.c): it counts as one without friction. */
    const double grip = c->grip >= .999 * from->p->repulsion[c->node] ? c->grip : 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            t->stiff[a][b] = -t->force * h[a][b] + (spring - grip) * t->way[a] * t->way[b] + (a == b ? grip : 0);
}

static void add(tangent_touches *to, const contact *c, const msds_parts *from, bool flat)
{
    tangent_touch *t = &to->list[to->count++];
    double x[3], h[3][3] = {{0}};
    *t = (tangent_touch){.own = from->order->own_node[c->node], .force = c->force};
    for (int a = 0; a < 3; a++)
        x[a] = from->p->position[3 * (int64_t)c->node + a] +
               (from->place ? from->place[3 * (int64_t)c->node + a] : (double)from->springs->u.x[a][t->own]);
    const probe_touch at = probe_at(from->probe, x);
    for (int a = 0; a < 3; a++) {
        t->way[a] = at.way[a];
        t->arm[a] = x[a] - from->probe->origin[a];
    }
    if (!flat)
        curvature(from->probe, x, h);
    stiffen(t, c, from, to->held, h);
}

int tangent_touches_find(tangent_touches *to, const msds_parts *from, bool flat, err *e)
{
    const contacts *c = from->contacts;
    to->count = 0;
    to->held = !from->p->options.penalty && from->method != MSDS_SPRINGS;
    if (!from->probe)
        return 0;
    if (MEM_ROOM(&to->list, &to->room, c->count, "the contact stiffness", e))
        return -1;
    for (int64_t i = 0; i < c->count; i++)
        if (c->list[i].force > 0)
            add(to, &c->list[i], from, flat);
    return 0;
}

void tangent_touches_free(tangent_touches *t)
{
    free(t->list);
    *t = (tangent_touches){0};
}
