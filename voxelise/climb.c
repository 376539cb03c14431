#include "voxelise/climb.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum { WORD = 64 };

static int64_t row_words_of(const inside *test)
{
    return pool_chunks(grid_cells(test->mesh.g, 0), WORD);
}

int climb_create(climb *c, const inside *test, const int32_t *level, int32_t volumes, err *e)
{
    *c = (climb){.test = test, .level = level};
    c->count = mem_array(volumes, sizeof *c->count, "volumes", e);
    c->below = mem_array(row_words_of(test), sizeof *c->below, "a row", e);
    c->now = mem_array(row_words_of(test), sizeof *c->now, "a row", e);
    if (c->count && c->below && c->now)
        return 0;
    climb_free(c);
    return -1;
}

void climb_free(climb *c)
{
    free(c->count);
    free(c->active);
    free(c->below);
    free(c->now);
    *c = (climb){0};
}

int climb_add_run(climb_runs *to, climb_run run, err *e)
{
    if (mem_grow(&to->run, &to->capacity, to->runs + 1, sizeof *to->run, "runs of voxels", e))
        return -1;
    to->run[to->runs++] = run;
    return 0;
}

/* ---- Algorithm 1, one row of cells along x */

static int popcount(uint64_t x)
{
    return __builtin_popcountll(x);
}

static uint64_t *row_words(const climb *c, const inside_part *p, int64_t j, int64_t k)
{
    return inside_words(c->test, p, k, j);
}

/* Lines 7 to 9: each volume, from the lowest level, takes of its voxels what is taken on the level below, and what no
 * volume before it took on its own. */
static void take_levels(climb *c, int64_t j, int64_t k)
{
    int64_t words = row_words_of(c->test);
    int32_t level = -1;
    for (int64_t a = 0; a < c->actives; a++) {
        const inside_part *p = &c->active[a];
        int32_t mine = c->level[p->volume];
        uint64_t *bits = row_words(c, p, j, k);
        climb_count *count = &c->count[p->volume];
        if (mine != level) {
            uint64_t *spare = c->below;
            c->below = c->now, c->now = spare;
            memset(c->now, 0, (size_t)words * sizeof *c->now);
            if (mine != level + 1) /* nothing is on the level between */
                memset(c->below, 0, (size_t)words * sizeof *c->below);
            level = mine;
        }
        for (int64_t i = 0; i < p->words; i++) {
            int64_t at = p->word + i;
            uint64_t reached = mine ? bits[i] & c->below[at] : bits[i];
            count->inside += popcount(bits[i]);
            count->reached += popcount(reached);
            bits[i] = reached & ~c->now[at];
            c->now[at] |= bits[i];
        }
    }
}

/* What volumes of the next level took is theirs. */
static void yield(const climb *c, int64_t j, int64_t k)
{
    for (int64_t a = 0; a < c->actives; a++) {
        const inside_part *p = &c->active[a];
        uint64_t *bits = row_words(c, p, j, k);
        for (int64_t b = a + 1; b < c->actives; b++) {
            const inside_part *q = &c->active[b];
            if (c->level[q->volume] != c->level[p->volume] + 1)
                continue;
            const uint64_t *theirs = row_words(c, q, j, k);
            int64_t from = q->word > p->word ? q->word : p->word;
            int64_t to = q->word + q->words < p->word + p->words ? q->word + q->words : p->word + p->words;
            for (int64_t i = from; i < to; i++)
                bits[i - p->word] &= ~theirs[i - q->word];
        }
    }
}

/* The runs of set bits: a bit that differs from the one before begins or ends one. */
static int add_runs(const climb *c, const inside_part *p, int64_t j, int64_t k, climb_runs *to, err *e)
{
    const uint64_t *bits = row_words(c, p, j, k);
    int64_t low = c->test->mesh.g->low[0] + p->word * WORD, from = 0;
    uint64_t last = 0;
    for (int64_t i = 0; i < p->words; i++) {
        uint64_t changes = bits[i] ^ (bits[i] << 1 | last);
        last = bits[i] >> (WORD - 1);
        for (; changes; changes &= changes - 1) {
            int64_t at = low + i * WORD + __builtin_ctzll(changes);
            bool begins = bits[i] >> (at - low - i * WORD) & 1;
            climb_run run = {(int32_t)from, (int32_t)at, (int32_t)j, (int32_t)k, p->volume};
            if (begins)
                from = at;
            else if (climb_add_run(to, run, e))
                return -1;
        }
    }
    climb_run run = {(int32_t)from, (int32_t)(low + p->words * WORD), (int32_t)j, (int32_t)k, p->volume};
    return last ? climb_add_run(to, run, e) : 0;
}

static int compare_runs(const void *a, const void *b)
{
    const climb_run *x = a, *y = b;
    return (x->from > y->from) - (x->from < y->from);
}

static int find_runs(const climb *c, int64_t j, int64_t k, climb_runs *to, err *e)
{
    int64_t before = to->runs;
    for (int64_t a = 0; a < c->actives; a++)
        if (add_runs(c, &c->active[a], j, k, to, e))
            return -1;
    if (c->actives > 1 && to->runs > before)
        qsort(to->run + before, (size_t)(to->runs - before), sizeof(climb_run), compare_runs);
    return 0;
}

static bool any_bits(const uint64_t *words, int64_t count)
{
    uint64_t any = 0;
    for (int64_t i = 0; i < count; i++)
        any |= words[i];
    return any != 0;
}

static int find_active(climb *c, const inside_slab *slab, int64_t j, int64_t k, err *e)
{
    c->actives = 0;
    if (mem_grow(&c->active, &c->capacity, slab->parts, sizeof *c->active, "volumes", e))
        return -1;
    for (int64_t n = 0; n < slab->parts; n++) {
        const inside_part *p = &slab->part[n];
        if (j < p->box.low[1] || j >= p->box.high[1] || k < p->box.low[2] || k >= p->box.high[2])
            continue;
        if (any_bits(row_words(c, p, j, k), p->words))
            c->active[c->actives++] = *p;
    }
    return 0;
}

static void count_kept(const climb *c, int64_t j, int64_t k)
{
    for (int64_t a = 0; a < c->actives; a++) {
        const inside_part *p = &c->active[a];
        const uint64_t *bits = row_words(c, p, j, k);
        for (int64_t i = 0; i < p->words; i++)
            c->count[p->volume].kept += popcount(bits[i]);
    }
}

/* One volume of level 0 alone, as most rows have it: all of it is kept. */
static int plain_row(const climb *c, int64_t j, int64_t k, climb_runs *to, err *e)
{
    int64_t before = to->runs, cells = 0;
    climb_count *count = &c->count[c->active[0].volume];
    if (add_runs(c, &c->active[0], j, k, to, e))
        return -1;
    for (int64_t r = before; r < to->runs; r++)
        cells += to->run[r].to - to->run[r].from;
    count->inside += cells, count->reached += cells, count->kept += cells;
    return 0;
}

int climb_row(climb *c, const inside_slab *slab, int64_t j, int64_t k, climb_runs *to, err *e)
{
    if (find_active(c, slab, j, k, e))
        return -1;
    if (c->actives == 0)
        return 0;
    if (c->actives == 1 && to && c->level[c->active[0].volume] == 0)
        return plain_row(c, j, k, to, e);
    take_levels(c, j, k);
    yield(c, j, k);
    count_kept(c, j, k);
    return to ? find_runs(c, j, k, to, e) : 0;
}
