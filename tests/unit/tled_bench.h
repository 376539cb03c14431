/* A block with a run around it, for tests of the solver: what the run wrote last is kept. Functions end the test
 * program where even the setting up fails.
 */
#ifndef SINEW_TLED_BENCH_H
#define SINEW_TLED_BENCH_H

#include "tled/contact/self_contact.h"
#include "tled/contact/sliding.h"
#include "tled/cpu/cpu.h"
#include "tled/loop/relax.h"
#include "tled/loop/run.h"
#include "tled/problem/collider.h"
#include "tled/problem/step.h"
#include "tled/problem/support.h"

#include "tap.h"
#include "tled_block.h"

#include <string.h>

/* The CUDA executor of a table, or NULL with the reason where there is none that can be used. */
static inline const tled_executor *bench_cuda(const executor *const *table, const char **why)
{
    for (*why = "built without CUDA"; *table; table++)
        if (!strcmp((*table)->device, "cuda")) {
            *why = (*table)->unusable();
            return *why ? NULL : tled_executor_of(*table);
        }
    return NULL;
}

typedef struct bench {
    model m;
    script script;
    tled_problem problem;
    run_setup setup;
    run_end end;
    sliding sliding; /* of no nodes, unless a test makes it, as: */
    collider probe;
    self_contact skin;
    err e;
    double *displacement, *velocity, time; /* the last frame's */
    int64_t frames, cuts;                  /* written; the most parts that a step was cut in */
} bench;

static inline int bench_frame(void *context, double time, const field_values *state, err *e)
{
    bench *b = context;
    (void)e;
    memcpy(b->displacement, state->of[TLED_DISPLACEMENT], (size_t)b->problem.nodes * 3 * sizeof *b->displacement);
    memcpy(b->velocity, state->of[TLED_VELOCITY], (size_t)b->problem.nodes * 3 * sizeof *b->velocity);
    b->time = time;
    b->frames++;
    return 0;
}

static inline void bench_checked(void *context, int64_t step, const monitor_reading *reading, double remaining,
                                 int64_t cut, double damping)
{
    bench *b = context;
    (void)step, (void)reading, (void)remaining, (void)damping;
    b->cuts = cut > b->cuts ? cut : b->cuts;
}

static inline void bench_must(int result, const err *e)
{
    if (!result)
        return;
    printf("Bail out! %s\n", e->text);
    exit(1);
}

/* The setting of a problem that is made: to rest, by default settings. */
static inline void bench_finish(bench *b, int threads)
{
    b->displacement = calloc((size_t)b->problem.nodes * 6, sizeof *b->displacement);
    b->velocity = b->displacement + 3 * b->problem.nodes;
    b->setup = (run_setup){.p = &b->problem,
                           .device = &tled_cpu_double,
                           .steps = 200000,
                           .rest = 1e-4,
                           .adapt = true,
                           .context = b,
                           .frame = bench_frame,
                           .checked = bench_checked};
    b->setup.rate = step_rate(step_at_rest(&b->problem, NULL), &b->setup.check);
    support held;
    bench_must(support_of(&b->problem, &held, &b->e), &b->e);
    b->setup.frequency = relax_guess(&b->problem, held.reach);
    b->setup.damping = 2 * b->setup.frequency;
    b->setup.threads = pool_create(threads, &b->e);
    bench_must(!b->displacement || !b->setup.threads || b->e.status, &b->e);
}

/* gravity and level: 0 for none; both come up over .1 s. Ends at rest until the caller says otherwise. */
static inline void bench_make(bench *b, const block *what, const double gravity[3], double level,
                              hourglass_control control, int threads)
{
    char contract[80];
    memset(b, 0, sizeof *b);
    block_make(what, &b->m);
    snprintf(contract, sizeof contract, what->mixed ? "m=%.17g,n=%.17g" : "m=%.17g", level, level / 2);
    if (gravity)
        bench_must(script_add_gravity(&b->script, gravity, .1, &b->e), &b->e);
    if (level > 0)
        bench_must(script_add_contract(&b->script, &b->m, contract, .1, &b->e), &b->e);
    bench_must(tled_problem_make(&b->problem, &b->m, &b->script, control, &b->e), &b->e);
    bench_finish(b, threads);
}

/* From here on: `steps` steps with a fixed damping. */
static inline void bench_steps(bench *b, int64_t steps, double damping)
{
    b->setup.steps = steps;
    b->setup.rest = -1;
    b->setup.adapt = false;
    b->setup.damping = damping;
}

/* Goes on from what was written last. */
static inline void bench_go_on(bench *b)
{
    memcpy(b->problem.at_start.of[TLED_DISPLACEMENT], b->displacement,
           (size_t)b->problem.nodes * 3 * sizeof *b->displacement);
    memcpy(b->problem.at_start.of[TLED_VELOCITY], b->velocity, (size_t)b->problem.nodes * 3 * sizeof *b->velocity);
    b->problem.start = b->time;
}

static inline int bench_go(bench *b)
{
    return run_go(&b->setup, &b->end, &b->e);
}

static inline void bench_free(bench *b)
{
    pool_destroy(b->setup.threads);
    sliding_free(&b->sliding);
    collider_free(&b->probe);
    self_contact_free(&b->skin);
    tled_problem_free(&b->problem);
    script_free(&b->script);
    model_free(&b->m);
    free(b->displacement);
}

/* The stable step that a device's look finds of a block at rest, as a share of that at rest. */
static inline double bench_look_at_rest(const block *what, const tled_executor *device)
{
    bench b;
    bench_make(&b, what, NULL, 0, PHYSICAL, 1);
    tled_state *state = device->create(&b.problem, b.setup.threads, &b.e);
    monitor *w = monitor_create(&b.problem, b.setup.threads, &b.e);
    bench_must(!state || !w || monitor_read(w, device, state, 0, &b.e), &b.e);
    const double share = w->reading.stable / step_at_rest(&b.problem, NULL);
    device->destroy(state);
    monitor_destroy(w);
    bench_free(&b);
    return share;
}

#endif
