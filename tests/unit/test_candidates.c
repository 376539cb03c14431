/* Boxes that overlap: all pairs are found, each once, and none that is far apart. */
#include "surface/candidates.h"

#include "tap.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { BOXES = 2000 };

typedef struct one {
    double low[3], high[3];
} one;

static double uniform(double low, double high)
{
    return low + (high - low) * rand() / (double)RAND_MAX;
}

static void give(const void *context, int64_t item, double *low, double *high)
{
    const one *b = &((const one *)context)[item];
    for (int a = 0; a < 3; a++) {
        low[a] = b->low[a];
        high[a] = b->high[a];
    }
}

static void count_pair(void *context, int64_t first, int64_t second)
{
    atomic_uchar *times = context;
    atomic_fetch_add(&times[first * BOXES + second], 1);
}

/* Whether they overlap when each is made larger by so much. */
static bool overlap(const one *a, const one *b, double by)
{
    for (int i = 0; i < 3; i++)
        if (a->low[i] - by > b->high[i] + by || b->low[i] - by > a->high[i] + by)
            return false;
    return true;
}

static void test_pairs(const one *box)
{
    static atomic_uchar times[BOXES * BOXES];
    err e = {0};
    candidates *c = candidates_create(BOXES, give, box, 100, 3, &e);
    ok(c != NULL, "a tree %s", e.text);
    if (c)
        candidates_pairs(c, count_pair, times);
    candidates_destroy(c);
    int missed = 0, far = 0, again = 0, found = 0;
    for (int64_t i = 0; i < BOXES; i++)
        for (int64_t j = 0; j < BOXES; j++) {
            int count = atomic_load(&times[i * BOXES + j]);
            found += count > 0;
            again += count > 1;
            missed += i < j && !count && overlap(&box[i], &box[j], 0);
            far += count > 0 && (i >= j || !overlap(&box[i], &box[j], .01));
        }
    ok(!missed && found > BOXES / 2, "%d pairs missed of %d", missed, found);
    ok(!again && !far, "%d pairs twice, %d far apart or the wrong way round", again, far);
}

int main(void)
{
    static one box[BOXES];
    srand(11);
    for (int i = 0; i < BOXES; i++)
        for (int a = 0; a < 3; a++) { /* many at the same places, many flat */
            box[i].low[a] = i % 2 ? floor(uniform(-10, 10)) : uniform(-10, 10);
            const double side = i % 50 ? 1 : 12;
            box[i].high[a] = box[i].low[a] + (i % 3 == a ? 0 : side);
        }
    test_pairs(box);
    return done_testing();
}
