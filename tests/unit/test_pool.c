/* Loops shared by threads: every item once, and the same chunks for any number of threads. */
#include "base/pool.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ITEMS = 100003, SIZE = 97, ROUNDS = 200, UNEVEN = 40, SLEEPS = 5 };

typedef struct context {
    int seen[ITEMS];
    double sum[ITEMS / SIZE + 1];
    int calls;
} context;

static void work(void *argument, int64_t chunk, int64_t from, int64_t to)
{
    context *c = argument;
    c->sum[chunk] = 0;
    for (int64_t i = from; i < to; i++) {
        c->seen[i]++;
        c->sum[chunk] += 1. / (double)(i + 1);
    }
}

/* What the chunks must hold, from the definition: chunk c has the items from c SIZE on. */
static bool right_sums(const context *c)
{
    bool right = true;
    for (int64_t from = 0; from < ITEMS; from += SIZE) {
        double sum = 0;
        for (int64_t i = from; i < from + SIZE && i < ITEMS; i++)
            sum += 1. / (double)(i + 1);
        right &= c->sum[from / SIZE] == sum;
    }
    return right;
}

static bool seen_all(const context *c, int64_t items, int times)
{
    int64_t wrong = 0;
    for (int64_t i = 0; i < ITEMS; i++)
        wrong += c->seen[i] != (i < items ? times : 0);
    return !wrong;
}

static void doze(int64_t us)
{
    nanosleep(&(struct timespec){.tv_nsec = 1000 * us}, NULL);
}

/* Chunks that take from nothing to a few ms, one of them much the longest: threads wait for it, past their spins. */
static void uneven(void *argument, int64_t chunk, int64_t from, int64_t to)
{
    context *c = argument;
    doze(chunk == 3 ? 20000 : chunk % 7 * 100);
    for (int64_t i = from; i < to; i++)
        c->seen[i]++;
}

static void count_calls(void *argument, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk, (void)from, (void)to;
    ((context *)argument)->calls++;
}

static void with_threads(int threads, context *c)
{
    err e = {0};
    pool *p = pool_create(threads, &e);
    ok(p && pool_threads(p) == threads, "a pool of %d %s", threads, e.text);
    if (!p)
        return;
    memset(c, 0, sizeof *c);
    for (int round = 0; round < ROUNDS; round++)
        pool_run(p, ITEMS, SIZE, work, c);
    ok(seen_all(c, ITEMS, ROUNDS), "%d threads: each item once a round", threads);
    ok(right_sums(c), "%d threads: the chunks are what they must be, to the bit", threads);

    memset(c, 0, sizeof *c);
    for (int round = 0; round < SLEEPS; round++) {
        pool_run(p, UNEVEN, 1, uneven, c);
        doze(20000); /* workers are asleep when the next round begins */
    }
    ok(seen_all(c, UNEVEN, SLEEPS), "%d threads: uneven chunks, and rounds far apart", threads);

    pool_run(p, 0, SIZE, count_calls, c);
    ok(!c->calls, "%d threads: nothing to do is not done", threads);
    pool_run(p, SIZE, SIZE, count_calls, c);
    ok(c->calls == 1, "%d threads: one chunk is one call", threads);
    pool_destroy(p);
}

int main(void)
{
    context *c = calloc(1, sizeof *c);
    for (int threads = 1; c && threads <= 5; threads += 2)
        with_threads(threads, c);
    ok(pool_chunks(0, 4) == 0 && pool_chunks(8, 4) == 2 && pool_chunks(9, 4) == 3, "chunks");
    free(c);
    return done_testing();
}
