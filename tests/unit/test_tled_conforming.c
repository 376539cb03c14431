/* Hexahedra of any shape: boxes move as the lattice's solver moves them; distorted ones pass the patch test, are not
 * strained by turns, keep their energy, bring the same bytes with any number of threads and any vectors; and the stable
 * step bounds the largest frequency. */
// needs: tled/*/*.c
#include "tled/cpu/cpu_pass.h"
#include "tled/loop/monitor.h"
#include "tled/problem/conforming_step.h"
#include "tled/problem/deformed.h"

#include "form_tried.h"
#include "tap.h"
#include "tled_block.h"

#include <string.h>

enum { BY_DOUBLE, BY_SINGLE };

static const block soft = {{4, 3, 5}, {.01, .012, .009}, 3000, .45, 1000, 30000, 2, 0, 1, {0, 0, 0}, 0, false};

typedef struct setting {
    model m;
    script s;
    tled_problem p;
    pool *threads;
    const tled_executor *device;
    tled_state *state;
} setting;

static void die(const char *why)
{
    printf("Bail out! %s\n", why);
    exit(1);
}

/* Without the metadata, a block of boxes is a mesh like any other. */
static void forget_lattice(model *m)
{
    for (int i = 0; i < m->metas; i++) {
        free(m->meta[i].key);
        free(m->meta[i].value);
    }
    m->metas = 0;
    lookup_free(&m->meta_index);
}

/* by: of a side, how far nodes inside may move along each axis; outer ones stay on their
 * planes where nothing is asked of them. */
static void distort(const block *b, model *m, double by)
{
    double *x = model_find(m, "node.position")->f64;
    uint32_t seed = 1;
    for (int32_t k = 1; k < b->cells[2]; k++)
        for (int32_t j = 1; j < b->cells[1]; j++)
            for (int32_t i = 1; i < b->cells[0]; i++)
                for (int a = 0; a < 3; a++) {
                    seed = seed * 1664525 + 1013904223;
                    x[3 * block_node(b, i, j, k) + a] += by * b->side[a] * (2 * (double)(seed >> 8) / (1 << 24) - 1);
                }
}

static void begin(setting *s, block b, bool boxes, double by, hourglass_control control, int threads, int precision)
{
    err e = {0};
    *s = (setting){.state = NULL};
    block_make(&b, &s->m);
    if (!boxes)
        forget_lattice(&s->m);
    distort(&b, &s->m, by);
    if (b.fibre[0] != 0) {
        char level[] = "m=0.03";
        if (script_add_contract(&s->s, &s->m, level, 0, &e))
            die(e.text);
    }
    const double gravity[3] = {1, 2, -9.81};
    if (script_add_gravity(&s->s, gravity, 0, &e) || tled_problem_make(&s->p, &s->m, &s->s, control, &e))
        die(e.text);
    if (boxes == (s->p.conforming != NULL))
        die("a lattice is a lattice");
    s->threads = pool_create(threads, &e);
    const executor_need need = tled_need(&s->p);
    s->device = tled_executor_of(executor_choose(precision == BY_SINGLE ? tled_executors_single : tled_executors_double,
                                                 "cpu", &need, (char[300]){0}, 300, &e));
    s->state = s->threads && s->device ? s->device->create(&s->p, s->threads, &e) : NULL;
    if (!s->state)
        die(e.text);
}

static void end(setting *s)
{
    s->device->destroy(s->state);
    pool_destroy(s->threads);
    tled_problem_free(&s->p);
    script_free(&s->s);
    model_free(&s->m);
}

/* Begins anew from displacements; what the elements pull with then. */
static void pull(setting *s, const double *u, double *f)
{
    err e = {0};
    memcpy(s->p.at_start.of[TLED_DISPLACEMENT], u, 3 * (size_t)s->p.nodes * sizeof *u);
    s->device->destroy(s->state);
    s->state = s->device->create(&s->p, s->threads, &e);
    if (!s->state || s->device->get(s->state, TLED_INTERNAL, f, &e))
        die(e.text);
}

static double *numbers(const setting *s)
{
    double *x = calloc(3 * (size_t)s->p.nodes, sizeof *x);
    if (!x)
        die("no memory");
    return x;
}

static double *moved(setting *s, int64_t steps, double dt)
{
    err e = {0};
    tled_plan plan = {.rate = 1 / dt, .damping = 3};
    double *u = numbers(s);
    if (s->device->step(s->state, &plan, steps, &e) || s->device->get(s->state, TLED_DISPLACEMENT, u, &e))
        die(e.text);
    return u;
}

