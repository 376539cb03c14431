/* Springs that pull at tissue: what they do to momentum and energy while it moves, at rest the tissue's energy against
 * the work of springs, what a release leaves, the stable step, and what is refused.
 */
// needs: tled/*/*.c
#include "tled/problem/loads.h"
#include "tled_card.h"

static const block soft = {{4, 4, 3}, {.005, .004, .006}, 3000, .45, 1000, 0, 2, 1, 0, {0, 0, 0}, 0, false};
static const double to[3] = {.015, .007, .025}, from[3] = {.01, .008, .018}, stiffness = 7;

static const char pulled[] = "0 pull mouse 10mm,8mm,18mm 6mm 15mm,7mm,25mm 7\n";

static void begin(bench *b, const block *what, const char *text)
{
    bench_make(b, what, NULL, 0, PHYSICAL, 2);
    tled_problem_free(&b->problem);
    pool_destroy(b->setup.threads);
    free(b->displacement);
    read_script(b, text);
    bench_finish(b, 2);
}

/* The springs' energy (J) and the sum of their forces (N), by the script's words. */
static double springs(const bench *b, const double *u, double force[3])
{
    const script_curve *c = &b->script.curve[0];
    double energy = 0;
    force[0] = force[1] = force[2] = 0;
    for (int32_t i = 0; i < c->node_count; i++)
        for (int a = 0; a < 3; a++) {
            const double gap = to[a] - from[a] - u[3 * (int64_t)b->script.node[c->node_first + i] + a];
            energy += .5 * stiffness / c->node_count * gap * gap;
            force[a] += stiffness / c->node_count * gap;
        }
    return energy;
}

typedef struct look {
    double *u, *v, time, energy, momentum[3], force[3];
} look;

static void see(bench *b, monitor *w, tled_state *s, double time, look *l)
{
    const tled_executor *d = b->setup.device;
    bench_must(d->get(s, TLED_DISPLACEMENT, l->u, &b->e) || d->get(s, TLED_VELOCITY, l->v, &b->e) ||
                   monitor_read(w, d, s, time, &b->e),
               &b->e);
    l->energy = w->reading.strain + w->reading.kinetic + springs(b, l->u, l->force);
    for (int a = 0; a < 3; a++) {
        l->momentum[a] = 0;
        for (int64_t n = 0; n < b->problem.nodes; n++)
            l->momentum[a] += b->problem.mass[n] * l->v[3 * n + a];
    }
}

/* A block that nothing holds: its momentum changes by what the springs pull with alone; energy stays. */
static void in_motion(void)
{
    bench b;
    block loose = soft;
    loose.fixed_low = 0;
    begin(&b, &loose, pulled);
    tled_state *s = b.setup.device->create(&b.problem, b.setup.threads, &b.e);
    monitor *w = monitor_create(&b.problem, b.setup.threads, &b.e);
    double *room = calloc(6 * (size_t)b.problem.nodes, sizeof *room), worst = 0, most = 0, gone = 0;
    bench_must(!s || !w || !room, &b.e);
    const tled_plan at = {0, b.setup.rate, 0, 0};
    look was, is = {.u = room, .v = room + 3 * b.problem.nodes};
    see(&b, w, s, 0, &is);
    const double first = is.energy;
    near_(springs(&b, is.u, is.force), .5 * stiffness * (25e-6 + 1e-6 + 49e-6), 1e-12, "the springs' energy at rest");
    for (int64_t i = 0; i < 400; i++) {
        was = is;
        bench_must(b.setup.device->step(s, &(tled_plan){0, at.rate, i, 0}, 1, &b.e), &b.e);
        see(&b, w, s, tled_time(&at, i + 1), &is);
        for (int a = 0; a < 3; a++) {
            const double step = .5 / at.rate * (was.force[a] + is.force[a]);
            worst = fmax(worst, fabs(is.momentum[a] - was.momentum[a] - step));
            most = fmax(most, fabs(is.momentum[a]));
        }
        gone = fmax(gone, fabs(is.energy - first));
    }
    ok(most > 0 && worst < 1e-12 * most, "momentum changes by what springs pull with: off by %.1e of it", worst / most);
    ok(gone < 2e-3 * first, "energy stays, to %.1e", gone / first);
    b.setup.device->destroy(s);
    monitor_destroy(w);
    free(room);
    bench_free(&b);
}

/* At rest, and at small strain, the tissue holds half of what the springs' forces by displacements are. */
static void at_rest(void)
{
    bench b;
    begin(&b, &soft, "0 pull p 10mm,8mm,18mm 6mm 10.001mm,7.9995mm,18.002mm 5\n");
    b.setup.rest = 1e-8;
    bench_must(bench_go(&b), &b.e);
    const script_curve *c = &b.script.curve[0];
    const double gap[3] = {1e-6, -.5e-6, 2e-6};
    double half = 0;
    for (int32_t i = 0; i < c->node_count; i++)
        for (int a = 0; a < 3; a++) {
            const double u = b.displacement[3 * (int64_t)b.script.node[c->node_first + i] + a];
            half += .5 * 5 / c->node_count * (gap[a] - u) * u;
        }
    ok(c->node_count == 6, "%d nodes share the spring", c->node_count);
    ok(half > 0 && fabs(b.end.reading.strain / half - 1) < 1e-3, "strain energy is half the springs' work: %.6g",
       b.end.reading.strain / half);
    bench_free(&b);
}

