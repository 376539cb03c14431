/* `make bench-tled`: what a step of tled-run's solver takes, on each executor and in each precision that this machine
 * has, over blocks of growing size and over the models whose files are named (after nu=NU: with that Poisson ratio):
 * CSV. `both`: each by isotropic hourglass control too, right before physical. `slits`: each block again with a slit
 * half through its middle, across each axis. After a warm-up, the median, the least and the most of some rounds. A
 * `step` is the executor's own; a `run` is one as tled-run makes it, with its looks, and with 60 frames a second of the
 * model's time; times_real_time is the time simulated over the time taken. A run's steps are known to be done when it
 * looks, after each window of them: it is timed from a look after its first frames to its last, and
 * worst_window_us_a_step is of the slowest of all rounds.
 *
 * bytes_a_step is what a step must move at least, each thing once: of a node its displacement and velocity, read and
 * written, 1/m, and 4 bytes that say what it is; of an element 4 bytes that say where and what it is, its share (4)
 * where the model has them, and its fibre (12) where its muscle contracts. flops_a_step is what flops.h counts, for
 * each element and node once, without fibres that resist being stretched; `computed` says how many elements for each
 * one of the model are computed in fact, and lanes_filled how much of a processor's vectors they fill. Beside them
 * stands what the machine did at most in the same rounds: copying (on a card of more than its L2 cache holds or
 * within it, as the bytes of a step are) and multiply-adds, in two instructions, of the same precision.
 */
// needs: tests/bench/roof.c tests/bench/flops.cc  tled/*/*.c
#include "../unit/tled_bench.h"

#include "card_roof.h"
#include "flops.h"
#include "model/stream.h"
#include "roof.h"
#include "tled/cpu/cpu_pass.h"

#include <inttypes.h>

enum {
    ROUNDS = 7,
    FRAMES_FIRST = 8 /* more than are ever under way */,
    CPU_MOST = 1100000 /* elements: more take too long there */
};

typedef struct options {
    int threads;
    const char *device; /* or NULL: all */
    bool runs;          /* as well as steps */
    double least;       /* s: a round takes at least so long */
    double poisson;     /* of all tissue of models that are read; 0: as it is */
    bool both;          /* by isotropic hourglass control too */
    card_roof *card;    /* or NULL */
} options;

typedef struct measured {
    const char *model;
    const tled_executor *device;
    const char *precision;
    bool single;
    double least;            /* s: a round takes at least so long */
    double bytes;            /* of the device's memory */
    double computed, filled; /* elements, as times the model's; lanes, as a share of all */
    card_roof *card;
    double took[ROUNDS], copy[ROUNDS], flops[ROUNDS]; /* s; bytes and operations a second, of the machine */
} measured;

/* A run by the clock, from one look to the next: at each all steps before are done. */
typedef struct windows {
    bench *b;
    int64_t from;        /* steps: it is timed from the first look at or past these */
    int64_t first, last; /* steps at that look, and at the last so far */
    double begun, clock; /* when these were */
    double worst;        /* s a step, of all rounds */
} windows;

static const char *const header =
    "model,device,threads,precision,what,elements,nodes,bytes_an_element,steps,rounds,median_us_a_step,least_us,"
    "most_us,ns_an_element_step,simulated_us_a_step,times_real_time,bytes_a_step,flops_a_step,computed,GB_s,Gflop_s,"
    "copied,copy_GB_s,multiply_add_Gflop_s,share_of_copy,share_of_multiply_add,"
    "lanes_filled,window_steps,worst_window_us_a_step";

static int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static double middle_of(double *of)
{
    qsort(of, ROUNDS, sizeof *of, ascending);
    return of[ROUNDS / 2];
}

/* What every row begins with; returns the median of a step in seconds. */
static double say(measured *w, const bench *b, const char *what, int64_t steps)
{
    const double nodes = (double)b->problem.nodes, elements = (double)b->problem.elements;
    const double middle = middle_of(w->took) / (double)steps, simulated = 1 / b->setup.rate;
    printf("%s,%s,%d,%s,%s,%.0f,%.0f,%.4g,%" PRId64 ",%d,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,", w->model,
           w->device->is.device, pool_threads(b->setup.threads), w->precision, what, elements, nodes,
           w->bytes / elements, steps, ROUNDS, 1e6 * middle, 1e6 * w->took[0] / (double)steps,
           1e6 * w->took[ROUNDS - 1] / (double)steps, 1e9 * middle / elements, 1e6 * simulated, simulated / middle);
    return middle;
}

/* Elements of volumes that contract. */
static double active_of(const tled_problem *p)
{
    double sum = 0;
    for (int32_t i = 0; i < p->volumes; i++)
        sum += p->volume[i].contract < 0 ? 0 : (double)p->volume[i].elements;
    return sum;
}

