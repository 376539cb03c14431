#include "msds/run/openness.h"

#include "base/mem.h"

#include <stdlib.h>

static double volume_of(const msds_problem *p, int64_t t, const double *u)
{
    const int32_t *n = p->element_node + 4 * t;
    double x[4][3];
    for (int c = 0; c < 4; c++)
        for (int a = 0; a < 3; a++)
            x[c][a] = p->position[3 * (int64_t)n[c] + a] + (u ? u[3 * (int64_t)n[c] + a] : 0);
    return simplex_volume(x[0], x[1], x[2], x[3]);
}

static void measure(const openness *o, const double *u, double to[CAVITIES_MOST])
{
    const msds_problem *p = o->p;
    for (int c = 0; c < p->cavities; c++)
        to[c] = 0;
    for (int64_t i = 0; i < o->elements; i++)
        to[cavity_of(p->cavity, p->cavities, p->volume[o->element[i]])] += volume_of(p, o->element[i], u);
}

int openness_make(openness *o, const msds_problem *p, err *e)
{
    *o = (openness){.p = p};
    if (!p->cavities)
        return 0;
    o->element = mem_array(p->elements, sizeof *o->element, "the frames", e);
    if (!o->element)
        return -1;
    for (int64_t t = 0; t < p->elements; t++)
        if (cavity_of(p->cavity, p->cavities, p->volume[t]) >= 0)
            o->element[o->elements++] = (int32_t)t;
    measure(o, NULL, o->at_rest);
    for (int c = 0; c < p->cavities; c++)
        o->now[c] = o->least[c] = 1;
    return 0;
}

void openness_free(openness *o)
{
    free(o->element);
    *o = (openness){.elements = 0};
}

void openness_measure(openness *o, const double *u, double time)
{
    if (!o->elements)
        return;
    measure(o, u, o->now);
    for (int c = 0; c < o->p->cavities; c++) {
        o->now[c] /= o->at_rest[c];
        if (o->now[c] < o->least[c]) {
            o->least[c] = o->now[c];
            o->least_time[c] = time;
        }
    }
}
