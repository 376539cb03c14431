/* The time loop: what is conserved without damping, the same bytes whatever the threads and wherever a run was cut in
 * two, muscles at full contraction, steps that are too large, and the ends of runs.
 */
// needs: tled/*/*.c
#include "tled/loop/timeline.h"
#include "tled_bench.h"

#include <time.h>

static const block lump = {{4, 3, 5}, {.01, .01, .0125}, 3000, .45, 1000, 30000, 0, 0, 0, {0, 0, 0}, 0, false};
static const block muscle = {{8, 4, 4}, {.0025, .0025, .0025}, 3000, .45, 1000, 30000, 2, 1, 0, {1, 0, 0}, 0, false};

/* A velocity that bends, stretches and turns the block as it moves on. */
static void push(bench *b)
{
    for (int64_t n = 0; n < b->problem.nodes; n++) {
        const double *x = b->problem.position + 3 * n;
        double *v = b->problem.at_start.of[TLED_VELOCITY] + 3 * n;
        v[0] = .05 - 6 * x[1] + 2 * x[0];
        v[1] = 6 * x[0] + .1 * sin(80 * x[2]);
        v[2] = .02 - 3 * x[2] + 20 * x[0] * x[1];
    }
}

static void moments(const bench *b, const double *u, const double *v, double linear[3], double angular[3])
{
    for (int a = 0; a < 3; a++) {
        int next = (a + 1) % 3, last = (a + 2) % 3;
        linear[a] = angular[a] = 0;
        for (int64_t n = 0; n < b->problem.nodes; n++) {
            const double *x = b->problem.position + 3 * n;
            linear[a] += b->problem.mass[n] * v[3 * n + a];
            angular[a] += b->problem.mass[n] * ((x[next] + u[3 * n + next]) * v[3 * n + last] -
                                                (x[last] + u[3 * n + last]) * v[3 * n + next]);
        }
    }
}

