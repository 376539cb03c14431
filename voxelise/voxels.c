#include "voxelise/voxels.h"

#include "base/mem.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 50, WORD = 64 }; /* PARTS: between which progress is shown */

/* What an element needs: its nodes, lattice place and volume (48 bytes), a little over one node (36 bytes), and room for
 * the writer. A row of cells: some runs. */
static const double element_bytes = 120, row_bytes = 64;

/* The runs of one slab. */
typedef struct chunk {
    voxels_run *run;
    int64_t runs, capacity;
} chunk;

typedef struct counter {
    atomic_llong inside, reached, kept;
} counter;

typedef struct work {
    const inside *test;
    const int32_t *level;
    int32_t volumes;
    int64_t first;    /* slab of this part */
    chunk *chunk;     /* slabs; NULL: elements are only counted */
    counter *counter; /* volumes */
    atomic_bool failed;
} work;

/* One thread's, for one slab. */
typedef struct scratch {
    const work *w;
    inside_slab slab;
    inside_part **active; /* the volumes in a row, in order */
    int64_t actives;
    uint64_t *below, *now; /* words of a row: what is taken on the level below, and on this one */
    voxels_count *count;   /* volumes */
    chunk *to;
} scratch;

/* ---- memory */

int voxels_check_memory(const grid *g, double elements, double slabs, double available, err *e)
{
    double layer = (double)(grid_cells(g, 0) + 1) * (double)(grid_cells(g, 1) + 1);
    double bytes = element_bytes * elements + row_bytes * (double)grid_cells(g, 1) * (double)grid_cells(g, 2) +
                   2 * 4 * layer + slabs;
    if (bytes <= available && elements <= INT32_MAX)
        return 0;
    const char *say =
        bytes <= available ? "at most 2147483647 elements can be numbered" : "use larger voxels, or a --box";
    return err_set(
        e, NULL, 0,
        "a lattice of %lld x %lld x %lld cells (%.3g, of which some %.3g would be elements) needs %.3g GB of "
        "memory, and %.3g GB are free; %s",
        (long long)grid_cells(g, 0), (long long)grid_cells(g, 1), (long long)grid_cells(g, 2), grid_count(g), elements,
        bytes / 1e9, available / 1e9, say);
}

/* ---- Algorithm 1, one row of cells along x */

static int popcount(uint64_t x)
{
    return __builtin_popcountll(x);
}

static uint64_t *row_words(const scratch *s, const inside_part *p, int64_t j, int64_t k)
{
    return inside_words(s->w->test, p, k, j);
}

/* Lines 7 to 9: each volume, from the lowest level, takes of its voxels what is taken on the level below, and what no
 * volume before it took on its own. */
static void climb(scratch *s, int64_t j, int64_t k)
{
    const work *w = s->w;
    int64_t words = (grid_cells(w->test->mesh.g, 0) + WORD - 1) / WORD;
    int32_t level = -1;
    for (int64_t a = 0; a < s->actives; a++) {
        const inside_part *p = s->active[a];
        int32_t mine = w->level[p->volume];
        uint64_t *bits = row_words(s, p, j, k);
        voxels_count *count = &s->count[p->volume];
        if (mine != level) {
            uint64_t *spare = s->below;
            s->below = s->now, s->now = spare;
            memset(s->now, 0, (size_t)words * sizeof *s->now);
            if (mine != level + 1) /* nothing is on the level between */
                memset(s->below, 0, (size_t)words * sizeof *s->below);
            level = mine;
        }
        for (int64_t i = 0; i < p->words; i++) {
            int64_t at = p->word + i;
            uint64_t reached = mine ? bits[i] & s->below[at] : bits[i];
            count->inside += popcount(bits[i]);
            count->reached += popcount(reached);
            bits[i] = reached & ~s->now[at];
            s->now[at] |= bits[i];
        }
    }
}

