/* The contact stiffness of a probe, by each method, against differences of what the method itself converges to at poses
 * a little beside; against closed forms; symmetric where it has to be; and turned where everything is. And what it
 * costs from frame to frame.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c msds/tangent/*.c
#include "msds_block.h"

#include "msds/cpu/msds_cpu.h"
#include "msds/problem/largest.h"
#include "msds/tangent/probe_tangent.h"

#include "tap.h"

typedef double matrix6[6][6];

typedef struct bench {
    model m;
    msds_problem p;
    pool *threads;
    msds_state *state;
    probe_tangent *tangent;
    msds_plan plan;
    probe shape;
    pose at;
    int frames;
    int64_t iterations;
} bench;

/* turn: of the whole block, about the origin. */
static void begin_turned(bench *b, const tets *block, const msds_options *o, const pose *turn)
{
    err e = {0};
    largest l;
    tets_make(block, &b->m);
    double *x = model_find(&b->m, "node.position")->f64;
    for (int64_t n = 0; n < model_count(&b->m, "node") && turn; n++)
        pose_apply(turn, x + 3 * n, x + 3 * n);
    tets_must(!msds_problem_make(&b->p, &b->m, o, &e) && !largest_of(&b->p, &l, &e), &e);
    b->p.mass_factor = fmax(1, largest_factor(l.bound, o->damping, .01));
    b->threads = pool_create(1, &e);
    b->state = b->threads ? msds_cpu.create(&b->p, b->threads, &e) : NULL;
    b->tangent = b->state ? probe_tangent_create(&msds_cpu, b->state, &e) : NULL;
    tets_must(b->tangent != NULL, &e);
}

static void begin(bench *b, const tets *block, const msds_options *o)
{
    begin_turned(b, block, o, NULL);
}

static void end(bench *b)
{
    probe_tangent_destroy(b->tangent);
    msds_cpu.destroy(b->state);
    pool_destroy(b->threads);
    msds_problem_free(&b->p);
    model_free(&b->m);
}

/* The force and the torque with the probe there, when nothing moves any more. */
static msds_reading settle(bench *b, const pose *at, int frames)
{
    err e = {0};
    msds_reading r;
    b->plan.touched = true;
    b->plan.probe = probe_place(&b->shape, at);
    for (int i = 0; i < frames; i++)
        tets_must(!msds_cpu.step(b->state, &b->plan, b->iterations, &e), &e);
    tets_must(!msds_cpu.monitor(b->state, &r, &e), &e);
    return r;
}

/* The pose moved by h along one of the six. */
static pose beside(const pose *at, int j, double h)
{
    pose by = pose_none(), to = *at;
    if (j < 3) {
        to.position[j] += h;
        return to;
    }
    by.quaternion[j - 3] = sin(h / 2);
    by.quaternion[3] = cos(h / 2);
    to = pose_compose(&by, at);
    memcpy(to.position, at->position, sizeof to.position);
    return to;
}

static void differences(bench *b, double h, double turn, matrix6 k)
{
    for (int j = 0; j < 6; j++) {
        const double by = j < 3 ? h : turn;
        const pose more = beside(&b->at, j, by), less = beside(&b->at, j, -by);
        const msds_reading high = settle(b, &more, b->frames), low = settle(b, &less, b->frames);
        for (int i = 0; i < 3; i++) {
            k[i][j] = -(high.force[i] - low.force[i]) / (2 * by);
            k[3 + i][j] = -(high.torque[i] - low.torque[i]) / (2 * by);
        }
    }
}

static double scale_of(int i)
{
    return i < 3 ? 1 : .01; /* m: a turn is as long as an arc at that radius */
}

/* The largest difference, over the largest element, turns by arcs. */
static double apart(matrix6 a, matrix6 b)
{
    double most = 0, worst = 0;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            const double s = scale_of(i) * scale_of(j);
            most = fmax(most, fabs(a[i][j]) / s);
            worst = fmax(worst, fabs(a[i][j] - b[i][j]) / s);
        }
    return worst / most;
}

static void show(const char *what, matrix6 k)
{
    printf("# %s\n", what);
    for (int i = 0; i < 6; i++) {
        printf("#");
        for (int j = 0; j < 6; j++)
            printf(" %10.4g", k[i][j]);
        printf("\n");
    }
}

