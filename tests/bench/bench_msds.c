/* `make bench-msds`: what a frame of msds-run's solvers takes at the four sizes of PST's Table I, whose figures stand beside: CSV, with
 * a probe of the machine in the same run, the rounds of all interleaved; and, where there is a card, the same there, and on half a
 * million nodes. A sphere presses the block, deeper with each frame, and starts again. `bench_msds [THREADS [ROUNDS]]`.
 */
// needs: tests/bench/bench.c msds/mesh_tets.c msds/problem.c msds/springs.c msds/slices.c msds/lanes.c msds/lanes_plain.c msds/lanes_avx2.c msds/contacts.c msds/stiffness.c msds/dissect.c msds/factor.c msds/exact.c msds/cg.c msds/msds_cpu.c msds/msds_backends.c msds/largest.c msds/levels.c msds/parts.c
#include "../unit/msds_block.h"

#include "bench.h"
#include "msds/largest.h"
#include "msds/msds_cpu.h"

enum { SIZES = 5, LARGE = SIZES - 1, METHODS = 4, COLLISION = METHODS - 1, FRAMES = 30, ITERATIONS = 20, TOUCHES = 20 };

typedef struct paper {
    int32_t nodes[3];
    double ms[METHODS]; /* Table I: MSDS, FEM; none for exact; collision */
} paper;

static const paper papers[SIZES] = {{{20, 10, 10}, {10, 30, NAN, .1}},
                                    {{24, 12, 12}, {17, 60, NAN, .2}},
                                    {{28, 14, 14}, {27, 100, NAN, .2}},
                                    {{32, 16, 16}, {40, 150, NAN, .3}},
                                    {{128, 64, 64}, {NAN, NAN, NAN, NAN}}}; /* on a card alone */

static const char *const names[METHODS] = {"msds", "fem 20 cg", "fem exact", "collision"};

typedef struct runner { /* a device, over all methods */
    const backend *device;
    void *state[METHODS];
    double took[METHODS][BENCH_ROUNDS * FRAMES];
    int count[METHODS];
    double first;  /* s: the exact method's first frame */
    int most;      /* solves that an exact frame took */
    double solves; /* of all of them together */
    int64_t frames;
    double residual;
} runner;

typedef struct subject {
    const paper *from;
    model m;
    msds_problem p;
    runner cpu, card; /* without a device: not run */
} subject;

static void make_runner(subject *s, runner *r, const backend *device, pool *threads)
{
    err e = {0};
    r->device = device;
    for (int i = 0; i < METHODS && device; i++) {
        r->state[i] = device->create(&s->p, threads, &e);
        bench_must(r->state[i] != NULL, &e);
    }
}

static void make(subject *s, const paper *from, const backend *cpu, const backend *card, pool *threads)
{
    err e = {0};
    tets b = {{from->nodes[0], from->nodes[1], from->nodes[2]}, {.16, .08, .08}, 1e4, .45, 1000, 2, false};
    msds_options o = tets_options();
    largest l;
    s->from = from;
    tets_make(&b, &s->m);
    bench_must(!msds_problem_make(&s->p, &s->m, &o, &e) && !largest_of(&s->p, &l, &e), &e);
    s->p.mass_factor = fmax(1, largest_factor(l.bound, o.damping, .01));
    make_runner(s, &s->cpu, cpu, threads);
    make_runner(s, &s->card, card, threads);
}

static msds_plan plan_of(int method, int number)
{
    static const msds_method methods[METHODS] = {MSDS_SPRINGS, MSDS_FEM, MSDS_EXACT, MSDS_SPRINGS};
    msds_plan plan = tets_plan(methods[method]);
    tets_press(&plan, .02, .08 + .0003 * number, .04, .08 - .0005 * number);
    return plan;
}