/* Before it pulls and after its release it is not there. */
static void released(void)
{
    static const double gravity[3] = {0, 0, -3};
    static const char *const text[] = {"0 gravity 0,0,-3\n", ".02 pull p 10mm,8mm,18mm 6mm 11mm,8mm,18mm 5\n"
                                                             ".03 pull p 10mm,8mm,18mm 6mm 12mm,8mm,18mm 5\n"
                                                             ".05 release p\n"
                                                             "0 gravity 0,0,-3\n"};
    double *rest[2];
    (void)gravity;
    for (int i = 0; i < 2; i++) {
        bench b;
        begin(&b, &soft, text[i]);
        b.setup.rate = 40000;
        b.setup.check = 100;
        bench_steps(&b, 799, 0);
        bench_must(bench_go(&b), &b.e);
        rest[i] = malloc(3 * (size_t)b.problem.nodes * sizeof **rest);
        memcpy(rest[i], b.displacement, 3 * (size_t)b.problem.nodes * sizeof **rest);
        if (i) {
            double now[9], later[9];
            tled_curves(&b.problem, .0401, now);
            tled_curves(&b.problem, .0501, later);
            ok(now[0] == .002 && now[3] == 1 && later[0] == 0 && later[3] == 0, "it holds until its release: %g",
               now[0]);
            near_(loads_square(&b.problem, NULL), loads_square(&b.problem, now), 1e-15, "and stiffens until then");
            ok(loads_square(&b.problem, later) == 0, "no longer");
        }
        if (i)
            ok(!memcmp(rest[0], rest[1], 3 * (size_t)b.problem.nodes * sizeof **rest),
               "before it pulls nothing changes");
        bench_free(&b);
    }
    free(rest[0]);
    free(rest[1]);
}

/* Just below the step that is told it is stable; a stiffer spring cuts it. */
static void stable(void)
{
    bench b;
    begin(&b, &soft, "0 pull p 10mm,8mm,18mm 6mm 10.1mm,8mm,18mm 4000\n");
    const double rest = step_at_rest(&b.problem, NULL);
    monitor *w = monitor_create(&b.problem, b.setup.threads, &b.e);
    tled_state *s = b.setup.device->create(&b.problem, b.setup.threads, &b.e);
    bench_must(!w || !s || monitor_read(w, b.setup.device, s, 0, &b.e), &b.e);
    const double told = w->reading.stable, square = loads_square(&b.problem, NULL);
    near_(told, 2 / sqrt(4 / (rest * rest) + square), 1e-12, "a spring adds to the square of the frequency");
    ok(told < .8 * rest, "a stiff one cuts the step: %.3g of it at rest", told / rest);
    const tled_plan at = {0, 1 / (.99 * told), 0, 0};
    bench_must(b.setup.device->step(s, &at, 3000, &b.e) || monitor_read(w, b.setup.device, s, 0, &b.e), &b.e);
    ok(w->reading.broken < 0 && w->reading.kinetic + w->reading.strain < 4000 * 1e-8, "just below it, it is stable");
    b.setup.device->destroy(s);
    monitor_destroy(w);
    bench_free(&b);
}

/* Refused: with the line. */
static void refused(void)
{
    static const char *const text[][2] = {
        {"0 pull p 1,1,1 1mm 0,0,0 5\n", "no node lies within"},
        {"0 pull p 0,0,0 0 0,0,0 5\n", "radius '0'"},
        {"0 pull p 0,0,0 9mm 0,0,0 0\n", "stiffness '0'"},
        {"0 pull p 0,0,0 9mm 0,0,0 nan\n", "stiffness 'nan'"},
        {"0 pull p 0,0,0 9mm 0,0 5\n", "TX,TY,TZ"},
        {"0 pull p 0,0,0 9mm 0,0,0\n", "expected TIME pull ID"},
        {"0 release p\n", "nothing is pulled as 'p'"},
        {"0 pull p 0,0,0 9mm 0,0,0 5\n1 release p\n2 release p\n", "script:3: nothing is pulled as 'p'"},
        {"0 pull p 0,0,0 9mm 0,0,0 5\n1 pull p 0,0,0 9mm 0,0,0 6\n", "since line 1"},
        {"1 pull p 0,0,0 9mm 0,0,0 5\n0 pull p 0,0,0 9mm 0,0,1 5\n", "expected times in order"},
    };
    model m;
    memset(&m, 0, sizeof m);
    block_make(&soft, &m);
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        err e = {0};
        script s = {0};
        in *source = in_memory(text[i][0], strlen(text[i][0]), "script", &e);
        ok(source && script_read(&s, source, &m, &e) && strstr(e.text, text[i][1]), "%s", e.text);
        in_close(source);
        script_free(&s);
    }
    model_free(&m);
}

int main(void)
{
    in_motion();
    at_rest();
    released();
    stable();
    refused();
    return done_testing();
}
