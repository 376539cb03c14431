#include "tled/cuda/march_units.h"

#include "base/mem.h"
#include "tled/tiles/lattice_sheet.h"

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

/* The order of nodes that is being made. */
typedef struct ordering {
    march *m;
    int32_t *next; /* layers: how many nodes each owns; then the next number of one of these */
} ordering;

/* Gives numbers to the nodes that a layer's words own, from *next on; order: NULL: only counts them. */
static void number_layer(const uint32_t *word, int32_t *next, int32_t *order)
{
    for (int32_t j = 1; j < MARCH_SIDE; j++)
        for (int32_t i = 1; i < MARCH_SIDE; i++) {
            const uint32_t own = word[march_word_of(i, j)];
            if (own & MARCH_OWN && order)
                order[own & MARCH_NODE] = *next;
            *next += (own & MARCH_OWN) != 0;
        }
}

static void count_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const ordering *o = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        number_layer(o->m->word + MARCH_WORDS * i, &o->next[i], NULL);
}

static void number_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const ordering *o = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        number_layer(o->m->word + MARCH_WORDS * i, &o->next[i], o->m->order);
}

static void place_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const march *m = ((const ordering *)context)->m;
    (void)chunk;
    for (uint32_t *word = m->word + MARCH_WORDS * from; word < m->word + MARCH_WORDS * to; word++)
        if (*word & MARCH_THERE)
            *word = (*word & ~(uint32_t)MARCH_NODE) | (uint32_t)m->order[*word & MARCH_NODE];
}

int march_order_nodes(march *m, int64_t nodes, const int32_t *sheet, pool *threads, err *e)
{
    enum { LAYERS = 64 };
    int32_t count = 0;
    ordering o = {m, mem_array(m->layers, sizeof *o.next, "the march", e)};
    m->order = mem_array(nodes, sizeof *m->order, "the march", e);
    if (m->order && o.next) {
        pool_run(threads, m->layers, LAYERS, count_work, &o);
        for (int64_t i = 0; i < m->layers; i++) {
            const int32_t owned = o.next[i];
            o.next[i] = count;
            count += owned;
        }
        pool_run(threads, m->layers, LAYERS, number_work, &o);
        m->tip_first = count;
        m->tips = nodes - count;
        for (int64_t n = 0; sheet && n < nodes; n++)
            if (sheet[n] == SHEET_TIP)
                m->order[n] = count++;
        pool_run(threads, m->layers, LAYERS, place_work, &o);
    }
    const int result = m->order && o.next ? 0 : -1;
    free(o.next);
    return result;
}
