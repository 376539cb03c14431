#include "tled/cuda/march_units.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a layer takes beside its warps with cells, and one with special cells more: it waits for what these are. */
static const double layer_cost = 2, special_cost = 4;

/* A block takes so many units a pass. With fewer, those that wait for longer ones near them hold up others in turn;
 * each of more has its start, and one more layer of cells. */
static const double units_a_slot = 1.3;

typedef struct pieces {
    march_unit *of;
    int64_t count, capacity;
} pieces;

int march_warps(uint8_t mask)
{
    return __builtin_popcount(mask);
}

int march_runs_add(march_runs *r, int32_t base, const uint8_t *warps, const bool *special, int64_t owned, bool further,
                   err *e)
{
    if (MEM_ROOM(&r->run, &r->capacity, r->count + 1, "the march", e) ||
        MEM_ROOM(&r->cost, &r->costs_capacity, r->costs + owned, "the march", e))
        return -1;
    r->run[r->count++] = (march_run){base, (int32_t)owned, r->costs};
    for (int64_t i = 0; i < owned; i++) {
        const int count = further ? MARCH_THREADS / 32 : march_warps(warps[i]);
        const double cost = layer_cost + (special[i] ? special_cost : 0) + count;
        r->cost[r->costs++] = cost;
        r->all += further ? 0 : cost;
    }
    return 0;
}

void march_runs_free(march_runs *r)
{
    free(r->run);
    free(r->cost);
    memset(r, 0, sizeof *r);
}

/* Owned layers `from` to end - 1 of a run. */
static int add_piece(pieces *to, const march_run *run, int32_t from, int32_t end, err *e)
{
    if (MEM_ROOM(&to->of, &to->capacity, to->count + 1, "the march", e))
        return -1;
    to->of[to->count++] = (march_unit){.base = run->base + from, .cells = end - from + 1};
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
        if (add_piece(to, run, from, i + 1, e))
            return -1;
        from = i + 1;
        done++;
    }
    return 0;
}

int march_runs_cut(const march_runs *r, int64_t slots, march_unit **unit, int64_t *units, err *e)
{
    pieces p = {0};
    const double most = r->all / (units_a_slot * (double)slots);
    for (int64_t i = 0; i < r->count; i++)
        if (cut_run(&p, &r->run[i], r->cost + r->run[i].first, most, e)) {
            free(p.of);
            return -1;
        }
    *unit = p.of;
    *units = p.count;
    return 0;
}

void march_units_mark(march *m)
{
    for (int64_t i = 0; i < m->units; i++)
        for (int32_t k = 0; k < m->unit[i].cells; k++)
            m->unit[i].special |= m->detail[m->unit[i].base + k] >= 0;
}

void march_free(march *m)
{
    free(m->order);
    free(m->word);
    free(m->unit);
    free(m->near);
    free(m->detail);
    free(m->which);
    free(m->cell);
    free(m->cut);
    free(m->along);
    free(m->tip);
    memset(m, 0, sizeof *m);
}
