/* Runs of blocks on a real card against those on processors: the same bytes, or, where it marches, nearly the same.
 * Included by test_tled_cuda.c.
 */
#ifndef SINEW_TLED_CARD_RUNS_H
#define SINEW_TLED_CARD_RUNS_H

#include "tled/cuda/march.h"

#include "tled_card.h"

static inline bool same(const bench *a, const bench *b)
{
    return a->time == b->time && a->frames == b->frames &&
           !memcmp(a->displacement, b->displacement, (size_t)a->problem.nodes * 6 * sizeof *a->displacement);
}

/* In single precision numbers that are too small to be normal are taken for zero; which of those at the very edge are,
 * a card and a processor may decide differently. */
static inline bool same_but_the_smallest(const bench *a, const bench *b)
{
    double most = 0;
    for (int64_t i = 0; i < 6 * a->problem.nodes; i++)
        most = fmax(most, fabs(a->displacement[i] - b->displacement[i]));
    return a->time == b->time && a->frames == b->frames && most < 1e-30;
}

/* The largest difference of a component, as a share of the largest displacement. */
static inline double apart(const bench *a, const bench *b)
{
    double most = 0;
    for (int64_t i = 0; i < 3 * a->problem.nodes; i++)
        most = fmax(most, fabs(a->displacement[i] - b->displacement[i]));
    return most / b->end.reading.largest;
}

/* As lump, of so many elements that a card marches in single precision; and boxes, so that its axes differ. */
static const block marched = {
    {80, 80, 64}, {.002125, .0009, .001171875}, 30000, .45, 1000, 30000, 0, 1, 0, {0, 0, 0}, 0, false};

/* More curves than bricks that stay keep beside them: so a block of few elements does not stay, and may march. */
static inline void add_pushes(bench *b)
{
    char text[4096] = "";
    size_t at = 0;
    for (int i = 0; i < 40; i++)
        at += (size_t)snprintf(text + at, sizeof text - at, "0 force .0%02d,.0%02d,.008 .004 1e-4,%de-6,-2e-5\n",
                               i % 20 + 4, i < 20 ? 10 : 4, 7 * i - 100);
    read_script(b, text);
}

static inline void test_bytes(const block *what, double level, bool scripted, int64_t steps, const tled_executor *cpu,
                              const tled_executor *cuda, const char *name)
{
    bench here, there;
    make(&here, what, level, scripted, cpu, steps);
    make(&there, what, level, scripted, cuda, steps);
    int gone = bench_go(&here) | bench_go(&there);
    ok(!gone && here.end.reading.largest > 1e-6, "%s: %" PRId64 " steps, %" PRId64 " frames, %.2g mm %s", name, steps,
       there.frames, 1e3 * here.end.reading.largest, there.e.text);
    ok(!gone && (cpu == &tled_cpu_double ? same(&here, &there) : same_but_the_smallest(&here, &there)),
       "%s: the same bytes as the CPU in the same precision", name);
    bench_free(&here);
    bench_free(&there);
}

/* Threads or cells that the card has for each element. */
static inline double computed(bench *b, const tled_executor *cuda)
{
    tled_state *state = cuda->create(&b->problem, b->setup.threads, &b->e);
    bench_must(!state, &b->e);
    const double each = (double)cuda->computed(state) / (double)b->problem.elements;
    cuda->destroy(state);
    return each;
}

/* Whether the card marches: it computes what a march of the same problem does,
 * rounded down. each: what computed() says. */
static inline bool is_march(bench *b, double each)
{
    const double elements = (double)b->problem.elements;
    march m;
    const int failed = march_make(&m, &b->problem, 264, &b->e);
    const bool is = m.units > 0 && fabs(floor(m.computed * elements) - each * elements) < .5;
    march_free(&m);
    bench_must(failed, &b->e);
    return is;
}

/* Two runs of the same steps, made: the processor's in double precision, and one that marches: fused
 * operations, and sums in another order. */
static inline void compare_marched(bench *here, bench *there, const char *name)
{
    const double each = computed(there, there->setup.device);
    int gone = bench_go(here) | bench_go(there);
    ok(!gone && here->end.reading.largest > 1e-6 && here->frames == there->frames && apart(there, here) < 1e-5,
       "%s, marched: after %" PRId64 " steps and %.2g mm, %.2g of the largest displacement off %s", name,
       here->end.steps, 1e3 * here->end.reading.largest, apart(there, here), there->e.text);
    ok(is_march(there, each), "%s: it marches, %.3g threads an element", name, each);
    bench_free(here);
    bench_free(there);
}

static inline void test_marched(const block *what, double level, bool scripted, int64_t steps,
                                const tled_executor *cuda, const char *name)
{
    bench here, there;
    make(&here, what, level, scripted, &tled_cpu_double, steps);
    make(&there, what, level, scripted, cuda, steps);
    compare_marched(&here, &there, name);
}

/* The same in double precision, in which large models march as well. */
static inline void test_marched_double(const block *what, double level, int64_t steps, const tled_executor *cuda,
                                       const char *name)
{
    bench here, there;
    make(&here, what, level, false, &tled_cpu_double, steps);
    make(&there, what, level, false, cuda, steps);
    const int gone = bench_go(&here) | bench_go(&there);
    ok(!gone && here.end.reading.largest > 1e-6 && here.frames == there.frames && apart(&there, &here) < 1e-12,
       "%s: after %" PRId64 " steps and %.2g mm, %.2g of the largest displacement off %s", name, here.end.steps,
       1e3 * here.end.reading.largest, apart(&there, &here), there.e.text);
    bench_free(&here);
    bench_free(&there);
}

/* Few elements, so that tools which watch every access of a card get through it. */
static inline void test_marched_small(const block *what, int64_t steps, const tled_executor *cuda, const char *name)
{
    bench here, there;
    const double level = what->fibre[1] > 0 ? .5 : 0;
    make(&here, what, level, false, &tled_cpu_double, steps);
    make(&there, what, level, false, cuda, steps);
    add_pushes(&here);
    add_pushes(&there);
    compare_marched(&here, &there, name);
}

#endif