/* What volumes of the next level took is theirs. */
static void yield(scratch *s, int64_t j, int64_t k)
{
    const work *w = s->w;
    for (int64_t a = 0; a < s->actives; a++) {
        const inside_part *p = s->active[a];
        uint64_t *bits = row_words(s, p, j, k);
        for (int64_t b = a + 1; b < s->actives; b++) {
            const inside_part *q = s->active[b];
            if (w->level[q->volume] != w->level[p->volume] + 1)
                continue;
            const uint64_t *theirs = row_words(s, q, j, k);
            int64_t from = q->word > p->word ? q->word : p->word;
            int64_t to = q->word + q->words < p->word + p->words ? q->word + q->words : p->word + p->words;
            for (int64_t i = from; i < to; i++)
                bits[i - p->word] &= ~theirs[i - q->word];
        }
    }
}

static int add_run(scratch *s, voxels_run run, err *e)
{
    chunk *to = s->to;
    if (mem_grow(&to->run, &to->capacity, to->runs + 1, sizeof *to->run, "runs of voxels", e))
        return -1;
    to->run[to->runs++] = run;
    return 0;
}

/* The runs of set bits: a bit that differs from the one before begins or ends one. */
static int add_runs(scratch *s, const inside_part *p, int64_t j, int64_t k, err *e)
{
    const uint64_t *bits = row_words(s, p, j, k);
    int64_t low = s->w->test->mesh.g->low[0] + p->word * WORD, from = 0;
    uint64_t last = 0;
    for (int64_t i = 0; i < p->words; i++) {
        uint64_t changes = bits[i] ^ (bits[i] << 1 | last);
        last = bits[i] >> (WORD - 1);
        for (; changes; changes &= changes - 1) {
            int64_t at = low + i * WORD + __builtin_ctzll(changes);
            bool begins = bits[i] >> (at - low - i * WORD) & 1;
            voxels_run run = {(int32_t)from, (int32_t)at, (int32_t)j, (int32_t)k, p->volume};
            if (begins)
                from = at;
            else if (add_run(s, run, e))
                return -1;
        }
    }
    voxels_run run = {(int32_t)from, (int32_t)(low + p->words * WORD), (int32_t)j, (int32_t)k, p->volume};
    return last ? add_run(s, run, e) : 0;
}

static int compare_runs(const void *a, const void *b)
{
    const voxels_run *x = a, *y = b;
    return (x->from > y->from) - (x->from < y->from);
}

static int find_runs(scratch *s, int64_t j, int64_t k, err *e)
{
    int64_t before = s->to->runs;
    for (int64_t a = 0; a < s->actives; a++)
        if (add_runs(s, s->active[a], j, k, e))
            return -1;
    if (s->actives > 1 && s->to->runs > before)
        qsort(s->to->run + before, (size_t)(s->to->runs - before), sizeof(voxels_run), compare_runs);
    return 0;
}

/* ---- slabs */

static bool any_bits(const uint64_t *words, int64_t count)
{
    uint64_t any = 0;
    for (int64_t i = 0; i < count; i++)
        any |= words[i];
    return any != 0;
}

static void find_active(scratch *s, int64_t j, int64_t k)
{
    s->actives = 0;
    for (int64_t n = 0; n < s->slab.parts; n++) {
        inside_part *p = &s->slab.part[n];
        if (j < p->box.low[1] || j >= p->box.high[1] || k < p->box.low[2] || k >= p->box.high[2])
            continue;
        if (any_bits(row_words(s, p, j, k), p->words))
            s->active[s->actives++] = p;
    }
}

static void count_kept(scratch *s, int64_t j, int64_t k)
{
    for (int64_t a = 0; a < s->actives; a++) {
        const inside_part *p = s->active[a];
        const uint64_t *bits = row_words(s, p, j, k);
        for (int64_t i = 0; i < p->words; i++)
            s->count[p->volume].kept += popcount(bits[i]);
    }
}

/* One volume of level 0 alone, as most rows have it: all of it is kept. */
static int do_plain_row(scratch *s, int64_t j, int64_t k, err *e)
{
    int64_t before = s->to->runs, cells = 0;
    voxels_count *count = &s->count[s->active[0]->volume];
    if (add_runs(s, s->active[0], j, k, e))
        return -1;
    for (int64_t r = before; r < s->to->runs; r++)
        cells += s->to->run[r].to - s->to->run[r].from;
    count->inside += cells, count->reached += cells, count->kept += cells;
    return 0;
}

