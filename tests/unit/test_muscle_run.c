/* Muscles with curves of their own in runs: a bar that is active beyond its optimum, whose elements part into long and
 * short ones until the passive curve holds them; the stable step at rest; forces of mixed elements; what such muscles
 * need of an executor; and those in series with springs: whether a state is all that they have, and where they begin.
 */
// needs: tled/*/*.c
#include "tled/loop/account.h"

#include "tled_bench.h"

#include "tled/problem/muscle_fibre.h"

/* Both ends held. */
static const block bar = {{12, 2, 2}, {.005, .005, .005}, 3000, .45, 1000, 3e5, 0, 1, 1, {1, 0, 0}, 0, false};

static double vmax; /* of the first material of models that are made; 0: not given */

/* A muscle that contracts by the level, with an optimum and a passive stress; 0: not given. */
static void muscle_make(bench *b, const block *what, double level, double optimum, double passive)
{
    char contract[80];
    memset(b, 0, sizeof *b);
    block_make(what, &b->m);
    for (int64_t i = 0; i < 1 + what->mixed; i++) {
        if (optimum > 0)
            (model_find(&b->m, "material.optimum") ? model_find(&b->m, "material.optimum")
                                                   : block_array(&b->m, "material.optimum"))
                ->f64[i] = optimum;
        if (passive > 0)
            (model_find(&b->m, "material.passive") ? model_find(&b->m, "material.passive")
                                                   : block_array(&b->m, "material.passive"))
                ->f64[i] = passive;
    }
    if (vmax > 0) {
        const double values[2] = {vmax, 0};
        block_values(&b->m, "material.vmax", values);
    }
    snprintf(contract, sizeof contract, what->mixed ? "m=%.17g,n=%.17g" : "m=%.17g", level, level / 2);
    if (level > 0)
        bench_must(script_add_contract(&b->script, &b->m, contract, .1, &b->e), &b->e);
    bench_must(tled_problem_make(&b->problem, &b->m, &b->script, PHYSICAL, &b->e), &b->e);
    bench_finish(b, 2);
}

/* Of all elements: the least and the largest l, and how many fall. */
typedef struct lengths {
    double least, most;
    int64_t falling;
} lengths;

static lengths lengths_of(const bench *b)
{
    const tled_problem *p = &b->problem;
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    lengths l = {10, 0, 0};
    double *value = calloc((size_t)p->script->curves * 3 + 3, sizeof *value);
    tled_curves(p, b->time, value);
    for (int64_t i = 0; i < p->elements; i++) {
        const deformed d = deformed_of(p, i, box, b->displacement);
        const element_fibre fibre = muscle_fibre_of(p, p->fibre, i, 0, 1, value);
        const double at = element_length(element_fibre_now(d.h, fibre.along)) * (1 + fibre.curves.less);
        l.least = fmin(l.least, at);
        l.most = fmax(l.most, at);
        l.falling += muscle_fibre_falls(p, i, value, d.h, d.law.mu);
    }
    free(value);
    return l;
}

/* So that not all stays even: nodes that are not held move along by up to 1 mm/s. */
static void push(bench *b)
{
    for (int64_t n = 0; n < b->problem.nodes; n++)
        if (b->problem.hold[3 * n] == HOLD_FREE)
            b->problem.at_start.of[TLED_VELOCITY][3 * n] = .001 * sin((double)(n * n % 97));
}

/* At rest l is 1/.85, so past the optimum. */
static void test_popping(void)
{
    for (int with = 0; with < 2; with++) {
        bench b;
        muscle_make(&b, &bar, 1, .85, with ? .05 : 0);
        bench_steps(&b, (int64_t)(.4 * b.setup.rate), b.setup.damping);
        push(&b);
        const int gone = bench_go(&b);
        const lengths l = lengths_of(&b);
        printf("# %s: l from %.3f to %.3f, %lld of %lld elements fall %s\n", with ? "passive" : "active alone", l.least,
               l.most, (long long)l.falling, (long long)b.problem.elements, gone ? b.e.text : "");
        if (with)
            ok(!gone && l.most < 1.4 && l.falling < b.problem.elements / 4,
               "the passive curve holds what is stretched before its fibres are straight: l to %.3f", l.most);
        else
            ok(gone || l.most > 1.5, "without it elements are pulled past the end of the active curve: l to %.3f",
               l.most);
        bench_free(&b);
    }
}

