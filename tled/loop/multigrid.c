#include "tled/loop/multigrid.h"

#include "base/mem.h"
#include "tled/coarse/coarse.h"
#include "tled/coarse/coarse_loads.h"
#include "tled/loop/residual.h"
#include "tled/loop/timeline.h"
#include "tled/problem/collider.h"
#include "tled/problem/followers.h"
#include "tled/problem/loads.h"
#include "tled/problem/step.h"
#include "tled/problem/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEAST = 4096, /* elements: a smaller model is at rest soon by itself */
    STEPS = 20000 /* past the script's end, before a coarser model gives up */
};

/* How close a coarser model comes to rest to begin with: what it is off by its elements is some hundredths. And what of
 * the way that is left to go a correction may leave. */
static const double tolerance = 1e-3, left = .3;

struct multigrid {
    coarse *c;
    run_setup setup;      /* of its runs */
    multigrid *coarser;   /* or NULL */
    double *displacement; /* nodes x 3, m: where it came to rest last */
    double *before;       /* nodes x 3, m: and the time before */
    double *residual;     /* nodes x 3, N: what is out of balance there; or to be */
    int64_t steps;
};

static int take_frame(void *context, double time, const field_values *state, err *e)
{
    (void)context, (void)time, (void)state, (void)e;
    return 0;
}

static int take_rest(void *context, const tled_executor *device, tled_state *state, double time, err *e)
{
    const multigrid *g = context;
    return residual_read(&g->c->problem, device, state, time, g->displacement, g->residual, e);
}

static void checked(void *context, int64_t step, const monitor_reading *reading, double remaining, int64_t cut,
                    double damping)
{
    (void)context, (void)step, (void)reading, (void)remaining, (void)cut, (void)damping;
}

/* Steps to rest from a start of a problem. */
static int64_t steps_of(const tled_problem *p, double rate)
{
    return timeline_steps_to(fmax(0, collider_events_end(p) - p->start), rate) + STEPS;
}

static int set_level(multigrid *g, const run_setup *r, err *e)
{
    char says[300];
    support of;
    err none = {0};
    const tled_problem *p = &g->c->problem;
    run_setup *l = &g->setup;
    const executor_need need = tled_need(p);
    const executor *const *table = r->single ? tled_executors_single : tled_executors_double;
    if (support_of(p, &of, e))
        return -1;
    if (of.loose || of.falling >= 0)
        return err_set(e, NULL, 0, "nothing holds a part of it, or holds it along some axis");
    *l = (run_setup){.p = p,
                     .device =
                         tled_executor_of(executor_choose(table, r->device->is.device, &need, says, sizeof says, e)),
                     .threads = r->threads,
                     .end = -INFINITY,
                     .rest = fmax(tolerance, r->rest),
                     .frequency = relax_guess(p, of.reach),
                     .adapt = true,
                     .finer = r->single ? tled_executor_of(executor_choose(tled_executors_double, r->device->is.device,
                                                                           &need, says, sizeof says, &none))
                                        : NULL,
                     .single = r->single,
                     .coarser = g->coarser,
                     .context = g,
                     .frame = take_frame,
                     .ended = take_rest,
                     .checked = checked};
    l->damping = 2 * l->frequency;
    l->rate = step_rate(followers_step(loads_square(p, NULL), step_at_rest(p, NULL)), &l->check);
    return l->device ? 0 : -1;
}

static int make_arrays(multigrid *g, err *e)
{
    const int64_t nodes = g->c->problem.nodes;
    g->displacement = mem_array(nodes, 3 * sizeof *g->displacement, "the coarser model", e);
    g->before = mem_array(nodes, 3 * sizeof *g->before, "the coarser model", e);
    g->residual = mem_array(nodes, 3 * sizeof *g->residual, "the coarser model", e);
    return g->displacement && g->before && g->residual ? 0 : -1;
}