static probe_tangent_reading find(bench *b, int64_t most)
{
    err e = {0};
    probe_tangent_reading r;
    tets_must(!probe_tangent_find(b->tangent, most, most, &r, &e), &e);
    return r;
}

/* Whether it is symmetric but for what a torque does where turns follow each other. */
static double asymmetry(matrix6 k, const double torque[3])
{
    matrix6 other;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            other[i][j] = k[j][i];
    for (int a = 0; a < 3; a++) {
        other[3 + (a + 1) % 3][3 + (a + 2) % 3] -= torque[a];
        other[3 + (a + 2) % 3][3 + (a + 1) % 3] += torque[a];
    }
    return apart(k, other);
}

typedef struct trial {
    const char *name;
    msds_method method;
    bool warp, penalty;
    double friction, poisson;
    int frames;
    int64_t iterations;
    double within;
} trial;

static void try_method(const trial *t, const probe *shape, const pose *at, const char *by)
{
    const tets block = {{7, 7, 5}, {.06, .06, .04}, 1e4, t->poisson, 1000, 2, false};
    bench b = {.shape = *shape, .at = *at, .frames = t->frames, .iterations = t->iterations};
    msds_options o = tets_options();
    matrix6 k;
    o.penalty = t->penalty;
    o.friction = t->friction;
    begin(&b, &block, &o);
    b.plan = tets_plan(t->method);
    b.plan.warp = t->warp;
    pose above = *at;
    for (int i = 6; i >= 0; i--) { /* it comes down */
        above.position[2] = at->position[2] + .0005 * i;
        settle(&b, &above, 2);
    }
    const msds_reading there = settle(&b, at, 3 * t->frames);
    probe_tangent_reading r = find(&b, 400);
    differences(&b, 2e-5, 2e-3, k);
    const double off = apart(k, r.stiffness);
    ok(off < t->within, "%s, %s: off by %.2g of the largest, after %lld products", t->name, by, off,
       (long long)r.products);
    if (!(off < t->within)) {
        show("differences", k);
        show("tangent", r.stiffness);
    }
    if (!(t->friction > 0))
        ok(asymmetry(k, there.torque) < 5 * t->within && asymmetry(r.stiffness, there.torque) < t->within,
           "symmetric, but for the torque's turn: off by %.2g, its differences by %.2g",
           asymmetry(r.stiffness, there.torque), asymmetry(k, there.torque));
    end(&b);
}

static void test_methods(void)
{
    static const trial trials[] = {
        {"springs", MSDS_SPRINGS, false, false, 0, .4, 24, 60, .005},
        {"fem", MSDS_FEM, false, false, 0, .4, 5, 40, .001},
        {"fem, penalty", MSDS_FEM, false, true, 0, .4, 5, 40, .001},
        {"fem, friction", MSDS_FEM, false, false, .8, .4, 10, 30, .02},
        {"exact", MSDS_EXACT, false, false, 0, .4, 4, 1, .001},
        {"exact, penalty", MSDS_EXACT, false, true, 0, .4, 4, 1, .001},
        {"warp", MSDS_FEM, true, false, 0, .4, 5, 40, .001},
        {"exact-warp", MSDS_EXACT, true, false, 0, .4, 4, 1, .001},
        {"tissue", MSDS_TISSUE, false, false, 0, .4, 4, 60, .001},
        {"tissue, penalty", MSDS_TISSUE, false, true, 0, .4, 4, 60, .001},
        {"tissue of nu .49", MSDS_TISSUE, false, false, 0, .49, 12, 60, .001},
    };
    const probe ball = probe_sphere(.02), box = probe_linear(.03, .012, .003);
    const pose on = {{.031, .0285, .037}, {1, 0, 0, 0}};
    const pose tilted = {{.031, .0285, .0375}, {.9961947, 0, .0871557, 0}};
    for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
        try_method(&trials[i], &ball, &on, "a ball");
        try_method(&trials[i], &box, &tilted, "a box that is tilted");
    }
}

/* A plate without friction on a block of nu 0: its stiffness is E A / L along its axis, that of a hinge across it, and
 * nothing along its face. A penalty is a spring in series. */
