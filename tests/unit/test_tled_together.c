/* Threads that share a card, as jobs of a batch do: each has the bytes of a run alone. Without a card all is skipped.
 */
// needs: tled/cuda/march.c tled/cuda/march_units.c tled/cuda/march_near.c tled/cuda/march_tips.c
// needs: tled/cuda/march_cells.c tled/tiles/lattice_sheet.c tled/tiles/places.c  tled/*/*.c
#include "tled_card_runs.h"

static const block middle = {{40, 40, 24}, {.001, .001, .001}, 3000, .49, 1000, 30000, 2, 1, 0, {0, 1, 0}, 0, false};
static const block large = {{80, 80, 64}, {.001, .001, .001}, 3000, .49, 1000, 30000, 2, 1, 0, {0, 1, 0}, 0, false};

enum { TOGETHER = 6, ROUNDS_TOGETHER = 5 };

typedef struct together { /* runs that several threads make at once */
    bench run[TOGETHER];
    int gone[TOGETHER];
} together;

static void go_together(void *context, int64_t chunk, int64_t from, int64_t to)
{
    together *t = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        t->gone[i] = bench_go(&t->run[i]);
}

/* Run i of those that are made side by side: resident tiles in both precisions, with and without a script's curves, and
 * a march. */
static void make_one_of_them(bench *b, int i, const tled_executor *twice, const tled_executor *once)
{
    if (i < 4)
        make(b, i % 2 ? &muscle : &lump, i % 2 ? .2 + .1 * i : 0, i % 2 == 0, i < 2 ? twice : once, 300);
    else
        make(b, i == 4 ? &middle : &large, .3, false, once, 200);
}

static void test_together(const tled_executor *twice, const tled_executor *once)
{
    bench alone[TOGETHER];
    int different = 0, gone = 0;
    err e = {0};
    pool *threads = pool_create(TOGETHER, &e);
    bench_must(!threads, &e);
    for (int i = 0; i < TOGETHER; i++) {
        make_one_of_them(&alone[i], i, twice, once);
        gone |= bench_go(&alone[i]);
    }
    once->is.share();
    for (int round = 0; round < ROUNDS_TOGETHER; round++) {
        together t;
        for (int i = 0; i < TOGETHER; i++)
            make_one_of_them(&t.run[i], i, twice, once);
        pool_run(threads, TOGETHER, 1, go_together, &t);
        for (int i = 0; i < TOGETHER; i++) {
            gone |= t.gone[i];
            different += !same(&alone[i], &t.run[i]);
            bench_free(&t.run[i]);
        }
    }
    ok(!gone && !different, "%d runs side by side, %d times: the same bytes as alone", TOGETHER, ROUNDS_TOGETHER);
    for (int i = 0; i < TOGETHER; i++)
        bench_free(&alone[i]);
    pool_destroy(threads);
}

int main(void)
{
    const char *why;
    const tled_executor *twice = bench_cuda(tled_executors_double, &why),
                        *once = bench_cuda(tled_executors_single, &why);
    if (twice && once)
        test_together(twice, once);
    else
        skip(1, why);
    return done_testing();
}
