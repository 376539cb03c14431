#include "voxelise/voxels.h"

#include "base/mem.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 64, PARTS = 100 }; /* columns that one thread takes at a time; parts between which progress is shown */

/* What an element needs: its nodes, lattice place and volume (48 bytes), a little over one node (36 bytes), and room for
 * the writer. A column: its chunk's share and some runs. */
static const double element_bytes = 120, column_bytes = 64;

typedef struct chunk {
    voxels_run *run;
    int64_t runs, capacity;
} chunk;

typedef struct counter {
    atomic_llong inside, reached, kept;
} counter;

typedef struct work {
    const columns *c;
    const int32_t *level;
    int32_t volumes;
    int64_t first; /* column of this part */
    chunk *chunk;  /* of all parts */
    counter *counter;
    atomic_bool failed;
} work;

/* One thread's, for one chunk. */
typedef struct scratch {
    columns_scratch look;
    int32_t *owner;      /* cells of a column: the volume that has it, -1 = none */
    voxels_count *count; /* volumes */
} scratch;

/* ---- memory */

int voxels_check_memory(const grid *g, double elements, int threads, double available, err *e)
{
    double layer = (double)(grid_cells(g, 0) + 1) * (double)(grid_cells(g, 1) + 1);
    double bytes = element_bytes * elements + column_bytes * (double)grid_cells(g, 1) * (double)grid_cells(g, 2) +
                   2 * 4 * layer + 4.0 * threads * (double)grid_cells(g, 0);
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

/* Cells of a column inside any volume of level 0: the elements that it will have. Spans come by volume. */
static int64_t column_elements(const columns_scratch *s, const int32_t *level, int64_t low)
{
    int64_t total = 0, done = low;
    for (;;) {
        /* The span that reaches furthest among those that begin at or before `done`, else the next to begin. */
        int64_t from = INT64_MAX, to = done;
        for (int64_t i = 0; i < s->spans; i++) {
            const columns_span *a = &s->span[i];
            if (level[a->volume] != 0 || a->to <= done)
                continue;
            int64_t begin = a->from > done ? a->from : done;
            if (begin < from)
                from = begin, to = a->to;
        }
        if (from == INT64_MAX)
            return total;
        total += to - from;
        done = to;
    }
}

/* The share of cells that will be elements, from columns evenly picked: enough to refuse by. */
static int estimate(const columns *c, const int32_t *level, double *elements, err *e)
{
    enum { PICKS = 48 };
    const grid *g = c->g;
    columns_scratch s = {0};
    int64_t total = 0;
    int status = 0;
    for (int n = 0; !status && n < PICKS * PICKS; n++) {
        int64_t j = g->low[1] + grid_cells(g, 1) * (2 * (n % PICKS) + 1) / (2 * PICKS);
        int64_t k = g->low[2] + grid_cells(g, 2) * (2 * (n / PICKS) + 1) / (2 * PICKS);
        status = columns_look(c, 0, j, k, &s, e);
        if (!status)
            total += column_elements(&s, level, g->low[0]);
    }
    columns_scratch_free(&s);
    *elements = (double)total / (PICKS * PICKS) * (double)grid_cells(g, 1) * (double)grid_cells(g, 2);
    return status;
}

static int check_memory(const columns *c, const int32_t *level, int threads, err *e)
{
    double available = (double)mem_available(), elements = 0;
    err whole = {0};
    if (voxels_check_memory(c->g, grid_count(c->g), threads, available, &whole) == 0)
        return 0;
    if (estimate(c, level, &elements, e))
        return -1;
    return voxels_check_memory(c->g, elements, threads, available, e);
}

/* ---- Algorithm 1 */

/* Lines 7 to 9 for one span of one volume: it takes what is at the level below, and what is not is left. */
static void climb(const work *w, const columns_span *a, scratch *s)
{
    int32_t *owner = s->owner;
    int32_t level = w->level[a->volume];
    int64_t reached = 0, low = w->c->g->low[0];
    for (int64_t i = a->from - low; i < a->to - low; i++) {
        int32_t has = owner[i] < 0 ? -1 : w->level[owner[i]];
        reached += has >= level - 1;
        if (has == level - 1)
            owner[i] = a->volume;
    }
    s->count[a->volume].inside += a->to - a->from;
    s->count[a->volume].reached += reached;
}

static int add_run(chunk *to, voxels_run run, err *e)
{
    if (mem_grow(&to->run, &to->capacity, to->runs + 1, sizeof *to->run, "runs of voxels", e))
        return -1;
    to->run[to->runs++] = run;
    return 0;
}

static int column_runs(const work *w, int64_t j, int64_t k, scratch *s, chunk *to, err *e)
{
    int64_t low = w->c->g->low[0], cells = grid_cells(w->c->g, 0);
    for (int64_t from = 0, end; from < cells; from = end) {
        int32_t volume = s->owner[from];
        for (end = from + 1; end < cells && s->owner[end] == volume;)
            end++;
        if (volume < 0)
            continue;
        s->count[volume].kept += end - from;
        voxels_run run = {(int32_t)(low + from), (int32_t)(low + end), (int32_t)j, (int32_t)k, volume};
        if (add_run(to, run, e))
            return -1;
    }
    return 0;
}

static int do_column(const work *w, int64_t column, scratch *s, chunk *to, err *e)
{
    const grid *g = w->c->g;
    int64_t j = g->low[1] + column % grid_cells(g, 1), k = g->low[2] + column / grid_cells(g, 1);
    if (columns_look(w->c, 0, j, k, &s->look, e))
        return -1;
    if (s->look.spans == 0)
        return 0;
    memset(s->owner, -1, (size_t)grid_cells(g, 0) * sizeof *s->owner);
    for (int64_t i = 0; i < s->look.spans; i++)
        climb(w, &s->look.span[i], s);
    return column_runs(w, j, k, s, to, e);
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

static void do_chunk(void *context, int64_t number, int64_t from, int64_t to)
{
    work *w = context;
    scratch s = {0};
    err e = {0};
    chunk *mine = &w->chunk[w->first / CHUNK + number];
    s.owner = mem_array(grid_cells(w->c->g, 0), sizeof *s.owner, "a column", &e);
    s.count = mem_array(w->volumes, sizeof *s.count, "volumes", &e);
    int status = s.owner && s.count ? 0 : -1;
    for (int64_t column = w->first + from; !status && column < w->first + to; column++)
        status = do_column(w, column, &s, mine, &e);
    if (status)
        atomic_store(&w->failed, true); /* nothing here fails but for want of memory */
    else
        add_counts(w, &s);
    columns_scratch_free(&s.look);
    free(s.owner);
    free(s.count);
}

static void run_parts(work *w, pool *threads, progress *shown)
{
    int64_t all = voxels_columns(w->c->g), part = all / (PARTS * CHUNK) * CHUNK + CHUNK;
    for (; w->first < all && !atomic_load(&w->failed); w->first += part) {
        int64_t left = all - w->first;
        pool_run(threads, left < part ? left : part, CHUNK, do_chunk, w);
        if (shown)
            progress_at(shown, (double)(w->first + part));
    }
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

int voxels_find(voxels *x, const columns *c, const int32_t *level, int32_t volumes, pool *threads, progress *shown,
                err *e)
{
    *x = (voxels){0};
    if (check_memory(c, level, pool_threads(threads), e))
        return -1;
    int64_t chunks = pool_chunks(voxels_columns(c->g), CHUNK);
    work w = {.c = c, .level = level, .volumes = volumes};
    int status = -1;
    w.chunk = mem_array(chunks, sizeof *w.chunk, "columns", e);
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
    if (join_chunks(x, w.chunk, chunks, e) ||
        voxels_check_memory(c->g, (double)x->elements, pool_threads(threads), (double)mem_available(), e))
        goto out;
    status = 0;
out:
    for (int64_t i = 0; w.chunk && i < chunks; i++)
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