static void stretch(bench *b, double x)
{
    for (int64_t n = 0; n < b->problem.nodes; n++)
        b->problem.at_start.of[TLED_DISPLACEMENT][3 * n] = (x - 1) * b->problem.position[3 * n];
}

/* A muscle that is just longer than at rest, where its slope begins, is no stiffer than the step at rest knows;
 * whatever its shares. */
static void test_step_at_rest(void)
{
    for (int mixed = 0; mixed < 2; mixed++) {
        bench b;
        block what = bar;
        what.mixed = mixed;
        what.side[1] = .004;
        muscle_make(&b, &what, 0, 0, 1);
        const double rest = step_at_rest(&b.problem, NULL);
        stretch(&b, 1 + 1e-9);
        tled_state *state = tled_cpu_double.create(&b.problem, b.setup.threads, &b.e);
        monitor *w = monitor_create(&b.problem, b.setup.threads, &b.e);
        bench_must(!state || !w || monitor_read(w, &tled_cpu_double, state, 0, &b.e), &b.e);
        ok(w->reading.stable >= rest * (1 - 1e-9), "%s: the stable step is that at rest: %.6g of %.6g ms",
           mixed ? "mixed" : "a muscle", 1e3 * w->reading.stable, 1e3 * rest);
        tled_cpu_double.destroy(state);
        monitor_destroy(w);
        bench_free(&b);
        muscle_make(&b, &what, 0, 0, 0);
        ok(rest < step_at_rest(&b.problem, NULL), "and below that without a passive stress");
        bench_free(&b);
    }
}

/* The forces that executors step with are those of the reports, summed by nodes; with shares of two muscles. */
static void test_forces(const tled_executor *device, double tolerance)
{
    bench b;
    block what = bar;
    double most = 0, gap = 0;
    what.mixed = true;
    what.fixed_low = what.fixed_high = 0;
    muscle_make(&b, &what, 1, .9, .05);
    tled_problem *p = &b.problem;
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        p->at_start.of[TLED_DISPLACEMENT][i] = .2 * p->position[i] + 4e-4 * sin((double)(i * i % 89));
    p->start = 1; /* past the ramp */
    double *internal = calloc((size_t)p->nodes * 6, sizeof *internal), *want = internal + 3 * p->nodes;
    double *value = calloc((size_t)p->script->curves * 3, sizeof *value);
    tled_state *state = device->create(p, b.setup.threads, &b.e);
    bench_must(!state || device->get(state, TLED_INTERNAL, internal, &b.e), &b.e);
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    tled_curves(p, 1, value);
    for (int64_t i = 0; i < p->elements; i++) {
        const deformed d = deformed_of(p, i, box, p->at_start.of[TLED_DISPLACEMENT]);
        const double s = tled_mixture(p, i);
        const element_fibre own = muscle_fibre_of(p, p->fibre, i, p->element_volume[i], 1 - s, value);
        const element_fibre other = muscle_fibre_of(p, p->mixfibre, i, tled_mix(p, i), s, value);
        element_law law = {{0}, {0}};
        element_field u;
        element_corners *const to[3] = {&u.x, &u.y, &u.z};
        memcpy(law.c, d.law.c, sizeof law.c);
        memcpy(law.hourglass, d.law.hourglass, sizeof law.hourglass);
        for (int k = 0; k < 24; k++)
            to[k % 3]->at[k / 3] = p->at_start.of[TLED_DISPLACEMENT][3 * p->element_node[8 * i + k / 3] + k % 3];
        const element_field f = element_force_of_two(p->form, p->control.kind, u, box, law, own,
                                                     element_fibre_which(own), other, element_fibre_which(other));
        const element_corners *const pulls[3] = {&f.x, &f.y, &f.z};
        for (int k = 0; k < 24; k++)
            want[3 * p->element_node[8 * i + k / 3] + k % 3] += pulls[k % 3]->at[k / 3];
    }
    for (int64_t i = 0; i < 3 * p->nodes; i++) {
        most = fmax(most, fabs(want[i]));
        gap = fmax(gap, fabs(want[i] - internal[i]));
    }
    ok(most > .1 && gap <= tolerance * most, "%s: forces of two muscles with shares: %.2g of %.2g N", device->is.device,
       gap, most);
    device->destroy(state);
    free(internal);
    free(value);
    bench_free(&b);
}

