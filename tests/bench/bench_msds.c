/* `make bench-msds`: what a frame of msds-run's solvers takes at the four sizes of PST's Table I, whose figures stand
 * beside, as do OpenTissue's at the largest (one thread; as the project was given them, not measured here): CSV, with a
 * probe of the machine in the same run, the rounds of all interleaved. A sphere presses the block, deeper with each
 * frame, and starts again. At the largest, each shape of probe too; and what one node costs, by closed form and by
 * libccd. Last, exact frames of a flat probe that touches few nodes of a slab, or all 961: the factor and five frames.
 * `bench_msds [THREADS [ROUNDS]]`.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c tests/bench/bench.c msds/run/msds_executors.c
#include "../unit/msds_block.h"

#include "base/mem.h"
#include "bench.h"
#include "msds/cpu/msds_cpu.h"
#include "msds/problem/largest.h"
#include "probe/narrow.h"

enum { SIZES = 4, METHODS = 5, FRAMES = 30, ITERATIONS = 20, TOUCHES = 20 };

typedef struct paper {
    int32_t nodes[3];
    double ms[METHODS]; /* Table I: MSDS, FEM; none for exact and tissue; collision */
} paper;

/* At the last size. */
static const double open_tissue[METHODS] = {9.4, 47, NAN, NAN, NAN};

static const paper papers[SIZES] = {{{20, 10, 10}, {10, 30, NAN, NAN, .1}},
                                    {{24, 12, 12}, {17, 60, NAN, NAN, .2}},
                                    {{28, 14, 14}, {27, 100, NAN, NAN, .2}},
                                    {{32, 16, 16}, {40, 150, NAN, NAN, .3}}};

static const char *const names[METHODS] = {"msds", "fem 20 cg", "fem exact", "tissue 20 cg", "collision"};

/* Shapes, against which nodes of the largest mesh are found, and single points asked
 * of the closed forms and of libccd. */
enum { SHAPES = 4, QUERIES = 2000 };

typedef struct shape {
    probe of;
    const char *found, *closed, *libccd; /* names of cases */
} shape;

typedef struct subject {
    model m;
    msds_problem p;
    msds_state *state[METHODS];
    double took[METHODS][BENCH_ROUNDS * FRAMES];
    int count[METHODS];
    double factor; /* s: the exact method's first frame */
} subject;

static void make(subject *s, const paper *from, pool *threads)
{
    err e = {0};
    tets b = {{from->nodes[0], from->nodes[1], from->nodes[2]}, {.16, .08, .08}, 1e4, .45, 1000, 2, false};
    msds_options o = tets_options();
    largest l;
    tets_make(&b, &s->m);
    bench_must(!msds_problem_make(&s->p, &s->m, &o, &e) && !largest_of(&s->p, &l, &e), &e);
    s->p.mass_factor = fmax(1, largest_factor(l.bound, o.damping, .01));
    for (int i = 0; i < METHODS; i++) {
        s->state[i] = msds_cpu.create(&s->p, threads, &e);
        bench_must(s->state[i] != NULL, &e);
    }
}

static msds_plan plan_of(int method, int number)
{
    static const msds_method methods[METHODS] = {MSDS_SPRINGS, MSDS_FEM, MSDS_EXACT, MSDS_TISSUE, MSDS_SPRINGS};
    msds_plan plan = tets_plan(methods[method]);
    tets_press(&plan, .02, .08 + .0003 * number, .04, .08 - .0005 * number);
    return plan;
}

/* A convex body of 128 facets: a ball's. */
static probe faceted(void)
{
    enum { AROUND = 16, RINGS = 7 };
    probe p = {.kind = PROBE_CONVEX, .middle = {0, 0, -.02}, .reach = .0205, .size = .019};
    err e = {0};
    p.plane = mem_array((RINGS + 1) * AROUND, 4 * sizeof *p.plane, "a probe", &e);
    p.corner = mem_array((int64_t)(RINGS + 1) * AROUND, 3 * sizeof *p.corner, "a probe", &e);
    bench_must(p.plane && p.corner, &e);
    for (int i = 0; i < (RINGS + 1) * AROUND; i++) {
        double a = 3.14159265358979 * (i / AROUND + .5) / (RINGS + 1), b = 6.28318530717959 * (i % AROUND) / AROUND;
        double n[3] = {sin(a) * cos(b), sin(a) * sin(b), cos(a)};
        for (int c = 0; c < 3; c++) {
            p.plane[4 * p.planes + c] = n[c];
            p.corner[3 * p.corners + c] = .02 * n[c] + p.middle[c];
        }
        p.plane[4 * p.planes++ + 3] = .0195 - .02 * n[2];
        p.corners++;
    }
    return p;
}

