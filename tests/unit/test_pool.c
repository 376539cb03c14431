/* Loops shared by threads: every item once, and the same chunks for any number of threads. */
#include "base/pool.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

enum { ITEMS = 100003, SIZE = 97 };

typedef struct context {
    int seen[ITEMS];
    double sum[ITEMS / SIZE + 1];
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

int main(void)
{
    context *c = calloc(2, sizeof *c);
    for (int threads = 1; threads <= 5; threads += 2) {
        err e = {0};
        pool *p = pool_create(threads, &e);
        context *now = &c[threads > 1];
        memset(now, 0, sizeof *now);
        for (int round = 0; round < 200; round++)
            pool_run(p, ITEMS, SIZE, work, now);
        int wrong = 0;
        for (int i = 0; i < ITEMS; i++)
            wrong += now->seen[i] != 200;
        ok(!wrong, "%d threads: each item once a round", threads);
        ok(!memcmp(now->sum, c[0].sum, sizeof c[0].sum), "%d threads: the same partial sums as one", threads);
        pool_run(p, 0, SIZE, work, now);
        pool_destroy(p);
    }
    ok(pool_chunks(0, 4) == 0 && pool_chunks(8, 4) == 2 && pool_chunks(9, 4) == 3, "chunks");
    free(c);
    return done_testing();
}