static double norm(const double *x)
{
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

/* 10,000 steps without damping, in parts, so that the worst on the way is seen. */
static void test_conserved(const tled_executor *device, const char *name)
{
    bench b;
    double linear[3], angular[3], l[3], a[3], first = 0, gap_l = 0, gap_a = 0, gap_e = 0;
    bench_make(&b, &lump, NULL, 0, PHYSICAL, 1);
    bench_steps(&b, 400, 0);
    b.setup.device = device;
    push(&b);
    moments(&b, b.problem.at_start.of[TLED_DISPLACEMENT], b.problem.at_start.of[TLED_VELOCITY], linear, angular);
    for (int64_t n = 0; n < 3 * b.problem.nodes; n++)
        first += b.problem.mass[n / 3] / 2 * b.problem.at_start.of[TLED_VELOCITY][n] *
                 b.problem.at_start.of[TLED_VELOCITY][n];
    for (int part = 0; part < 25 && !bench_go(&b); part++, bench_go_on(&b)) {
        moments(&b, b.displacement, b.velocity, l, a);
        for (int k = 0; k < 3; k++) {
            l[k] -= linear[k];
            a[k] -= angular[k];
        }
        gap_l = fmax(gap_l, norm(l) / norm(linear));
        gap_a = fmax(gap_a, norm(a) / norm(angular));
        gap_e = fmax(gap_e, fabs(b.end.reading.kinetic + b.end.reading.strain - first) / first);
    }
    ok(b.frames == 25 && b.end.reading.strain > .05 * first, "%s: 10,000 steps that deform: %s", name, b.e.text);
    ok(gap_l < .01, "%s: momentum to 1 %% (%.2g)", name, gap_l);
    ok(gap_a < .01, "%s: angular momentum to 1 %% (%.2g)", name, gap_a);
    ok(gap_e < .01, "%s: energy to 1 %% (%.2g)", name, gap_e);
    bench_free(&b);
}

static bool same(const bench *a, const bench *b)
{
    return a->time == b->time &&
           !memcmp(a->displacement, b->displacement, (size_t)a->problem.nodes * 6 * sizeof *a->displacement);
}

/* A run of 300 steps, at once on one thread; on 2 and 3; in two parts. */
static void test_same_bytes(const tled_executor *device, const char *name)
{
    int gone;
    const double gravity[3] = {1, -2, -9.81};
    bench whole, other;
    bench_make(&whole, &muscle, gravity, .5, PHYSICAL, 1);
    whole.setup.device = device;
    bench_steps(&whole, 300, whole.setup.damping);
    gone = bench_go(&whole);
    ok(!gone, "%s: 300 steps: %s", name, whole.e.text);
    ok(whole.cuts > 1, "%s: with the step cut on the way", name);
    for (int threads = 2; threads <= 3; threads++) {
        bench_make(&other, &muscle, gravity, .5, PHYSICAL, threads);
        other.setup.device = device;
        bench_steps(&other, 300, other.setup.damping);
        gone = bench_go(&other);
        ok(!gone && same(&whole, &other), "%s: the same bytes on %d threads", name, threads);
        bench_free(&other);
    }
    bench_make(&other, &muscle, gravity, .5, PHYSICAL, 2);
    other.setup.device = device;
    other.setup.every = .0123;
    bench_steps(&other, 300, other.setup.damping);
    gone = bench_go(&other);
    ok(!gone && same(&whole, &other) && other.frames == 6, "%s: whatever frames are written (%lld)", name,
       (long long)other.frames);
    bench_free(&other);
    bench_make(&other, &muscle, gravity, .5, PHYSICAL, 2);
    other.setup.device = device;
    bench_steps(&other, 4 * other.setup.check, other.setup.damping);
    gone = bench_go(&other);
    ok(!gone, "%s: a part of it", name);
    bench_go_on(&other);
    other.setup.steps = 300 - 4 * other.setup.check;
    gone = bench_go(&other);
    ok(!gone && same(&whole, &other), "%s: gone on from its last frame, the same bytes", name);
    bench_free(&other);
    bench_free(&whole);
}

/* An end between two steps: of a body that falls, u = -g t^2/2 and v = -g t there, which these steps have exactly,
 * whatever their length. In one step, or many; cut in parts too. */
static void test_end(const tled_executor *device, double tolerance, const char *name)
{
    static const double end[] = {1e-7, .0003, .0123457, .02}, gravity[3] = {0, 0, -9.81};
    for (int i = 0; i < 4; i++) {
        bench b;
        bench_make(&b, &lump, gravity, 0, PHYSICAL, 2);
        for (int64_t k = 0; k < 3 * b.script.keys; k++) /* at once */
            b.script.value[k] = gravity[k % 3];
        bench_steps(&b, timeline_steps_to(end[i], b.setup.rate), 0);
        b.setup.device = device;
        b.setup.end = end[i];
        const int gone = bench_go(&b);
        double fallen = 0, speed = 0;
        for (int64_t n = 0; n < b.problem.nodes; n++) {
            fallen = fmax(fallen, fabs(b.displacement[3 * n + 2] / (-9.81 / 2 * end[i] * end[i]) - 1));
            speed = fmax(speed, fabs(b.velocity[3 * n + 2] / (-9.81 * end[i]) - 1));
        }
        ok(!gone && b.time == end[i] && b.end.reading.time == end[i], "%s: the run ends at %.17g s, in %lld steps %s",
           name, b.time, (long long)b.end.steps, b.e.text);
        ok(fallen < tolerance && speed < tolerance, "%s: it has fallen as far as it does, to %.2g, as fast, to %.2g",
           name, fallen, speed);
        bench_free(&b);
    }
}

/* The same where steps are cut on the way there, which ends on 1 and 2 threads at the same bytes; and is what many more
 * steps come to. */
static void test_end_cut(const tled_executor *device, const char *name)
{
    bench b[3];
    for (int i = 0; i < 3; i++) {
        bench_make(&b[i], &muscle, NULL, 1, PHYSICAL, 1 + i % 2);
        b[i].setup.rate *= i == 2 ? 32 : 1;
        bench_steps(&b[i], timeline_steps_to(.0671, b[i].setup.rate), b[i].setup.damping);
        b[i].setup.device = device;
        b[i].setup.every = i == 1 ? .0007 : 0;
        b[i].setup.end = .0671;
        const int gone = bench_go(&b[i]);
        ok(!gone && b[i].time == .0671, "%s: a muscle for .0671 s, %lld steps, cut in %lld %s", name,
           (long long)b[i].end.steps, (long long)b[i].end.parts, b[i].e.text);
    }
    ok(same(&b[0], &b[1]), "%s: the same bytes on two threads, with frames", name);
    ok(b[0].end.parts == b[0].cuts && b[0].cuts > 1 && b[0].end.taken > b[0].end.steps, "%s: cut on the way", name);
    near_(b[0].end.reading.largest / b[2].end.reading.largest, 1, 1e-4, "%s: as steps of 1/32 have it", name);
    for (int i = 0; i < 3; i++)
        bench_free(&b[i]);
}

/* At full contraction by default settings: stable, all elements right way out, and it comes to rest. */
static void test_contraction(const block *what, const char *name)
{
    int gone;
    bench b;
    bench_make(&b, what, NULL, 1, PHYSICAL, 2);
    bench_steps(&b, (int64_t)b.setup.rate, b.setup.damping);
    gone = bench_go(&b);
    ok(!gone && b.end.reading.kinetic < 1e-6 * b.end.reading.strain,
       "%s, full contraction for 1 s: kinetic %.2g J of %.2g J %s", name, b.end.reading.kinetic, b.end.reading.strain,
       b.e.text);
    ok(b.end.reading.largest > .003, "%s has contracted: %.2g mm", name, 1e3 * b.end.reading.largest);
    bench_free(&b);
    bench_make(&b, what, NULL, 1, PHYSICAL, 2);
    gone = bench_go(&b);
    ok(!gone && b.end.rested, "%s comes to rest after %lld steps %s", name, (long long)b.end.steps, b.e.text);
    bench_free(&b);
}

/* The whole block strained by F = diag(x, y, z). */
static void strain(bench *b, double x, double y, double z)
{
    const double by[3] = {x - 1, y - 1, z - 1};
    for (int64_t i = 0; i < 3 * b->problem.nodes; i++)
        b->problem.at_start.of[TLED_DISPLACEMENT][i] = by[i % 3] * b->problem.position[i];
}

/* A step that is given is judged by the stable one of the state that it led to, and by nothing less or more. */
static void test_judged(void)
{
    static const struct {
        double share;
        bool taken;
    } cases[] = {{.6, true}, {.99, true}, {1.01, false}, {1.5, false}, {1.9, false}};
    const element_tensor h = {.3, 0, 0, 0, .2, 0, 0, 0, .1};
    const step_fibres none = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bench b;
        step_matrix a;
        bench_make(&b, &lump, NULL, 0, PHYSICAL, 1);
        strain(&b, 1.3, 1.2, 1.1);
        const tled_law law = tled_law_of(&b.problem, 0);
        step_matrix_of(&b.problem, &law, h, &none, &a);
        bench_steps(&b, 0, 0);
        b.setup.rate = 1 / (cases[i].share * 2 / sqrt(step_largest(&a)));
        b.setup.rate_fixed = true;
        b.setup.check = 50;
        const int gone = bench_go(&b);
        ok(cases[i].taken ? !gone : gone && strstr(b.e.text, "stable step of") && strstr(b.e.text, "below the step"),
           "a step of %g of the stable one of a block that is strained: %s", cases[i].share, gone ? b.e.text : "taken");
        bench_free(&b);
    }
}