static double furthest(const double *u, const double *v, int64_t count)
{
    double most = 0;
    for (int64_t i = 0; i < count; i++)
        most = fmax(most, fabs(u[i] - (v ? v[i] : 0)));
    return most;
}

static void test_boxes(block b, const char *name)
{
    setting grid, mesh;
    begin(&grid, b, true, 0, PHYSICAL, 1, BY_DOUBLE);
    begin(&mesh, b, false, 0, PHYSICAL, 2, BY_DOUBLE);
    near_(step_at_rest(&mesh.p, NULL) / step_at_rest(&grid.p, NULL), 1, 1e-9, "%s: the lattice's stable step", name);
    const double dt = .5 * step_at_rest(&grid.p, NULL);
    double *u = moved(&grid, 200, dt), *v = moved(&mesh, 200, dt);
    ok(furthest(u, NULL, 3 * mesh.p.nodes) > 1e-3, "%s: it moves", name);
    near_(furthest(u, v, 3 * mesh.p.nodes) / furthest(u, NULL, 3 * mesh.p.nodes), 0, 1e-10,
          "%s: boxes move as the lattice's", name);
    free(u);
    free(v);
    end(&grid);
    end(&mesh);
}

/* x -> F x + shift, H = F - I. */
static void stretch(const setting *s, const double h[3][3], double *u)
{
    for (int64_t n = 0; n < s->p.nodes; n++)
        for (int i = 0; i < 3; i++) {
            u[3 * n + i] = .001 * i;
            for (int j = 0; j < 3; j++)
                u[3 * n + i] += h[i][j] * s->p.position[3 * n + j];
        }
}

/* The largest force on a node that eight elements hold, and on any. */
static void look(const setting *s, const double *f, double *inside, double *any)
{
    *inside = *any = 0;
    for (int64_t i = 0; i < 3 * s->p.nodes; i++) {
        bool held = s->p.corner_start[i / 3 + 1] - s->p.corner_start[i / 3] == 8;
        *any = fmax(*any, fabs(f[i]));
        *inside = held ? fmax(*inside, fabs(f[i])) : *inside;
    }
}

static void test_patch(void)
{
    const double h[3][3] = {{.1, .05, -.02}, {.03, -.08, .04}, {0, .06, .12}};
    const double angle = 1.1, turn[3][3] = {{cos(angle) - 1, -sin(angle), 0}, {sin(angle), cos(angle) - 1, 0}, {0}};
    setting s;
    double inside, any, turned;
    begin(&s, soft, false, .3, PHYSICAL, 1, BY_DOUBLE);
    double *u = numbers(&s), *f = numbers(&s);
    ok(s.p.conforming->element[30].couple > 1e-4, "a distorted element: its stretches and twists are not apart");
    stretch(&s, h, u);
    pull(&s, u, f);
    look(&s, f, &inside, &any);
    ok(any > 1e-3, "stretched, it pulls: %g N", any);
    near_(inside / any, 0, 1e-12, "the patch test: nothing at nodes inside");
    stretch(&s, turn, u);
    pull(&s, u, f);
    look(&s, f, &inside, &turned);
    near_(turned / any, 0, 1e-12, "turned by 63 degrees, it does not pull");
    free(u);
    free(f);
    end(&s);
}

/* Force is the energy's slope: by the monitor's energy, hourglass part and all. */
static void test_energy(hourglass_control control)
{
    setting s;
    err e = {0};
    block b = soft;
    begin(&s, b, false, .3, control, 1, BY_DOUBLE);
    s.p.gravity = -1;
    double *u = numbers(&s), *v = numbers(&s), *f = numbers(&s), first = 0, worst = 0, kinetic = 0;
    for (int64_t i = 0; i < 3 * s.p.nodes; i++)
        v[i] = s.p.hold[i] == HOLD_FREE ? .2 * sin((double)(i * 37 % 101)) : 0;
    memcpy(s.p.at_start.of[TLED_VELOCITY], v, 3 * (size_t)s.p.nodes * sizeof *v);
    pull(&s, u, f);
    const double dt = .05 * step_at_rest(&s.p, NULL);
    monitor *w = monitor_create(&s.p, s.threads, &e);
    tled_plan plan = {.rate = 1 / dt};
    for (int64_t i = 0; i <= 40; i++) {
        if (monitor_read(w, s.device, s.state, (double)i * 50 * dt, &e))
            die(e.text);
        const double energy = w->reading.kinetic + w->reading.strain;
        first = i ? first : energy;
        kinetic = fmax(kinetic, w->reading.strain);
        worst = fmax(worst, fabs(energy - first));
        plan.first = i * 50;
        if (s.device->step(s.state, &plan, 50, &e))
            die(e.text);
    }
    ok(kinetic > .2 * first, "much of the motion becomes strain: %g of %g J", kinetic, first);
    near_(worst / first, 0, 2e-3, "energy is kept over 2000 steps");
    monitor_destroy(w);
    free(u);
    free(v);
    free(f);
    end(&s);
}

