#include "tled/run.h"

#include "tled/relax.h"
#include "tled/step.h"

#include <math.h>
#include <stdio.h>

enum { CUTS_MAX = 10 }; /* a step cut 2^10 times is no step */

/* A step is safe up to this share of the stable one: it changes a little between two checks. */
static const double margin = .8;

typedef struct run {
    const run_setup *r;
    void *state;
    watch *watch;
    relax relax;
    tled_plan plan; /* plan.first: steps counted */
    int64_t from;   /* the first of this run */
    int cuts;
    double damping;
    err *e;
} run;

int64_t run_steps_to(double t, double rate)
{
    return (int64_t)ceil(t * rate - 1e-6);
}

tled_plan run_plan(double start, double rate)
{
    double steps = nearbyint(start * rate);
    tled_plan plan = {.rate = rate};
    if (fabs(steps) < 1e15 && steps / rate == start)
        plan.first = (int64_t)steps;
    else
        plan.origin = start;
    return plan;
}

double run_load(const watch_sight *s)
{
    return fmax(s->load, .01 * s->load_most);
}

bool run_at_rest(const watch_sight *s, double tolerance)
{
    double strain = fmax(s->strain, 1e-4 * s->strain_most);
    return s->residual <= tolerance * run_load(s) && s->kinetic <= tolerance * tolerance * strain;
}

/* Status 3, with where and when. Returns -1. */
static int diverged(const run *n, int64_t element, const char *what)
{
    const tled_problem *p = n->r->p;
    err_set(n->e, NULL, 0, "diverged at step %lld, %.6g s: element %lld (volume '%s') %s",
            (long long)(n->plan.first - n->from), tled_time(&n->plan, 0), (long long)element,
            p->volume[p->element_volume[element]].name, what);
    n->e->status = STATUS_DIVERGED;
    return -1;
}

static int look(run *n)
{
    if (watch_look(n->watch, n->r->device, n->state, tled_time(&n->plan, 0), n->e))
        return -1;
    const watch_sight *s = &n->watch->sight;
    if (s->broken < 0)
        return 0;
    return diverged(n, s->broken, s->inverted ? "is inverted" : "is no longer finite");
}

/* Chooses how often a step is cut: from the state alone, so that it is the same whatever went before. */
static int choose_step(run *n)
{
    const watch_sight *s = &n->watch->sight;
    char text[200];
    if (n->r->rate_fixed && s->stable * n->r->rate >= 1)
        return 0;
    for (n->cuts = 0; n->cuts <= CUTS_MAX && !n->r->rate_fixed; n->cuts++)
        if (ldexp(margin * s->stable * n->r->rate, n->cuts) >= 1)
            return 0;
    snprintf(text, sizeof text, "has a stable step of %.3g ms now, below the step of %.3g ms; expected a smaller --dt",
             1e3 * s->stable, 1e3 / n->r->rate);
    return diverged(n, s->stable_element < 0 ? 0 : s->stable_element, text);
}

/* What happens at a check. Returns -1, or whether the run is over. */
static int check(run *n)
{
    const run_setup *r = n->r;
    const watch_sight *s = &n->watch->sight;
    bool settled = s->time >= script_end(r->p->script);
    if (choose_step(n))
        return -1;
    if (r->adapt && settled) {
        relax_update(&n->relax, n->watch);
        n->damping = n->relax.damping;
    }
    r->checked(r->context, n->plan.first - n->from, s, INT64_C(1) << n->cuts, n->damping);
    return r->rest >= 0 && settled && run_at_rest(s, r->rest);
}

static int write_frame(run *n)
{
    return n->r->frame(n->r->context, tled_time(&n->plan, 0), n->watch->displacement, n->watch->velocity, n->e);
}

/* The first step past plan.first with a frame. */
static int64_t next_frame(const run *n)
{
    double every = n->r->every, passed = floor(tled_time(&n->plan, 0) / every);
    int64_t at = n->plan.first;
    if (every * n->r->rate <= 1)
        return at + 1;
    for (int more = 0; at <= n->plan.first; more++)
        at = run_steps_to((passed + more) * every - n->plan.origin, n->r->rate);
    return at;
}

static int advance(run *n, int64_t to)
{
    int64_t parts = INT64_C(1) << n->cuts;
    tled_plan cut = {n->plan.origin, n->plan.rate * (double)parts, n->plan.first * parts, n->damping};
    if (n->r->device->step(n->state, &cut, (to - n->plan.first) * parts, n->e))
        return -1;
    n->plan.first = to;
    return 0;
}

/* Steps to the end. Looks at the state at every check, every frame and the end; decides only at checks. */
static int loop(run *n, run_end *end)
{
    const run_setup *r = n->r;
    int64_t last = n->plan.first + r->steps, written = -1;
    int over = look(n) ? -1 : check(n);
    while (!over && n->plan.first < last) {
        int64_t to = (n->plan.first / r->check + 1) * r->check, frame_at = r->every > 0 ? next_frame(n) : last;
        to = to < last ? to : last;
        to = to < frame_at ? to : frame_at;
        if (advance(n, to) || look(n))
            return -1;
        if (to % r->check == 0)
            over = check(n);
        if (over >= 0 && r->every > 0 && to == frame_at) {
            written = to;
            over = write_frame(n) ? -1 : over;
        }
    }
    end->steps = n->plan.first - n->from;
    end->sight = n->watch->sight;
    end->rested = over > 0;
    if (over >= 0 && r->rest >= 0 && !end->rested)
        return err_set(
            n->e, NULL, 0,
            "not at rest after %lld steps, %.6g s: residual %.3g of the load, expected %.3g; a larger --rest, or -t to "
            "stop at a time",
            (long long)end->steps, end->sight.time, end->sight.residual / run_load(&end->sight), r->rest);
    return over < 0 ? -1 : written == n->plan.first ? 0 : write_frame(n);
}

int run_go(const run_setup *r, run_end *end, err *e)
{
    run n = {.r = r, .plan = run_plan(r->p->start, r->rate), .damping = r->damping, .e = e};
    int result = -1;
    n.from = n.plan.first;
    n.watch = watch_create(r->p, r->threads, e);
    if (!n.watch || (r->adapt && relax_make(&n.relax, r->p, r->damping, n.watch->rest_step, e)))
        goto out;
    n.state = r->device->create(r->p, r->threads, e);
    if (n.state)
        result = loop(&n, end);
out:
    if (n.state)
        r->device->destroy(n.state);
    relax_free(&n.relax);
    watch_destroy(n.watch);
    return result;
}
