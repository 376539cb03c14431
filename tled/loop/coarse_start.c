#include "tled/loop/coarse_start.h"

#include "base/mem.h"
#include "tled/coarse/coarse.h"
#include "tled/loop/timeline.h"
#include "tled/problem/collider.h"
#include "tled/problem/followers.h"
#include "tled/problem/loads.h"
#include "tled/problem/step.h"
#include "tled/problem/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEAST = 4096, /* elements: a smaller model is at rest soon by itself */
    STEPS = 20000 /* past the script's end, before a coarser model gives up */
};

/* How close a coarser model comes to rest: what it is off by its elements is some hundredths. */
static const double tolerance = 1e-3;

typedef struct level {
    double *displacement;
    int64_t numbers;
} level;

static int take_frame(void *context, double time, const field_values *state, err *e)
{
    const level *l = context;
    (void)time, (void)e;
    memcpy(l->displacement, state->of[TLED_DISPLACEMENT], (size_t)l->numbers * sizeof *l->displacement);
    return 0;
}

static void checked(void *context, int64_t step, const monitor_reading *reading, double remaining, int64_t cut,
                    double damping)
{
    (void)context, (void)step, (void)reading, (void)remaining, (void)cut, (void)damping;
}

static int set_level(run_setup *l, const run_setup *r, const tled_problem *p, err *e)
{
    char says[300];
    support of;
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
                     .single = r->single,
                     .frame = take_frame,
                     .checked = checked};
    l->damping = 2 * l->frequency;
    l->rate = step_rate(followers_step(loads_square(p, NULL), step_at_rest(p, NULL)), &l->check);
    l->steps = timeline_steps_to(fmax(0, collider_events_end(p) - p->start), l->rate) + STEPS;
    return l->device ? 0 : -1;
}

/* A coarser problem to rest; displacement: its nodes x 3. */
static int relax_level(const run_setup *r, const tled_problem *p, double *displacement, coarse_told *told, err *e)
{
    run_setup setup;
    run_end end = {0};
    level l = {.numbers = 3 * p->nodes};
    l.displacement = displacement;
    if (set_level(&setup, r, p, e))
        return -1;
    setup.context = &l;
    if (run_go(&setup, &end, e))
        return -1;
    told->models++;
    told->elements += p->elements;
    told->steps += end.taken;
    return 0;
}

/* Takes over where the coarser one rests, at the script's end. */
static int begin_there(tled_problem *p, const coarse *c, const double *displacement, err *e)
{
    const double end = collider_events_end(p);
    const int inverted = coarse_prolong(c, displacement, end, p->at_start.of[TLED_DISPLACEMENT], e);
    if (inverted > 0)
        err_set(e, NULL, 0, "its rest inverts an element");
    if (inverted) {
        coarse_forget(p);
        return -1;
    }
    p->start = end;
    return 0;
}

/* Each is an eighth of the one before: ten deep at most. */
// NOLINTNEXTLINE(misc-no-recursion)
static int start_from(const run_setup *r, tled_problem *p, const model *m, coarse_told *told, err *e)
{
    err none = {0};
    const char *lacks = p->elements < LEAST ? "few elements" : coarse_lacks(p, m);
    if (lacks)
        return err_set(e, NULL, 0, "%s", lacks);
    coarse *c = coarse_make(p, m, e);
    if (!c)
        return -1;
    start_from(r, &c->problem, &c->m, told, &none); /* where it cannot, it begins at the script's beginning */
    double *displacement = mem_array(c->problem.nodes, 3 * sizeof *displacement, "the coarser model", e);
    const int failed =
        !displacement || relax_level(r, &c->problem, displacement, told, e) || begin_there(p, c, displacement, e);
    free(displacement);
    coarse_free(c);
    return failed ? -1 : 0;
}

int coarse_start(const run_setup *r, tled_problem *p, const model *m, coarse_told *told)
{
    err e = {0};
    *told = (coarse_told){0};
    const int result = start_from(r, p, m, told, &e);
    snprintf(told->why, sizeof told->why, "%.190s", e.text);
    return result;
}

void coarse_forget(tled_problem *p)
{
    for (int i = 0; i < p->fields.count; i++)
        memset(p->at_start.of[i], 0, (size_t)fields_size(&p->fields, i) * sizeof(double));
    p->start = 0;
}
