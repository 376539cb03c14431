/* msds-run's solvers: Algorithm 1 on PST's figure 4, springs at rest under gravity and their momentum, the sharp bound
 * of the step, the FEM's patch test, the exact solver's contact, warping, and the same bytes for any number of threads.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c
#include "msds_block.h"

#include "base/mem.h"
#include "msds/cpu/msds_cpu.h"
#include "msds/problem/largest.h"
#include "msds/problem/stiffness.h"

#include "tap.h"

/* Solves `count` frames by a method from a start; returns displacements, the caller's to free. */
static double *run_frames(const msds_problem *p, const msds_plan *plan, int threads, int count, int64_t iterations,
                          msds_reading *reading)
{
    err e = {0};
    pool *workers = pool_create(threads, &e);
    msds_state *state = workers ? msds_cpu.create(p, workers, &e) : NULL;
    double *u = mem_array(p->nodes, 3 * sizeof *u, "test", &e);
    tets_must(state && u, &e);
    for (int i = 0; i < count; i++)
        tets_must(!msds_cpu.step(state, plan, iterations, &e), &e);
    tets_must(!msds_cpu.get(state, MSDS_DISPLACEMENT, u, &e) && !msds_cpu.monitor(state, reading, &e), &e);
    msds_cpu.destroy(state);
    pool_destroy(workers);
    return u;
}

static void make_problem(const tets *b, const msds_options *o, model *m, msds_problem *p)
{
    err e = {0};
    largest l;
    tets_make(b, m);
    tets_must(!msds_problem_make(p, m, o, &e) && !largest_of(p, &l, &e), &e);
    p->mass_factor = fmax(1, largest_factor(l.bound, o->damping, .01));
}

static void free_problem(model *m, msds_problem *p)
{
    msds_problem_free(p);
    model_free(m);
}

/* A model of any tetrahedra. */
static void make_any(const double *x, int64_t nodes, const int32_t *node, int64_t elements, double young, model *m)
{
    err e = {0};
    tets b = {.young = young, .poisson = .3, .density = 1000};
    tets_must(!model_axis_add(m, "node", nodes, &e) && !model_axis_add(m, "element", elements, &e), &e);
    memcpy(tets_array(m, "node.position")->f64, x, 3 * (size_t)nodes * sizeof *x);
    model_array *a = model_add_as(m, "element.node", MODEL_I32, "@node", "element", 4, &e);
    tets_must(a != NULL, &e);
    memcpy(a->i32, node, 4 * (size_t)elements * sizeof *node);
    tets_tables(&b, m);
    tets_array(m, "node.rigid");
}

