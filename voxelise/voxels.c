#include "voxelise/voxels.h"

#include "base/mem.h"
#include "voxelise/depths.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 50 }; /* between which progress is shown */

/* Bytes for an element: its nodes, its place in the lattice and its volume (48), a little over one node (36), and the
 * writer's share. Bytes for a row of cells: some runs. */
static const double element_bytes = 120, row_bytes = 64;

/* What one slab gives. */
typedef struct chunk {
    climb_runs to;
    shares_list share;
    pieces_list part;
} chunk;

typedef struct counter {
    atomic_llong inside, reached, kept, mixed, divided;
} counter;

typedef struct work {
    const inside *test;
    const int32_t *level;
    int32_t volumes;
    const shares_rule *rule;
    const cuts *cut;             /* NULL: parts are not looked for */
    const voxels_strata *strata; /* or NULL */
    int64_t first;               /* slab of this part */
    chunk *chunk;                /* slabs; NULL: elements are only counted */
    counter *counter;            /* volumes, with the layers */
    atomic_bool failed;
} work;

/* One thread's, for one slab. */
typedef struct scratch {
    inside_slab slab;
    climb climb;
    shares shares;
    pieces pieces;
    climb_runs samples; /* runs of the rows of them that are in one row of voxels */
    climb_count *kept;  /* volumes, with the layers: their voxels by shares; of layers all counts */
    uint8_t *step;      /* samples of a row of voxels: a layer + 1, 0: deeper than all */
    int64_t step_capacity;
    int64_t low[2], high[2]; /* of its parts, along y and z */
} scratch;

/* ---- memory */