static void test_bytes(int precision, const char *name)
{
    static const char *const vectors[] = {"plain", "AVX2", "AVX-512"};
    block b = soft;
    b.cells[0] = 11; /* past a chunk of nodes */
    b.cells[2] = 13;
    b.fibre[0] = .6F, b.fibre[1] = .8F;
    double *first = NULL;
    for (int i = 0; i < 4; i++) {
        setting s;
        const char *vector = i ? vectors[i - 1] : "";
        if (i)
            setenv("SINEW_VECTORS", vector, 1);
        err none = {0};
        if (i &&
            !cpu_pass_choose(precision == BY_SINGLE ? cpu_passes_single : cpu_passes_double, FORM_NEO_HOOKEAN, &none)) {
            skip(1, "a vector unit that is not here");
            continue;
        }
        begin(&s, b, false, .25, PHYSICAL, 1 + i, precision);
        double *u = moved(&s, 60, .4 * step_at_rest(&s.p, NULL));
        if (first)
            ok(!memcmp(first, u, 3 * (size_t)s.p.nodes * sizeof *u), "%s: the same bytes by %d threads in %s", name,
               1 + i, vector);
        else
            ok(furthest(u, NULL, 3 * s.p.nodes) > 1e-4, "%s: it moves", name);
        if (first)
            free(u);
        else
            first = u;
        end(&s);
    }
    unsetenv("SINEW_VECTORS");
    free(first);
}

static void test_single(void)
{
    setting s, d;
    begin(&s, soft, false, .3, PHYSICAL, 2, BY_SINGLE);
    begin(&d, soft, false, .3, PHYSICAL, 2, BY_DOUBLE);
    const double dt = .5 * step_at_rest(&d.p, NULL);
    double *u = moved(&s, 200, dt), *v = moved(&d, 200, dt);
    near_(furthest(u, v, 3 * d.p.nodes) / furthest(v, NULL, 3 * d.p.nodes), 0, 1e-4, "single comes near to double");
    free(u);
    free(v);
    end(&s);
    end(&d);
}

/* The square of the largest frequency of the whole, by power iteration on the forces of small displacements. */
static double largest(setting *s)
{
    double *u = numbers(s), *f = numbers(s), square = 0;
    for (int64_t i = 0; i < 3 * s->p.nodes; i++)
        u[i] = sin((double)(i * i % 97));
    for (int round = 0; round < 300; round++) {
        double size = furthest(u, NULL, 3 * s->p.nodes);
        for (int64_t i = 0; i < 3 * s->p.nodes; i++)
            u[i] *= 1e-9 / size;
        pull(s, u, f);
        for (int64_t i = 0; i < 3 * s->p.nodes; i++)
            f[i] /= s->p.mass[i / 3];
        square = furthest(f, NULL, 3 * s->p.nodes) / 1e-9;
        memcpy(u, f, 3 * (size_t)s->p.nodes * sizeof *u);
    }
    free(u);
    free(f);
    return square;
}

static void test_step(double by, hourglass_control control)
{
    setting s;
    block b = soft;
    begin(&s, b, false, by, control, 1, BY_DOUBLE);
    s.p.gravity = -1;
    const double step = step_at_rest(&s.p, NULL), true_step = 2 / sqrt(largest(&s));
    ok(step <= true_step * (1 + 1e-6) && step > .6 * true_step,
       "by %g, kappa %g: the stable step %.4g ms is below %.4g", by, control.kappa, 1e3 * step, 1e3 * true_step);
    end(&s);
}

