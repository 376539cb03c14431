/* `make bench-tled`: what a step of tled-run's solver takes, on each back end and in each precision that this machine has, over
 * blocks of growing size and over the models whose files are named: CSV. After a warm-up, the median, the least and the most of
 * some rounds. A `step` is the back end's own; a `run` is one as tled-run makes it, with its looks, and with 60 frames a second of
 * the model's time.
 */
// needs: tled/state.c tled/step.c tled/script.c tled/script_read.c tled/watch.c tled/relax.c tled/run.c tled/outbox.c tled/backends.c tled/cpu_double.c tled/cpu_single.c tled/rows.c tled/cpu_choose.c tled/cpu_pass_base_double.c tled/cpu_pass_base_single.c tled/cpu_pass_avx2_double.c tled/cpu_pass_avx2_single.c tled/cpu_pass_avx512_double.c tled/cpu_pass_avx512_single.c tled/collider.c
#include "../unit/tled_bench.h"

#include "model/stream.h"

#include <inttypes.h>
#include <time.h>

enum { ROUNDS = 7, CPU_MOST = 1100000 /* elements: more take too long there */ };

typedef struct options {
    int threads;
    const char *device; /* or NULL: all */
    bool runs;          /* as well as steps */
    double least;       /* s: a round takes at least so long */
} options;

typedef struct measured {
    const char *model;
    const backend *device;
    const char *precision;
    double least; /* s: a round takes at least so long */
    double bytes; /* of the device's memory */
} measured;

static double clock_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static void say(const measured *w, const bench *b, const char *what, double *took, int64_t steps)
{
    const double nodes = (double)b->problem.nodes, elements = (double)b->problem.elements;
    qsort(took, ROUNDS, sizeof *took, ascending);
    double middle = took[ROUNDS / 2] / (double)steps;
    printf("%s,%s,%d,%s,%s,%.0f,%.0f,%.4g,%" PRId64 ",%d,%.4g,%.4g,%.4g,%.4g\n", w->model, w->device->name,
           pool_threads(b->setup.threads), w->precision, what, elements, nodes, w->bytes / elements, steps, ROUNDS,
           1e6 * middle, 1e6 * took[0] / (double)steps, 1e6 * took[ROUNDS - 1] / (double)steps,
           1e9 * middle / elements);
    fflush(stdout);
}

/* So many steps, and that they are done. */
static double time_steps(bench *b, const backend *d, void *state, tled_plan *plan, int64_t steps)
{
    tled_sums answer;
    tled_question question = {.time = tled_time(plan, steps), .rest = INFINITY, .raise = 1.01};
    double before = clock_now();
    bench_must(d->step(state, plan, steps, &b->e), &b->e);
    if (d->look)
        bench_must(d->look(state, &question, &answer, &b->e), &b->e); /* waits */
    plan->first += steps;
    return clock_now() - before;
}

/* The steps alone: enough of them in a round that the wait at its end counts for little. */
static void measure_steps(measured *w, bench *b)
{
    double took[ROUNDS];
    tled_plan plan = {.rate = b->setup.rate, .damping = b->setup.damping};
    void *state = w->device->create(&b->problem, b->setup.threads, &b->e);
    bench_must(!state, &b->e);
    int64_t steps = 4;
    while (time_steps(b, w->device, state, &plan, steps) < w->least) /* warm-up */
        steps *= 2;
    for (int i = 0; i < ROUNDS; i++)
        took[i] = time_steps(b, w->device, state, &plan, steps);
    bench_must(w->device->take(state, 0, &b->e), &b->e); /* what a run has: one frame at least */
    w->bytes = (double)w->device->bytes(state);
    say(w, b, "step", took, steps);
    w->device->destroy(state);
}

static double time_run(bench *b, int64_t steps)
{
    double before = clock_now();
    bench_steps(b, steps, b->setup.damping);
    bench_must(bench_go(b), &b->e);
    return clock_now() - before;
}

/* Runs with looks, and 60 frames a second of the model's time or none, that are copied and dropped: what a longer run takes
 * more than one of four frames, which has all the memory that it will need. */
