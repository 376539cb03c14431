/* What msds-run says a probe feels, held to figures of our own. The contacts of a ball have no friction, so that all
 * their forces go through its centre, and their torque about any other point is that of the whole force there. What the
 * FEM's nodes are pushed with is what their elements pull with, from stresses made here by hand. And what is fixed
 * presses nothing.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c
#include "msds_block.h"

#include "base/mem.h"
#include "msds/cpu/msds_cpu.h"
#include "msds/problem/largest.h"

#include "tap.h"

static const char *const names[] = {"springs", "conjugate gradients", "exactly"};

typedef struct pressed {
    model m;
    msds_problem p;
    double *u; /* nodes x 3, m */
    msds_reading reading;
} pressed;

static void press(pressed *s, const tets *b, const msds_plan *plan, int frames, int64_t iterations)
{
    err e = {0};
    largest l;
    const msds_options o = tets_options();
    *s = (pressed){0};
    tets_make(b, &s->m);
    tets_must(!msds_problem_make(&s->p, &s->m, &o, &e) && !largest_of(&s->p, &l, &e), &e);
    s->p.mass_factor = fmax(1, largest_factor(l.bound, o.damping, .01));
    pool *workers = pool_create(1, &e);
    msds_state *state = workers ? msds_cpu.create(&s->p, workers, &e) : NULL;
    s->u = mem_array(s->p.nodes, 3 * sizeof *s->u, "test", &e);
    tets_must(state && s->u, &e);
    for (int i = 0; i < frames; i++)
        tets_must(!msds_cpu.step(state, plan, iterations, &e), &e);
    tets_must(!msds_cpu.get(state, MSDS_DISPLACEMENT, s->u, &e) && !msds_cpu.monitor(state, &s->reading, &e), &e);
    msds_cpu.destroy(state);
    pool_destroy(workers);
}

static void let_go(pressed *s)
{
    free(s->u);
    msds_problem_free(&s->p);
    model_free(&s->m);
}