/* The shortest step of an element alone is found exactly where its bound is: against its 24 x 24 matrix. */
static void test_element_bound(void)
{
    setting s;
    block b = soft;
    b.cells[0] = b.cells[1] = b.cells[2] = 1;
    b.fixed_low = b.fixed_high = 0;
    begin(&s, b, false, 0, PHYSICAL, 1, BY_DOUBLE);
    s.p.gravity = -1;
    near_(step_at_rest(&s.p, NULL) / (2 / sqrt(largest(&s))), 1, 1e-3, "one box: its step exactly");
    end(&s);
    for (int stiff = 0; stiff < 2; stiff++) {
        const hourglass_control control = stiff ? ISOTROPIC(2) : PHYSICAL;
        begin(&s, b, false, 0, control, 1, BY_DOUBLE);
        double *x = model_find(&s.m, "node.position")->f64;
        for (int i = 0; i < 24; i++)
            x[i] += .003 * sin(7. * i + 1);
        model copy = s.m;
        script none = {0};
        tled_problem p = {0};
        err e = {0};
        if (tled_problem_make(&p, &copy, &none, control, &e))
            die(e.text);
        s.device->destroy(s.state);
        tled_problem_free(&s.p);
        s.p = p;
        s.state = s.device->create(&s.p, s.threads, &e);
        const double step = step_at_rest(&s.p, NULL), true_step = 2 / sqrt(largest(&s));
        ok(step <= true_step * (1 + 1e-6) && step > .8 * true_step,
           "one distorted element, kappa %g: step %.5g ms, its largest frequency's %.5g ms", control.kappa, 1e3 * step,
           1e3 * true_step);
        s.p.script = &s.s;
        end(&s);
    }
}

/* ---- the bound of one element against the largest eigenvalue of M^-1 K, deformed too */

static double chance(void)
{
    static uint32_t seed = 11;
    seed = seed * 1664525 + 1013904223;
    return 2 * (double)(seed >> 8) / (1 << 24) - 1;
}

static element_field field_of(const tled_problem *p, const double u[24])
{
    element_field at;
    for (int c = 0; c < 8; c++) {
        const double *corner = u + 3 * p->element_node[c];
        at.x.at[c] = corner[0];
        at.y.at[c] = corner[1];
        at.z.at[c] = corner[2];
    }
    return at;
}

static void forces_of(const tled_problem *p, const double u[24], double f[24])
{
    const conforming_hold hold = conforming_hold_of(p, 0);
    const element_any shape = conforming_shape(p, 0, &hold);
    const tled_law from = tled_law_of(p, 0);
    const element_fibre none = {0};
    element_law law;
    memcpy(law.c, from.c, sizeof law.c);
    memcpy(law.hourglass, hold.law, sizeof law.hourglass);
    const element_field g = element_any_force(p->form, p->control.kind, field_of(p, u), &shape, law, none, false);
    for (int c = 0; c < 8; c++) {
        double *corner = f + 3 * p->element_node[c];
        corner[0] = g.x.at[c];
        corner[1] = g.y.at[c];
        corner[2] = g.z.at[c];
    }
}

/* At u, by power iteration on differences of forces. */
static double largest_of_element(const tled_problem *p, const double u[24])
{
    double way[24], moved[24], low[24] = {0}, high[24] = {0}, value = 0;
    for (int i = 0; i < 24; i++)
        way[i] = sin(3. * i * i + 1);
    for (int round = 0; round < 300; round++) {
        double size = 0, square = 0, own = 0;
        for (int i = 0; i < 24; i++)
            size = fmax(size, fabs(way[i]));
        for (int side = -1; side <= 1; side += 2) {
            for (int i = 0; i < 24; i++)
                moved[i] = u[i] + side * 1e-8 * way[i] / size;
            forces_of(p, moved, side < 0 ? low : high);
        }
        for (int i = 0; i < 24; i++) {
            const double next = (high[i] - low[i]) / (2e-8 * p->mass[i / 3]);
            square += next * way[i] / size;
            own += way[i] / size * (way[i] / size);
            way[i] = next;
        }
        value = square / own;
    }
    return value;
}

static double bound_of_element(const tled_problem *p, const double u[24], double *j)
{
    const element_fibre none = {0};
    const deformed d = deformed_of(p, 0, element_box(1, 1, 1), u);
    step_matrix a;
    conforming_matrix(p, 0, &d.law, d.h, none, &a);
    *j = 1 + d.dilation;
    return conforming_square(p, 0, conforming_twists(p, 0, d.h, &d.modes, d.stiffening), step_largest(&a));
}

/* One element, its corners moved by a share `by` of a side; false: it has no inside. */
static bool make_element(model *m, tled_problem *p, double nu, double by, hourglass_control control)
{
    static const script none = {0};
    block b = soft;
    err e = {0};
    b.poisson = nu;
    b.cells[0] = b.cells[1] = b.cells[2] = 1;
    b.fixed_low = b.fixed_high = 0;
    block_make(&b, m);
    forget_lattice(m);
    double *x = model_find(m, "node.position")->f64;
    for (int i = 0; i < 24; i++)
        x[i] += by * b.side[i % 3] * chance();
    return !tled_problem_make(p, m, &none, control, &e);
}