static int do_row(scratch *s, int64_t j, int64_t k, err *e)
{
    find_active(s, j, k);
    if (s->actives == 0)
        return 0;
    if (s->actives == 1 && s->to && s->w->level[s->active[0]->volume] == 0)
        return do_plain_row(s, j, k, e);
    climb(s, j, k);
    yield(s, j, k);
    count_kept(s, j, k);
    return s->to ? find_runs(s, j, k, e) : 0;
}

/* Whole numbers: the sums are the same in any order. */
static void add_counts(work *w, const scratch *s)
{
    for (int32_t v = 0; v < w->volumes; v++) {
        if (s->count[v].inside == 0)
            continue;
        atomic_fetch_add(&w->counter[v].inside, s->count[v].inside);
        atomic_fetch_add(&w->counter[v].reached, s->count[v].reached);
        atomic_fetch_add(&w->counter[v].kept, s->count[v].kept);
    }
}

static int do_rows(scratch *s, int64_t number, err *e)
{
    const inside *test = s->w->test;
    int32_t low[2] = {INT32_MAX, INT32_MAX}, high[2] = {INT32_MIN, INT32_MIN};
    if (inside_look(test, number, &s->slab, e))
        return -1;
    s->active = mem_array(s->slab.parts, sizeof *s->active, "volumes", e);
    if (!s->active)
        return -1;
    for (int64_t n = 0; n < s->slab.parts; n++)
        for (int a = 0; a < 2; a++) {
            const inside_box *b = &s->slab.part[n].box;
            low[a] = b->low[1 + a] < low[a] ? b->low[1 + a] : low[a];
            high[a] = b->high[1 + a] > high[a] ? b->high[1 + a] : high[a];
        }
    for (int64_t k = low[1]; k < high[1]; k++)
        for (int64_t j = low[0]; j < high[0]; j++)
            if (do_row(s, j, k, e))
                return -1;
    return 0;
}

static void do_slab(void *context, int64_t chunk_number, int64_t from, int64_t to)
{
    (void)chunk_number;
    work *w = context;
    err e = {0};
    for (int64_t number = w->first + from; number < w->first + to; number++) {
        scratch s = {.w = w, .to = w->chunk ? &w->chunk[number] : NULL};
        int64_t words = (grid_cells(w->test->mesh.g, 0) + WORD - 1) / WORD;
        s.below = mem_array(words, sizeof *s.below, "a row", &e);
        s.now = mem_array(words, sizeof *s.now, "a row", &e);
        s.count = mem_array(w->volumes, sizeof *s.count, "volumes", &e);
        if (!s.below || !s.now || !s.count || do_rows(&s, number, &e))
            atomic_store(&w->failed, true); /* nothing here fails but for want of memory */
        else
            add_counts(w, &s);
        inside_slab_free(&s.slab);
        free(s.active);
        free(s.below);
        free(s.now);
        free(s.count);
    }
}

static void run_parts(work *w, pool *threads, progress *shown)
{
    int64_t all = w->test->slabs, part = all / PARTS + 4 * (int64_t)pool_threads(threads);
    for (; w->first < all && !atomic_load(&w->failed); w->first += part) {
        int64_t left = all - w->first;
        pool_run(threads, left < part ? left : part, 1, do_slab, w);
        if (shown)
            progress_at(shown, (double)(w->first + part));
    }
}

/* ---- how many there will be */

/* The same region in at most so many cells a side: enough to refuse by. */
static grid coarse_of(const grid *g)
{
    enum { MOST = 64 };
    grid c = *g;
    for (int a = 0; a < 3; a++) {
        int64_t cells = grid_cells(g, a), kept = cells < MOST ? cells : MOST;
        if (kept == cells)
            continue;
        c.offset[a] = g->offset[a] + (double)g->low[a] * g->spacing[a];
        c.spacing[a] = g->spacing[a] * ((double)cells / (double)kept);
        c.low[a] = 0, c.high[a] = kept;
    }
    return c;
}