/* J = 0 to the last bit, and below: an element is inverted, whatever its energy is then. */
static void test_inverted(void)
{
    static const double flat[] = {0, -1e-9, -.01, -.1, -.5, -1, -2};
    block half = lump;
    half.side[0] = half.side[1] = half.side[2] = 1. / 128; /* of which nothing rounds */
    for (size_t i = 0; i < sizeof flat / sizeof *flat; i++)
        for (int a = 0; a < 3; a++) {
            bench b;
            bench_make(&b, &half, NULL, 0, PHYSICAL, 1);
            double by[3] = {1, 1, 1};
            by[a] = flat[i];
            strain(&b, by[0], by[1], by[2]);
            bench_steps(&b, 10, 0);
            const int gone = bench_go(&b);
            ok(gone && b.e.status == STATUS_DIVERGED && strstr(b.e.text, "element 0 (volume 'skin') is inverted"),
               "J = %g along %c: %s", flat[i], "xyz"[a], b.e.text);
            bench_free(&b);
        }
}

static void test_step_too_large(void)
{
    int gone;
    bench b;
    bench_make(&b, &muscle, NULL, 1, PHYSICAL, 1);
    bench_steps(&b, 100000, b.setup.damping);
    b.setup.rate = 1.5 / step_at_rest(&b.problem, NULL);
    b.setup.rate_fixed = true;
    b.setup.check = 50;
    gone = bench_go(&b);
    ok(gone && b.e.status == STATUS_DIVERGED && strstr(b.e.text, "stable step of") && strstr(b.e.text, "'muscle_m'"),
       "a fixed step that the contraction makes too large ends the run: %s", b.e.text);
    bench_free(&b);
}