static void test_random_bounds(form f, double nu, double by, double moved, double least, hourglass_control control)
{
    double low = INFINITY, high = 0, sum = 0, u[24], j;
    int count = 0;
    for (int round = 0; round < 40; round++) {
        model m = {0};
        tled_problem p = {0};
        const bool made = make_element(&m, &p, nu, by, control);
        for (int i = 0; i < 24; i++)
            u[i] = moved * soft.side[i % 3] * chance();
        if (made) {
            p.form = f;
            form_tried(f, p.volume[0].law.mu, p.volume[0].law.bulk, p.volume[0].law.c);
            const double bound = bound_of_element(&p, u, &j);
            const double share = j > .3 ? bound / largest_of_element(&p, u) : NAN;
            low = fmin(low, share);
            high = fmax(high, share);
            sum += j > .3 ? share : 0;
            count += j > .3;
        }
        tled_problem_free(&p);
        model_free(&m);
    }
    ok(count > 20 && low >= 1 - 1e-5 && sum / count < least,
       "form %d, nu %g, corners moved by %g, then by %g: the bound is %.4f to %.4f of w^2, %.4f in the mean of %d",
       (int)f, nu, by, moved, low, high, sum / count, count);
}

static void test_refused(void)
{
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    err e = {0};
    block b = soft;
    block_make(&b, &m);
    forget_lattice(&m);
    int32_t *node = model_find(&m, "element.node")->i32;
    for (int c = 0; c < 4; c++) {
        int32_t swap = node[8 * 7 + c];
        node[8 * 7 + c] = node[8 * 7 + 4 + c];
        node[8 * 7 + 4 + c] = swap;
    }
    ok(tled_problem_make(&p, &m, &s, PHYSICAL, &e) && strstr(e.text, "element 7 has no inside"), "inside out: %s",
       e.text);
    tled_problem_free(&p);
    model_free(&m);
    b.mixed = true;
    e = (err){0};
    block_make(&b, &m);
    forget_lattice(&m);
    ok(tled_problem_make(&p, &m, &s, PHYSICAL, &e) && strstr(e.text, "element.mix"), "mixed: %s", e.text);
    tled_problem_free(&p);
    model_free(&m);
}

int main(void)
{
    block b = soft;
    test_boxes(b, "passive");
    b.fraction = -1;
    test_boxes(b, "by shares");
    b.fraction = 0;
    b.fibre[0] = .48F, b.fibre[1] = .6F, b.fibre[2] = .64F;
    test_boxes(b, "with muscle");
    test_patch();
    test_energy(PHYSICAL);
    test_energy(ISOTROPIC(.5));
    test_bytes(BY_DOUBLE, "double");
    test_bytes(BY_SINGLE, "single");
    test_single();
    test_step(0, PHYSICAL);
    test_step(.3, PHYSICAL);
    test_step(.3, ISOTROPIC(.0075));
    test_step(.3, ISOTROPIC(1));
    test_element_bound();
    test_random_bounds(FORM_NEO_HOOKEAN, .3, 0, 0, 1.0001, PHYSICAL);
    test_random_bounds(FORM_NEO_HOOKEAN, .3, .2, 0, 1.015, PHYSICAL);
    test_random_bounds(FORM_NEO_HOOKEAN, .3, .3, 0, 1.03, PHYSICAL);
    test_random_bounds(FORM_NEO_HOOKEAN, .45, .3, 0, 1.01, PHYSICAL);
    test_random_bounds(FORM_NEO_HOOKEAN, .3, .2, .05, 1.08, PHYSICAL);
    test_random_bounds(FORM_NEO_HOOKEAN, .3, .2, .15, 1.35, PHYSICAL);
    test_random_bounds(FORM_NEO_HOOKEAN, .45, .2, .15, 1.12, PHYSICAL);
    test_random_bounds(FORM_NEO_HOOKEAN, .3, .2, .05, 1.02, ISOTROPIC(.5));
    test_random_bounds(FORM_FIRST, .3, .2, .05, 1.1, PHYSICAL);
    test_random_bounds(FORM_FIRST, .45, .2, .15, 1.3, PHYSICAL);
    test_random_bounds(FORM_GENERAL, .45, .2, .15, 1.3, PHYSICAL);
    test_refused();
    return done_testing();
}