int voxels_check_memory(const grid *g, double elements, double more, double available, err *e)
{
    double layer = (double)(grid_cells(g, 0) + 1) * (double)(grid_cells(g, 1) + 1);
    double bytes = element_bytes * elements + row_bytes * (double)grid_cells(g, 1) * (double)grid_cells(g, 2) +
                   2 * 4 * layer + more;
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

/* ---- slabs */

/* How many volumes there are with the layers; and the number that a volume has among these. */
static int32_t volumes_of(const work *w)
{
    return w->volumes + (w->strata ? w->strata->layers : 0);
}

static int32_t moved(const work *w, int32_t volume)
{
    return w->strata && volume >= w->strata->lowest ? volume + w->strata->layers : volume;
}

/* Whole numbers: the sums are the same in any order. kept: by shares, or NULL. */
static void add_counts(work *w, const climb_count *count, climb_count *kept)
{
    for (int32_t v = 0; kept && v < w->volumes; v++) {
        climb_count *to = &kept[moved(w, v)];
        to->inside = count[v].inside, to->reached = count[v].reached;
    }
    for (int32_t v = 0; v < (kept ? volumes_of(w) : w->volumes); v++) {
        const climb_count *from = kept ? &kept[v] : &count[v];
        if (from->inside == 0)
            continue;
        atomic_fetch_add(&w->counter[v].inside, from->inside);
        atomic_fetch_add(&w->counter[v].reached, from->reached);
        atomic_fetch_add(&w->counter[v].kept, from->kept);
        atomic_fetch_add(&w->counter[v].mixed, from->mixed);
        atomic_fetch_add(&w->counter[v].divided, from->divided);
    }
}

static void find_extent(scratch *s)
{
    for (int a = 0; a < 2; a++) {
        s->low[a] = INT32_MAX, s->high[a] = INT32_MIN;
        for (int64_t n = 0; n < s->slab.parts; n++) {
            const inside_box *b = &s->slab.part[n].box;
            s->low[a] = b->low[1 + a] < s->low[a] ? b->low[1 + a] : s->low[a];
            s->high[a] = b->high[1 + a] > s->high[a] ? b->high[1 + a] : s->high[a];
        }
    }
}

static int by_centres(scratch *s, climb_runs *to, err *e)
{
    for (int64_t k = s->low[1]; k < s->high[1]; k++)
        for (int64_t j = s->low[0]; j < s->high[0]; j++)
            if (climb_row(&s->climb, &s->slab, j, k, to, e))
                return -1;
    return 0;
}

static int add_run(scratch *s, const work *w, climb_run run, err *e)
{
    return shares_add(&s->shares, &run, e) || (w->cut && pieces_add(&s->pieces, &run, e)) ? -1 : 0;
}

/* Finds the layer of each sample of level 0 in a row of voxels. low, high: the samples of the row. */
static int find_steps(scratch *s, const work *w, const int64_t low[3], const int64_t high[3], err *e)
{
    const int64_t x = high[0] - low[0], y = high[1] - low[1], cells = x * y * (high[2] - low[2]);
    if (mem_grow(&s->step, &s->step_capacity, cells, sizeof *s->step, "depths", e))
        return -1;
    memset(s->step, DEPTHS_UNWANTED, (size_t)cells);
    for (int64_t r = 0; r < s->samples.runs; r++) {
        const climb_run *run = &s->samples.run[r];
        if (run->volume < w->strata->lowest)
            memset(s->step + ((run->k - low[2]) * y + run->j - low[1]) * x + run->from - low[0], 0,
                   (size_t)(run->to - run->from));
    }
    return depths_look(w->strata->depth, low, high, s->step, e);
}

/* A run of level 0, cut where layers change. step: of its first sample. */
static int add_layered(scratch *s, const work *w, const climb_run *run, const uint8_t *step, err *e)
{
    for (int32_t from = run->from, to; from < run->to; from = to) {
        const int layer = step[from - run->from];
        climb_run part = *run;
        for (to = from; to < run->to && step[to - run->from] == layer; to++)
            ;
        part.from = from, part.to = to;
        part.volume = layer ? w->strata->lowest + layer - 1 : run->volume;
        if (layer) {
            s->kept[part.volume].inside += to - from;
            s->kept[part.volume].reached += to - from;
        }
        if (add_run(s, w, part, e))
            return -1;
    }
    return 0;
}

/* Adds the samples of a row of voxels, those of level 0 in their layers. */
static int add_strata(scratch *s, const work *w, int64_t j, int64_t k, err *e)
{
    const int64_t n = w->rule->samples;
    int64_t low[3] = {INT32_MAX, j * n, k * n}, high[3] = {INT32_MIN, (j + 1) * n, (k + 1) * n};
    for (int64_t r = 0; r < s->samples.runs; r++) {
        const climb_run *run = &s->samples.run[r];
        low[0] = run->from < low[0] ? run->from : low[0];
        high[0] = run->to > high[0] ? run->to : high[0];
    }
    if (s->samples.runs && find_steps(s, w, low, high, e))
        return -1;
    for (int64_t r = 0; r < s->samples.runs; r++) {
        climb_run run = s->samples.run[r];
        const uint8_t *step =
            s->step + ((run.k - low[2]) * n + run.j - low[1]) * (high[0] - low[0]) + run.from - low[0];
        const bool low_level = run.volume < w->strata->lowest;
        run.volume = moved(w, run.volume);
        if (low_level ? add_layered(s, w, &run, step, e) : add_run(s, w, run, e))
            return -1;
    }
    return 0;
}

/* The samples of one row of voxels. */
static int add_samples(scratch *s, const work *w, int64_t j, int64_t k, err *e)
{
    int samples = s->shares.rule.samples;
    s->samples.runs = 0;
    for (int64_t z = k * samples; z < (k + 1) * samples; z++)
        for (int64_t y = j * samples; y < (j + 1) * samples; y++)
            if (y >= s->low[0] && y < s->high[0] && z >= s->low[1] && z < s->high[1] &&
                climb_row(&s->climb, &s->slab, y, z, &s->samples, e))
                return -1;
    if (w->strata)
        return add_strata(s, w, j, k, e);
    for (int64_t r = 0; r < s->samples.runs; r++)
        if (add_run(s, w, s->samples.run[r], e))
            return -1;
    return 0;
}

static int64_t floor_of(int64_t a, int64_t b)
{
    return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/* The voxels of one row, from its samples. */
static int add_row(scratch *s, const work *w, int64_t j, int64_t k, chunk *to, err *e)
{
    const int64_t first = to->to.runs, element = to->share.count;
    if (add_samples(s, w, j, k, e) || shares_row(&s->shares, j, k, &to->to, &to->share, s->kept, e))
        return -1;
    return w->cut ? pieces_row(&s->pieces, to->to.run + first, to->to.runs - first, element, &to->part, e) : 0;
}

/* Slabs hold whole layers of voxels. */
static int by_shares(scratch *s, const work *w, chunk *to, err *e)
{
    int samples = w->rule->samples;
    if (s->slab.parts == 0)
        return 0;
    for (int64_t k = floor_of(s->low[1], samples); k * samples < s->high[1]; k++)
        for (int64_t j = floor_of(s->low[0], samples); j * samples < s->high[0]; j++)
            if (add_row(s, w, j, k, to, e))
                return -1;
    return 0;
}

static int look(scratch *s, work *w, int64_t number, err *e)
{
    if (climb_create(&s->climb, w->test, w->level, w->volumes, e) || inside_look(w->test, number, &s->slab, e))
        return -1;
    find_extent(s);
    if (!w->rule || !w->chunk)
        return by_centres(s, w->chunk ? &w->chunk[number].to : NULL, e);
    if (shares_create(&s->shares, w->test->mesh.g, w->rule, volumes_of(w), e) ||
        (w->cut && pieces_create(&s->pieces, w->test->mesh.g, w->rule->samples, w->cut, e)))
        return -1;
    s->kept = mem_array(volumes_of(w), sizeof *s->kept, "volumes", e);
    return s->kept && !by_shares(s, w, &w->chunk[number], e) ? 0 : -1;
}

static void do_slab(void *context, int64_t chunk_number, int64_t from, int64_t to)
{
    (void)chunk_number;
    work *w = context;
    err e = {0};
    for (int64_t number = w->first + from; number < w->first + to; number++) {
        scratch s = {0};
        if (look(&s, w, number, &e))
            atomic_store(&w->failed, true); /* nothing here fails but for want of memory */
        else
            add_counts(w, s.climb.count, s.kept);
        inside_slab_free(&s.slab);
        climb_free(&s.climb);
        shares_free(&s.shares);
        pieces_free(&s.pieces);
        free(s.samples.run);
        free(s.kept);
        free(s.step);
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
    if (!w.counter || inside_create(&coarse, &g, &test->t, test->mesh.ray, 1, threads, e)) {
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

/* The cells of the voxels: those of the inside test, or of samples. */
static grid voxel_cells(const work *w)
{
    grid g = *w->test->mesh.g;
    for (int a = 0; w->rule && a < 3; a++) {
        g.low[a] /= w->rule->samples;
        g.high[a] /= w->rule->samples;
    }
    return g;
}

static double slab_bytes(const work *w, const pool *threads)
{
    return pool_threads(threads) * inside_slab_bytes(w->test);
}

/* How many voxels the surfaces go through: a plane goes through a box with each of its three shadows on the box's sides
 * (the width of a cube across a plane). Where surfaces lie close, voxels are counted twice. */
static double crossed_voxels(const work *w)
{
    const grid *g = w->test->mesh.g; /* of samples */
    const inside_triangles *t = &w->test->t;
    double crossed = 0;
    for (int64_t i = 0; i < t->triangles; i++) {
        const double *p[3];
        for (int n = 0; n < 3; n++)
            p[n] = &t->position[3 * (int64_t)t->vertex[3 * i + n]];
        for (int a = 0; a < 3; a++) {
            const int u = (a + 1) % 3, v = (a + 2) % 3;
            const double shadow = (p[1][u] - p[0][u]) * (p[2][v] - p[0][v]) - (p[1][v] - p[0][v]) * (p[2][u] - p[0][u]);
            crossed += fabs(shadow) / (2 * g->spacing[u] * g->spacing[v]);
        }
    }
    return crossed / pow(w->rule->samples, 2);
}

/* What the parts of `elements` voxels take at most, with a number for each in two tables (split.h), and moments. */
static double part_bytes(const work *w, double elements)
{
    const double parts = w->cut ? pieces_bytes(w->rule->samples) + 2 * sizeof(int64_t) : 0;
    const double each = w->rule && w->rule->moments ? 3 * sizeof(moments_voxel) : 0; /* twice here, and written */
    return parts + each > 0 ? fmin(elements, crossed_voxels(w)) * (parts + each) : 0;
}

static int check_memory(const work *w, pool *threads, err *e)
{
    double available = (double)mem_available(), elements = 0;
    err whole = {0};
    grid g = voxel_cells(w);
    double more = slab_bytes(w, threads) + part_bytes(w, grid_count(&g));
    if (voxels_check_memory(&g, grid_count(&g), more, available, &whole) == 0)
        return 0;
    if (estimate(w->test, w->level, w->volumes, threads, &elements, e))
        return -1;
    elements *= grid_count(&g) / grid_count(w->test->mesh.g);
    more = slab_bytes(w, threads) + part_bytes(w, elements);
    return voxels_check_memory(&g, elements, more, available, e);
}

static int make_lists(voxels *x, const work *w, err *e)
{
    int64_t mixed = 0;
    for (int32_t v = 0; v < volumes_of(w); v++)
        mixed += x->count[v].mixed;
    x->run = mem_array(x->runs, sizeof *x->run, "runs of voxels", e);
    if (!x->run || !w->rule)
        return x->run ? 0 : -1;
    x->fraction = mem_array(x->elements, sizeof *x->fraction, "shares of voxels", e);
    if (!x->fraction || !mixed)
        return x->fraction ? 0 : -1;
    x->mix = mem_array(x->elements, sizeof *x->mix, "shares of voxels", e);
    x->mixture = mem_array(x->elements, sizeof *x->mixture, "shares of voxels", e);
    return x->mix && x->mixture ? 0 : -1;
}

/* The list of parts, as large as those of all chunks. */
static int reserve_parts(voxels *x, const work *w, err *e)
{
    int64_t cells = 0, words = 0, share = 0;
    for (int64_t i = 0; i < w->test->slabs; i++) {
        const pieces_list *l = &w->chunk[i].part;
        cells += l->cells, words += l->words, share += l->shares;
    }
    return cells ? pieces_list_reserve(&x->part, cells, words, share, e) : 0;
}

static void put_shares(voxels *x, int64_t voxel, const shares_list *list)
{
    for (int64_t i = 0; i < list->count; i++) {
        x->fraction[voxel + i] = list->voxel[i].fraction;
        if (x->mix) {
            x->mix[voxel + i] = list->voxel[i].mix;
            x->mixture[voxel + i] = list->voxel[i].mixture;
        }
    }
}

/* One list of all, in order; chunks are freed as they go. */
static int join_chunks(voxels *x, const work *w, err *e)
{
    int64_t at = 0, voxel = 0;
    x->moments = w->rule && w->rule->moments;
    for (int64_t i = 0; i < w->test->slabs; i++) {
        x->runs += w->chunk[i].to.runs;
        for (int64_t r = 0; r < w->chunk[i].to.runs; r++)
            x->elements += w->chunk[i].to.run[r].to - w->chunk[i].to.run[r].from;
    }
    if (make_lists(x, w, e) || reserve_parts(x, w, e))
        return -1;
    for (int64_t i = 0; i < w->test->slabs; i++) {
        chunk *c = &w->chunk[i];
        if (c->to.runs)
            memcpy(x->run + at, c->to.run, (size_t)c->to.runs * sizeof *x->run);
        put_shares(x, voxel, &c->share);
        if (pieces_list_join(&x->part, &c->part, voxel, e) || moments_list_join(&x->cut, &c->share.cut, voxel, e) ||
            moments_list_join(&x->border, &c->share.border, voxel, e))
            return -1;
        at += c->to.runs;
        voxel += c->share.count;
        free(c->to.run);
        shares_list_free(&c->share);
        pieces_list_free(&c->part);
        c->to.run = NULL;
    }
    return 0;
}

static void take_counts(voxels *x, const work *w)
{
    for (int32_t v = 0; v < volumes_of(w); v++)
        x->count[v] = (climb_count){atomic_load(&w->counter[v].inside), atomic_load(&w->counter[v].reached),
                                    atomic_load(&w->counter[v].kept), atomic_load(&w->counter[v].mixed),
                                    atomic_load(&w->counter[v].divided)};
}

int voxels_find(voxels *x, const inside *test, const int32_t *level, int32_t volumes, const shares_rule *rule,
                const cuts *cut, const voxels_strata *strata, pool *threads, progress *shown, err *e)
{
    *x = (voxels){0};
    work w = {.test = test, .level = level, .volumes = volumes, .rule = rule, .cut = rule ? cut : NULL};
    w.strata = rule ? strata : NULL;
    int status = -1;
    if (check_memory(&w, threads, e))
        return -1;
    w.chunk = mem_array(test->slabs, sizeof *w.chunk, "slabs", e);
    w.counter = mem_array(volumes_of(&w), sizeof *w.counter, "volumes", e);
    x->count = mem_array(volumes_of(&w), sizeof *x->count, "volumes", e);
    if (!w.chunk || !w.counter || !x->count)
        goto out;
    run_parts(&w, threads, shown);
    if (atomic_load(&w.failed)) {
        err_memory(e, "runs of voxels");
        goto out;
    }
    take_counts(x, &w);
    grid g = voxel_cells(&w);
    if (join_chunks(x, &w, e) ||
        voxels_check_memory(&g, (double)x->elements, slab_bytes(&w, threads), (double)mem_available(), e))
        goto out;
    status = 0;
out:
    for (int64_t i = 0; w.chunk && i < test->slabs; i++) {
        free(w.chunk[i].to.run);
        shares_list_free(&w.chunk[i].share);
        pieces_list_free(&w.chunk[i].part);
    }
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
    free(x->fraction);
    free(x->mix);
    free(x->mixture);
    free(x->cut.voxel);
    free(x->border.voxel);
    pieces_list_free(&x->part);
    *x = (voxels){0};
}

int voxels_find_layers(const voxels *x, voxels_layers *l, err *e)
{
    *l = (voxels_layers){.low = x->runs ? x->run[0].k : 0};
    l->count = x->runs ? x->run[x->runs - 1].k - l->low + 1 : 0;
    l->run = mem_array(l->count + 1, sizeof *l->run, "layers of cells", e);
    l->voxel = mem_array(l->count + 1, sizeof *l->voxel, "layers of cells", e);
    if (!l->run || !l->voxel) {
        voxels_layers_free(l);
        return -1;
    }
    for (int64_t r = 0, at = 0, voxel = 0; r <= x->runs; r++) {
        for (; at <= l->count && (r == x->runs || at <= x->run[r].k - l->low); at++)
            l->run[at] = r, l->voxel[at] = voxel;
        if (r < x->runs)
            voxel += x->run[r].to - x->run[r].from;
    }
    return 0;
}

void voxels_layers_free(voxels_layers *l)
{
    free(l->run);
    free(l->voxel);
    *l = (voxels_layers){0};
}