static const double two_x[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
static const int32_t two[] = {0, 1, 2, 3, 1, 2, 3, 4};

static void test_figure_4(void)
{
    model m = {0};
    msds_problem p = {0};
    err e = {0};
    msds_options o = tets_options();
    int doubled = 0, single = 0;
    make_any(two_x, 5, two, 2, 5000, &m);
    ok(!msds_problem_make(&p, &m, &o, &e), "two tetrahedra that share a face: %s", e.text);
    for (int64_t i = 0; i < p.springs; i++) {
        const msds_spring *s = &p.spring[i];
        bool on_face = s->node[0] >= 1 && s->node[1] <= 3;
        doubled += on_face && s->stiffness == 20 && s->damper == 2;
        single += !on_face && s->stiffness == 10 && s->damper == 1;
    }
    ok(p.springs == 9 && doubled == 3 && single == 6, "9 springs, 3 of them doubled (PST figure 4): %d, %d, %d",
       (int)p.springs, doubled, single);
    near_(p.spring[0].rest, 1, 0, "as long as the edge");
    free_problem(&m, &p);
}

static void test_counts(void)
{
    static const int want[][5] = {{5, 5, 5, 320, 540}, {20, 10, 10, 7695, 10540}, {24, 12, 12, 13915, 18624}};
    for (int i = 0; i < 3; i++) {
        model m = {0};
        msds_problem p = {0};
        err e = {0};
        msds_options o = tets_options();
        tets b = {{want[i][0], want[i][1], want[i][2]}, {.1, .1, .1}, 3000, .45, 1000, 2, false};
        tets_make(&b, &m);
        tets_must(!msds_problem_make(&p, &m, &o, &e), &e);
        ok(p.elements == want[i][3] && p.springs == want[i][4], "%d x %d x %d nodes: %lld tetrahedra, %lld springs",
           want[i][0], want[i][1], want[i][2], (long long)p.elements, (long long)p.springs);
        free_problem(&m, &p);
    }
}

/* Gravity along a column of springs: at rest, the springs across each level carry what hangs below. The exact answer is
 * a small system of springs; here it is met as the balance of every node, and, for one tetrahedron, in closed form. */
static void test_hanging(void)
{
    model m = {0};
    msds_problem p = {0};
    msds_reading reading;
    err e = {0};
    msds_options o = tets_options();
    static const double x[] = {1, 0, 0, -.5, .8660254037844386, 0, -.5, -.8660254037844386, 0, 0, 0, -1};
    static const int32_t node[] = {0, 1, 2, 3};
    static const int32_t flipped[] = {0, 2, 1, 3};
    o.gravity[2] = -10;
    simplex shape;
    simplex_shape(x, x + 3, x + 6, x + 9, &shape);
    make_any(x, 4, shape.volume > 0 ? node : flipped, 1, 1e6, &m);
    for (int n = 0; n < 3; n++)
        model_find(&m, "node.rigid")->u8[n] = 1;
    largest l;
    tets_must(!msds_problem_make(&p, &m, &o, &e) && !largest_of(&p, &l, &e), &e);
    p.mass_factor = largest_factor(l.bound, o.damping, .01);
    msds_plan plan = tets_plan(MSDS_SPRINGS);
    double *u = run_frames(&p, &plan, 1, 200, 100, &reading);
    double k = 2000, weight = p.weight[3] * 10, down = 1; /* 3 k (L - L0) down / L = weight */
    for (int i = 0; i < 200; i++) {
        double length = sqrt(1 + down * down), f = 3 * k * (length - sqrt(2.)) * down / length - weight;
        double slope = 3 * k * (1 - sqrt(2.) / (length * length * length));
        down -= f / slope;
    }
    near_(-u[11], down - 1, 1e-5 * (down - 1), "a mass on three springs hangs where they balance it: %.9g m", -u[11]);
    near_(u[9], 0, 1e-7, "and straight down");
    free(u);
    free_problem(&m, &p);
}

static void test_column(void)
{
    model m = {0};
    msds_problem p = {0};
    msds_reading reading;
    err e = {0};
    msds_options o = tets_options();
    tets b = {{3, 3, 9}, {.02, .02, .08}, 20000, .3, 1000, 2, false};
    o.gravity[2] = 5;
    double worst = 0, heaviest = 0;
    make_problem(&b, &o, &m, &p);
    msds_plan plan = tets_plan(MSDS_SPRINGS);
    double *u = run_frames(&p, &plan, 2, 3000, 20, &reading), *f = mem_array(p.nodes, 3 * sizeof *f, "test", &e);
    tets_must(f != NULL, &e);
    for (int64_t i = 0; i < p.springs; i++) { /* in double, from the definition: equation 1 */
        const msds_spring *s = &p.spring[i];
        double d[3], length = 0;
        for (int a = 0; a < 3; a++) {
            d[a] = p.position[3 * s->node[1] + a] + u[3 * s->node[1] + a] - p.position[3 * s->node[0] + a] -
                   u[3 * s->node[0] + a];
            length += d[a] * d[a];
        }
        length = sqrt(length);
        for (int a = 0; a < 3; a++) {
            f[3 * s->node[0] + a] += s->stiffness * (length - s->rest) * d[a] / length;
            f[3 * s->node[1] + a] -= s->stiffness * (length - s->rest) * d[a] / length;
        }
    }
    double hangs = 0, held = 0;
    for (int64_t n = 0; n < p.nodes; n++) {
        hangs += p.fixed[n] ? 0 : p.weight[n] * 5;
        heaviest = fmax(heaviest, p.weight[n] * 5);
        held += p.fixed[n] ? f[3 * n + 2] : 0;
        for (int a = 0; a < 3 && !p.fixed[n]; a++)
            worst = fmax(worst, fabs(f[3 * n + a] + p.weight[n] * o.gravity[a]));
    }
    ok(worst < 1e-3 * heaviest, "a column of springs at rest: every node in balance to %.2g of a weight",
       worst / heaviest);
    near_(held, hangs, 1e-4 * hangs, "and what is fixed holds its weight");
    free(f);
    free(u);
    free_problem(&m, &p);
}

/* Momentum: without fixed nodes and forces, springs leave it as it was. */
static void test_momentum(void)
{
    model m = {0};
    msds_problem p = {0};
    err e = {0};
    msds_options o = tets_options();
    tets b = {{6, 5, 4}, {.1, .1, .1}, 3000, .45, 1000, -1, false};
    double before[3] = {0}, after[3] = {0}, size = 0;
    make_problem(&b, &o, &m, &p);
    for (int64_t i = 0; i < 3 * p.nodes; i++) {
        p.velocity[i] = .05 * sin((double)i * 1.7) + .002 * (double)(i % 3);
        before[i % 3] += p.weight[i / 3] * p.velocity[i];
        size += p.weight[i / 3] * fabs(p.velocity[i]);
    }
    pool *workers = pool_create(2, &e);
    msds_state *state = workers ? msds_cpu.create(&p, workers, &e) : NULL;
    double *v = mem_array(p.nodes, 3 * sizeof *v, "test", &e);
    msds_plan plan = tets_plan(MSDS_SPRINGS);
    tets_must(state && v, &e);
    tets_must(!msds_cpu.step(state, &plan, 100, &e) && !msds_cpu.get(state, MSDS_VELOCITY, v, &e), &e);
    for (int64_t i = 0; i < 3 * p.nodes; i++)
        after[i % 3] += p.weight[i / 3] * v[i];
    for (int a = 0; a < 3; a++)
        near_(after[a], before[a], 1e-5 * size, "momentum along axis %d after 100 steps", a);
    msds_cpu.destroy(state);
    pool_destroy(workers);
    free(v);
    free_problem(&m, &p);
}

/* The sum of what nodes carry, inertia times velocity. */
static void sum_momentum(const msds_problem *p, msds_state *state, double *v, double sum[3])
{
    err e = {0};
    tets_must(!msds_cpu.get(state, MSDS_VELOCITY, v, &e), &e);
    sum[0] = sum[1] = sum[2] = 0;
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        sum[i % 3] += p->weight[i / 3] * p->mass_factor * v[i];
}

/* What moves a block that nothing holds is the probe alone: its force, damper and all, is what the next step adds. */
static void test_push(void)
{
    model m = {0};
    msds_problem p = {0};
    msds_reading reading;
    err e = {0};
    msds_options o = tets_options();
    tets b = {{6, 5, 4}, {.1, .1, .1}, 3000, .45, 1000, -1, false};
    double before[3], after[3];
    make_problem(&b, &o, &m, &p);
    pool *workers = pool_create(2, &e);
    msds_state *state = workers ? msds_cpu.create(&p, workers, &e) : NULL;
    double *v = mem_array(p.nodes, 3 * sizeof *v, "test", &e);
    msds_plan plan = tets_plan(MSDS_SPRINGS);
    tets_press(&plan, .04, .055, .045, .09);
    tets_must(state && v, &e);
    for (int i = 0; i < 4; i++) {
        tets_must(!msds_cpu.step(state, &plan, 3, &e) && !msds_cpu.monitor(state, &reading, &e), &e);
        sum_momentum(&p, state, v, before);
        tets_must(!msds_cpu.step(state, &plan, 1, &e), &e);
        sum_momentum(&p, state, v, after);
        double off = 0, size = 0;
        for (int a = 0; a < 3; a++) {
            off = fmax(off, fabs((after[a] - before[a]) / plan.dt + reading.force[a]));
            size = fmax(size, fabs(reading.force[a]));
        }
        ok(size > 0 && off < 1e-3 * size, "the force on the probe, %.4g N, is what the block gains, to %.2g", size,
           off / size);
    }
    msds_cpu.destroy(state);
    pool_destroy(workers);
    free(v);
    free_problem(&m, &p);
}

/* Small motion about rest: a step just below the bound dies out, one just above grows. */
static void test_bound(void)
{
    model m = {0};
    msds_problem p = {0};
    err e = {0};
    largest l;
    msds_options o = tets_options();
    tets b = {{4, 4, 4}, {.06, .06, .06}, 3000, .45, 1000, 2, false};
    tets_make(&b, &m);
    tets_must(!msds_problem_make(&p, &m, &o, &e) && !largest_of(&p, &l, &e), &e);
    double stable = largest_step(l.rest, .1);
    near_(stable * stable * l.rest + .2 * stable * l.rest, 4, 1e-9, "dt^2 L + .2 dt L = 4");
    ok(l.bound >= l.rest, "no configuration is stiffer than the bound: %g, at rest %g", l.bound, l.rest);
    for (int64_t i = 0; i < 3 * p.nodes; i++)
        p.displacement[i] = p.fixed[i / 3] ? 0 : 1e-7 * sin(2.3 * (double)i);
    for (int above = 0; above < 2; above++) {
        msds_plan plan = tets_plan(MSDS_SPRINGS);
        msds_reading reading;
        plan.dt = stable * (above ? 1.01 : .995);
        free(run_frames(&p, &plan, 1, 1, 2000, &reading));
        ok(above ? !(reading.largest < 1e-4) : reading.largest < 3e-7, "a step of %s the stable one %s: %g m",
           above ? "1.01" : ".995", above ? "grows" : "does not grow", reading.largest);
    }
    free_problem(&m, &p);
}

/* Nodes on the surface displaced linearly: so are those inside, by either solver,
 * and the strain is that of the field. */
static void test_patch(void)
{
    model m = {0};
    msds_problem p = {0};
    msds_options o = tets_options();
    static const double slope[9] = {.01, .004, -.003, .002, -.008, .005, .001, .006, .012};
    tets b = {{6, 5, 7}, {.1, .08, .12}, 3000, .45, 1000, -1, true};
    make_problem(&b, &o, &m, &p);
    for (int64_t i = 0; i < 3 * p.nodes; i++)
        for (int c = 0; c < 3 && p.fixed[i / 3]; c++)
            p.displacement[i] += slope[3 * (i % 3) + c] * p.position[i / 3 * 3 + c];
    for (int exact = 0; exact < 2; exact++) {
        msds_plan plan = tets_plan(exact ? MSDS_EXACT : MSDS_FEM);
        msds_reading reading;
        double *u = run_frames(&p, &plan, 2, exact ? 3 : 1, 200, &reading), worst = 0;
        for (int64_t i = 0; i < 3 * p.nodes; i++) {
            double want = 0;
            for (int c = 0; c < 3; c++)
                want += slope[3 * (i % 3) + c] * p.position[i / 3 * 3 + c];
            worst = fmax(worst, fabs(u[i] - want));
        }
        ok(worst < (exact ? 1e-9 : 2e-7) * .12, "patch test, %s: off by %.2g m",
           exact ? "exact" : "conjugate gradients", worst);
        free(u);
    }
    free_problem(&m, &p);
}

/* Contact: no node is left in the probe, what it presses on is pushed away from it, and both solvers agree. */
static void test_contact(void)
{
    model m = {0};
    msds_problem p = {0};
    msds_options o = tets_options();
    tets b = {{11, 11, 7}, {.1, .1, .06}, 3000, .45, 1000, 2, false};
    msds_reading exact, cg, springs;
    make_problem(&b, &o, &m, &p);
    msds_plan plan = tets_plan(MSDS_EXACT);
    tets_press(&plan, .02, .052, .047, .052);
    double *u = run_frames(&p, &plan, 2, 5, 20, &exact), deepest = -1, off = 0;
    for (int64_t n = 0; n < p.nodes; n++) {
        double x[3] = {p.position[3 * n] + u[3 * n], p.position[3 * n + 1] + u[3 * n + 1],
                       p.position[3 * n + 2] + u[3 * n + 2]};
        deepest = fmax(deepest, probe_at(&plan.probe, x).depth);
    }
    ok(deepest < 1e-6 * .02, "no node is left in the probe: %g m", deepest);
    ok(exact.residual < 1e-6 && exact.contacts > 3 && exact.force[2] > 0, "residual %.2g, %lld contacts, %.4g N back",
       exact.residual, (long long)exact.contacts, exact.force[2]);
    plan.method = MSDS_FEM;
    double *w = run_frames(&p, &plan, 2, 5, 400, &cg);
    for (int64_t i = 0; i < 3 * p.nodes; i++)
        off = fmax(off, fabs(u[i] - w[i]));
    ok(off < 1e-3 * exact.largest, "400 conjugate gradients agree to %.2g of the largest", off / exact.largest);
    near_(cg.force[2], exact.force[2], 2e-3 * exact.force[2], "and so does the force");
    plan.method = MSDS_SPRINGS;
    free(run_frames(&p, &plan, 2, 5, 20, &springs));
    ok(springs.contacts > 0 && springs.force[2] > 0 && isnan(springs.residual), "springs push too: %.4g N",
       springs.force[2]);
    free(u);
    free(w);
    free_problem(&m, &p);
}

/* By a penalty, nodes stay in the probe as deep as their springs give; both solvers agree; and what
 * is fixed holds what the probe pushes. */
static void test_penalty(void)
{
    model m = {0};
    msds_problem p = {0};
    stiffness k = {0};
    err e = {0};
    msds_options o = tets_options();
    tets b = {{11, 11, 7}, {.1, .1, .06}, 3000, .45, 1000, 2, false};
    msds_reading exact, cg;
    o.penalty = true;
    make_problem(&b, &o, &m, &p);
    msds_plan plan = tets_plan(MSDS_EXACT);
    tets_press(&plan, .02, .052, .047, .052);
    double *u = run_frames(&p, &plan, 2, 8, 20, &exact), off = 0, springs = 0, held[3] = {0};
    for (int64_t n = 0; n < p.nodes; n++) {
        double x[3] = {p.position[3 * n] + u[3 * n], p.position[3 * n + 1] + u[3 * n + 1],
                       p.position[3 * n + 2] + u[3 * n + 2]};
        probe_touch t = probe_at(&plan.probe, x);
        springs += t.depth > 0 ? p.repulsion[n] * t.depth * t.way[2] : 0;
    }
    near_(-springs, exact.force[2], 2e-3 * exact.force[2], "a penalty pushes as deep as nodes are: %.4g N",
          exact.force[2]);
    plan.method = MSDS_FEM;
    double *w = run_frames(&p, &plan, 2, 8, 400, &cg), *f = mem_array(p.nodes, 3 * sizeof *f, "test", &e);
    for (int64_t i = 0; i < 3 * p.nodes; i++)
        off = fmax(off, fabs(u[i] - w[i]));
    ok(off < 2e-3 * exact.largest, "400 conjugate gradients agree to %.2g of the largest", off / exact.largest);
    pool *workers = pool_create(1, &e);
    tets_must(workers && f && !stiffness_make(&k, &p, false, workers, &e), &e);
    stiffness_force(&k, u, f);
    for (int64_t i = 0; i < 3 * p.nodes; i++)
        held[i % 3] += p.fixed[i / 3] ? f[i] : 0;
    for (int a = 0; a < 3; a++)
        near_(held[a], exact.force[a], 1e-5 * exact.force[2], "what is fixed holds the probe's force along axis %d", a);
    stiffness_free(&k);
    pool_destroy(workers);
    free(f);
    free(u);
    free(w);
    free_problem(&m, &p);
}

/* auto: springs store the energy of their material, pulled along an axis (nu = 3/13, as theirs is). */
static void test_auto(void)
{
    model m = {0};
    msds_problem p = {0};
    msds_options o = tets_options();
    tets b = {{6, 5, 7}, {.05, .04, .06}, 7000, 3. / 13, 1000, 2, false};
    double energy = 0;
    o.scale = 0;
    make_problem(&b, &o, &m, &p);
    near_(p.scale, .01 / 8.615, 1e-6 * .01, "k = h / 8.615 E");
    for (int64_t i = 0; i < p.springs; i++) {
        const msds_spring *s = &p.spring[i];
        double square = 0;
        for (int a = 0; a < 3; a++) {
            double d = p.position[3 * s->node[1] + a] - p.position[3 * s->node[0] + a];
            d *= 1 + (a ? -3. / 13 : 1) * 1e-5;
            square += d * d;
        }
        energy += s->stiffness * (sqrt(square) - s->rest) * (sqrt(square) - s->rest) / 2;
    }
    double want = .5 * 7000 * 1e-10 * .05 * .04 * .06;
    near_(energy, want, 2e-4 * want, "and the energy of a pull along x is the material's");
    free_problem(&m, &p);
}

/* A rigid turn: linear elements take it for strain, warped ones do not. */
static void test_warp(void)
{
    double q[4] = {0, 0, sin(.4), cos(.4)}, r[3][3], g[3][3], f[4][3], start[4] = {0, 0, 0, 1}, found[3][3], worst = 0;
    static const double x[] = {0, 0, 0, 1, .1, 0, 0, 1, .2, .1, 0, 1};
    simplex s;
    simplex_shape(x, x + 3, x + 6, x + 9, &s);
    simplex_material(1000, .3, &s);
    simplex_matrix(q, r);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            g[a][b] = r[a][b] - (a == b);
    simplex_rotation(g, start, found);
    simplex_warped(&s, g, found, f);
    for (int c = 0; c < 4; c++)
        for (int a = 0; a < 3; a++)
            worst = fmax(worst, fabs(f[c][a]));
    ok(worst < 1e-6, "a turn of .8 is no strain to a warped element: %g N", worst);
    simplex_force(&s, g, f);
    ok(fabs(f[1][0]) > 1, "but to a linear one: %g N", f[1][0]);
}

/* A beam that hangs far down: the equilibrium of warped elements by two ways that share only the elements' forces. */
static void test_warped(void)
{
    model m = {0};
    msds_problem p = {0};
    msds_options o = tets_options();
    tets b = {{11, 4, 4}, {.1, .03, .03}, 20000, .4, 1000, 0, false};
    msds_reading exact, cg;
    o.gravity[2] = -9.81;
    make_problem(&b, &o, &m, &p);
    msds_plan plan = tets_plan(MSDS_EXACT);
    plan.warp = true;
    double *first = run_frames(&p, &plan, 2, 1, 20, &exact), left = tets_left(&p, first);
    ok(exact.residual < 1e-6 && left < 1e-6, "warped, the first frame: residual %.2g, by its elements %.2g",
       exact.residual, left);
    double *u = run_frames(&p, &plan, 2, 2, 20, &exact), off = 0;
    ok(exact.residual < 1e-6 && exact.largest > .02, "warped, %.3g m down: residual %.2g", exact.largest,
       exact.residual);
    plan.method = MSDS_FEM;
    double *w = run_frames(&p, &plan, 2, 60, 100, &cg);
    for (int64_t i = 0; i < 3 * p.nodes; i++)
        off = fmax(off, fabs(u[i] - w[i]));
    ok(off < 1e-4 * exact.largest, "conjugate gradients come to the same to %.2g of the largest", off / exact.largest);
    free(first);
    free(u);
    free(w);
    free_problem(&m, &p);
}

static void test_threads(void)
{
    model m = {0};
    msds_problem p = {0};
    msds_options o = tets_options();
    tets b = {{20, 10, 10}, {.16, .08, .08}, 3000, .45, 1000, 2, false};
    static const char *const names[] = {"springs", "conjugate gradients", "exact"};
    make_problem(&b, &o, &m, &p);
    for (int method = 0; method < 3; method++) {
        msds_plan plan = tets_plan((msds_method)method);
        msds_reading reading;
        tets_press(&plan, .02, .08, .04, .074);
        double *one = run_frames(&p, &plan, 1, 3, 20, &reading),
               *two_threads = run_frames(&p, &plan, 2, 3, 20, &reading);
        double *three = run_frames(&p, &plan, 3, 3, 20, &reading);
        size_t size = 3 * (size_t)p.nodes * sizeof *one;
        ok(!memcmp(one, two_threads, size) && !memcmp(one, three, size), "%s: the same bytes by 1, 2 and 3 threads",
           names[method]);
        free(one);
        free(two_threads);
        free(three);
    }
    free_problem(&m, &p);
}

static void test_bad(void)
{
    model m = {0};
    msds_problem p = {0};
    err e = {0};
    probe shape;
    msds_options o = tets_options();
    static const int32_t inverted[] = {0, 1, 2, 3, 1, 3, 2, 4};
    make_any(two_x, 5, inverted, 2, 5000, &m);
    ok(msds_problem_make(&p, &m, &o, &e) && strstr(e.text, "element 1 is inverted"), "%s", e.text);
    free_problem(&m, &p);
    static const char *const bad[] = {"sphere:0", "sphere:-1cm", "sphere:", "sphere:nan", "box:1", "sphere"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        e = (err){0};
        ok(probe_of(&shape, bad[i], &e) && e.status == (i < 2 ? STATUS_BAD : STATUS_USAGE), "%s", e.text);
    }
    e = (err){0};
    ok(!probe_of(&shape, "sphere:2cm", &e) && shape.radius == .02, "a sphere of 2 cm");
    make_any(two_x, 5, two, 2, 5000, &m);
    tets_must(!msds_problem_make(&p, &m, &o, &e), &e);
    pool *workers = pool_create(1, &e);
    msds_state *state = workers ? msds_cpu.create(&p, workers, &e) : NULL;
    msds_plan plan = tets_plan(MSDS_EXACT);
    ok(state && msds_cpu.step(state, &plan, 1, &e) && strstr(e.text, "nothing holds"), "%s", e.text);
    msds_cpu.destroy(state);
    pool_destroy(workers);
    free_problem(&m, &p);
}

/* An element has its share of stiffness and mass, and what two volumes mixed have between them. */
static void test_shares(void)
{
    model m = {0};
    msds_problem p = {0};
    err e = {0};
    msds_options o = tets_options();
    make_any(two_x, 5, two, 2, 5000, &m);
    tets_must(!msds_problem_make(&p, &m, &o, &e), &e);
    const double whole = p.weight[0], young = p.young[0];
    msds_problem_free(&p);
    p = (msds_problem){0};
    float *fraction = tets_array(&m, "element.fraction")->f32, *mixture;
    fraction[0] = .5F, fraction[1] = 1;
    tets_must(!msds_problem_make(&p, &m, &o, &e), &e);
    near_(p.young[0] / young, .5, 1e-12, "half an element: half the stiffness");
    ok(p.young[1] == young, "not of the other");
    msds_problem_free(&p);
    p = (msds_problem){0};
    tets_array(&m, "element.mix")->i32[1] = -1;
    mixture = tets_array(&m, "element.mixture")->f32;
    mixture[0] = .3F;
    tets_must(!msds_problem_make(&p, &m, &o, &e), &e);
    near_(p.young[0] / young, .5, 1e-9, "mixed of one material twice");
    ok(p.weight[0] < whole, "and less mass");
    msds_problem_free(&p);
    p = (msds_problem){0};
    mixture[0] = 2;
    ok(msds_problem_make(&p, &m, &o, &e) && strstr(e.text, "element.mixture, row 0 is 2"), "%s", e.text);
    e = (err){0};
    mixture[0] = .3F;
    fraction[0] = 0;
    msds_problem_free(&p);
    p = (msds_problem){0};
    ok(msds_problem_make(&p, &m, &o, &e) && strstr(e.text, "element.fraction, row 0 is 0"), "%s", e.text);
    free_problem(&m, &p);
}

int main(void)
{
    test_shares();
    test_figure_4();
    test_counts();
    test_hanging();
    test_column();
    test_momentum();
    test_push();
    test_bound();
    test_patch();
    test_contact();
    test_penalty();
    test_auto();
    test_warp();
    test_threads();
    test_warped();
    test_bad();
    return done_testing();
}
