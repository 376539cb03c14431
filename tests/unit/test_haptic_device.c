/* A haptic device against frames of a run, in simulated time: a mass that a hand's spring pulls into tissue, in a loop
 * of 1 kHz, with frames of 60 Hz that arrive one frame late. By the force and the stiffness of a frame (HAPTICS in
 * msds-run(1)) it comes to rest where the hand's spring and the tissue balance; by the force alone it does not. And how
 * well a frame's line foretells the force a little farther on.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c msds/tangent/*.c
#include "msds_block.h"

#include "msds/cpu/msds_cpu.h"
#include "msds/problem/largest.h"
#include "msds/tangent/probe_tangent.h"

#include "tap.h"

enum { RATE = 60, LOOP = 1000, ITERATIONS = 20, USUALLY = 3, AT_FIRST = 12 /* as msds/run/haptics.c */ };

static const double mass = .1, hand = 300, grip = 2; /* kg, N/m, N s/m */
static const double into[3] = {.004, 0, -.012};      /* m: where the hand goes, from where it touches */
static const double touch[3] = {.041, .0385, .05};   /* m */

typedef struct told {
    double at[3], force[3], k[3][3];
} told;

typedef struct bench {
    model m;
    msds_problem p;
    pool *threads;
    msds_state *state;
    probe_tangent *tangent;
    msds_plan plan;
} bench;

static void begin(bench *b, msds_method method)
{
    static const tets block = {{9, 9, 6}, {.08, .08, .05}, 3e4, .45, 1000, 2, false};
    err e = {0};
    largest l;
    const msds_options o = tets_options();
    *b = (bench){.plan = tets_plan(method)};
    tets_make(&block, &b->m);
    tets_must(!msds_problem_make(&b->p, &b->m, &o, &e) && !largest_of(&b->p, &l, &e), &e);
    b->p.mass_factor = fmax(1, largest_factor(l.bound, o.damping, b->plan.dt));
    b->threads = pool_create(1, &e);
    b->state = b->threads ? msds_cpu.create(&b->p, b->threads, &e) : NULL;
    b->tangent = b->state ? probe_tangent_create(&msds_cpu, b->state, &e) : NULL;
    tets_must(b->tangent != NULL, &e);
}

static void end(bench *b)
{
    probe_tangent_destroy(b->tangent);
    msds_cpu.destroy(b->state);
    pool_destroy(b->threads);
    msds_problem_free(&b->p);
    model_free(&b->m);
}

/* A frame with the ball there, and what a device is told of it. */
static told frame_at(bench *b, const double at[3], int64_t iterations)
{
    err e = {0};
    msds_reading r;
    probe_tangent_reading t;
    told to;
    tets_press(&b->plan, .02, at[0], at[1], at[2]);
    tets_must(!msds_cpu.step(b->state, &b->plan, iterations, &e) && !msds_cpu.monitor(b->state, &r, &e) &&
                  !probe_tangent_find(b->tangent, USUALLY, AT_FIRST, &t, &e),
              &e);
    memcpy(to.at, at, sizeof to.at);
    memcpy(to.force, r.force, sizeof to.force);
    for (int i = 0; i < 3; i++)
        memcpy(to.k[i], t.stiffness[i], sizeof to.k[i]);
    return to;
}

/* F(x) = F0 - K (x - x0), which never pulls. */
static void foretell(const told *t, const double x[3], bool stiff, double force[3])
{
    double along = 0;
    for (int i = 0; i < 3; i++) {
        force[i] = t->force[i];
        for (int j = 0; j < 3 && stiff; j++)
            force[i] -= t->k[i][j] * (x[j] - t->at[j]);
        along += force[i] * t->force[i];
    }
    for (int i = 0; i < 3 && along < 0; i++)
        force[i] = 0;
}

typedef struct device {
    double x[3], v[3];
    double fastest; /* m/s: in the last half of a second */
    double energy;  /* J: the most that it had, moving and in the hand's spring */
} device;

static void loop(device *d, const told *t, const double goal[3], bool stiff)
{
    double force[3], energy = 0;
    foretell(t, d->x, stiff, force);
    for (int a = 0; a < 3; a++) {
        d->v[a] += (force[a] + hand * (goal[a] - d->x[a]) - grip * d->v[a]) / mass / LOOP;
        d->x[a] += d->v[a] / LOOP;
        energy += mass * d->v[a] * d->v[a] / 2 + hand * (goal[a] - d->x[a]) * (goal[a] - d->x[a]) / 2;
    }
    d->energy = fmax(d->energy, energy);
}

