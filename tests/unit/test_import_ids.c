// needs: common/exchange/import_ids.c
/* The numbers of a mesh's file, in any order and with gaps: each is found again, and one that stands twice is refused,
 * wherever. */
#include "exchange/import_ids.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static import_ids list_of(const int32_t *id, int count)
{
    err e = {0};
    import_ids s = {0};
    for (int i = 0; i < count; i++)
        import_ids_add(&s, id[i], &e);
    return s;
}

static void twice(const int32_t *id, int count, int32_t which)
{
    char want[80];
    err e = {0};
    import_ids s = list_of(id, count);
    snprintf(want, sizeof want, "mesh.inp: node %d is given twice; expected", which);
    ok(import_ids_close(&s, "node", "mesh.inp", &e) == -1 && !strncmp(e.text, want, strlen(want)), "%s", e.text);
    import_ids_free(&s);
}

/* Numbers below a hundred, of which some are taken, in some order. */
static void found(unsigned int seed, bool rises, int gap)
{
    enum { COUNT = 40 };
    int32_t id[COUNT];
    int wrong = 0;
    err e = {0};
    srand(seed);
    for (int i = 0; i < COUNT; i++)
        id[i] = 3 + gap * i;
    for (int i = COUNT - 1; i > 0 && !rises; i--) {
        const int j = rand() % (i + 1);
        const int32_t swap = id[i];
        id[i] = id[j];
        id[j] = swap;
    }
    import_ids s = list_of(id, COUNT);
    ok(!import_ids_close(&s, "node", "mesh.inp", &e), "numbers %s, each %d: %s", rises ? "that rise" : "in any order",
       gap, e.text);
    for (int64_t n = -2; n < 100; n++) {
        int32_t want = -1;
        for (int i = 0; i < COUNT; i++)
            want = id[i] == n ? i : want;
        wrong += import_ids_find(&s, n) != want || (want >= 0 && import_ids_of(&s, want) != n);
    }
    ok(!wrong && import_ids_find(&s, INT64_C(1) << 33) == -1, "all are found, and no other");
    import_ids_free(&s);
}

int main(void)
{
    twice((const int32_t[]){7, 7}, 2, 7);
    twice((const int32_t[]){1, 2, 3, 3}, 4, 3);
    twice((const int32_t[]){1, 1, 2, 3}, 4, 1);
    twice((const int32_t[]){1, 2, 3, 1}, 4, 1);
    twice((const int32_t[]){5, 9, 2, 30, 9, 31}, 6, 9);
    twice((const int32_t[]){INT32_MAX, 1, INT32_MAX}, 3, INT32_MAX);
    for (unsigned int seed = 1; seed <= 5; seed++)
        found(seed, false, 1 + (int)seed % 2);
    found(0, true, 1);
    found(0, true, 2);
    return done_testing();
}
