/* What msds-run's states do live, on each device that there is: other options, the way back to rest from what is not
 * finite, and an exact solver that a thread makes; each leads to the bytes of a state that was made so. And how many
 * iterations live frames take.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c msds/run/msds_executors.c msds/run/press.c
// needs: msds/run/bones.c
#include "msds_block.h"

#include "base/clock.h"
#include "base/mem.h"
#include "msds/problem/largest.h"
#include "msds/problem/msds_executor.h"
#include "msds/run/press.h"

#include "tap.h"

enum { FRAMES = 3, ITERATIONS = 20, WAIT = 60 /* s: nothing here takes so long */ };

static const tets block = {{9, 9, 7}, {.08, .08, .06}, 1e4, .4, 1000, 2, false};

typedef struct bench {
    model m;
    msds_problem p;
    pool *threads;
    const msds_executor *device;
    double *u[2];
    err e;
} bench;

static void find_inertia(msds_problem *p)
{
    err e = {0};
    largest l;
    p->mass_factor = 1;
    tets_must(!largest_of(p, &l, &e), &e);
    p->mass_factor = fmax(1, largest_factor(l.bound, p->options.damping, .01));
}

static void begin(bench *b, const msds_options *o, const msds_executor *device)
{
    err e = {0};
    *b = (bench){.device = device};
    tets_make(&block, &b->m);
    tets_must(!msds_problem_make(&b->p, &b->m, o, &e), &e);
    find_inertia(&b->p);
    b->threads = pool_create(2, &e);
    for (int i = 0; i < 2; i++)
        b->u[i] = mem_array(b->p.nodes, 3 * sizeof *b->u[i], "test", &e);
    tets_must(b->threads && b->u[0] && b->u[1], &e);
}

static void end(bench *b)
{
    for (int i = 0; i < 2; i++)
        free(b->u[i]);
    pool_destroy(b->threads);
    msds_problem_free(&b->p);
    model_free(&b->m);
}

static msds_state *state_of(bench *b)
{
    msds_state *state = b->device->create(&b->p, b->threads, &b->e);
    tets_must(state != NULL, &b->e);
    return state;
}

static msds_plan plan_of(msds_method method, bool warp)
{
    msds_plan plan = tets_plan(method);
    plan.warp = warp;
    tets_press(&plan, .02, .042, .037, .055);
    return plan;
}

static void run(const bench *b, msds_state *state, const msds_plan *plan, int frames)
{
    err e = {0};
    for (int i = 0; i < frames; i++)
        tets_must(!b->device->step(state, plan, ITERATIONS, &e), &e);
}

static void look(const bench *b, msds_state *state, double *u, msds_reading *reading)
{
    err e = {0};
    tets_must(!b->device->get(state, MSDS_DISPLACEMENT, u, &e) && !b->device->monitor(state, reading, &e), &e);
}

/* The two are the same, and something moved. */
static void compare(const bench *b, const char *what, msds_method method, bool warp, const msds_reading reading[2])
{
    const bool same = !memcmp(b->u[0], b->u[1], 3 * (size_t)b->p.nodes * sizeof *b->u[0]) &&
                      !memcmp(reading[0].force, reading[1].force, sizeof reading[0].force);
    ok(same && reading[0].finite && reading[0].largest > 1e-3 && reading[0].contacts > 0,
       "%s, method %d%s on %s: the same bytes, %.3g mm", what, (int)method, warp ? " warped" : "", b->device->is.device,
       1e3 * reading[0].largest);
}

static msds_options others(void)
{
    msds_options o = {.scale = .003, .damping = .07, .repulsion = 2.5, .gravity = {1, 2, -9}, .penalty = true};
    return o;
}

static void test_change(const msds_executor *device, msds_method method, bool warp)
{
    bench b;
    err e = {0};
    msds_reading reading[2];
    const msds_options usual = tets_options(), other = others();
    const msds_plan plan = plan_of(method, warp);
    begin(&b, &usual, device);
    msds_state *changed = state_of(&b);
    msds_problem_change(&b.p, &other);
    find_inertia(&b.p);
    tets_must(!device->change(changed, &e), &e);
    run(&b, changed, &plan, FRAMES);
    look(&b, changed, b.u[0], &reading[0]);
    device->destroy(changed);
    bench made;
    begin(&made, &other, device);
    msds_state *fresh = state_of(&made);
    run(&made, fresh, &plan, FRAMES);
    look(&made, fresh, b.u[1], &reading[1]);
    compare(&b, "other options", method, warp, reading);
    ok(!memcmp(b.p.spring, made.p.spring, (size_t)b.p.springs * sizeof *b.p.spring) &&
           b.p.mass_factor == made.p.mass_factor && b.p.scale == made.p.scale,
       "the springs are those of a problem made so");
    device->destroy(fresh);
    end(&made);
    end(&b);
}

static void test_reset(const msds_executor *device, msds_method method, bool warp)
{
    bench b;
    err e = {0};
    msds_reading reading[2], broken;
    msds_options o = tets_options();
    const msds_plan plan = plan_of(method, warp), springs = plan_of(MSDS_SPRINGS, false), fem = plan_of(MSDS_FEM, warp);
    begin(&b, &o, device);
    msds_state *state = state_of(&b);
    run(&b, state, &plan, FRAMES);
    look(&b, state, b.u[0], &reading[0]);
    b.p.options.gravity[2] = INFINITY;
    tets_must(!device->change(state, &e), &e);
    run(&b, state, &springs, 1);
    run(&b, state, &fem, 1);
    look(&b, state, b.u[1], &broken);
    ok(!broken.finite, "gravity that is not finite breaks it");
    b.p.options.gravity[2] = 0;
    tets_must(!device->change(state, &e) && !device->reset(state, &e), &e);
    look(&b, state, b.u[1], &broken);
    run(&b, state, &plan, FRAMES);
    look(&b, state, b.u[1], &reading[1]);
    compare(&b, "back to rest", method, warp, reading);
    device->destroy(state);
    end(&b);
}