static void measure_shape(bench *b, const shape *s, msds_state *state)
{
    msds_plan plan = plan_of(METHODS - 1, FRAMES / 2);
    pose at = {{.085, .04, .07}, {1, 0, 0, 0}};
    probe_touch t = {0, {0, 0, 0}};
    double sum = 0;
    plan.probe = probe_place(&s->of, &at);
    double start = bench_clock();
    for (int i = 0; i < TOUCHES; i++)
        msds_cpu_touch(state, &plan);
    bench_take(b, s->found, TOUCHES, "search of 8192 nodes", bench_clock() - start);
    for (int kind = 0; kind < 2; kind++) {
        start = bench_clock();
        for (int i = 0; i < QUERIES; i++) { /* all over the body */
            double x[3];
            for (int a = 0; a < 3; a++)
                x[a] = plan.probe.centre[a] + .5 * s->of.size * sin(1. * i * (a + 1) + a);
            if (kind)
                narrow_at(&plan.probe, x, 1e-4, 1, &t);
            else
                t = probe_at(&plan.probe, x);
            sum += t.depth;
        }
        bench_take(b, kind ? s->libccd : s->closed, QUERIES, "node", bench_clock() - start);
    }
    bench_use(sum);
}

static void measure(subject *s)
{
    err e = {0};
    for (int method = 0; method < METHODS; method++)
        for (int number = 0; number < FRAMES; number++) {
            msds_plan plan = plan_of(method, number);
            double start = bench_clock();
            for (int i = 0; method == METHODS - 1 && i < TOUCHES; i++)
                msds_cpu_touch(s->state[method], &plan);
            if (method < METHODS - 1)
                bench_must(!msds_cpu.step(s->state[method], &plan, ITERATIONS, &e), &e);
            double took = (bench_clock() - start) / (method == METHODS - 1 ? TOUCHES : 1);
            if (method == MSDS_EXACT && s->factor == 0)
                s->factor = took;
            else
                s->took[method][s->count[method]++] = took;
        }
}

/* The factor and five exact frames of a slab, under a flat probe that touches so many of 31 x 31 nodes. */
enum { SLABS = 2, SLAB_FRAMES = 5 };

static const char *const slab_names[SLABS] = {"5 exact frames of 121 touching", "5 exact frames of 961 touching"};
static const double slab_wide[SLABS] = {.044, .14};
static const int64_t slab_touching[SLABS] = {121, 961};

typedef struct slab {
    model m;
    msds_problem p;
    double took[SLABS][BENCH_ROUNDS];
    int count;
} slab;

static void make_slab(slab *s)
{
    err e = {0};
    tets b = {{31, 31, 6}, {.12, .12, .02}, 1e4, .45, 1000, 2, false};
    msds_options o = tets_options();
    tets_make(&b, &s->m);
    bench_must(!msds_problem_make(&s->p, &s->m, &o, &e), &e);
    s->p.mass_factor = 1;
}

static void measure_slab(slab *s, pool *threads)
{
    err e = {0};
    for (int i = 0; i < SLABS; i++) {
        const probe flat = probe_linear(slab_wide[i], slab_wide[i], .001);
        msds_plan plan = tets_plan(MSDS_EXACT);
        msds_reading reading;
        const double start = bench_clock();
        msds_state *state = msds_cpu.create(&s->p, threads, &e);
        bench_must(state != NULL, &e);
        plan.touched = true;
        for (int number = 1; number <= SLAB_FRAMES; number++) {
            const pose at = {{.06, .06, .02 - .0004 * number}, {1, 0, 0, 0}};
            plan.probe = probe_place(&flat, &at);
            bench_must(!msds_cpu.step(state, &plan, ITERATIONS, &e), &e);
        }
        s->took[i][s->count] = bench_clock() - start;
        bench_must(!msds_cpu.monitor(state, &reading, &e), &e);
        if (reading.contacts != slab_touching[i])
            bench_must(err_set(&e, NULL, 0, "%lld nodes touch; expected %lld", (long long)reading.contacts,
                               (long long)slab_touching[i]) == 0,
                       &e);
        msds_cpu.destroy(state);
    }
    s->count++;
}

