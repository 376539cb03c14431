#include "tled/loop/relax.h"

#include <math.h>

/* Of shear waves at rest, m/s. */
static double speed_of(const tled_law *law)
{
    return sqrt(law->mu / law->density);
}

double relax_guess(const tled_problem *p, double reach)
{
    double speed = INFINITY;
    for (int32_t i = 0; i < p->volumes && !p->own_values; i++)
        if (p->volume[i].elements)
            speed = fmin(speed, speed_of(&p->volume[i].law));
    for (int64_t i = 0; i < p->elements && p->own_values; i++) {
        const tled_law law = tled_law_of(p, i);
        speed = fmin(speed, speed_of(&law));
    }
    return acos(-1) / 2 * speed / reach;
}

relax relax_of(double guess, double stable)
{
    relax r = {.guess = guess, .frequency = guess, .lowest = guess, .low = .01 * guess, .high = 1 / stable};
    return r;
}

void relax_update(relax *r, const monitor_reading *s)
{
    if (r->states && s->stiffness > 0 && s->inertia > 0)
        r->frequency = fmin(fmax(sqrt(s->stiffness / s->inertia), r->low), r->high);
    /* What was lowest fades: it grows e-fold in 4 of its radians, so that half a
     * period leaves it where it was, to a factor. */
    if (r->states)
        r->lowest = fmin(r->guess, fmin(r->frequency, r->lowest * exp(r->lowest * (s->time - r->time) / 4)));
    r->time = s->time;
    r->states += r->states < 2;
}

/* m, root mean square over the mass. */
static double way_left(const relax *r, const monitor_reading *s)
{
    double w = r->lowest;
    if (s->acceleration == 0 && s->speed == 0)
        return 0;
    return r->states < 2 ? INFINITY : hypot(s->acceleration / (w * w), s->speed / w);
}

double relax_share(const relax *r, const monitor_reading *s)
{
    const double way = way_left(r, s);
    return way == 0 ? 0 : way / fmax(s->moved, .01 * s->moved_most);
}