static void test_plate(void)
{
    const tets block = {{7, 7, 6}, {.06, .06, .05}, 1e4, 0, 1000, 2, false};
    for (int penalty = 0; penalty < 2; penalty++) {
        bench b = {.shape = probe_linear(.2, .2, .005), .at = {{.03, .03, .0499}, {1, 0, 0, 0}}, .iterations = 60};
        msds_options o = tets_options();
        o.penalty = penalty;
        begin(&b, &block, &o);
        b.plan = tets_plan(MSDS_FEM);
        settle(&b, &b.at, 20);
        const probe_tangent_reading r = find(&b, 400);
        double springs = 0, want = 1e4 * .06 * .06 / .05;
        for (int64_t n = 0; n < b.p.nodes; n++)
            springs += b.p.position[3 * n + 2] > .0499 ? b.p.repulsion[n] : 0;
        if (penalty) /* not uniform over the face: softer than all springs together in series, and by little */
            ok(r.stiffness[2][2] < 1 / (1 / want + 1 / springs) && r.stiffness[2][2] > .9 / (1 / want + 1 / springs),
               "a plate by a penalty: %.6g N/m; springs in series %.6g", r.stiffness[2][2],
               1 / (1 / want + 1 / springs));
        else
            near_(r.stiffness[2][2], want, 1e-4 * want, "a plate on a block: E A / L = %.6g N/m", want);
        ok(fabs(r.stiffness[0][0]) < 1e-4 * want && fabs(r.stiffness[1][1]) < 1e-4 * want, "slips along it: %.2g",
           r.stiffness[0][0]);
        end(&b);
    }
}

static void turn_matrix(matrix6 k, const pose *turn, matrix6 to)
{
    double r[9];
    pose_matrix(turn->quaternion, r);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            to[i][j] = 0;
            for (int a = 0; a < 3; a++)
                for (int c = 0; c < 3; c++)
                    to[i][j] += r[3 * (i % 3) + a] * k[i / 3 * 3 + a][j / 3 * 3 + c] * r[3 * (j % 3) + c];
        }
}

/* Block and probe turned together: the stiffness is turned with them. */
static void test_turned(void)
{
    const tets block = {{9, 9, 6}, {.08, .08, .05}, 1e4, .4, 1000, 2, false};
    const pose turn = {{0, 0, 0}, {.1825742, .3651484, .5477226, .7302967}},
               at = {{.041, .0385, .047}, {.9961947, 0, .0871557, 0}};
    const msds_options o = tets_options();
    static const msds_method methods[] = {MSDS_FEM, MSDS_TISSUE};
    for (int i = 0; i < 2; i++) {
        matrix6 want;
        probe_tangent_reading r[2];
        for (int turned = 0; turned < 2; turned++) {
            bench b = {.shape = probe_linear(.03, .012, .003), .at = at, .iterations = 40};
            begin_turned(&b, &block, &o, turned ? &turn : NULL);
            b.plan = tets_plan(methods[i]);
            b.at = turned ? pose_compose(&turn, &at) : at;
            settle(&b, &b.at, 20);
            r[turned] = find(&b, 400);
            end(&b);
        }
        turn_matrix(r[0].stiffness, &turn, want);
        ok(apart(want, r[1].stiffness) < 3e-3, "%s: all turned, it is turned: off by %.2g", i ? "tissue" : "fem",
           apart(want, r[1].stiffness));
    }
}

