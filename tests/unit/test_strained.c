/* What is folded, with the energies of elements or without them: the same bits, for elements, mixed ones and parts,
 * from slight displacements to such as turn elements inside out, whichever element was the worst before.
 */
// needs: tled/*/*.c
#include "tled/loop/strained.h"

#include "tled_bench.h"

#include "tap.h"

#include <string.h>

enum { THREADS = 3 };

static uint32_t seed = 3;

static double uniform(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (double)(seed >> 8) / (1 << 24) - .5;
}

static bool same(double a, double b)
{
    return !memcmp(&a, &b, sizeof a);
}

static bool is_same(const quality *a, const quality *b)
{
    return same(a->centre, b->centre) && same(a->corner, b->corner) && a->folded == b->folded &&
           a->element == b->element && same(a->worst, b->worst);
}

static void test_block(const block *what, const char *name)
{
    bench b;
    err e = {0};
    int64_t wrong = 0, folded = 0, sound = 0;
    bench_make(&b, what, NULL, 0, ISOTROPIC(.04), 1);
    const tled_problem *p = &b.problem;
    double *u = calloc(3 * (size_t)p->nodes, sizeof *u);
    strained *part = calloc((size_t)pool_chunks(p->elements, STRAINED_CHUNK), sizeof *part);
    pool *threads = pool_create(THREADS, &e);
    for (int i = 0; i < 24 && u && part && threads; i++) {
        for (int64_t k = 0; k < 3 * p->nodes; k++)
            u[k] = .1 * i * p->side[k % 3] * uniform();
        const strained_view v = strained_view_of(p, u, i % 3 ? 7 * i : -1);
        const strained whole = strained_of(&v, NULL, part);
        const quality alone = strained_quality(&v, threads, part);
        wrong += !is_same(&whole.quality, &alone);
        folded += alone.folded > 0;
        sound += !alone.folded;
    }
    ok(!wrong && folded > 3 && sound > 3, "%s: the same without energies; %lld states are folded, %lld are not", name,
       (long long)folded, (long long)sound);
    pool_destroy(threads);
    free(part);
    free(u);
    bench_free(&b);
}

int main(void)
{
    block what = {.cells = {11, 9, 8},
                  .side = {.002, .003, .0025},
                  .young = 3000,
                  .poisson = .45,
                  .density = 1000,
                  .fixed_axis = 2,
                  .fixed_low = 1};
    test_block(&what, "boxes");
    what.mixed = true;
    test_block(&what, "mixed");
    what.fraction = -1;
    test_block(&what, "mixed, of which parts are there");
    return done_testing();
}
