#include "slice/contour/segment_region.h"

#include "base/mem.h"

#include <stdlib.h>

enum { OUT, IN, SEEN, WAITING };

void region_free(region *r)
{
    free(r->held);
    *r = (region){0};
}

static int64_t count_of(const region *r)
{
    return r->size[0] * r->size[1] * r->size[2];
}

/* A walk over a region: what is held is to be gone on from; what waits is marked so in the mask, within low to high. */
typedef struct walk {
    region *r;
    uint8_t from, to;
    int64_t held, most, low, high, waiting;
} walk;

static int64_t room_of(int64_t voxels)
{
    return voxels / REGION_SHARE > REGION_LEAST ? voxels / REGION_SHARE : REGION_LEAST;
}

double region_bytes(double voxels)
{
    return sizeof(int64_t) * (double)room_of((int64_t)voxels);
}

/* A voxel is turned when it is held, so that it is held once. */
static int hold(walk *w, int64_t at, err *e)
{
    region *r = w->r;
    if (r->mask[at] != w->from)
        return 0;
    if (w->held == w->most) {
        r->mask[at] = WAITING;
        w->low = !w->waiting || at < w->low ? at : w->low;
        w->high = !w->waiting || at > w->high ? at : w->high;
        w->waiting++;
        return 0;
    }
    if (MEM_ROOM(&r->held, &r->capacity, w->held + 1, "a region", e))
        return -1;
    r->mask[at] = w->to;
    r->held[w->held++] = at;
    return 0;
}

/* Goes on until nothing is held. Returns how many voxels that were, or -1. */
static int64_t go_on(walk *w, err *e)
{
    const region *r = w->r;
    const int64_t apart[3] = {1, r->size[0], r->size[0] * r->size[1]};
    int64_t count = 0;
    for (; w->held; count++) {
        const int64_t here = r->held[--w->held];
        for (int a = 0; a < 3; a++) {
            const int64_t place = here / apart[a] % r->size[a];
            if (place > 0 && hold(w, here - apart[a], e))
                return -1;
            if (place + 1 < r->size[a] && hold(w, here + apart[a], e))
                return -1;
        }
    }
    return count;
}

int64_t region_flood(region *r, int64_t at, uint8_t from, uint8_t to, err *e)
{
    walk w = {.r = r, .from = from, .to = to, .most = room_of(count_of(r))};
    if (hold(&w, at, e))
        return -1;
    int64_t count = go_on(&w, e);
    while (count >= 0 && w.waiting) {
        const int64_t low = w.low, high = w.high;
        w.waiting = 0;
        for (int64_t i = low; i <= high; i++) {
            if (r->mask[i] != WAITING)
                continue;
            r->mask[i] = from;
            const int64_t more = hold(&w, i, e) ? -1 : go_on(&w, e);
            if (more < 0)
                return -1;
            count += more;
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