static double bytes_of(const tled_problem *p, bool single)
{
    const int number = single ? sizeof(float) : sizeof(double);
    return (double)p->nodes * (13 * number + 4) + (double)p->elements * (4 + (p->fraction ? 4 : 0)) + 12 * active_of(p);
}

static double flops_of(const tled_problem *p)
{
    const double zero[24] = {0}, active = active_of(p);
    return (double)p->nodes * (double)flops_sum(flops_of_node()) +
           ((double)p->elements - active) * (double)flops_sum(flops_of_element(p->control.kind, 0, zero, NULL)) +
           active * (double)flops_sum(flops_of_element(p->control.kind, 1, zero, NULL));
}

static const char *copied_by(const measured *w, double bytes)
{
    (void)w, (void)bytes;
#ifdef SINEW_CUDA
    if (w->device->monitor && bytes < (double)card_roof_cache(w->card))
        return "cache";
#endif
    return "memory";
}

static void say_shares(measured *w, const bench *b, int64_t steps)
{
    const double middle = say(w, b, "step", steps), bytes = bytes_of(&b->problem, w->single);
    const double operations = flops_of(&b->problem), copy = middle_of(w->copy), most = middle_of(w->flops);
    printf("%.0f,%.0f,%.4g,%.4g,%.4g,%s,%.4g,%.4g,%.4g,%.4g,%.4g,,\n", bytes, operations, w->computed,
           1e-9 * bytes / middle, 1e-9 * operations / middle, copied_by(w, bytes), 1e-9 * copy, 1e-9 * most,
           bytes / middle / copy, operations / middle / most, w->filled);
    fflush(stdout);
}

static void say_run(measured *w, const bench *b, const char *what, int64_t steps, double worst)
{
    say(w, b, what, steps);
    printf(",,,,,,,,,,,%" PRId64 ",%.4g\n", b->setup.check, 1e6 * worst);
    fflush(stdout);
}

/* One round of what the machine can do, in the round of what is compared with it. */
static void probe_machine(measured *w, bench *b, const roof *r, int round)
{
#ifdef SINEW_CUDA
    card_rates card;
    if (w->device->monitor) {
        bench_must(card_roof_take(w->card, w->single, &card, &b->e), &b->e);
        w->copy[round] = strcmp(copied_by(w, bytes_of(&b->problem, w->single)), "memory") ? card.cache : card.memory;
        w->flops[round] = card.flops;
        return;
    }
#endif
    (void)b;
    const roof_rates rates = roof_take(r, w->single);
    w->copy[round] = rates.copy;
    w->flops[round] = rates.flops;
}

/* So many steps, and that they are done. */
static double time_steps(bench *b, const tled_executor *d, tled_state *state, tled_plan *plan, int64_t steps)
{
    tled_sums answer;
    tled_question question = {.time = tled_time(plan, steps), .rest = INFINITY, .raise = 1.01};
    double before = roof_clock();
    bench_must(d->step(state, plan, steps, &b->e), &b->e);
    if (d->monitor)
        bench_must(d->monitor(state, &question, &answer, &b->e), &b->e); /* waits */
    plan->first += steps;
    return roof_clock() - before;
}

/* Of the elements that are computed side by side, how many are any. */
static double lanes_filled(bench *b, int lanes)
{
    rows r = {0};
    bench_must(rows_make(&r, &b->problem, lanes, pool_threads(b->setup.threads), &b->e), &b->e);
    const double filled = (double)r.cells / ((double)r.groups * lanes);
    rows_free(&r);
    return filled;
}

/* The steps alone: enough of them in a round that the wait at its end counts for little. */
static void measure_steps(measured *w, bench *b)
{
    tled_plan plan = {.rate = b->setup.rate, .damping = b->setup.damping};
    roof r = {0};
    if (!w->device->monitor) {
        const cpu_pass *pass =
            cpu_pass_choose(w->single ? cpu_passes_single : cpu_passes_double, b->problem.form, &b->e);
        bench_must(!pass || roof_make(&r, b->setup.threads, pass->name, &b->e), &b->e);
        w->filled = lanes_filled(b, pass->lanes);
    }
    tled_state *state = w->device->create(&b->problem, b->setup.threads, &b->e);
    bench_must(!state, &b->e);
    int64_t steps = 4;
    while (time_steps(b, w->device, state, &plan, steps) < w->least) /* warm-up */
        steps *= 2;
    for (int i = 0; i < ROUNDS; i++) {
        w->took[i] = time_steps(b, w->device, state, &plan, steps);
        probe_machine(w, b, &r, i);
    }
    bench_must(w->device->snapshot(state, 0, &b->e), &b->e); /* what a run has: one frame at least */
    w->bytes = (double)w->device->bytes(state);
    w->computed = (double)w->device->computed(state) / (double)b->problem.elements;
    say_shares(w, b, steps);
    w->device->destroy(state);
    roof_free(&r);
}