/* A jump breaks the steps that the state before it allows: they are taken again, cut; whatever threads and frames. */
static void test_jump(const tled_executor *device, const char *name)
{
    bench first = {0}, b = {0};
    block fixed = muscle;
    fixed.fixed_axis = 0;
    for (int i = 0; i < 5; i++) {
        static const double every[] = {0, .0123, .0007, .01, 0};
        bench *to = i ? &b : &first;
        bench_make(to, &fixed, NULL, 1, PHYSICAL, 1 + i % 3);
        for (int64_t k = 0; k < to->script.keys; k++)
            to->script.time[k] = k ? .0101 : .01005; /* between two checks */
        to->setup.device = device;
        to->setup.every = every[i];
        bench_steps(to, (int64_t)(.1 * to->setup.rate), to->setup.damping);
        int gone = bench_go(to);
        if (i == 4) { /* in two parts, the second with the jump */
            b.setup.steps = 2 * b.setup.check;
            memset(b.problem.at_start.of[TLED_DISPLACEMENT], 0, (size_t)b.problem.nodes * 3 * sizeof(double));
            gone |= bench_go(&b);
            bench_go_on(&b);
            b.setup.steps = first.setup.steps - 2 * b.setup.check;
            gone |= bench_go(&b);
        }
        ok(!gone && same(&first, to), "%s: a jump, %d threads, frames every %g s%s %s", name, 1 + i % 3, every[i],
           i == 4 ? ", in two parts" : "", to->e.text);
        if (i)
            bench_free(&b);
    }
    ok(first.end.reading.largest > .003, "%s: %.2g mm", name, 1e3 * first.end.reading.largest);
    bench_free(&first);
}

/* Steps just below the stable one are taken as told. */
static void test_just_stable(void)
{
    static const double share[] = {.99, .996, .9999, 1};
    for (int i = 0; i < 4; i++) {
        bench b;
        bench_make(&b, &lump, NULL, 0, PHYSICAL, 1);
        bench_steps(&b, 200, 0);
        b.problem.at_start.of[TLED_VELOCITY][0] = 1e-12;
        b.setup.rate = 1 / (share[i] * step_at_rest(&b.problem, NULL));
        b.setup.rate_fixed = true;
        b.setup.check = 50;
        int gone = bench_go(&b);
        ok(!gone && b.end.reading.largest < 1e-9, "a step of %g of the stable one %s", share[i], b.e.text);
        bench_free(&b);
    }
}

/* Where and when it broke: the element that a force of no bounds acts on, in the first of many steps between checks. */
static void test_place(bool fixed)
{
    bench b;
    char text[60];
    bench_make(&b, &lump, NULL, 0, PHYSICAL, 1);
    bench_steps(&b, 1000, 10);
    b.setup.rate_fixed = fixed;
    b.setup.check = 50;
    int64_t node = block_node(&lump, 4, 3, 5);
    b.problem.at_start.of[TLED_VELOCITY][3 * node] = -1e6;
    int gone = bench_go(&b);
    snprintf(text, sizeof text, "element %lld ", (long long)b.problem.elements - 1);
    ok(gone && b.e.status == STATUS_DIVERGED && strstr(b.e.text, "at step 1, ") && strstr(b.e.text, text), "%s",
       b.e.text);
    bench_free(&b);
}

