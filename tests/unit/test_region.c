/* Regions of a mask, also those whose walk has more to hold than it may, against a plain walk. */
// needs: slice/contour/segment_region.c
#include "slice/contour/segment_region.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 90, COUNT = SIDE * SIDE * SIDE };

/* How many voxels are joined to `at`; these become 2. */
static int64_t plain(uint8_t *mask, int64_t at)
{
    static int32_t list[COUNT];
    const int64_t apart[3] = {1, SIDE, SIDE * SIDE};
    int64_t count = 0;
    mask[at] = 2;
    list[count++] = (int32_t)at;
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 6; k++) {
            const int64_t place = list[i] / apart[k / 2] % SIDE, next = list[i] + (k % 2 ? 1 : -1) * apart[k / 2];
            if ((k % 2 ? place + 1 < SIDE : place > 0) && mask[next] == 1) {
                mask[next] = 2;
                list[count++] = (int32_t)next;
            }
        }
    return count;
}

static void test(const char *name, int percent, bool full)
{
    static uint8_t mask[COUNT], want[COUNT];
    err e = {0};
    uint32_t seed = 5;
    region r = {.mask = mask, .size = {SIDE, SIDE, SIDE}};
    for (int64_t i = 0; i < COUNT; i++) {
        seed = seed * 1664525U + 1013904223U;
        mask[i] = (seed >> 8) % 100 < (uint32_t)percent;
    }
    const int64_t at = COUNT / 2 + SIDE / 2;
    mask[at] = 1;
    memcpy(want, mask, sizeof mask);
    const int64_t count = plain(want, at), got = region_flood(&r, at, 1, 2, &e);
    ok(got == count && !memcmp(mask, want, sizeof mask), "%s: %lld voxels are joined (%lld)", name, (long long)got,
       (long long)count);
    ok(r.capacity <= REGION_LEAST && (r.capacity == REGION_LEAST) == full, "%s: of which %lld were held at most", name,
       (long long)r.capacity);
    for (int64_t i = 0; i < COUNT; i++)
        mask[i] = mask[i] > 0;
    ok(!region_largest(&r, &e), "%s: the largest is kept", name);
    int64_t left = 0;
    for (int64_t i = 0; i < COUNT; i++)
        left += mask[i];
    ok(left >= count, "%s: of %lld voxels", name, (long long)left);
    region_free(&r);
}

int main(void)
{
    test("all voxels", 100, true);
    test("most", 70, true);
    test("a maze", 35, false);
    test("few", 10, false);
    return done_testing();
}
