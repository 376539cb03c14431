#include "slice/segment_region.h"

#include "base/mem.h"

#include <stdlib.h>

enum { OUT, IN, SEEN };

void region_free(region *r)
{
    free(r->held);
    *r = (region){0};
}

static int64_t count_of(const region *r)
{
    return r->size[0] * r->size[1] * r->size[2];
}

/* A voxel is turned when it is put on the stack, so that it is there once. */
static int hold(region *r, int64_t *held, int64_t at, uint8_t from, uint8_t to, err *e)
{
    if (r->mask[at] != from)
        return 0;
    if (MEM_ROOM(&r->held, &r->capacity, *held + 1, "a region", e))
        return -1;
    r->mask[at] = to;
    r->held[(*held)++] = at;
    return 0;
}

int64_t region_flood(region *r, int64_t at, uint8_t from, uint8_t to, err *e)
{
    int64_t held = 0, count = 0, apart[3] = {1, r->size[0], r->size[0] * r->size[1]};
    if (hold(r, &held, at, from, to, e))
        return -1;
    for (; held; count++) {
        int64_t here = r->held[--held];
        for (int a = 0; a < 3; a++) {
            int64_t place = here / apart[a] % r->size[a];
            if (place > 0 && hold(r, &held, here - apart[a], from, to, e))
                return -1;
            if (place + 1 < r->size[a] && hold(r, &held, here + apart[a], from, to, e))
                return -1;
        }
    }
    return count;
}

int region_largest(region *r, err *e)
{
    int64_t best = -1, most = 0;
    for (int64_t i = 0; i < count_of(r); i++) {
        if (r->mask[i] != IN)
            continue;
        int64_t count = region_flood(r, i, IN, SEEN, e);
        if (count < 0)
            return -1;
        if (count > most) {
            most = count;
            best = i;
        }
    }
    if (best >= 0 && region_flood(r, best, SEEN, IN, e) < 0)
        return -1;
    for (int64_t i = 0; i < count_of(r); i++)
        r->mask[i] = r->mask[i] == IN;
    return 0;
}

int region_fill(region *r, err *e)
{
    const int64_t *n = r->size;
    for (int a = 0; a < 3; a++) {
        int b = (a + 1) % 3, c = (a + 2) % 3;
        int64_t apart[3] = {1, n[0], n[0] * n[1]};
        for (int64_t j = 0; j < n[c]; j++)
            for (int64_t i = 0; i < n[b]; i++) {
                int64_t at = i * apart[b] + j * apart[c];
                if (region_flood(r, at, OUT, SEEN, e) < 0 ||
                    region_flood(r, at + (n[a] - 1) * apart[a], OUT, SEEN, e) < 0)
                    return -1;
            }
    }
    for (int64_t i = 0; i < count_of(r); i++)
        r->mask[i] = r->mask[i] != SEEN;
    return 0;
}