/* The monitor is told to look too rarely to save it. */
static void test_diverged(void)
{
    int gone;
    bench b;
    bench_make(&b, &lump, NULL, 0, PHYSICAL, 1);
    bench_steps(&b, 2000, 0);
    push(&b);
    b.setup.rate = .3 / step_at_rest(&b.problem, NULL);
    b.setup.rate_fixed = true;
    b.setup.check = 2000;
    monitor *w = monitor_create(&b.problem, b.setup.threads, &b.e);
    tled_state *state = b.setup.device->create(&b.problem, b.setup.threads, &b.e);
    tled_plan plan = {.rate = b.setup.rate};
    b.setup.device->step(state, &plan, 2000, &b.e);
    gone = monitor_read(w, b.setup.device, state, 1, &b.e);
    ok(!gone && w->reading.broken >= 0, "steps of 3.3 times the stable one break element %lld",
       (long long)w->reading.broken);
    b.setup.device->destroy(state);
    monitor_destroy(w);
    for (int64_t i = 0; i < b.problem.nodes; i++) /* inside out */
        b.problem.at_start.of[TLED_DISPLACEMENT][3 * i] = -2.5 * b.problem.position[3 * i];
    gone = bench_go(&b);
    ok(gone && b.e.status == STATUS_DIVERGED && strstr(b.e.text, "element 0 (volume 'skin') is inverted"),
       "an inverted element: %s", b.e.text);
    bench_free(&b);
}

/* Stretched at the start and let go, with nothing that loads it: the residual has to vanish against what it was. */
static void test_let_go(void)
{
    int gone;
    block held = lump;
    bench b;
    held.fixed_low = 1;
    bench_make(&b, &held, NULL, 0, PHYSICAL, 1);
    for (int64_t i = 0; i < b.problem.nodes; i++)
        b.problem.at_start.of[TLED_DISPLACEMENT][3 * i] = .2 * b.problem.position[3 * i];
    gone = bench_go(&b);
    ok(!gone && b.end.rested && b.end.reading.largest < 1e-5, "let go, it comes to rest after %lld steps, %.2g mm off",
       (long long)b.end.steps, 1e3 * b.end.reading.largest);
    bench_free(&b);
    bench_make(&b, &held, NULL, 0, PHYSICAL, 1);
    gone = bench_go(&b);
    ok(!gone && b.end.rested && b.end.steps == 0 && b.frames == 1, "what nothing moves is at rest at once");
    b.setup.rest = 1e-4;
    b.setup.steps = 10;
    b.problem.at_start.of[TLED_DISPLACEMENT][3 * (b.problem.nodes - 1)] = .001;
    gone = bench_go(&b);
    ok(gone && b.e.status == STATUS_BAD && strstr(b.e.text, "not at rest after 10 steps"), "%s", b.e.text);
    bench_free(&b);
}

enum { LAST_FRAME = 3 }; /* that no_room takes */

/* Takes its time, so that the run has to wait; then there is no more room. */
static int no_room(void *context, double time, const field_values *state, err *e)
{
    bench *b = context;
    struct timespec nap = {0, 2000000};
    nanosleep(&nap, NULL);
    if (b->frames == LAST_FRAME)
        return err_set(e, NULL, 0, "no room at %g s", time);
    return bench_frame(context, time, state, e);
}

static void count_checks(void *context, int64_t step, const monitor_reading *reading, double remaining, int64_t cut,
                         double damping)
{
    (void)step, (void)reading, (void)remaining, (void)cut, (void)damping;
    ((bench *)context)->cuts++;
}

/* A frame that cannot be written ends the run soon, whether frames are taken on the
 * way or steps are taken again for them. */
static void test_frame_fails(const tled_executor *device, const char *name)
{
    static const double every[] = {1e-9, .0007, .0123};
    static const char *const want[] = {"no room at 0.000909091 s", "no room at 0.00295455 s", "no room at 0.0493182 s"};
    for (int i = 0; i < 3; i++) {
        bench b;
        bench_make(&b, &muscle, NULL, .1, PHYSICAL, 1);
        bench_steps(&b, 1000000, b.setup.damping);
        b.setup.device = device;
        b.setup.every = every[i];
        b.setup.frame = no_room;
        b.setup.checked = count_checks;
        int gone = bench_go(&b);
        ok(gone && !strcmp(b.e.text, want[i]), "%s: frames every %g s: %s", name, every[i], b.e.text);
        ok(b.frames == LAST_FRAME && b.cuts < 20, "%s: the run ends, after %lld checks", name, (long long)b.cuts);
        bench_free(&b);
    }
}