/* A few iterations a frame follow a probe that moves; once it rests, fewer do; and one that has left feels nothing. */
static void test_frames(void)
{
    const tets block = {{13, 9, 7}, {.12, .08, .06}, 1e4, .45, 1000, 2, false};
    bench b = {.shape = probe_sphere(.02), .iterations = 20};
    const msds_options o = tets_options();
    err e = {0};
    probe_tangent_reading few, many;
    double worst = 0;
    begin(&b, &block, &o);
    probe_tangent *other = probe_tangent_create(&msds_cpu, b.state, &e);
    tets_must(other != NULL, &e);
    b.plan = tets_plan(MSDS_TISSUE);
    int64_t products = 0;
    for (int i = 0; i < 60; i++) { /* 60 mm/s along the surface, up and down by 2 mm */
        const pose at = {{.04 + .001 * i * (i < 40) + .04 * (i >= 40), .04, .058 - .002 * sin(.3 * fmin(i, 40))},
                         {1, 0, 0, 0}};
        settle(&b, &at, 1);
        tets_must(!probe_tangent_find(b.tangent, 3, 12, &few, &e), &e);
        if (i == 0 || i == 39 || i == 59)
            tets_must(!probe_tangent_find(other, 400, 400, &many, &e), &e);
        if (i == 39)
            worst = apart(many.stiffness, few.stiffness);
        products += few.products;
    }
    ok(worst < .03, "a moving probe's is right to %.2g, by %.3g products a frame", worst, (double)products / 60);
    ok(apart(many.stiffness, few.stiffness) < 3e-3 && few.products <= 15, "one at rest to %.2g, by %lld",
       apart(many.stiffness, few.stiffness), (long long)few.products);
    const pose away = {{.04, .04, .2}, {1, 0, 0, 0}};
    settle(&b, &away, 1);
    tets_must(!probe_tangent_find(b.tangent, 3, 12, &few, &e), &e);
    ok(few.products == 0 && few.stiffness[2][2] == 0, "what touches nothing feels nothing");
    probe_tangent_destroy(other);
    end(&b);
}

/* Springs that are pressed so that elements turn inside out have no equilibrium that holds, and no tangent: what is
 * told then still is a stiffness, of no more than the contacts' own. */
static void test_buckled(void)
{
    const tets block = {{9, 9, 7}, {.08, .08, .06}, 1e4, .4, 1000, 2, false};
    bench b = {.shape = probe_linear(.03, .012, .003), .iterations = 20};
    const msds_options o = tets_options();
    double most = 0, least = 0, springs = 0;
    begin(&b, &block, &o);
    b.plan = tets_plan(MSDS_SPRINGS);
    for (int i = 0; i < 60; i++) {
        const pose at = {{.03 + .0005 * i, .041, .06 - .0008 * fmin(i, 25)}, {1, 0, 0, 0}};
        settle(&b, &at, 1);
        const probe_tangent_reading r = find(&b, 3);
        for (int j = 0; j < 3; j++) {
            most = fmax(most, fabs(r.stiffness[j][j]));
            least = fmin(least, r.stiffness[j][j]);
        }
    }
    for (int64_t n = 0; n < b.p.nodes; n++)
        springs += b.p.repulsion[n];
    ok(most > 1 && most < springs && least > -.1 * most, "springs that buckle: %.3g N/m, and down to %.3g", most,
       least);
    end(&b);
}

/* Frames are the same bytes whether or not their stiffness is asked for. */
static void test_untouched(void)
{
    const tets block = {{9, 9, 6}, {.08, .08, .05}, 1e4, .4, 1000, 2, false};
    static const struct {
        msds_method method;
        bool warp;
    } methods[] = {
        {MSDS_SPRINGS, false}, {MSDS_FEM, false}, {MSDS_FEM, true}, {MSDS_EXACT, true}, {MSDS_TISSUE, false}};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        double *u[2];
        err e = {0};
        for (int asked = 0; asked < 2; asked++) {
            bench b = {.shape = probe_sphere(.02), .iterations = 20};
            const msds_options o = tets_options();
            begin(&b, &block, &o);
            b.plan = tets_plan(methods[i].method);
            b.plan.warp = methods[i].warp;
            for (int f = 0; f < 6; f++) {
                const pose at = {{.041, .0385 + .001 * f, .0493 - .0005 * f}, {1, 0, 0, 0}};
                settle(&b, &at, 1);
                if (asked)
                    find(&b, 6);
            }
            u[asked] = mem_array(b.p.nodes, 3 * sizeof **u, "test", &e);
            tets_must(u[asked] && !msds_cpu.get(b.state, MSDS_DISPLACEMENT, u[asked], &e), &e);
            if (asked)
                ok(!memcmp(u[0], u[1], 3 * (size_t)b.p.nodes * sizeof **u), "method %zu goes on as if nobody had asked",
                   i);
            end(&b);
        }
        free(u[0]);
        free(u[1]);
    }
}

int main(void)
{
    test_methods();
    test_plate();
    test_turned();
    test_frames();
    test_buckled();
    test_untouched();
    return done_testing();
}
