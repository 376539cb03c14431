#include "tled/tiles/places.h"

#include "base/mem.h"
#include "mesh/lattice.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 4096 }; /* nodes, or elements */

/* Parts that threads join side by side: each node leads to a lower one of its part, the lowest to itself. */
typedef struct parts {
    const tled_problem *p;
    int32_t *part;
} parts;

static int32_t leads_to(const int32_t *part, int32_t n)
{
    return __atomic_load_n(&part[n], __ATOMIC_RELAXED);
}

/* Shortens the way as it goes; whoever does so meanwhile leads to no higher node either. */
static int32_t root(int32_t *part, int32_t n)
{
    for (int32_t to; (to = leads_to(part, n)) != n; n = to) {
        const int32_t next = leads_to(part, to);
        if (next != to)
            __atomic_store_n(&part[n], next, __ATOMIC_RELAXED);
    }
    return n;
}

/* The higher of two roots leads to the lower, unless another thread has led it elsewhere: then they are found anew. */
static void join(int32_t *part, int32_t a, int32_t b)
{
    while ((a = root(part, a)) != (b = root(part, b))) {
        int32_t high = a > b ? a : b;
        const int32_t low = a > b ? b : a;
        if (__atomic_compare_exchange_n(&part[high], &high, low, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
            return;
    }
}

static void begin_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const parts *w = context;
    (void)chunk;
    for (int64_t n = from; n < to; n++)
        w->part[n] = (int32_t)n;
}

static void join_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const parts *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const int32_t *node = w->p->element_node + 8 * i;
        const int32_t first = root(w->part, node[0]);
        for (int k = 1; k < 8; k++)
            if (leads_to(w->part, node[k]) != first)
                join(w->part, first, node[k]);
    }
}

static void end_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const parts *w = context;
    (void)chunk;
    for (int64_t n = from; n < to; n++)
        __atomic_store_n(&w->part[n], root(w->part, (int32_t)n), __ATOMIC_RELAXED);
}

/* The root of each part is its lowest node. */
static void find_parts(const tled_problem *p, int32_t *part)
{
    parts w = {.p = p};
    w.part = part;
    pool_run(p->threads, p->nodes, CHUNK, begin_work, &w);
    pool_run(p->threads, p->elements, CHUNK, join_work, &w);
    pool_run(p->threads, p->nodes, CHUNK, end_work, &w);
}

typedef struct finder {
    const tled_problem *p;
    const int32_t *part;
    int32_t *at;
    atomic_llong off; /* the first element that is off the lattice */
} finder;

static void place_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const finder *f = context;
    const tled_problem *p = f->p;
    (void)chunk;
    for (int64_t n = from; n < to; n++)
        for (int a = 0; a < 3; a++) {
            double way = p->position[3 * n + a] - p->position[3 * (int64_t)f->part[n] + a];
            f->at[3 * n + a] = (int32_t)nearbyint(way / p->side[a]);
        }
}

static bool is_off(const finder *f, int64_t element)
{
    const int32_t *node = f->p->element_node + 8 * element, *first = f->at + 3 * (int64_t)node[0];
    bool off = false;
    for (int c = 1; c < 8; c++)
        for (int a = 0; a < 3; a++)
            off |= f->at[3 * (int64_t)node[c] + a] != first[a] + lattice_vtk[c][a];
    return off;
}

static void check_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    finder *f = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        if (is_off(f, i)) {
            long long before = atomic_load(&f->off);
            while (i < before && !atomic_compare_exchange_weak(&f->off, &before, i))
                ;
            return;
        }
}

int places_find(const tled_problem *p, int32_t *part, int32_t *at, err *e)
{
    finder f = {.p = p, .part = part};
    f.at = at;
    atomic_init(&f.off, INT64_MAX);
    find_parts(p, part);
    pool_run(p->threads, p->nodes, CHUNK, place_work, &f);
    pool_run(p->threads, p->elements, CHUNK, check_work, &f);
    const int64_t off = atomic_load(&f.off);
    if (off < INT64_MAX)
        return err_set(e, NULL, 0, "element %lld is off the lattice; expected a box of it, or -d cpu", (long long)off);
    return 0;
}

static uint64_t hash(int32_t group, const int32_t at[3])
{
    uint64_t h = (uint32_t)group;
    for (int a = 0; a < 3; a++)
        h = (h ^ (uint32_t)at[a]) * UINT64_C(0x9E3779B97F4A7C15), h ^= h >> 29;
    return h;
}

int places_shared(int64_t nodes, const int32_t *group, const int32_t *at, int32_t *first, err *e)
{
    uint64_t seats = 512;
    while (seats < 2 * (uint64_t)nodes)
        seats *= 2;
    int32_t *seat = mem_array((int64_t)seats, sizeof *seat, "places of nodes", e); /* a node, and 1; 0: free */
    if (!seat)
        return -1;
    for (int32_t n = 0; n < nodes; n++) {
        uint64_t to = hash(group[n], at + 3 * (int64_t)n) & (seats - 1);
        int32_t there;
        for (; (there = seat[to] - 1) >= 0; to = (to + 1) & (seats - 1))
            if (group[there] == group[n] && !memcmp(at + 3 * (int64_t)there, at + 3 * (int64_t)n, 3 * sizeof *at))
                break;
        first[n] = there < 0 ? n : there;
        seat[to] = first[n] + 1;
    }
    free(seat);
    return 0;
}

void places_sort(int32_t *item, uint32_t *key, int32_t count)
{
    for (int32_t i = 1; i < count; i++) {
        int32_t one = item[i], at = i;
        uint32_t its = key[i];
        for (; at && key[at - 1] > its; at--) {
            item[at] = item[at - 1];
            key[at] = key[at - 1];
        }
        item[at] = one;
        key[at] = its;
    }
}