static void test_times(void)
{
    tled_plan p = timeline_plan(.3, 900);
    ok(p.origin == 0 && p.first == 270, "0.3 s is step 270 of 900 a second");
    p = timeline_plan(.3001, 900);
    ok(p.origin == .3001 && p.first == 0, "0.3001 s is no step");
    ok(timeline_steps_to(.5, 4400) == 2200 && timeline_steps_to(.04, 4400) == 176, "times are whole numbers of steps");
    ok(timeline_steps_to(.0123, 900) == 12, "or the next step");
    ok(!timeline_is_between(.5, 4400) && !timeline_is_between(.3, 900) && timeline_is_between(.0123, 900),
       "which are told apart");
    ok(timeline_steps_to(1e9, 1e12) > INT64_C(1000000000000000), "what no run comes to is far");
}

static const char *no_device(void)
{
    return "no device";
}

static void test_choice(void)
{
    static const executor broken = {.device = "cuda", .features = EXECUTOR_MIXTURES, .unusable = no_device};
    static const executor first = {.device = "cuda", .forms = 1, .unusable = no_device};
    const executor *formed_first[] = {&first, &tled_cpu_double.is, NULL};
    const executor *both[] = {&broken, &tled_cpu_double.is, NULL}, *none[] = {&broken, NULL},
                   *without[] = {both[1], NULL};
    static const executor_need none_needed = {0}, contact = {.features = EXECUTOR_CONTACT},
                               remembers = {.features = EXECUTOR_HISTORY}, mixed = {.features = EXECUTOR_MIXTURES},
                               formed = {.form = 1 << 1, .law = {"plain", "rubber"}, .volume = "skin"},
                               unnamed = {.form = 1 << 1, .law = {"plain", "rubber"}},
                               lawless = {.form = 1 << 1, .law = {"plain"}};
    char says[100];
    err e = {0};
    const executor *took = executor_choose(both, "auto", &none_needed, says, sizeof says, &e);
    ok(took == both[1] && !strcmp(says, "cpu (cuda: no device)"), "auto: %s", says);
    took = executor_choose(both, "cpu", &none_needed, says, sizeof says, &e);
    ok(took == both[1] && !strcmp(says, "cpu"), "by name");
    took = executor_choose(both, "cuda", &none_needed, says, sizeof says, &e);
    ok(!took && strstr(e.text, "no device"), "%s", e.text);
    e = (err){0};
    took = executor_choose(without, "cuda", &none_needed, says, sizeof says, &e);
    ok(!took && !strcmp(e.text, "this build has no CUDA back end; have: cpu"), "%s", e.text);
    e = (err){0};
    took = executor_choose(none, "auto", &none_needed, says, sizeof says, &e);
    ok(!took && strstr(e.text, "no device"), "%s", e.text);
    took = executor_choose(both, "auto", &contact, says, sizeof says, &e);
    ok(took == both[1] && !strcmp(says, "cpu (the one with contact with a probe)"), "auto, with contact: %s", says);
    e = (err){0};
    took = executor_choose(both, "cuda", &contact, says, sizeof says, &e);
    ok(!took && !strcmp(e.text, "the CUDA back end has no contact with a probe; expected -d cpu or auto"), "%s",
       e.text);
    e = (err){0};
    took = executor_choose(both, "cuda", &unnamed, says, sizeof says, &e);
    ok(!took && !strcmp(e.text, "the CUDA back end has no law rubber; expected -d cpu or auto"), "%s", e.text);
    e = (err){0};
    took = executor_choose(formed_first, "cuda", &formed, says, sizeof says, &e);
    ok(!took &&
           !strcmp(e.text, "the CUDA back end has no law rubber, which volume 'skin' has; expected plain, or -d cpu "
                           "or auto"),
       "%s", e.text);
    e = (err){0};
    took = executor_choose(formed_first, "cuda", &lawless, says, sizeof says, &e);
    ok(!took &&
           !strcmp(
               e.text,
               "the CUDA back end has no law that expresses all laws of the model; expected plain, or -d cpu or auto"),
       "%s", e.text);
    took = executor_choose(both, "auto", &formed, says, sizeof says, &e);
    ok(took == both[1] && !strcmp(says, "cpu (cuda: no law rubber)"), "auto, by form: %s", says);
    took = executor_choose(both, "auto", &mixed, says, sizeof says, &e);
    ok(took == both[1] && !strcmp(says, "cpu (cuda: no device)"), "auto, with mixed elements, which all have: %s",
       says);
    e = (err){0};
    took = executor_choose(both, "cpu", &remembers, says, sizeof says, &e);
    ok(!took && strstr(e.text, "no history of elements"), "nobody changes a history yet: %s", e.text);
    const executor *many[40];
    for (int i = 0; i < 38; i++)
        many[i] = &broken;
    many[38] = both[1], many[39] = NULL;
    took = executor_choose(many, "cpu", &none_needed, says, sizeof says, &e);
    ok(took == both[1] && !strcmp(says, "cpu"), "a table may be long");
}