static int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* A frame is there when it has been looked at. */
static void measure_frame(runner *r, int method, int number)
{
    err e = {0};
    msds_sight sight = {0};
    const msds_plan plan = plan_of(method, number);
    double start = bench_clock();
    if (method == COLLISION) {
        for (int i = 0; i < TOUCHES; i++)
            msds_cpu_touch(r->state[method], &plan);
    } else {
        bench_must(!r->device->step(r->state[method], &plan, ITERATIONS, &e) &&
                       !r->device->look(r->state[method], NULL, &sight, &e),
                   &e);
    }
    double took = (bench_clock() - start) / (method == COLLISION ? TOUCHES : 1);
    if (method == MSDS_EXACT) {
        r->most = sight.solves > r->most ? sight.solves : r->most;
        r->solves += sight.solves;
        r->frames++;
        r->residual = fmax(r->residual, sight.residual);
    }
    if (method == MSDS_EXACT && r->first == 0)
        r->first = took;
    else
        r->took[method][r->count[method]++] = took;
}

static void measure(runner *r)
{
    for (int method = 0; method < METHODS && r->device; method++)
        for (int number = 0; number < FRAMES && (method < COLLISION || r->device == &msds_cpu); number++)
            measure_frame(r, method, number);
}

static void say_row(const subject *s, const char *name, const char *on, int count, const double took[3], double before)
{
    printf("%dx%dx%d,%lld,%lld,%lld,%s,%s,%d,%.4g,%.4g,%.4g,", (int)s->from->nodes[0], (int)s->from->nodes[1],
           (int)s->from->nodes[2], (long long)s->p.nodes, (long long)s->p.elements, (long long)s->p.springs, name, on,
           count, 1e3 * took[0], 1e3 * took[1], 1e3 * took[2]);
    if (!isnan(before))
        printf("%g", before);
    printf("\n");
}

static void say(subject *s, runner *r, const char *on)
{
    for (int i = 0; i < METHODS && r->device; i++) {
        double *t = r->took[i];
        int n = r->count[i];
        qsort(t, (size_t)n, sizeof *t, ascending);
        if (n)
            say_row(s, names[i], on, n, (double[3]){t[0], t[n / 2], t[n - 1 - n / 20]}, s->from->ms[i]);
        r->device->destroy(r->state[i]);
    }
    if (!r->device)
        return;
    say_row(s, "first exact frame", on, 1, (double[3]){r->first, r->first, r->first}, NAN);
    printf("# %s: an exact frame took %.3g solves in the mean, at most %d, and left at most %.3g\n", on,
           r->solves / (double)r->frames, r->most, r->residual);
}

static const backend *find_card(void)
{
    for (int i = 0; msds_backends[i]; i++)
        if (!strcmp(msds_backends[i]->name, "cuda") && !msds_backends[i]->unusable())
            return msds_backends[i];
    return NULL;
}

int main(int argc, char **argv)
{
    static subject subjects[SIZES];
    static bench probes;
    err e = {0};
    char on[20];
    int threads = argc > 1 ? atoi(argv[1]) : 2, rounds = argc > 2 ? atoi(argv[2]) : 7;
    const backend *card = find_card();
    const int sizes = card ? SIZES : LARGE;
    if (threads < 1 || rounds < 1 || rounds > BENCH_ROUNDS) {
        fprintf(stderr, "usage: bench_msds [THREADS [ROUNDS]]\n");
        return 2;
    }
    pool *workers = pool_create(threads, &e);
    bench_must(workers != NULL, &e);
    for (int i = 0; i < sizes; i++)
        make(&subjects[i], &papers[i], i < LARGE ? &msds_cpu : NULL, card, workers);
    for (int round = 0; round < rounds; round++) {
        bench_probe(&probes);
        for (int i = 0; i < sizes; i++) {
            measure(&subjects[i].cpu);
            measure(&subjects[i].card);
        }
    }
    snprintf(on, sizeof on, "%d", threads);
    printf("mesh,nodes,tetrahedra,springs,method,threads,frames,best_ms,median_ms,p95_ms,paper_ms\n");
    for (int i = 0; i < sizes; i++) {
        say(&subjects[i], &subjects[i].cpu, on);
        say(&subjects[i], &subjects[i].card, "cuda");
        msds_problem_free(&subjects[i].p);
        model_free(&subjects[i].m);
    }
    bench_print(&probes);
    pool_destroy(workers);
    return 0;
}
