#include "voxelise/cuts.h"

#include "base/mem.h"

#include <stdatomic.h>
#include <stdlib.h>

enum { WORD = 64 };

typedef struct work {
    inside test;
    int samples;
    cuts *of; /* slabs */
    atomic_bool failed;
} work;

/* Where a line crosses a surface, of several volumes. */
typedef struct meeting {
    int32_t row, column, past; /* past: the first sample that is past it */
    double at;                 /* along the line, in samples */
    int32_t volume;
} meeting;

/* One slab's. */
typedef struct scratch {
    const work *w;
    cuts *to;
    int32_t first;        /* row */
    int64_t along, words; /* cells along the ray; words of a row of columns */
    uint64_t *crossed;    /* rows x along x words: a surface is crossed just before this sample */
    uint64_t *several;    /* rows x words: columns with a sample before which several are; NULL: one volume */
    meeting *list;        /* of those columns */
    int64_t count, capacity;
    bool *in; /* volumes */
    bool listing;
    err e;
} scratch;

static int64_t floor_of(int64_t a, int64_t b)
{
    return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/* ---- what is crossed */

static void add_cut(scratch *s, int32_t row, int32_t column, int32_t past)
{
    const crossing_mesh *m = &s->w->test.mesh;
    const int samples = s->w->samples;
    int32_t at[3], local[3];
    cuts_cut cut = {.axis = (uint8_t)m->ray};
    if (s->e.status || mem_grow(&s->to->cut, &s->to->capacity, s->to->count + 1, sizeof *s->to->cut, "slits", &s->e))
        return;
    at[m->ray] = past - 1, at[m->row] = row, at[m->column] = column;
    for (int a = 0; a < 3; a++) {
        cut.cell[a] = (int32_t)floor_of(at[a], samples);
        local[a] = at[a] - cut.cell[a] * samples;
    }
    cut.sample = (uint16_t)((local[2] * samples + local[1]) * samples + local[0]);
    s->to->cut[s->to->count++] = cut;
}

static void add_meeting(scratch *s, const meeting *m)
{
    if (!s->e.status && !mem_grow(&s->list, &s->capacity, s->count + 1, sizeof *s->list, "crossings", &s->e))
        s->list[s->count++] = *m;
}

/* Marks what is crossed, and takes note of what is crossed twice. */
static void mark(scratch *s, int32_t row, int32_t column, int32_t past)
{
    const crossing_mesh *m = &s->w->test.mesh;
    const int64_t i = column - m->g->low[m->column], along = past - m->g->low[m->ray];
    const uint64_t bit = (uint64_t)1 << (i % WORD);
    uint64_t *word = &s->crossed[((row - s->first) * s->along + along) * s->words + i / WORD];
    if (!(*word & bit))
        *word |= bit;
    else if (s->several)
        s->several[(row - s->first) * s->words + i / WORD] |= bit;
    else
        add_cut(s, row, column, past);
}

static bool is_several(const scratch *s, int32_t row, int32_t column)
{
    const int64_t i = column - s->w->test.mesh.g->low[s->w->test.mesh.column];
    return s->several[(row - s->first) * s->words + i / WORD] >> (i % WORD) & 1;
}

static void take_crossing(void *context, int64_t triangle, const crossing_plane *plane, int32_t row, int32_t from,
                          int32_t to)
{
    scratch *s = context;
    const crossing_mesh *m = &s->w->test.mesh;
    for (int32_t i = from; i < to; i++) {
        if (s->listing && !is_several(s, row, i))
            continue;
        const int32_t past = crossing_plane_at(plane, row, i);
        if (s->listing) {
            const double at =
                plane->ray + ((row - plane->row) * plane->by_row + (i - plane->column) * plane->by_column);
            add_meeting(s, &(meeting){row, i, past, crossing_within(at, (double)past - 1, past),
                                      s->w->test.t.volume[triangle]});
        } else if (past > m->g->low[m->ray] && past < m->g->high[m->ray])
            mark(s, row, i, past);
    }
}

/* ---- several volumes: where the line is in none of them */

static int by_place(const void *a, const void *b)
{
    const meeting *p = a, *q = b;
    if (p->row != q->row)
        return p->row < q->row ? -1 : 1;
    if (p->column != q->column)
        return p->column < q->column ? -1 : 1;
    if (p->at != q->at)
        return p->at < q->at ? -1 : 1;
    return (p->volume > q->volume) - (p->volume < q->volume);
}

/* Whether what lies between is a slit. */
static bool parts(const scratch *s, const meeting *leaves, const meeting *enters)
{
    const crossing_mesh *m = &s->w->test.mesh;
    if (leaves->past != enters->past || enters->past <= m->g->low[m->ray] || enters->past >= m->g->high[m->ray])
        return false;
    return leaves->volume == enters->volume || enters->at - leaves->at > CUTS_TOUCHING * s->w->samples;
}

static void walk(scratch *s, const meeting *list, int64_t count)
{
    const meeting *leaves = NULL;
    int32_t around = 0; /* volumes that the line is in */
    for (int64_t i = 0; i < count; i++) {
        const meeting *at = &list[i];
        const bool was = around > 0;
        s->in[at->volume] = !s->in[at->volume];
        around += s->in[at->volume] ? 1 : -1;
        if (was && !around)
            leaves = at;
        else if (!was && leaves && parts(s, leaves, at))
            add_cut(s, at->row, at->column, at->past);
    }
    for (int64_t i = 0; i < count; i++)
        s->in[list[i].volume] = false;
}

static void walk_all(scratch *s, int64_t number)
{
    s->listing = true;
    inside_cross(&s->w->test, number, take_crossing, s);
    if (s->count)
        qsort(s->list, (size_t)s->count, sizeof *s->list, by_place);
    for (int64_t i = 0, end = 0; !s->e.status && i < s->count; i = end) {
        while (end < s->count && s->list[end].row == s->list[i].row && s->list[end].column == s->list[i].column)
            end++;
        walk(s, s->list + i, end - i);
    }
}

/* ---- all */

static int make_scratch(scratch *s, int64_t number)
{
    const inside *test = &s->w->test;
    const crossing_mesh *m = &test->mesh;
    s->first = (int32_t)(m->g->low[m->row] + number * test->layers);
    s->along = grid_cells(m->g, m->ray);
    s->words = pool_chunks(grid_cells(m->g, m->column), WORD);
    s->crossed = mem_array(test->layers * s->along * s->words, sizeof *s->crossed, "slits", &s->e);
    if (test->volumes < 2)
        return s->crossed ? 0 : -1;
    s->several = mem_array(test->layers * s->words, sizeof *s->several, "slits", &s->e);
    s->in = mem_array(test->volumes, sizeof *s->in, "volumes", &s->e);
    return s->crossed && s->several && s->in ? 0 : -1;
}

static void do_slab(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    work *w = context;
    for (int64_t number = from; number < to; number++) {
        if (w->test.start[number] == w->test.start[number + 1])
            continue;
        scratch s = {.w = w, .to = &w->of[number]};
        if (!make_scratch(&s, number)) {
            inside_cross(&w->test, number, take_crossing, &s);
            if (s.several)
                walk_all(&s, number);
        }
        if (s.e.status)
            atomic_store(&w->failed, true); /* for want of memory */
        free(s.crossed);
        free(s.several);
        free(s.list);
        free(s.in);
    }
}

/* Adds those of all slabs, which are emptied. */
static int join_slabs(const work *w, cuts *c, err *e)
{
    int status = 0;
    for (int64_t i = 0; i < w->test.slabs; i++) {
        cuts *of = &w->of[i];
        if (!status && of->count)
            status = mem_grow(&c->cut, &c->capacity, c->count + of->count, sizeof *c->cut, "slits", e);
        for (int64_t n = 0; !status && n < of->count; n++)
            c->cut[c->count++] = of->cut[n];
        free(of->cut);
    }
    return status;
}

static int find_along(cuts *c, const inside_triangles *t, const grid *g, int samples, int axis, pool *threads, err *e)
{
    work w = {.samples = samples};
    if (inside_create(&w.test, g, t, axis, 1, threads, e))
        return -1;
    w.of = mem_array(w.test.slabs, sizeof *w.of, "slabs", e);
    int status = w.of ? 0 : -1;
    if (!status) {
        pool_run(threads, w.test.slabs, 1, do_slab, &w);
        status = join_slabs(&w, c, e);
    }
    if (!status && atomic_load(&w.failed))
        status = err_memory(e, "slits");
    free(w.of);
    inside_free(&w.test);
    return status;
}

static int compare(const void *a, const void *b)
{
    const cuts_cut *p = a, *q = b;
    const int order = cuts_order(p->cell, q->cell);
    if (order)
        return order;
    return p->axis != q->axis ? p->axis - q->axis : p->sample - q->sample;
}

/* In order, and each once: a surface may be crossed more than twice. */
static void sort(cuts *c)
{
    int64_t kept = 0;
    if (c->count)
        qsort(c->cut, (size_t)c->count, sizeof *c->cut, compare);
    for (int64_t i = 0; i < c->count; i++)
        if (!kept || compare(&c->cut[kept - 1], &c->cut[i]))
            c->cut[kept++] = c->cut[i];
    c->count = kept;
}

int cuts_find(cuts *c, const inside_triangles *t, const grid *g, int samples, pool *threads, err *e)
{
    *c = (cuts){0};
    for (int axis = 0; axis < 3; axis++)
        if (find_along(c, t, g, samples, axis, threads, e)) {
            cuts_free(c);
            return -1;
        }
    sort(c);
    return 0;
}

int64_t cuts_from(const cuts *c, const int32_t *cell)
{
    int64_t low = 0, high = c->count;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (cuts_order(c->cut[middle].cell, cell) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void cuts_free(cuts *c)
{
    free(c->cut);
    *c = (cuts){0};
}