/* It is not copied: tled-run writes it from where it stands. */
static int window_frame(void *context, double time, const field_values *state, err *e)
{
    const windows *w = context;
    (void)time, (void)state, (void)e;
    w->b->frames++;
    return 0;
}

static void window_end(void *context, int64_t step, const monitor_reading *reading, double remaining, int64_t cut,
                       double damping)
{
    windows *w = context;
    const double now = roof_clock();
    bench_checked(w->b, step, reading, remaining, cut, damping);
    if (w->last >= w->from && step > w->last) {
        w->worst = fmax(w->worst, (now - w->clock) / (double)(step - w->last));
    } else if (step >= w->from) {
        w->first = step;
        w->begun = now;
    }
    w->last = step;
    w->clock = now;
}

/* s, of the steps from w->first to w->last. */
static double time_run(bench *b, windows *w, int64_t steps)
{
    w->last = 0;
    bench_steps(b, steps, b->setup.damping);
    bench_must(bench_go(b), &b->e);
    return w->clock - w->begun;
}

/* Runs with looks, and 60 frames a second of the model's time or none, that are counted and dropped. What is timed
 * lies between two looks of one run: its start takes longer than many steps, and a frame has its memory made, as
 * many times as there may be under way. */
static void measure_run(measured *w, bench *b, double every, const char *what, int64_t steps)
{
    const int64_t check = b->setup.check, start = (int64_t)ceil(FRAMES_FIRST / 60. * b->setup.rate);
    const run_setup setup = b->setup;
    windows seen = {.b = b, .from = (start + check - 1) / check * check};
    b->setup.device = w->device;
    b->setup.every = every;
    b->setup.context = &seen;
    b->setup.frame = window_frame;
    b->setup.checked = window_end;
    for (int i = 0; i < ROUNDS; i++)
        w->took[i] = time_run(b, &seen, seen.from + steps);
    say_run(w, b, what, seen.last - seen.first, seen.worst);
    b->setup = setup;
}

