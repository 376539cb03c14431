#include "tled/march_units.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a layer takes beside its warps with cells, and a unit beside its layers. */
static const double layer_cost = 2, unit_cost = 10;

enum { TRIALS = 40 };

typedef struct piece {
    double cost;
    march_unit unit;
} piece;

typedef struct pieces {
    piece *of;
    int64_t count, capacity;
    double *busy; /* slots: until when, the least first: a heap */
    int64_t slots;
} pieces;

int march_warps(uint8_t mask)
{
    return __builtin_popcount(mask);
}

int march_runs_add(march_runs *r, int32_t base, const uint8_t *warps, int64_t owned, err *e)
{
    if (MEM_ROOM(&r->run, &r->capacity, r->count + 1, "the march", e) ||
        MEM_ROOM(&r->cost, &r->costs_capacity, r->costs + owned, "the march", e))
        return -1;
    r->run[r->count++] = (march_run){base, (int32_t)owned, r->costs};
    for (int64_t i = 0; i < owned; i++)
        r->cost[r->costs++] = layer_cost + march_warps(warps[i]);
    return 0;
}

void march_runs_free(march_runs *r)
{
    free(r->run);
    free(r->cost);
    memset(r, 0, sizeof *r);
}

/* Owned layers from to to - 1 of a run; the layer of cells before them is computed too. */
static int add_piece(pieces *to, const march_run *run, const double *cost, int32_t from, int32_t end, err *e)
{
    double sum = unit_cost + (from ? cost[from - 1] : layer_cost);
    if (MEM_ROOM(&to->of, &to->capacity, to->count + 1, "the march", e))
        return -1;
    for (int32_t i = from; i < end; i++)
        sum += cost[i];
    to->of[to->count++] = (piece){sum, {run->base + from, end - from + 1, 0, 0}};
    return 0;
}

/* Cuts a run into parts of nearly equal cost, none of much more than `most`. */
static int cut_run(pieces *to, const march_run *run, const double *cost, double most, err *e)
{
    double all = 0, sum = 0;
    for (int32_t i = 0; i < run->owned; i++)
        all += cost[i];
    const double parts = ceil(all / most);
    int32_t from = 0;
    for (int32_t i = 0, done = 0; i < run->owned; i++) {
        sum += cost[i];
        if (i + 1 < run->owned && sum + cost[i + 1] / 2 < all * (done + 1) / parts)
            continue;
        if (add_piece(to, run, cost, from, i + 1, e))
            return -1;
        from = i + 1;
        done++;
    }
    return 0;
}

static int cut_runs(pieces *to, const march_runs *r, double most, err *e)
{
    to->count = 0;
    for (int64_t i = 0; i < r->count; i++)
        if (cut_run(to, &r->run[i], r->cost + r->run[i].first, most, e))
            return -1;
    return 0;
}

/* The longest first; of those that are as long, in order. */
static int longer(const void *a, const void *b)
{
    const piece *x = a, *y = b;
    if (x->cost != y->cost)
        return x->cost < y->cost ? 1 : -1;
    return (x->unit.base > y->unit.base) - (x->unit.base < y->unit.base);
}

/* When the last of the pieces ends, each taking the slot that is free first. Sorts them. */
static double time_of(pieces *p)
{
    double end = 0;
    if (!p->of)
        return 0;
    qsort(p->of, (size_t)p->count, sizeof *p->of, longer);
    memset(p->busy, 0, (size_t)p->slots * sizeof *p->busy);
    for (int64_t i = 0; i < p->count; i++) {
        const double until = p->busy[0] + p->of[i].cost;
        int64_t at = 0;
        for (int64_t next = 1; next < p->slots; next = 2 * at + 1) { /* sinks to its place */
            next += next + 1 < p->slots && p->busy[next + 1] < p->busy[next];
            if (p->busy[next] >= until)
                break;
            p->busy[at] = p->busy[next];
            at = next;
        }
        p->busy[at] = until;
        end = fmax(end, until);
    }
    return end;
}

/* Tries pieces from those of one for each slot down to small ones. */
static int choose(pieces *p, const march_runs *r, double all, double *best, err *e)
{
    double least = INFINITY, most = 2 * all / (double)p->slots;
    for (int i = 0; i < TRIALS && most > layer_cost; i++) {
        if (cut_runs(p, r, most, e))
            return -1;
        const double time = time_of(p);
        if (time < least) {
            least = time;
            *best = most;
        }
        most *= .93;
    }
    return 0;
}

int march_runs_cut(const march_runs *r, int64_t slots, march_unit **unit, int64_t *units, err *e)
{
    pieces p = {.slots = slots};
    double all = 0, best = INFINITY;
    int result = -1;
    for (int64_t i = 0; i < r->costs; i++)
        all += r->cost[i];
    p.busy = mem_array(slots, sizeof *p.busy, "the march", e);
    if (!p.busy || choose(&p, r, all, &best, e) || cut_runs(&p, r, best, e))
        goto out;
    time_of(&p); /* sorts them */
    *unit = mem_array(p.count, sizeof **unit, "the march", e);
    if (!*unit)
        goto out;
    for (int64_t i = 0; i < p.count; i++)
        (*unit)[i] = p.of[i].unit;
    *units = p.count;
    result = 0;
out:
    free(p.of);
    free(p.busy);
    return result;
}