/* Half of each element is tissue: half the mass, and half of all forces. Under gravity and in contraction it moves as
 * if it were whole; what a force moves, it moves as twice the force does. And where the shares differ from element to
 * element the step at rest is what it was, and stable. */
static void test_fraction(const tled_executor *device, const char *name)
{
    const double gravity[3] = {3, -2, -9.81};
    bench whole, half, mixed;
    block with = muscle;
    bench_make(&whole, &muscle, gravity, .4, PHYSICAL, 2);
    with.fraction = .5F;
    bench_make(&half, &with, gravity, .4, PHYSICAL, 2);
    with.fraction = -1;
    bench_make(&mixed, &with, gravity, .4, PHYSICAL, 2);
    bench *all[] = {&whole, &half, &mixed};
    int gone = 0;
    for (int i = 0; i < 3; i++) {
        bench_steps(all[i], 2000, whole.setup.damping);
        all[i]->setup.device = device;
        gone |= bench_go(all[i]);
    }
    ok(!gone && same(&whole, &half), "%s: half of every element is tissue: it moves by its weight as it did whole",
       name);
    near_(2 * half.end.reading.strain, whole.end.reading.strain, 1e-12 * whole.end.reading.strain,
          "%s: with half the energy", name);
    ok(!gone && mixed.end.reading.kinetic < 1e-3 * mixed.end.reading.strain && !same(&whole, &mixed),
       "%s: shares of .05 to 1 are stable by default settings: %.3g mm, whole %.3g %s", name,
       1e3 * mixed.end.reading.largest, 1e3 * whole.end.reading.largest, mixed.e.text);
    for (int i = 0; i < 3; i++)
        bench_free(all[i]);
}

/* What holds for every executor. */
static void test_device(const tled_executor *device, const char *name)
{
    test_conserved(device, name);
    test_same_bytes(device, name);
    test_end(device, strstr(name, "double") ? 1e-9 : 1e-4, name);
    test_end_cut(device, name);
    test_jump(device, name);
    test_fraction(device, name);
    test_frame_fails(device, name);
}

int main(void)
{
    block bound = muscle;
    bound.fixed_axis = 0;
    test_times();
    test_choice();
    test_device(&tled_cpu_double, "double");
    test_device(&tled_cpu_single, "single");
    test_contraction(&muscle, "a muscle on its side");
    test_contraction(&bound, "a muscle by its end");
    test_step_too_large();
    test_judged();
    test_inverted();
    ok(bench_look_at_rest(&lump, &tled_cpu_double) == 1,
       "a look at rest, with unlike sides, finds the stable step at rest");
    test_diverged();
    test_just_stable();
    test_place(true);
    test_place(false);
    test_let_go();
    const char *why;
    const tled_executor *cuda[] = {bench_cuda(tled_executors_double, &why), bench_cuda(tled_executors_single, &why)};
    for (int i = 0; i < 2; i++)
        if (cuda[i])
            test_device(cuda[i], i ? "CUDA, single" : "CUDA, double");
        else
            skip(1, why);
    return done_testing();
}
