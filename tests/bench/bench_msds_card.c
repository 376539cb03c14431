/* `make bench-msds_card`: what a frame of msds-run's solvers takes on a card, looked at, at the four sizes of PST's
 * Table I, whose figures stand beside, and with half a million nodes: CSV, the rounds of all interleaved. A sphere
 * presses the block, deeper with each frame, and starts again. `bench_msds_card [ROUNDS]`.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c tests/bench/bench.c msds/run/msds_executors.c
#include "../unit/msds_block.h"

#include "bench.h"
#include "msds/problem/largest.h"
#include "msds/problem/msds_executor.h"

enum { SIZES = 5, METHODS = 4, FRAMES = 30, ITERATIONS = 20 };

typedef struct paper {
    int32_t nodes[3];
    double ms[METHODS]; /* Table I: MSDS, FEM; none for the others */
} paper;

static const paper papers[SIZES] = {{{20, 10, 10}, {10, 30, NAN, NAN}},
                                    {{24, 12, 12}, {17, 60, NAN, NAN}},
                                    {{28, 14, 14}, {27, 100, NAN, NAN}},
                                    {{32, 16, 16}, {40, 150, NAN, NAN}},
                                    {{128, 64, 64}, {NAN, NAN, NAN, NAN}}};

static const char *const names[METHODS] = {"msds", "fem 20 cg", "fem exact", "tissue 20 cg"};

typedef struct subject {
    const paper *from;
    const msds_executor *card;
    model m;
    msds_problem p;
    msds_state *state[METHODS];
    double took[METHODS][BENCH_ROUNDS * FRAMES];
    int count[METHODS];
    double first;            /* s: the exact method's first frame, which makes the coarser lattices */
    int most;                /* solves that an exact frame took */
    double solves, residual; /* of all of them together; the largest */
    int64_t frames;
} subject;

static void make(subject *s, const paper *from, const msds_executor *card, pool *threads)
{
    err e = {0};
    tets b = {{from->nodes[0], from->nodes[1], from->nodes[2]}, {.16, .08, .08}, 1e4, .45, 1000, 2, false};
    msds_options o = tets_options();
    largest l;
    s->from = from;
    s->card = card;
    tets_make(&b, &s->m);
    bench_must(!msds_problem_make(&s->p, &s->m, &o, &e) && !largest_of(&s->p, &l, &e), &e);
    s->p.mass_factor = fmax(1, largest_factor(l.bound, o.damping, .01));
    for (int i = 0; i < METHODS; i++) {
        s->state[i] = card->create(&s->p, threads, &e);
        bench_must(s->state[i] != NULL, &e);
    }
}

static msds_plan plan_of(int method, int number)
{
    static const msds_method methods[METHODS] = {MSDS_SPRINGS, MSDS_FEM, MSDS_EXACT, MSDS_TISSUE};
    msds_plan plan = tets_plan(methods[method]);
    tets_press(&plan, .02, .08 + .0003 * number, .04, .08 - .0005 * number);
    return plan;
}

static void measure(subject *s, int method, int number)
{
    err e = {0};
    msds_reading reading = {0};
    const msds_plan plan = plan_of(method, number);
    double start = bench_clock();
    bench_must(!s->card->step(s->state[method], &plan, ITERATIONS, &e) &&
                   !s->card->monitor(s->state[method], &reading, &e),
               &e);
    double took = bench_clock() - start;
    if (method == MSDS_EXACT) {
        s->most = reading.solves > s->most ? reading.solves : s->most;
        s->solves += reading.solves;
        s->frames++;
        s->residual = fmax(s->residual, reading.residual);
    }
    if (method == MSDS_EXACT && s->first == 0)
        s->first = took;
    else
        s->took[method][s->count[method]++] = took;
}

static void say_row(const subject *s, const char *name, int count, double least, double median, double most,
                    double before)
{
    printf("%dx%dx%d,%lld,%lld,%lld,%s,cuda,%d,%.4g,%.4g,%.4g,", (int)s->from->nodes[0], (int)s->from->nodes[1],
           (int)s->from->nodes[2], (long long)s->p.nodes, (long long)s->p.elements, (long long)s->p.springs, name,
           count, 1e3 * least, 1e3 * median, 1e3 * most);
    if (!isnan(before))
        printf("%g", before);
    printf("\n");
}

static void say(subject *s)
{
    for (int i = 0; i < METHODS; i++) {
        double *t = s->took[i];
        int n = s->count[i];
        bench_sort(t, n);
        say_row(s, names[i], n, t[0], t[n / 2], t[n - 1 - n / 20], s->from->ms[i]);
        s->card->destroy(s->state[i]);
    }
    say_row(s, "first exact frame", 1, s->first, s->first, s->first, NAN);
    printf("# an exact frame took %.3g solves in the mean, at most %d, and left at most %.3g\n",
           s->solves / (double)s->frames, s->most, s->residual);
    msds_problem_free(&s->p);
    model_free(&s->m);
}

static const msds_executor *find_card(void)
{
    for (int i = 0; msds_executors[i]; i++)
        if (!strcmp(msds_executors[i]->device, "cuda") && !msds_executors[i]->unusable())
            return msds_executor_of(msds_executors[i]);
    return NULL;
}

int main(int argc, char **argv)
{
    static subject subjects[SIZES];
    err e = {0};
    int rounds = argc > 1 ? atoi(argv[1]) : 3;
    const msds_executor *card = find_card();
    if (rounds < 1 || rounds > BENCH_ROUNDS) {
        fprintf(stderr, "usage: bench_msds_card [ROUNDS]\n");
        return 2;
    }
    if (!card) {
        printf("# no card\n");
        return 0;
    }
    pool *workers = pool_create(2, &e);
    bench_must(workers != NULL, &e);
    for (int i = 0; i < SIZES; i++)
        make(&subjects[i], &papers[i], card, workers);
    for (int round = 0; round < rounds; round++)
        for (int i = 0; i < SIZES; i++)
            for (int k = 0; k < METHODS * FRAMES; k++)
                measure(&subjects[i], k / FRAMES, k % FRAMES);
    printf("mesh,nodes,tetrahedra,springs,method,device,frames,best_ms,median_ms,p95_ms,paper_ms\n");
    for (int i = 0; i < SIZES; i++)
        say(&subjects[i]);
    pool_destroy(workers);
    return 0;
}