static int estimate(const inside *test, const int32_t *level, int32_t volumes, pool *threads, double *elements, err *e)
{
    grid g = coarse_of(test->mesh.g);
    inside coarse;
    work w = {.test = &coarse, .level = level, .volumes = volumes};
    w.counter = mem_array(volumes, sizeof *w.counter, "volumes", e);
    if (!w.counter || inside_create(&coarse, &g, &test->t, test->mesh.ray, threads, e)) {
        free(w.counter);
        return -1;
    }
    run_parts(&w, threads, NULL);
    double kept = 0;
    for (int32_t v = 0; v < volumes; v++)
        kept += (double)atomic_load(&w.counter[v].kept);
    *elements = kept * (grid_count(test->mesh.g) / grid_count(&g));
    inside_free(&coarse);
    free(w.counter);
    return atomic_load(&w.failed) ? err_memory(e, "an estimate of the elements") : 0;
}

static int check_memory(const inside *test, const int32_t *level, int32_t volumes, pool *threads, err *e)
{
    double available = (double)mem_available(), slabs = pool_threads(threads) * inside_slab_bytes(test), elements = 0;
    err whole = {0};
    if (voxels_check_memory(test->mesh.g, grid_count(test->mesh.g), slabs, available, &whole) == 0)
        return 0;
    if (estimate(test, level, volumes, threads, &elements, e))
        return -1;
    return voxels_check_memory(test->mesh.g, elements, slabs, available, e);
}

/* One list of all, in order; chunks are freed as they go. */
static int join_chunks(voxels *x, chunk *list, int64_t chunks, err *e)
{
    for (int64_t i = 0; i < chunks; i++)
        x->runs += list[i].runs;
    x->run = mem_array(x->runs, sizeof *x->run, "runs of voxels", e);
    if (!x->run)
        return -1;
    int64_t at = 0;
    for (int64_t i = 0; i < chunks; i++) {
        if (list[i].runs)
            memcpy(x->run + at, list[i].run, (size_t)list[i].runs * sizeof *x->run);
        at += list[i].runs;
        free(list[i].run);
        list[i].run = NULL;
    }
    for (int64_t i = 0; i < x->runs; i++)
        x->elements += x->run[i].to - x->run[i].from;
    return 0;
}

static void take_counts(voxels *x, const work *w)
{
    for (int32_t v = 0; v < w->volumes; v++)
        x->count[v] = (voxels_count){atomic_load(&w->counter[v].inside), atomic_load(&w->counter[v].reached),
                                     atomic_load(&w->counter[v].kept)};
}

int voxels_find(voxels *x, const inside *test, const int32_t *level, int32_t volumes, pool *threads, progress *shown,
                err *e)
{
    *x = (voxels){0};
    if (check_memory(test, level, volumes, threads, e))
        return -1;
    work w = {.test = test, .level = level, .volumes = volumes};
    int status = -1;
    w.chunk = mem_array(test->slabs, sizeof *w.chunk, "slabs", e);
    w.counter = mem_array(volumes, sizeof *w.counter, "volumes", e);
    x->count = mem_array(volumes, sizeof *x->count, "volumes", e);
    if (!w.chunk || !w.counter || !x->count)
        goto out;
    run_parts(&w, threads, shown);
    if (atomic_load(&w.failed)) {
        err_memory(e, "runs of voxels");
        goto out;
    }
    take_counts(x, &w);
    double slabs = pool_threads(threads) * inside_slab_bytes(test);
    if (join_chunks(x, w.chunk, test->slabs, e) ||
        voxels_check_memory(test->mesh.g, (double)x->elements, slabs, (double)mem_available(), e))
        goto out;
    status = 0;
out:
    for (int64_t i = 0; w.chunk && i < test->slabs; i++)
        free(w.chunk[i].run);
    free(w.chunk);
    free(w.counter);
    if (status)
        voxels_free(x);
    return status;
}

void voxels_free(voxels *x)
{
    free(x->run);
    free(x->count);
    *x = (voxels){0};
}
