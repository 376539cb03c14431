#include "tled/relax.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double relax_guess(const tled_problem *p, double reach)
{
    double speed = INFINITY;
    for (int32_t i = 0; i < p->volumes; i++)
        if (p->volume[i].elements)
            speed = fmin(speed, sqrt(p->volume[i].mu / p->volume[i].density));
    return acos(-1) / 2 * speed / reach;
}

int relax_make(relax *r, const tled_problem *p, double guess, double stable, err *e)
{
    *r = (relax){.guess = guess, .frequency = guess, .lowest = guess, .low = .01 * guess, .high = 1 / stable};
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
    for (int64_t i = 0; r->looks && i < count; i++)
        if (w->p->hold[i] == HOLD_FREE) {
            double du = w->displacement[i] - r->displacement[i];
            stiffness += du * (w->internal[i] - r->internal[i]);
            inertia += w->p->mass[i / 3] * du * du;
        }
    if (stiffness > 0 && inertia > 0)
        r->frequency = fmin(fmax(sqrt(stiffness / inertia), r->low), r->high);
    /* What was lowest fades: it grows e-fold in 4 of its radians, so that half a period leaves it where it was, to a factor. */
    if (r->looks)
        r->lowest = fmin(r->guess, fmin(r->frequency, r->lowest * exp(r->lowest * (w->sight.time - r->time) / 4)));
    r->time = w->sight.time;
    memcpy(r->displacement, w->displacement, (size_t)count * sizeof *r->displacement);
    memcpy(r->internal, w->internal, (size_t)count * sizeof *r->internal);
    r->looks += r->looks < 2;
}

double relax_remaining(const relax *r, const watch_sight *s)
{
    double w = r->lowest;
    if (s->acceleration == 0 && s->speed == 0)
        return 0;
    return r->looks < 2 ? INFINITY : hypot(s->acceleration / (w * w), s->speed / w);
}