/* One executor: on the CPU with one thread and with all; on a card runs too. */
static void measure_device(measured *w, bench *b, const options *o)
{
    if (w->device->monitor) {
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
        for (const executor *const *d = single ? tled_executors_single : tled_executors_double; *d; d++) {
            measured w = {.model = name,
                          .device = tled_executor_of(*d),
                          .precision = single ? "single" : "double",
                          .single = single,
                          .least = o->least,
                          .filled = 1,
                          .card = o->card};
            const bool is_asked = !o->device || !strcmp((*d)->device, o->device);
            if (is_asked && !((*d)->features & EXECUTOR_MESHES) && !(*d)->unusable()) /* blocks are of boxes */
                measure_device(&w, b, o);
        }
}

/* What rows call the control, behind the model's name. */
static const char *said_of(hourglass_control control)
{
    return control.kind == HOURGLASS_ISOTROPIC ? " isotropic" : "";
}

/* slit: its axis: half through the block's middle; -1: none. */
static void measure_block(const int32_t cells[3], int slit_axis, hourglass_control control, const options *o)
{
    const int32_t first = cells[(slit_axis + 4) % 3], second = cells[(slit_axis + 5) % 3];
    const slit half = {
        "half",
        {{slit_axis, slit_axis < 0 ? 0 : cells[slit_axis] / 2, {0, 0}, {first / 2, second}, false, false}},
        false};
    char name[80];
    bench b;
    const double gravity[3] = {0, 0, -.5}; /* so little that no step is cut */
    const block what = {
        {cells[0], cells[1], cells[2]}, {.0025, .0025, .0025}, 3000, .49, 1000, 30000, 2, 1, 0, {0, 0, 0}, 0, false};
    snprintf(name, sizeof name, "block %d x %d x %d%s%.*s%s", cells[0], cells[1], cells[2],
             slit_axis < 0 ? "" : " slit across ", slit_axis >= 0, &"xyz"[slit_axis < 0 ? 0 : slit_axis],
             said_of(control));
    in_slit = slit_axis < 0 ? NULL : &half;
    bench_make(&b, &what, gravity, 0, control, o->threads);
    in_slit = NULL;
    measure(name, &b, o);
    bench_free(&b);
}

static void set_poisson(model *m, double poisson)
{
    const model_array *nu = model_find(m, "material.nu");
    for (int64_t i = 0; nu && i < nu->rows; i++)
        nu->f64[i] = poisson;
}

/* A model from a file; its first muscle contracts. */
static void measure_file(const char *path, hourglass_control control, const options *o)
{
    bench b = {0};
    char name[200];
    const char *file = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    char contract[200] = "";
    in *source = in_open(path, &b.e);
    model_reader *reader = source ? model_reader_open(source, &b.e) : NULL;
    bench_must(!reader || model_read(reader, &b.m, &b.e), &b.e);
    model_reader_close(reader);
    in_close(source);
    if (o->poisson > 0)
        set_poisson(&b.m, o->poisson);
    if (o->poisson > 0)
        snprintf(name, sizeof name, "%s nu=%g%s", file, o->poisson, said_of(control));
    else
        snprintf(name, sizeof name, "%s%s", file, said_of(control));
    const model_array *muscle = model_find(&b.m, "volume.muscle"), *names = model_find(&b.m, "volume.name");
    for (int64_t i = 0; muscle && i < muscle->rows && !*contract; i++)
        if (muscle->u8[i])
            snprintf(contract, sizeof contract, "%s=.05", names->str[i]);
    bench_must(*contract && script_add_contract(&b.script, &b.m, contract, .1, &b.e), &b.e);
    bench_must(tled_problem_make(&b.problem, &b.m, &b.script, control, &b.e), &b.e);
    bench_finish(&b, o->threads);
    measure(name, &b, o);
    bench_free(&b);
}

#ifdef SINEW_CUDA
/* In GB/s or Gflop/s. */
static void say_probe(const char *precision, const char *what, double rate, bool flops_too)
{
    printf("probe,cuda,,%s,%s,,,,,1,,,,,,,,,,%s%.4g,%s,,,,,,,\n", precision, what, flops_too ? "," : "", rate,
           flops_too ? "" : ",");
}
#endif

/* All that a card can do, a row each. */
static card_roof *find_card(const options *o)
{
#ifdef SINEW_CUDA
    err e = {0};
    const char *why;
    card_rates rates;
    if (!bench_cuda(tled_executors_single, &why) || (o->device && strcmp(o->device, "cuda") != 0))
        return NULL;
    card_roof *r = card_roof_create(&e);
    bench_must(!r, &e);
    for (int single = 0; single < 2; single++) {
        const char *precision = single ? "single" : "double";
        bench_must(card_roof_take(r, single, &rates, &e), &e);
        if (!single) {
            say_probe("", "copy in memory", 1e-9 * rates.memory, false);
            say_probe("", "copy within the L2 cache", 1e-9 * rates.cache, false);
        }
        say_probe(precision, "multiply-add", 1e-9 * rates.flops, true);
        say_probe(precision, "multiply-add fused", 1e-9 * rates.fused, true);
    }
    return r;
#else
    (void)o;
    return NULL;
#endif
}

int main(int argc, char **argv)
{
    static const hourglass_control controls[] = {{HOURGLASS_ISOTROPIC, .0075}, {HOURGLASS_PHYSICAL, 0}};
    static const int32_t blocks[][3] = {{16, 17, 8}, {29, 47, 9}, {46, 47, 46}, {100, 100, 100}, {159, 159, 159}};
    if (argc < 6 || atoi(argv[1]) < 1 || atoi(argv[2]) > 5) {
        fprintf(stderr, "usage: bench_tled THREADS BLOCKS all|cpu|cuda steps|runs SECONDS "
                        "[both|slits|nu=NU|MODEL...]\n");
        return 2;
    }
    bool slits_too = false;
    options o = {.threads = atoi(argv[1]),
                 .device = strcmp(argv[3], "all") ? argv[3] : NULL,
                 .runs = !strcmp(argv[4], "runs"),
                 .least = atof(argv[5])};
    puts(header);
    o.card = find_card(&o);
    for (int i = 6; i < argc; i++) {
        o.both |= !strcmp(argv[i], "both");
        slits_too |= !strcmp(argv[i], "slits");
    }
    for (int i = 0; i < atoi(argv[2]); i++)
        for (int c = !o.both; c < 2; c++)
            for (int axis = -1; axis < (slits_too ? 3 : 0); axis++)
                measure_block(blocks[i], axis, controls[c], &o);
    for (int i = 6; i < argc; i++)
        if (!strcmp(argv[i], "both") || !strcmp(argv[i], "slits"))
            continue;
        else if (!strncmp(argv[i], "nu=", 3))
            o.poisson = atof(argv[i] + 3);
        else
            for (int c = !o.both; c < 2; c++)
                measure_file(argv[i], controls[c], &o);
#ifdef SINEW_CUDA
    card_roof_destroy(o.card);
#endif
    return 0;
}