/* Frames by conjugate gradients until the solver is made, and then exact ones; and the same without a thread. */
static void test_ready(const msds_executor *device, bool warp)
{
    bench b;
    err e = {0};
    msds_reading reading[2];
    const msds_options o = tets_options();
    const msds_plan plan = plan_of(MSDS_EXACT, warp), meanwhile = plan_of(MSDS_FEM, warp);
    const double until = clock_now() + WAIT;
    int is_ready, frames = 0;
    begin(&b, &o, device);
    msds_state *state = state_of(&b);
    while (!(is_ready = device->ready(state, &plan, &e)) && clock_now() < until) {
        run(&b, state, &meanwhile, 1);
        frames++;
    }
    ok(is_ready == 1, "exact frames are ready after %d others", frames);
    run(&b, state, &plan, FRAMES);
    look(&b, state, b.u[0], &reading[0]);
    device->destroy(state);
    state = state_of(&b);
    run(&b, state, &meanwhile, frames);
    run(&b, state, &plan, FRAMES);
    look(&b, state, b.u[1], &reading[1]);
    compare(&b, "an exact solver made by a thread", MSDS_EXACT, warp, reading);
    device->destroy(state);
    end(&b);
}

/* A state that ends, or goes back to rest, or wants exact frames at once, while its solver is being made; and one whose
 * solver cannot be made. */
static void test_making(const msds_executor *device)
{
    bench b;
    err e = {0};
    msds_reading reading;
    const msds_options o = tets_options();
    const msds_plan plan = plan_of(MSDS_EXACT, false);
    begin(&b, &o, device);
    msds_state *state = state_of(&b);
    ok(device->ready(state, &plan, &e) >= 0, "it is being made: %s", e.text);
    device->destroy(state);
    state = state_of(&b);
    ok(device->ready(state, &plan, &e) >= 0 && !device->reset(state, &e) && !device->step(state, &plan, 1, &e),
       "who does not ask waits: %s", e.text);
    look(&b, state, b.u[0], &reading);
    ok(reading.residual < 1e-6, "for an exact frame: %g", reading.residual);
    device->destroy(state);
    memset(b.p.fixed, 0, (size_t)b.p.nodes);
    state = state_of(&b);
    const double until = clock_now() + WAIT;
    int is_ready;
    while (!(is_ready = device->ready(state, &plan, &e)) && clock_now() < until)
        ;
    ok(is_ready < 0 ? strstr(e.text, "nothing holds") != NULL : device->step(state, &plan, 1, &(err){0}) < 0,
       "one that cannot be made: %s", e.text);
    device->destroy(state);
    end(&b);
}

/* Iterations of a frame without a pose. */
static int64_t taken(press *p, double time)
{
    press_moves moves;
    press_wait(p, &(press_frame){.time = time, .iterations = -1}, &moves);
    return press_sum(&moves);
}

/* A frame takes what its time asks for, --iterations at most; a late one leaves as many to those that come early. */
static void test_pace(void)
{
    const double rate = 60;
    press p = {.iterations = 20, .rate = rate, .live = true};
    int64_t sum = taken(&p, 5), late;
    ok(sum == 20, "the first frame takes --iterations");
    for (int i = 1; i <= 600; i++)
        sum += taken(&p, 5 + i / rate);
    ok(sum == 601 * 20, "ten seconds at 60 a second take those of ten seconds: %lld", (long long)sum);
    ok(taken(&p, 5 + 600.25 / rate) == 5 && taken(&p, 5 + 600.5 / rate) == 5,
       "a frame that comes early takes its share");
    ok(taken(&p, 5 + 602 / rate) == 20, "a late one no more than --iterations");
    late = taken(&p, 5 + 602.25 / rate);
    ok(late == 15 && taken(&p, 5 + 602.5 / rate) == 5, "what it left is done by the next: %lld", (long long)late);
    taken(&p, 15 + 602.5 / rate);
    late = 0;
    for (int i = 1; i <= 20; i++)
        late += taken(&p, 15 + (602.5 + i / 4.) / rate);
    ok(late == 20 * 5 + 20, "ten seconds without a frame leave those of one: %lld", (long long)late);
    press_pace(&p, 8, 0);
    ok(taken(&p, 99) == 8 && taken(&p, 99.001) == 8, "without a rate each frame takes --iterations");
    ok(taken(&p, 99.001) == 8, "as does one at the same time");
    press_moves moves;
    press_wait(&p, &(press_frame){.time = 100, .iterations = 3}, &moves);
    ok(press_sum(&moves) == 3, "and one of a record what that says");
}

int main(void)
{
    test_pace();
    static const msds_method methods[] = {MSDS_SPRINGS, MSDS_FEM, MSDS_EXACT, MSDS_TISSUE};
    for (const executor *const *at = msds_executors; *at; at++) {
        const msds_executor *device = msds_executor_of(*at);
        if ((*at)->unusable())
            continue;
        for (int warp = 0; warp <= ((*at)->features & EXECUTOR_WARP ? 1 : 0); warp++) {
            const int count = !warp && (*at)->features & EXECUTOR_TISSUE ? 4 : 3;
            for (int i = warp; i < count; i++) {
                test_change(device, methods[i], warp);
                test_reset(device, methods[i], warp);
            }
            test_ready(device, warp);
        }
        test_making(device);
    }
    return done_testing();
}
