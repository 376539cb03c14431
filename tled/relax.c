#include "tled/relax.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double relax_estimate(const tled_problem *p, err *e)
{
    double speed = INFINITY, reach = tled_reach(p, e);
    if (reach < 0)
        return -1;
    for (int32_t i = 0; i < p->volumes; i++)
        if (p->volume[i].elements)
            speed = fmin(speed, sqrt(p->volume[i].mu / p->volume[i].density));
    return 2 * acos(-1) / 2 * speed / reach;
}

int relax_make(relax *r, const tled_problem *p, double estimate, double stable, err *e)
{
    *r = (relax){.damping = estimate, .low = .01 * estimate, .high = 2 / stable};
    r->displacement = mem_array(p->nodes, 3 * sizeof *r->displacement, "relaxation", e);
    r->internal = mem_array(p->nodes, 3 * sizeof *r->internal, "relaxation", e);
    return r->displacement && r->internal ? 0 : -1;
}

void relax_free(relax *r)
{
    free(r->displacement);
    free(r->internal);
    memset(r, 0, sizeof *r);
}

void relax_update(relax *r, const watch *w)
{
    double stiffness = 0, inertia = 0;
    int64_t count = 3 * w->p->nodes;
    for (int64_t i = 0; r->primed && i < count; i++)
        if (w->p->hold[i] == HOLD_FREE) {
            double du = w->displacement[i] - r->displacement[i];
            stiffness += du * (w->internal[i] - r->internal[i]);
            inertia += w->p->mass[i / 3] * du * du;
        }
    if (stiffness > 0 && inertia > 0)
        r->damping = fmin(fmax(2 * sqrt(stiffness / inertia), r->low), r->high);
    memcpy(r->displacement, w->displacement, (size_t)count * sizeof *r->displacement);
    memcpy(r->internal, w->internal, (size_t)count * sizeof *r->internal);
    r->primed = true;
}