/* Each is an eighth of the one before: ten deep at most. */
// NOLINTNEXTLINE(misc-no-recursion)
multigrid *multigrid_make(const run_setup *r, const tled_problem *p, const model *m, int64_t least, err *e)
{
    err none = {0};
    const int64_t at_least = least ? least : LEAST;
    const char *lacks = p->elements < at_least ? "few elements" : coarse_lacks(p, m);
    if (lacks) {
        err_set(e, NULL, 0, "%s", lacks);
        return NULL;
    }
    multigrid *g = mem_array(1, sizeof *g, "the coarser model", e);
    if (!g)
        return NULL;
    g->c = coarse_make(p, m, e);
    if (g->c)
        g->coarser = multigrid_make(r, &g->c->problem, &g->c->m, least, &none);
    if (!g->c || make_arrays(g, e) || set_level(g, r, e)) {
        multigrid_free(g);
        return NULL;
    }
    return g;
}

// NOLINTNEXTLINE(misc-no-recursion)
void multigrid_free(multigrid *g)
{
    if (!g)
        return;
    multigrid_free(g->coarser);
    coarse_free(g->c);
    free(g->displacement);
    free(g->before);
    free(g->residual);
    free(g);
}

/* The coarser problem to rest. */
// NOLINTNEXTLINE(misc-no-recursion)
static int relax_level(multigrid *g, err *e)
{
    run_end end = {0};
    g->setup.steps = steps_of(&g->c->problem, g->setup.rate);
    const int failed = run_go(&g->setup, &end, e);
    g->steps += end.taken;
    return failed;
}

/* Takes over where the coarser one rests, at the script's end. */
static int begin_there(const multigrid *g, tled_problem *p, err *e)
{
    const double end = collider_events_end(p);
    const int inverted = coarse_prolong(g->c, g->displacement, end, p->at_start.of[TLED_DISPLACEMENT], e);
    if (inverted > 0)
        err_set(e, NULL, 0, "its rest inverts an element");
    if (inverted) {
        multigrid_forget(p);
        return -1;
    }
    p->start = end;
    return 0;
}

// NOLINTNEXTLINE(misc-no-recursion)
int multigrid_start(multigrid *g, tled_problem *p, err *e)
{
    err none = {0};
    if (g->coarser && multigrid_start(g->coarser, &g->c->problem, &none)) {
        multigrid_free(g->coarser); /* where it cannot, this one begins at the script's beginning */
        g->coarser = g->setup.coarser = NULL;
    }
    return relax_level(g, e) || begin_there(g, p, e) ? -1 : 0;
}

// NOLINTNEXTLINE(misc-no-recursion)
int multigrid_correct(multigrid *g, const double *residual, double remaining, double *correction, err *e)
{
    const int64_t numbers = 3 * g->c->problem.nodes;
    tled_problem *p = &g->c->problem;
    memcpy(p->at_start.of[TLED_DISPLACEMENT], g->displacement, (size_t)numbers * sizeof *g->displacement);
    p->start = collider_events_end(p);
    memcpy(g->before, g->displacement, (size_t)numbers * sizeof *g->before);
    double *push = mem_array(numbers, sizeof *push, "the coarser model", e);
    if (!push)
        return -1;
    coarse_restrict(g->c, residual, push);
    for (int64_t i = 0; i < numbers; i++)
        push[i] -= g->residual[i];
    coarse_push(g->c, push);
    free(push);
    g->setup.rest = left * remaining;
    if (relax_level(g, e))
        return -1;
    for (int64_t i = 0; i < numbers; i++)
        g->before[i] = g->displacement[i] - g->before[i];
    coarse_interpolate(g->c, g->before, correction);
    return 0;
}

void multigrid_refine(multigrid *g)
{
    for (multigrid *l = g; l; l = l->coarser)
        if (l->setup.finer) {
            l->setup.device = l->setup.finer;
            l->setup.finer = NULL;
            l->setup.single = false;
        }
}

bool multigrid_is_upright(const multigrid *g, const double *displacement)
{
    return coarse_is_upright(g->c, displacement);
}

multigrid_told multigrid_tell(const multigrid *g)
{
    multigrid_told told = {0};
    for (const multigrid *l = g; l; l = l->coarser) {
        told.models++;
        told.elements += l->c->problem.elements;
        told.steps += l->steps;
        told.work += (double)l->steps * (double)l->c->problem.elements / (double)g->c->fine->elements;
    }
    return told;
}

void multigrid_forget(tled_problem *p)
{
    for (int i = 0; i < p->fields.count; i++)
        memset(p->at_start.of[i], 0, (size_t)fields_size(&p->fields, i) * sizeof(double));
    p->start = 0;
}
