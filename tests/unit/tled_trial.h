/* Trials of the CUDA executors on a card that the processor plays: a block, bent, goes on by some steps there and on
 * processors, and what each makes of it is compared. Included by test_tled_emulated.c.
 */
#ifndef SINEW_TLED_TRIAL_H
#define SINEW_TLED_TRIAL_H

#include "tests/emulate/emulate.h"

#include "tled_card.h"

/* Cards that march, that have bricks only, and on which they stay. */
static const emulated_card marching = {.capability = 90, .processors = 2}, plain = {.capability = 80, .processors = 4},
                           staying = {.capability = 80, .processors = 132, .together = true};

/* Whether all is tried: SINEW_LONG. */
static bool all_of_it;

/* Some lots, on so many of the card's processors. */
static inline void put_in(const emulated_card *card, uint64_t seed, int processors)
{
    emulated_card c = *card;
    c.seed = seed;
    c.processors = processors;
    emulate(&c);
}

typedef struct trial {
    const char *name;
    block what;
    double level;
    bool scripted;
    int32_t cells[3]; /* in place of the block's, if not 0 */
    bool rests;       /* it keeps what leaves the card no memory for frames */
} trial;

/* What an executor makes of it: displacements and velocities of a frame, and of one a step later; internal forces at
 * the first, displacements at the second. Then, of muscles in series with springs, the contractile elements of both. */
enum { PARTS = 6, TAKEN = 2 };
typedef struct answer {
    bench b;
    double *numbers;
    int64_t count, taken; /* of each of the former, of the latter */
    bool gone;
} answer;

/* Steps up to `last`: now some at once, whose middle passes a march makes in one launch, now one. */
static inline int go_on(const tled_executor *device, tled_state *state, tled_plan *plan, int64_t last, err *e)
{
    for (int64_t count; plan->first < last; plan->first += count) {
        count = plan->first % 4 == 0 && plan->first + 3 <= last ? 3 : 1;
        if (device->step(state, plan, count, e))
            return -1;
    }
    return 0;
}

/* As in a run to rest, where the executor itself computes what the monitor asks. */
static inline int look_for_rest(const tled_executor *device, tled_state *state, err *e)
{
    tled_sums sums;
    const tled_question question = {.rest = INFINITY, .raise = 1.01, .differences = true};
    return device->monitor ? device->monitor(state, &question, &sums, e) : 0;
}

/* `steps` steps, after one that is taken back, and one more. */
static inline void find(answer *a, const trial *t, const tled_executor *device, int64_t steps)
{
    block what = t->what;
    if (t->cells[0])
        memcpy(what.cells, t->cells, sizeof what.cells);
    bench *b = &a->b;
    make(b, &what, t->level, t->scripted, device, steps);
    bend(b);
    tled_plan plan = {.origin = b->problem.start, .rate = b->setup.rate, .damping = b->setup.damping}, once = plan;
    a->count = 3 * b->problem.nodes;
    a->taken = TAKEN * b->problem.elements;
    a->numbers = calloc(PARTS * (size_t)a->count + 2 * (size_t)a->taken, sizeof *a->numbers);
    double *taken = a->numbers + PARTS * a->count, *after = taken + a->taken;
    field_values first = {{a->numbers, a->numbers + a->count, taken, taken + b->problem.elements}},
                 second = {{a->numbers + 4 * a->count, a->numbers + 5 * a->count, after, after + b->problem.elements}};
    tled_state *state = device->create(&b->problem, b->setup.threads, &b->e);
    a->gone = !a->numbers || !state || (t->rests && look_for_rest(device, state, &b->e)) ||
              device->save(state, &b->e) || go_on(device, state, &once, 1, &b->e) || device->restore(state, &b->e) ||
              go_on(device, state, &plan, steps, &b->e) ||
              device->get(state, TLED_INTERNAL, a->numbers + 2 * a->count, &b->e) ||
              device->snapshot(state, 0, &b->e) || go_on(device, state, &plan, steps + 1, &b->e) ||
              device->snapshot(state, 1, &b->e) || device->fetch(state, 0, &first, &b->e) ||
              device->fetch(state, 1, &second, &b->e) ||
              device->get(state, TLED_DISPLACEMENT, a->numbers + 3 * a->count, &b->e);
    device->destroy(state);
}

static inline void answer_free(answer *a)
{
    bench_free(&a->b);
    free(a->numbers);
}

/* The largest difference of some, as a share of the largest there is; infinite where there is no number. */
static inline double off_part(const double *a, const double *b, int64_t count)
{
    double most = 0, size = 0;
    for (int64_t k = 0; k < count; k++) {
        const double gap = fabs(a[k] - b[k]);
        if (!isfinite(gap))
            return INFINITY;
        most = fmax(most, gap);
        size = fmax(size, fabs(b[k]));
    }
    return most / size;
}

/* That of any part. */
static inline double off(const answer *a, const answer *b)
{
    double worst = 0;
    if (a->gone || b->gone)
        return INFINITY;
    for (int i = 0; i < PARTS; i++)
        worst = fmax(worst, off_part(a->numbers + i * a->count, b->numbers + i * a->count, a->count));
    if (a->b.problem.serial && b->b.problem.serial)
        worst = fmax(worst, off_part(a->numbers + PARTS * a->count, b->numbers + PARTS * a->count, 2 * a->taken));
    return worst;
}

/* The CPU's answer, to within a share, or its very bytes; and, of every third trial or of all, the same bytes by other
 * lots, and in other units. */
static inline void try(const trial *t, const emulated_card *card, const tled_executor *device, const tled_executor *cpu,
                       int64_t steps, double tolerance)
{
    static int tried;
    answer here, there, again;
    find(&here, t, cpu, steps);
    put_in(card, 1, card->processors);
    find(&there, t, device, steps);
    const int64_t blocks = emulated_blocks();
    ok(off(&there, &here) <= tolerance, "%s: %.2g off by %" PRId64 " blocks %s", t->name, off(&there, &here), blocks,
       there.b.e.text);
    if (all_of_it || tried++ % 3 == 0) {
        put_in(card, 2, card->together ? card->processors : 1);
        find(&again, t, device, steps);
        ok(off(&again, &there) == 0, "%s: the same by other lots %s", t->name, again.b.e.text);
        answer_free(&again);
    }
    answer_free(&here);
    answer_free(&there);
}

/* Where it marches: nearly the numbers of the CPU in double precision, as operations are fused and sums are others. */
static inline void try_marched(const trial *t, int64_t steps)
{
    try(t, &marching, &tled_cuda_double, &tled_cpu_double, steps, 1e-12);
}

static inline block mixed_of(block what)
{
    what.fraction = -1;
    what.mixed = true;
    return what;
}

#endif
