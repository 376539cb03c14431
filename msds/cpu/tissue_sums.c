#include "msds/cpu/tissue_sums.h"

#include "base/mem.h"
#include "msds/problem/sell.h"

#include <stdlib.h>

enum { SUMS_ROW_LEAST = 3 /* summands that a slot in a row has at least */ };

/* A summand of a lane of a slice. */
typedef struct summand {
    int32_t row; /* where it stands, less its lane: summands of a row have the same */
    int32_t lane;
} summand;

static int by_row(const void *a, const void *b)
{
    const summand *x = a, *y = b;
    if (x->row != y->row)
        return x->row < y->row ? -1 : 1;
    return (x->lane > y->lane) - (x->lane < y->lane);
}

/* Where slots are added, and how much room there is. */
typedef struct adding {
    tissue_sums *s;
    int64_t room[3];
    int32_t nothing; /* where zeros are */
    err *e;
} adding;

static int64_t add_slot(adding *k, int32_t first)
{
    tissue_sums *s = k->s;
    const int64_t at = s->slots;
    if (MEM_ROOM(&s->first, &k->room[0], at + 1, "the solver", k->e) ||
        MEM_ROOM(&s->has, &k->room[1], at + 1, "the solver", k->e) ||
        MEM_ROOM(&s->list, &k->room[2], (at + 1) * LANES, "the solver", k->e))
        return -1;
    s->first[at] = first;
    s->has[at] = 0;
    for (int l = 0; l < LANES; l++)
        s->list[at * LANES + l] = k->nothing;
    return s->slots++;
}

static void put_summand(tissue_sums *s, int64_t slot, const summand *from)
{
    s->has[slot] |= (uint8_t)(1 << from->lane);
    s->list[slot * LANES + from->lane] = from->row + from->lane;
}

/* The slots of a slice: rows first, then what is left over, of each lane in its order. */
static int add_slice(adding *k, summand *list, int64_t count)
{
    const int64_t begin = k->s->slots;
    int64_t left = 0, used[LANES] = {0};
    qsort(list, (size_t)count, sizeof *list, by_row);
    for (int64_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && list[end].row == list[i].row;)
            end++;
        const bool is_row = end - i >= SUMS_ROW_LEAST && list[i].row >= 0;
        const int64_t slot = is_row ? add_slot(k, list[i].row) : 0;
        if (slot < 0)
            return -1;
        for (int64_t n = i; n < end; n++)
            if (is_row)
                put_summand(k->s, slot, &list[n]);
            else
                list[left++] = list[n];
    }
    const int64_t rows = k->s->slots - begin;
    for (int64_t i = 0; i < left; i++) {
        const int64_t slot = begin + rows + used[list[i].lane]++;
        if (slot == k->s->slots && add_slot(k, SELL_SCATTERED) < 0)
            return -1;
        put_summand(k->s, slot, &list[i]);
    }
    return 0;
}

/* at[taker]: where those of each begin in `item`, which has where they stand. */
static int make_slices(tissue_sums *s, int64_t takers, const int64_t *at, const int32_t *item, int32_t nothing, err *e)
{
    adding k = {.s = s, .nothing = nothing, .e = e};
    summand *list = NULL;
    int64_t room = 0;
    int failed = 0;
    s->slices = (takers + LANES - 1) / LANES;
    s->start = mem_array(s->slices + 1, sizeof *s->start, "the solver", e);
    for (int64_t i = 0; s->start && !failed && i < s->slices; i++) {
        int64_t count = 0;
        for (int32_t l = 0; l < LANES && i * LANES + l < takers && !failed; l++)
            for (int64_t n = at[i * LANES + l]; n < at[i * LANES + l + 1] && !failed; n++) {
                failed = MEM_ROOM(&list, &room, count + 1, "the solver", e);
                if (!failed)
                    list[count++] = (summand){item[n] - l, l};
            }
        failed = failed || add_slice(&k, list, count);
        s->start[i + 1] = s->slots;
    }
    free(list);
    return s->start && !failed ? 0 : -1;
}

/* Sorts items by who takes them. */
static int sort_items(int64_t takers, const tissue_items *from, int64_t **at, int32_t **item, err *e)
{
    *at = mem_array(takers + 2, sizeof **at, "the solver", e);
    *item = *at ? mem_array(from->count, sizeof **item, "the solver", e) : NULL;
    if (!*item)
        return -1;
    for (int64_t i = 0; i < from->count; i++)
        (*at)[from->taker[i] + 2]++;
    for (int64_t t = 2; t <= takers; t++)
        (*at)[t] += (*at)[t - 1];
    for (int64_t i = 0; i < from->count; i++)
        (*item)[(*at)[from->taker[i] + 1]++] = from->where[i];
    return 0;
}

int tissue_sums_make(tissue_sums *s, int64_t takers, const tissue_items *items, err *e)
{
    int64_t *at = NULL;
    int32_t *item = NULL;
    const int failed = sort_items(takers, items, &at, &item, e) || make_slices(s, takers, at, item, items->nothing, e);
    free(item);
    free(at);
    return failed ? -1 : 0;
}

void tissue_sums_free(tissue_sums *s)
{
    free(s->start);
    free(s->first);
    free(s->has);
    free(s->list);
}