static void cross(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double length(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* How far a is from b. */
static double apart(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return length(d);
}

/* Adds the forces that a tetrahedron pulls its nodes with where they are moved by u: V sigma grad N, sigma of Cauchy's
 * strain. */
static void pull(const double *x, const double *u, const int32_t node[4], double young, double poisson, double *f)
{
    const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    double edge[3][3], slope[4][3] = {{0}}, g[3][3] = {{0}}, trace = 0;
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            edge[i][a] = x[3 * node[i + 1] + a] - x[3 * node[0] + a];
    for (int i = 0; i < 3; i++)
        cross(edge[(i + 1) % 3], edge[(i + 2) % 3], slope[i + 1]);
    const double six = edge[0][0] * slope[1][0] + edge[0][1] * slope[1][1] + edge[0][2] * slope[1][2];
    for (int i = 1; i < 4; i++)
        for (int a = 0; a < 3; a++) {
            slope[i][a] /= six;
            slope[0][a] -= slope[i][a];
        }
    for (int i = 0; i < 4; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                g[a][b] += u[3 * node[i] + a] * slope[i][b];
    for (int a = 0; a < 3; a++)
        trace += g[a][a];
    for (int i = 0; i < 4; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                f[3 * node[i] + a] +=
                    six / 6 * slope[i][b] * (mu * (g[a][b] + g[b][a]) + (a == b ? lambda * trace : 0));
}

/* The block of these tests, whose lowest nodes along an axis are fixed, and a ball beside its middle, leaning. */
static const tets block = {{9, 8, 6}, {.08, .07, .05}, 3000, .4, 1000, 2, false};

static void lean(msds_plan *plan, double depth)
{
    const double tilt = .3;
    const probe shape = probe_sphere(.02);
    /* Turned about x by 180 degrees, so that +z goes down, and about y by the tilt. */
    const pose at = {{.057, .024, .05 - depth}, {cos(tilt / 2), 0, -sin(tilt / 2), 0}};
    plan->touched = true;
    plan->probe = probe_place(&shape, &at);
}

/* Every contact's force goes through the ball's centre, which is R behind the origin along the probe's own z. */
static void through_the_centre(void)
{
    pressed s;
    double arm[3], want[3];
    msds_plan plan = tets_plan(MSDS_SPRINGS);
    lean(&plan, .004);
    press(&s, &block, &plan, 3, 40);
    for (int a = 0; a < 3; a++)
        arm[a] = -.02 * plan.probe.axis[2][a];
    cross(arm, s.reading.force, want);
    ok(s.reading.contacts > 3 && s.reading.force[2] > 1e-2 && length(want) > 1e-3 * length(s.reading.force),
       "springs push a ball back: %.4g N, by %lld nodes", s.reading.force[2], (long long)s.reading.contacts);
    ok(apart(s.reading.torque, want) < 1e-7 * length(want),
       "with a torque of (%.4g, %.4g, %.4g) N m, as through its centre", s.reading.torque[0], s.reading.torque[1],
       s.reading.torque[2]);
    let_go(&s);
}

/* Of the FEM: force and torque are those of what the elements pull free nodes with, at their places. */
static void from_the_stresses(msds_method method, int64_t iterations, double tolerance)
{
    pressed s;
    err e = {0};
    double force[3] = {0}, torque[3] = {0};
    msds_plan plan = tets_plan(method);
    lean(&plan, .004);
    press(&s, &block, &plan, 4, iterations);
    double *f = mem_array(s.p.nodes, 3 * sizeof *f, "test", &e);
    tets_must(f != NULL, &e);
    for (int64_t t = 0; t < s.p.elements; t++)
        pull(s.p.position, s.u, s.p.element_node + 4 * t, block.young, block.poisson, f);
    for (int64_t n = 0; n < s.p.nodes; n++) {
        double arm[3], push[3], twist[3];
        for (int a = 0; a < 3; a++) {
            arm[a] = s.p.position[3 * n + a] + s.u[3 * n + a] - plan.probe.origin[a];
            push[a] = s.p.fixed[n] ? 0 : -f[3 * n + a];
            force[a] += push[a];
        }
        cross(arm, push, twist);
        for (int a = 0; a < 3; a++)
            torque[a] += twist[a];
    }
    const double size = length(force);
    ok(size > .1 && length(torque) > .002 * size && apart(s.reading.force, force) < tolerance * size,
       "%s: a force of %.4g N, as the stresses say", names[method], size);
    ok(apart(s.reading.torque, torque) < tolerance * .02 * size, "and a torque of (%.4g, %.4g, %.4g) N m",
       s.reading.torque[0], s.reading.torque[1], s.reading.torque[2]);
    free(f);
    let_go(&s);
}

/* A block held all round: the probe goes 4 mm into nodes that do not move, and nothing presses it. */
static void what_is_fixed(msds_method method)
{
    static const tets held = {{9, 8, 6}, {.08, .07, .05}, 3000, .4, 1000, 0, true};
    pressed s;
    int64_t inside = 0, loose = 0;
    msds_plan plan = tets_plan(method);
    lean(&plan, .004);
    press(&s, &held, &plan, 3, 20);
    for (int64_t n = 0; n < s.p.nodes; n++) {
        const bool hit = probe_at(&plan.probe, s.p.position + 3 * n).depth > 0;
        inside += hit;
        loose += hit && !s.p.fixed[n];
    }
    ok(inside > 2 && !loose, "%lld fixed nodes are in the probe, and none that is free", (long long)inside);
    ok(!s.reading.contacts && !s.reading.met && length(s.reading.force) == 0 && length(s.reading.torque) == 0 &&
           s.reading.largest == 0,
       "%s: they press nothing: %lld contacts, %g N", names[method], (long long)s.reading.contacts,
       length(s.reading.force));
    let_go(&s);
}

/* Where some that it touches are fixed, those push nothing, though they are in it. */
static void beside_the_fixed(void)
{
    static const tets wall = {{9, 8, 6}, {.08, .07, .05}, 3000, .4, 1000, 0, false};
    const probe shape = probe_sphere(.02);
    const pose at = {{.004, .035, .046}, {1, 0, 0, 0}};
    pressed s;
    double force[3] = {0};
    int64_t count = 0, fixed = 0;
    msds_plan plan = tets_plan(MSDS_SPRINGS);
    plan.touched = true;
    plan.probe = probe_place(&shape, &at);
    press(&s, &wall, &plan, 200, 40);
    for (int64_t n = 0; n < s.p.nodes; n++) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = s.p.position[3 * n + a] + s.u[3 * n + a];
        const probe_touch t = probe_at(&plan.probe, x);
        fixed += t.depth > 0 && s.p.fixed[n];
        if (t.depth <= 0 || s.p.fixed[n])
            continue;
        count++;
        for (int a = 0; a < 3; a++)
            force[a] -= s.p.repulsion[n] * t.depth * t.way[a];
    }
    ok(fixed > 1 && count > 1 && s.reading.contacts == count,
       "%lld fixed nodes in the probe, %lld free ones: these press", (long long)fixed, (long long)count);
    ok(apart(s.reading.force, force) < 1e-3 * length(force), "with what their springs give: %.4g N", length(force));
    let_go(&s);
}

int main(void)
{
    through_the_centre();
    from_the_stresses(MSDS_EXACT, 1, 1e-5);
    from_the_stresses(MSDS_FEM, 400, 2e-3);
    for (int method = 0; method < 3; method++)
        what_is_fixed((msds_method)method);
    beside_the_fixed();
    return done_testing();
}