static void say_slab(slab *s, int threads)
{
    for (int i = 0; i < SLABS; i++) {
        double *t = s->took[i];
        bench_sort(t, s->count);
        printf("31x31x6,%lld,%lld,%lld,%s,%d,%d,%.4g,%.4g,%.4g,,\n", (long long)s->p.nodes, (long long)s->p.elements,
               (long long)s->p.springs, slab_names[i], threads, s->count, 1e3 * t[0], 1e3 * t[s->count / 2],
               1e3 * t[s->count - 1 - s->count / 20]);
    }
    msds_problem_free(&s->p);
    model_free(&s->m);
}

static void say(subject *s, const paper *from, int threads)
{
    for (int i = 0; i < METHODS; i++) {
        double *t = s->took[i];
        int n = s->count[i];
        bench_sort(t, n);
        printf("%dx%dx%d,%lld,%lld,%lld,%s,%d,%d,%.4g,%.4g,%.4g,", (int)from->nodes[0], (int)from->nodes[1],
               (int)from->nodes[2], (long long)s->p.nodes, (long long)s->p.elements, (long long)s->p.springs, names[i],
               threads, n, 1e3 * t[0], 1e3 * t[n / 2], 1e3 * t[n - 1 - n / 20]);
        if (!isnan(from->ms[i]))
            printf("%g", from->ms[i]);
        printf(",");
        if (from == &papers[SIZES - 1] && !isnan(open_tissue[i]))
            printf("%g", open_tissue[i]);
        printf("\n");
    }
    printf("%dx%dx%d,%lld,%lld,%lld,first exact frame,%d,1,%.4g,%.4g,%.4g,,\n", (int)from->nodes[0],
           (int)from->nodes[1], (int)from->nodes[2], (long long)s->p.nodes, (long long)s->p.elements,
           (long long)s->p.springs, threads, 1e3 * s->factor, 1e3 * s->factor, 1e3 * s->factor);
    for (int i = 0; i < METHODS; i++)
        msds_cpu.destroy(s->state[i]);
    msds_problem_free(&s->p);
    model_free(&s->m);
}

int main(int argc, char **argv)
{
    static subject subjects[SIZES];
    static bench probes;
    static slab flat;
    shape shapes[SHAPES] = {
        {probe_sphere(.02), "collision: sphere", "depth: sphere, closed form", "depth: sphere, libccd"},
        {probe_linear(.04, .01, .0025), "collision: linear", "depth: linear, closed form", "depth: linear, libccd"},
        {probe_curved(.04, 1.2, .015, .003), "collision: curved", "depth: curved, closed form",
         "depth: curved, libccd"},
        {faceted(), "collision: convex of 128 planes", "depth: convex of 128 planes", "depth: convex of 128, libccd"}};
    err e = {0};
    int threads = argc > 1 ? atoi(argv[1]) : 2, rounds = argc > 2 ? atoi(argv[2]) : 7;
    if (threads < 1 || rounds < 1 || rounds > BENCH_ROUNDS) {
        fprintf(stderr, "usage: bench_msds [THREADS [ROUNDS]]\n");
        return 2;
    }
    pool *workers = pool_create(threads, &e);
    bench_must(workers != NULL, &e);
    for (int i = 0; i < SIZES; i++)
        make(&subjects[i], &papers[i], workers);
    make_slab(&flat);
    for (int round = 0; round < rounds; round++) {
        bench_probe(&probes);
        bench_probe_threads(&probes, workers);
        for (int i = 0; i < SIZES; i++)
            measure(&subjects[i]);
        for (int i = 0; i < SHAPES; i++)
            measure_shape(&probes, &shapes[i], subjects[SIZES - 1].state[METHODS - 1]);
        measure_slab(&flat, workers);
    }
    printf("mesh,nodes,tetrahedra,springs,method,threads,frames,best_ms,median_ms,p95_ms,paper_ms,opentissue_ms\n");
    for (int i = 0; i < SIZES; i++)
        say(&subjects[i], &papers[i], threads);
    say_slab(&flat, threads);
    bench_print(&probes);
    probe_free(&shapes[SHAPES - 1].of);
    pool_destroy(workers);
    return 0;
}