/* A state that is saved and restored gives the same bytes again, with contractile elements too. */
static void test_restored(const tled_executor *device)
{
    bench b;
    block what = bar;
    what.mixed = true;
    muscle_make(&b, &what, 1, .9, .05);
    const tled_problem *p = &b.problem;
    const tled_plan plan = {.rate = 4e5}, later = {.rate = 4e5, .first = 300};
    double *first = calloc((size_t)p->nodes * 6 + (size_t)p->elements * 2, sizeof *first);
    double *second = calloc((size_t)p->nodes * 3, sizeof *second), *taken = first + 6 * p->nodes, most = 0;
    tled_state *state = device->create(p, b.setup.threads, &b.e);
    ok(p->fields.count == TLED_MIXCONTRACTILE + 1, "mixed muscles with springs have two fields more");
    bench_must(!state || device->step(state, &plan, 300, &b.e) || device->save(state, &b.e) ||
                   device->step(state, &later, 300, &b.e) || device->get(state, TLED_DISPLACEMENT, first, &b.e) ||
                   device->get(state, TLED_CONTRACTILE, taken, &b.e) || device->restore(state, &b.e) ||
                   device->get(state, TLED_INTERNAL, second, &b.e) || device->step(state, &later, 300, &b.e) ||
                   device->get(state, TLED_DISPLACEMENT, second, &b.e),
               &b.e);
    for (int64_t i = 0; i < p->elements; i++)
        most = fmax(most, fabs(taken[i]));
    ok(most > 1e-3 && !memcmp(first, second, (size_t)p->nodes * 3 * sizeof *first),
       "saved and restored: the same bytes, c - 1 up to %.2g", most);
    device->destroy(state);
    free(first);
    free(second);
    bench_free(&b);
}

/* From displacements alone muscles begin with the stress of the plain curve. */
static void test_begins(void)
{
    bench b;
    block what = bar;
    double *value, worst = 0;
    what.mixed = true;
    muscle_make(&b, &what, 1, 0, .05);
    tled_problem *p = &b.problem;
    stretch(&b, 1.1);
    bench_must(muscle_fibre_rest(p, TLED_CONTRACTILE, 1, &b.e), &b.e);
    value = calloc((size_t)p->script->curves * 3, sizeof *value);
    tled_curves(p, 1, value);
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    for (int64_t i = 0; i < p->elements; i++) {
        const deformed d = deformed_of(p, i, box, p->at_start.of[TLED_DISPLACEMENT]);
        element_fibre fibre = muscle_fibre_of(p, p->fibre, i, p->element_volume[i], 1 - tled_mixture(p, i), value);
        fibre.series.contractile = p->at_start.of[TLED_CONTRACTILE][i];
        const double got = element_serial(d.h, fibre).xx;
        worst = fmax(worst, fabs(got - element_curved(d.h, fibre).xx));
    }
    ok(worst < 1e-6, "without contractile elements to begin with they are those of muscles at rest: %.2g Pa", worst);
    free(value);
    bench_free(&b);
}

static void test_need(void)
{
    bench b;
    muscle_make(&b, &bar, 1, 0, 0);
    ok(!(tled_need(&b.problem).features & EXECUTOR_CURVES), "plain muscles need no executor that has curves");
    bench_free(&b);
    muscle_make(&b, &bar, 1, 0, .05);
    ok(tled_need(&b.problem).features & EXECUTOR_CURVES, "passive ones do");
    bench_free(&b);
    muscle_make(&b, &bar, 1, 1.1, 0);
    ok(tled_need(&b.problem).features & EXECUTOR_CURVES, "and those with an optimum");
    ok(!(tled_need(&b.problem).features & EXECUTOR_SERIES), "which have no springs");
    bench_free(&b);
    vmax = 10;
    muscle_make(&b, &bar, 1, 0, 0);
    ok(tled_need(&b.problem).features & EXECUTOR_SERIES, "those with vmax do");
    bench_free(&b);
    vmax = 0;
}

int main(void)
{
    test_step_at_rest();
    test_forces(&tled_cpu_double, 1e-13);
    test_forces(&tled_cpu_single, 1e-5);
    test_need();
    vmax = 10;
    test_step_at_rest();
    test_forces(&tled_cpu_double, 1e-13);
    test_forces(&tled_cpu_single, 1e-5);
    test_restored(&tled_cpu_double);
    test_restored(&tled_cpu_single);
    test_begins();
    vmax = 0;
    test_popping();
    return done_testing();
}