/* The hand goes in for a quarter of a second, then stays. A frame is of the pose when the one before was done. */
static device press(bench *b, double seconds, bool stiff)
{
    device d = {.x = {touch[0], touch[1], touch[2] + .001}};
    told shown = {.at = {d.x[0], d.x[1], d.x[2]}}, next = shown;
    int frames = 0;
    for (int i = 0; i < seconds * LOOP; i++) {
        const double gone = fmin(1, i / (.25 * LOOP));
        double goal[3];
        for (int a = 0; a < 3; a++)
            goal[a] = touch[a] + gone * into[a];
        if (i * RATE >= frames * LOOP) {
            shown = next;
            next = frame_at(b, d.x, ITERATIONS);
            frames++;
        }
        loop(&d, &shown, goal, stiff);
        const double fast = sqrt(d.v[0] * d.v[0] + d.v[1] * d.v[1] + d.v[2] * d.v[2]);
        if (i > (seconds - .5) * LOOP)
            d.fastest = fmax(d.fastest, fast);
    }
    return d;
}

/* Where the hand's spring and tissue that has come to rest balance, and with which force: by Newton's method on frames
 * that are converged. */
static told balance(bench *b)
{
    told t = {.at = {touch[0], touch[1], touch[2] - .003}};
    for (int round = 0; round < 12; round++) {
        double a[3][3], f[3], d[3] = {0};
        for (int i = 0; i < 12; i++)
            t = frame_at(b, t.at, 60);
        for (int i = 0; i < 3; i++) {
            f[i] = t.force[i] + hand * (touch[i] + into[i] - t.at[i]);
            for (int j = 0; j < 3; j++)
                a[i][j] = (t.k[i][j] + t.k[j][i]) / 2 + (i == j ? hand : 0);
        }
        simplex_solve(a, f, d);
        double step = 0;
        for (int i = 0; i < 3; i++) {
            t.at[i] += d[i];
            step += d[i] * d[i];
        }
        if (step < 1e-14)
            break;
    }
    return t;
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static void test_device(msds_method method, const char *name)
{
    bench b;
    begin(&b, method);
    const told rest = balance(&b);
    end(&b);
    begin(&b, method);
    const device with = press(&b, 2, true);
    end(&b);
    begin(&b, method);
    const device without = press(&b, 2, false);
    end(&b);
    const double none[3] = {0}, depth = touch[2] - rest.at[2], first = hand * .013 * .013;
    printf("# %s: at rest %.3g mm deep with %.3g N, stiffness %.4g N/m\n", name, 1e3 * depth,
           distance(rest.force, none), rest.k[2][2]);
    ok(depth > .002 && rest.k[2][2] > hand, "%s: the tissue is stiffer than the hand", name);
    ok(with.fastest < 1e-3, "by its stiffness the device comes to rest: %.2g mm/s", 1e3 * with.fastest);
    ok(distance(with.x, rest.at) < .03 * depth, "where hand and tissue balance, to %.2g of the depth",
       distance(with.x, rest.at) / depth);
    ok(with.energy < first, "its energy stays: %.3g J of at most %.3g", with.energy, first);
    ok(without.fastest > 20 * with.fastest && without.fastest > .05, "by the force alone it does not: %.2g mm/s",
       1e3 * without.fastest);
}

/* The error of the line's force grows as the square of the way; without the stiffness as the way itself. */
static void test_foretold(void)
{
    bench b;
    double off[2], lacks[2];
    begin(&b, MSDS_TISSUE);
    double at[3] = {touch[0], touch[1], touch[2] - .004};
    told here = {0};
    for (int i = 0; i < 30; i++)
        here = frame_at(&b, at, 60);
    for (int i = 0; i < 2; i++) {
        const double way = i ? .0002 : .0004;
        double there[3] = {at[0] + way, at[1], at[2] - way}, force[3];
        told then = here;
        foretell(&here, there, true, force);
        for (int n = 0; n < 20; n++)
            then = frame_at(&b, there, 60);
        off[i] = distance(then.force, force);
        lacks[i] = distance(then.force, here.force);
    }
    ok(off[0] < .15 * lacks[0] && off[1] < .1 * lacks[1],
       "0.4 mm on, the force is off by %.2g of its change; 0.2 mm, %.2g", off[0] / lacks[0], off[1] / lacks[1]);
    end(&b);
}

int main(void)
{
    test_device(MSDS_TISSUE, "tissue");
    test_device(MSDS_FEM, "fem");
    test_device(MSDS_SPRINGS, "springs");
    test_foretold();
    return done_testing();
}