static void measure_run(const measured *w, bench *b, double every, const char *what, int64_t steps)
{
    double took[ROUNDS];
    const int64_t first = (int64_t)ceil(4. / 60 * b->setup.rate);
    b->setup.device = w->device;
    b->setup.every = every;
    time_run(b, b->setup.check);
    for (int i = 0; i < ROUNDS; i++)
        took[i] = -time_run(b, first) + time_run(b, first + steps);
    say(w, b, what, took, steps);
}

/* One back end in one precision: on the CPU with one thread and with all; on a device runs too. */
static void measure_device(measured *w, bench *b, const options *o)
{
    if (w->device->look) {
        measure_steps(w, b);
        int64_t steps = b->setup.check * (int64_t)ceil(3e8 / (double)b->problem.elements / 50 + 20);
        if (o->runs)
            measure_run(w, b, 0, "run", steps);
        if (o->runs)
            measure_run(w, b, 1. / 60, "run with frames", steps);
        return;
    }
    for (int threads = 1; threads && b->problem.elements <= CPU_MOST; threads = threads < o->threads ? o->threads : 0) {
        pool_destroy(b->setup.threads);
        b->setup.threads = pool_create(threads, &b->e);
        bench_must(!b->setup.threads, &b->e);
        measure_steps(w, b);
    }
}

static void measure(const char *name, bench *b, const options *o)
{
    for (int single = 0; single < 2; single++)
        for (const backend *const *d = single ? tled_backends_single : tled_backends_double; *d; d++) {
            measured w = {name, *d, single ? "single" : "double", o->least, 0};
            if (!(*d)->unusable() && !(o->device && strcmp((*d)->name, o->device)))
                measure_device(&w, b, o);
        }
}

static void measure_block(int32_t x, int32_t y, int32_t z, const options *o)
{
    char name[60];
    bench b;
    const double gravity[3] = {0, 0, -.5}; /* so little that no step is cut */
    block what = {{x, y, z}, {.0025, .0025, .0025}, 3000, .49, 1000, 30000, 2, 1, 0, {0, 0, 0}, 0, false};
    snprintf(name, sizeof name, "block %d x %d x %d", x, y, z);
    bench_make(&b, &what, gravity, 0, .0075, o->threads);
    measure(name, &b, o);
    bench_free(&b);
}

/* A model from a file; its first muscle contracts. */
static void measure_file(const char *path, const options *o)
{
    bench b = {0};
    char contract[200] = "";
    in *source = in_open(path, &b.e);
    model_reader *reader = source ? model_reader_open(source, &b.e) : NULL;
    bench_must(!reader || model_read(reader, &b.m, &b.e), &b.e);
    model_reader_close(reader);
    in_close(source);
    const model_array *muscle = model_find(&b.m, "volume.muscle"), *name = model_find(&b.m, "volume.name");
    for (int64_t i = 0; muscle && i < muscle->rows && !*contract; i++)
        if (muscle->u8[i])
            snprintf(contract, sizeof contract, "%s=.05", name->str[i]);
    bench_must(*contract && script_add_contract(&b.script, &b.m, contract, .1, NULL, &b.e), &b.e);
    bench_must(tled_problem_make(&b.problem, &b.m, &b.script, .0075, &b.e), &b.e);
    bench_finish(&b, o->threads);
    measure(strrchr(path, '/') ? strrchr(path, '/') + 1 : path, &b, o);
    bench_free(&b);
}

int main(int argc, char **argv)
{
    static const int32_t blocks[][3] = {{16, 17, 8}, {29, 47, 9}, {46, 47, 46}, {100, 100, 100}, {159, 159, 159}};
    if (argc < 6 || atoi(argv[1]) < 1 || atoi(argv[2]) > 5) {
        fprintf(stderr, "usage: bench_tled THREADS BLOCKS all|cpu|cuda steps|runs SECONDS [MODEL...]\n");
        return 2;
    }
    const options o = {.threads = atoi(argv[1]),
                       .device = strcmp(argv[3], "all") ? argv[3] : NULL,
                       .runs = !strcmp(argv[4], "runs"),
                       .least = atof(argv[5])};
    printf("model,device,threads,precision,what,elements,nodes,bytes_an_element,steps,rounds,median_us_a_step,least_us,"
           "most_us,ns_an_element_step\n");
    for (int i = 0; i < atoi(argv[2]); i++)
        measure_block(blocks[i][0], blocks[i][1], blocks[i][2], &o);
    for (int i = 6; i < argc; i++)
        measure_file(argv[i], &o);
    return 0;
}
