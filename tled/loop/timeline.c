#include "tled/loop/timeline.h"

#include <math.h>

/* Of a step: what is no farther from a whole number of them is one. */
static const double tolerance = 1e-6;

int64_t timeline_steps_to(double t, double rate)
{
    return (int64_t)fmin(ceil(t * rate - tolerance), 9e18); /* farther than any run */
}

bool timeline_is_between(double t, double rate)
{
    return ceil(t * rate - tolerance) - t * rate > tolerance;
}

tled_plan timeline_plan(double start, double rate)
{
    double steps = nearbyint(start * rate);
    tled_plan plan = {.rate = rate};
    if (fabs(steps) < 1e15 && steps / rate == start)
        plan.first = (int64_t)steps;
    else
        plan.origin = start;
    return plan;
}

int64_t timeline_next(const tled_plan *plan, double every, int64_t after)
{
    int64_t at = after;
    if (every == 0)
        return INT64_MAX;
    if (every * plan->rate <= 1)
        return at + 1;
    double passed = floor(tled_time(plan, after - plan->first) / every);
    for (int more = 0; at <= after; more++)
        at = timeline_steps_to((passed + more) * every - plan->origin, plan->rate);
    return at;
}
