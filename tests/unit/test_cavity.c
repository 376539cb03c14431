/* Cavities (msds/problem/cavity.h) in the method tissue: walls; Lame's tube; a wall of its own as a membrane's closed
 * form; the pressure at which a long ring buckles; rest under pressure; walls that meet and part; throttled flow.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/problem.c msds/problem/springs.c msds/problem/sell.c msds/cpu/lanes.c
// needs: msds/cpu/lanes_loops.c msds/cpu/contacts.c
// needs: msds/problem/stiffness.c msds/cpu/dissect.c msds/cpu/factor.c msds/cpu/exact.c msds/cpu/mixing.c msds/cpu/cg.c
// needs: msds/cpu/exact_making.c msds/cpu/msds_cpu.c msds/problem/largest.c
// needs: msds/cpu/tissue.c msds/cpu/tissue_mesh.c msds/cpu/tissue_sums.c msds/cpu/tissue_work.c
// needs: msds/cpu/tissue_walls.c msds/cpu/tissue_rest.c msds/problem/cavity.c
#include "msds_tube.h"

#include "msds/cpu/msds_cpu.h"

#include "tap.h"

typedef struct run {
    tube shape;
    model m;
    msds_problem p;
    msds_cavity lumen;
    pool *threads;
    msds_state *state;
    double *u; /* nodes x 3, m */
    msds_reading reading;
} run;

static void begin(run *r, const tube *t, double at_rest)
{
    err e = {0};
    const msds_options o = tets_options();
    *r = (run){.shape = *t, .lumen = {.volume = 1, .pressure = at_rest, .at_rest = at_rest}};
    tube_make(t, &r->m);
    tets_must(!msds_problem_make(&r->p, &r->m, &o, &e), &e);
    r->p.cavity = &r->lumen;
    r->p.cavities = 1;
    r->u = mem_array(r->p.nodes, 3 * sizeof *r->u, "test", &e);
    tets_must(r->u != NULL, &e);
}

/* Frames of 20 iterations until the residual is that small, at most so many. Returns how many. */
static int go(run *r, int iterations, int frames, double residual)
{
    err e = {0};
    msds_plan plan = tets_plan(MSDS_TISSUE);
    int i = 0;
    plan.elapsed = 1. / 60;
    if (!r->state) {
        r->threads = pool_create(2, &e);
        r->state = r->threads ? msds_cpu.create(&r->p, r->threads, &e) : NULL;
        tets_must(r->state != NULL, &e);
    }
    do {
        tets_must(!msds_cpu.step(r->state, &plan, iterations, &e) && !msds_cpu.monitor(r->state, &r->reading, &e), &e);
        i++;
        if (getenv("DBG")) printf("# %d %g\n", i, r->reading.residual);
    } while (i < frames && r->reading.residual > residual);
    tets_must(!msds_cpu.get(r->state, MSDS_DISPLACEMENT, r->u, &e), &e);
    return i;
}

static void end(run *r)
{
    msds_cpu.destroy(r->state);
    pool_destroy(r->threads);
    msds_problem_free(&r->p);
    model_free(&r->m);
    free(r->u);
}

/* The mean of the radial displacement of a ring in the middle level, times cos(k theta) and doubled where k > 0. */
static double radial(const run *r, int ring, int k)
{
    const tube *t = &r->shape;
    double sum = 0;
    for (int at = 0; at < t->around; at++) {
        const int64_t n = tube_node(t, ring, at, t->along / 2);
        const double angle = 2 * 3.14159265358979 * at / t->around;
        sum += (r->u[3 * n] * cos(angle) + r->u[3 * n + 1] * sin(angle)) * cos(k * angle) * (k ? 2 : 1);
    }
    return sum / t->around;
}

static void test_lame(void)
{
    const tube t = {32, 3, 6, 4, .005, .005, .01, 0, 3000, .3};
    run r;
    begin(&r, &t, 0);
    r.lumen.pressure = 10;
    const int took = go(&r, 20, 100, 1e-4);
    const double a = t.radius, b = t.radius + t.thickness, p = 10, nu = t.poisson;
    for (int ring = t.lumen; ring <= t.lumen + t.wall; ring += t.wall) {
        const double x = ring == t.lumen ? a : b;
        const double want = p * a * a / (t.young * (b * b - a * a)) * ((1 - nu) * x + (1 + nu) * b * b / x);
        near_(radial(&r, ring, 0), want, .03 * want, "Lame's tube, open ends, after %d frames: radius %g mm", took,
              1e3 * x);
    }
    end(&r);
}

static void test_ring(double poisson)
{
    const tube t = {.around = 96, .lumen = 2, .wall = 4, .along = 2, .radius = .0095, .thickness = .001,
                    .length = .003, .oval = 1e-3, .young = 1e5, .poisson = poisson};
    run r;
    begin(&r, &t, 0);
    const double middle = t.radius + t.thickness / 2, ratio = t.thickness / middle;
    const double buckling = t.young * ratio * ratio * ratio / (4 * (1 - poisson * poisson));
    for (int i = 1; i <= 3; i++) {
        r.lumen.pressure = -.2 * i * buckling;
        const int took = go(&r, 3000, 10, 2e-5);
        const double grown = (radial(&r, t.lumen, 2) + radial(&r, t.lumen + t.wall, 2)) / 2, first = t.oval * middle;
        printf("# %d frames, residual %g: p %g, %g: buckles at %g of the closed form\n", took, r.reading.residual, .2 * i, grown / first,
               .2 * i * (1 + first / grown));
    }
    end(&r);
}

int main(void)
{
    test_lame();
    test_ring(0);
    return done_testing();
}
