#include "voxelise/inside.h"

#include "base/mem.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Layers in a slab: not so many that one volume's bits would leave the cache, not so few that each triangle were in
 * several slabs. */
enum { LAYERS = 16, SLAB_BITS = 1 << 22, WORD = 64, CHUNK = 4096 };

/* ---- vertices in cells */

typedef struct vertices {
    inside *test;
    double (*local)[3], (*far)[3]; /* chunks: the largest */
} vertices;

static void place_chunk(void *context, int64_t chunk, int64_t from, int64_t to)
{
    vertices *v = context;
    const grid *g = v->test->mesh.g;
    double local[3] = {0}, far[3] = {0};
    for (int64_t i = from; i < to; i++)
        for (int a = 0; a < 3; a++) {
            double x = v->test->t.position[3 * i + a];
            local[a] = fmax(local[a], fabs(grid_local(g, a, x)));
            far[a] = fmax(far[a], fabs(x - g->origin[a]));
            v->test->cell[3 * i + a] = crossing_cells(g, a, x);
        }
    memcpy(v->local[chunk], local, sizeof local);
    memcpy(v->far[chunk], far, sizeof far);
}

static void find_first(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    const vertices *v = context;
    const inside *test = v->test;
    for (int64_t i = 3 * from; i < 3 * to; i++)
        test->first[i] = crossing_of_point(&test->mesh, (int)(i % 3), test->t.position[i], test->cell[i]);
}

static int place_vertices(inside *test, pool *threads, err *e)
{
    int64_t count = test->t.vertices, chunks = pool_chunks(count, CHUNK);
    vertices v = {.test = test};
    test->cell = mem_array(3 * count, sizeof *test->cell, "vertices", e);
    test->first = mem_array(3 * count, sizeof *test->first, "vertices", e);
    v.local = mem_array(chunks, sizeof *v.local, "vertices", e);
    v.far = mem_array(chunks, sizeof *v.far, "vertices", e);
    int status = test->cell && test->first && v.local && v.far ? 0 : -1;
    if (!status) {
        test->mesh.cell = test->cell;
        test->mesh.first = test->first;
        pool_run(threads, count, CHUNK, place_chunk, &v);
        for (int a = 0; a < 3; a++) {
            double local = 0, far = 0;
            for (int64_t c = 0; c < chunks; c++) {
                local = fmax(local, v.local[c][a]);
                far = fmax(far, v.far[c][a]);
            }
            test->mesh.error[a] = crossing_error(test->mesh.g, a, local, far);
        }
        pool_run(threads, count, CHUNK, find_first, &v);
    }
    free(v.local);
    free(v.far);
    return status;
}

/* ---- triangles by slab */

/* The slabs first <= s < past that a triangle turns anything over in. */
typedef struct reach {
    int32_t first, past;
} reach;

/* A volume's box while several threads widen it. */
typedef struct shared_box {
    atomic_int low[3], high[3];
} shared_box;

typedef struct sorting {
    const inside *test;
    reach *reach;    /* triangles */
    shared_box *box; /* volumes */
} sorting;

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* The cells that a triangle may turn inside or out along each axis. */
static inside_box box_of(const inside *test, int64_t triangle)
{
    inside_box b;
    const int32_t *corner = test->t.vertex + 3 * triangle;
    const int32_t *x = &test->first[3 * (int64_t)corner[0]], *y = &test->first[3 * (int64_t)corner[1]];
    const int32_t *z = &test->first[3 * (int64_t)corner[2]];
    for (int a = 0; a < 3; a++) {
        b.low[a] = smaller(x[a], smaller(y[a], z[a]));
        b.high[a] = larger(x[a], larger(y[a], z[a]));
    }
    return b;
}

static reach reach_of(const inside *test, const inside_box *b)
{
    const crossing_mesh *m = &test->mesh;
    int64_t low = m->g->low[m->row];
    if (b->low[m->row] >= b->high[m->row] || b->low[m->column] >= b->high[m->column] ||
        b->low[m->ray] >= m->g->high[m->ray])
        return (reach){0, 0};
    return (reach){(int32_t)((b->low[m->row] - low) / test->layers),
                   (int32_t)((b->high[m->row] - 1 - low) / test->layers + 1)};
}

/* The same whatever the order in which threads come. */
static void widen_shared(shared_box *to, const inside_box *by)
{
    for (int a = 0; a < 3; a++) {
        int low = atomic_load(&to->low[a]), high = atomic_load(&to->high[a]);
        while (by->low[a] < low && !atomic_compare_exchange_weak(&to->low[a], &low, by->low[a]))
            ;
        while (by->high[a] > high && !atomic_compare_exchange_weak(&to->high[a], &high, by->high[a]))
            ;
    }
}

static void reach_chunk(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    const sorting *s = context;
    const int32_t *volume = s->test->t.volume;
    inside_box all = {{0}, {0}};
    for (int64_t t = from; t < to; t++) {
        inside_box b = box_of(s->test, t);
        s->reach[t] = reach_of(s->test, &b);
        if (t == from || volume[t] != volume[t - 1]) {
            if (t > from)
                widen_shared(&s->box[volume[t - 1]], &all);
            all = b;
        }
        for (int a = 0; a < 3; a++) {
            all.low[a] = smaller(all.low[a], b.low[a]);
            all.high[a] = larger(all.high[a], b.high[a]);
        }
    }
    widen_shared(&s->box[volume[to - 1]], &all);
}

/* Counted two places up, so that filling leaves each slab's first in its place. */
static int fill_slabs(inside *test, const reach *of, err *e)
{
    int64_t *start = test->start = mem_array(test->slabs + 2, sizeof *test->start, "triangles", e);
    if (!start)
        return -1;
    for (int64_t t = 0; t < test->t.triangles; t++)
        for (int32_t s = of[t].first; s < of[t].past; s++)
            start[s + 2]++;
    for (int64_t s = 0; s < test->slabs; s++)
        start[s + 2] += start[s + 1];
    test->triangle = mem_array(start[test->slabs + 1], sizeof *test->triangle, "triangles", e);
    if (!test->triangle)
        return -1;
    for (int64_t t = 0; t < test->t.triangles; t++)
        for (int32_t s = of[t].first; s < of[t].past; s++)
            test->triangle[start[s + 1]++] = (uint32_t)t;
    return 0;
}

static int sort_triangles(inside *test, pool *threads, err *e)
{
    sorting s = {.test = test};
    s.reach = mem_array(test->t.triangles, sizeof *s.reach, "triangles", e);
    s.box = mem_array(test->volumes, sizeof *s.box, "volumes", e);
    test->box = mem_array(test->volumes, sizeof *test->box, "volumes", e);
    int status = s.reach && s.box && test->box ? 0 : -1;
    for (int64_t i = 0; !status && i < 3 * (int64_t)test->volumes; i++) {
        atomic_init(&s.box[i / 3].low[i % 3], INT32_MAX);
        atomic_init(&s.box[i / 3].high[i % 3], INT32_MIN);
    }
    if (!status) {
        pool_run(threads, test->t.triangles, CHUNK, reach_chunk, &s);
        for (int64_t i = 0; i < 3 * (int64_t)test->volumes; i++) {
            test->box[i / 3].low[i % 3] = atomic_load(&s.box[i / 3].low[i % 3]);
            test->box[i / 3].high[i % 3] = atomic_load(&s.box[i / 3].high[i % 3]);
        }
        status = fill_slabs(test, s.reach, e);
    }
    free(s.reach);
    free(s.box);
    return status;
}

/* Slabs that may be kept a list each: a few triangles far apart may not ask for any memory. */
enum { SLABS_MOST = 1 << 22 };

int inside_create(inside *test, const grid *g, const inside_triangles *t, int ray, int multiple, pool *threads, err *e)
{
    int row = (ray + 1) % 3, column = (ray + 2) % 3;
    *test = (inside){.t = *t, .mesh = {.g = g, .position = t->position, .ray = ray, .row = row, .column = column}};
    if (t->triangles > UINT32_MAX)
        return err_set(e, NULL, 0, "%lld triangles; at most %u are possible", (long long)t->triangles, UINT32_MAX);
    double layer = (double)grid_cells(g, ray) * (double)grid_cells(g, column);
    test->layers = LAYERS;
    if (layer * LAYERS > SLAB_BITS)
        test->layers = layer <= SLAB_BITS ? (int64_t)(SLAB_BITS / layer) : 1;
    test->layers = (test->layers + multiple - 1) / multiple * multiple;
    test->slabs = pool_chunks(grid_cells(g, row), test->layers);
    if (test->slabs > SLABS_MOST)
        return err_set(e, NULL, 0, "a lattice of %lld layers of cells; expected fewer: use larger voxels, or a --box",
                       (long long)grid_cells(g, row));
    test->volumes = t->triangles ? t->volume[t->triangles - 1] + 1 : 0;
    if (!place_vertices(test, threads, e) && !sort_triangles(test, threads, e))
        return 0;
    inside_free(test);
    return -1;
}

void inside_free(inside *test)
{
    free(test->cell);
    free(test->first);
    free(test->box);
    free(test->start);
    free(test->triangle);
    *test = (inside){0};
}

/* ---- one slab */

/* One triangle drawn onto a part. */
typedef struct drawing {
    const inside *test;
    const inside_part *part;
    const int32_t *triangle;
    int32_t low, high; /* cells along the ray where it can be crossed */
    bool planned;
    crossing_plane plane;
    inside_crossing *take; /* NULL: bits are turned over */
    void *context;
} drawing;

static void flip(uint64_t *words, int64_t bit)
{
    words[bit / WORD] ^= (uint64_t)1 << (bit % WORD);
}

/* Bits from <= i < to. */
static void flip_all(uint64_t *words, int64_t from, int64_t to)
{
    int64_t first = from / WORD, last = (to - 1) / WORD;
    uint64_t begin = ~(uint64_t)0 << (from % WORD), end = ~(uint64_t)0 >> (WORD - 1 - (to - 1) % WORD);
    if (first == last) {
        words[first] ^= begin & end;
        return;
    }
    words[first] ^= begin;
    for (int64_t w = first + 1; w < last; w++)
        words[w] = ~words[w];
    words[last] ^= end;
}

/* Columns from <= i < to of a row cross the triangle. */
static void draw_columns(drawing *d, int32_t row, int32_t from, int32_t to)
{
    const crossing_mesh *m = &d->test->mesh;
    const inside_part *p = d->part;
    int32_t first = p->box.low[m->column], past = p->box.high[m->ray];
    if (!d->take && d->low >= past)
        return;
    if (!d->take && d->low == d->high) {
        flip_all(inside_words(d->test, p, row, d->low), from - first, to - first);
        return;
    }
    if (!d->planned)
        d->plane = crossing_plane_of(m, d->triangle);
    d->planned = true;
    if (d->take) {
        d->take(d->context, (d->triangle - d->test->t.vertex) / 3, &d->plane, row, from, to);
        return;
    }
    uint64_t *layer = inside_words(d->test, p, row, p->box.low[m->ray]);
    for (int32_t i = from; i < to; i++) {
        int32_t at = crossing_plane_at(&d->plane, row, i);
        if (at < past)
            flip(layer + (at - p->box.low[m->ray]) * p->words, i - first);
    }
}

/* Rows from <= i < to, between two edges. */
static void draw_rows(drawing *d, int32_t from, int32_t to, const crossing_line *one, const crossing_line *other)
{
    for (int32_t row = from; row < to; row++) {
        int32_t a = crossing_line_at(one, row), b = crossing_line_at(other, row);
        if (a < b)
            draw_columns(d, row, a, b);
        else if (b < a)
            draw_columns(d, row, b, a);
    }
}

/* The corners in order of their rows: the first to the last is an edge across all
 * rows, which the middle one divides. */
static void draw_triangle(drawing *d, int64_t triangle)
{
    const inside *test = d->test;
    const inside_part *p = d->part;
    const crossing_mesh *m = &test->mesh;
    const int32_t *t = test->t.vertex + 3 * triangle;
    int32_t v[3] = {t[0], t[1], t[2]}, row[3];
    for (int i = 0; i < 3; i++)
        row[i] = m->first[3 * (int64_t)v[i] + m->row];
    for (int i = 0; i < 3; i++) {
        int a = i == 1, b = a + 1;
        if (row[b] >= row[a])
            continue;
        int32_t swap = v[a], rows = row[a];
        v[a] = v[b], v[b] = swap;
        row[a] = row[b], row[b] = rows;
    }
    inside_box box = box_of(test, triangle);
    d->triangle = t;
    d->low = box.low[m->ray], d->high = box.high[m->ray];
    d->planned = false;
    int32_t from = larger(row[0], p->box.low[m->row]), to = smaller(row[2], p->box.high[m->row]);
    int32_t middle = smaller(larger(row[1], from), to);
    crossing_line whole = crossing_line_of(m, v[0], v[2]);
    if (from < middle) {
        crossing_line line = crossing_line_of(m, v[0], v[1]);
        draw_rows(d, from, middle, &line, &whole);
    }
    if (middle < to) {
        crossing_line line = crossing_line_of(m, v[1], v[2]);
        draw_rows(d, middle, to, &line, &whole);
    }
}

/* Each cell along the ray is as the one before, but for what was turned over. */
static void run_along(const inside *test, const inside_part *p)
{
    int ray = test->mesh.ray, row = test->mesh.row;
    for (int64_t layer = p->box.low[row]; layer < p->box.high[row]; layer++) {
        uint64_t *before = inside_words(test, p, layer, p->box.low[ray]);
        for (int64_t i = p->box.low[ray] + 1; i < p->box.high[ray]; i++) {
            uint64_t *here = before + p->words;
            for (int64_t w = 0; w < p->words; w++)
                here[w] ^= before[w];
            before = here;
        }
    }
}

/* A volume's box, cut to a slab. */
static inside_part part_of(const inside *test, int32_t volume, int64_t number)
{
    const crossing_mesh *m = &test->mesh;
    inside_part p = {.volume = volume, .box = test->box[volume]};
    int64_t grid_low = m->g->low[m->column], slab_low = m->g->low[m->row] + number * test->layers;
    int64_t slab_high = slab_low + test->layers;
    if (p.box.low[m->row] < slab_low)
        p.box.low[m->row] = (int32_t)slab_low;
    if (p.box.high[m->row] > slab_high)
        p.box.high[m->row] = (int32_t)slab_high;
    p.word = (p.box.low[m->column] - grid_low) / WORD;
    p.words = pool_chunks(p.box.high[m->column] - grid_low, WORD) - p.word;
    p.box.low[m->column] = (int32_t)(grid_low + p.word * WORD);
    return p;
}

static int64_t part_words(const inside *test, const inside_part *p)
{
    int ray = test->mesh.ray, row = test->mesh.row;
    return (int64_t)(p->box.high[row] - p->box.low[row]) * (p->box.high[ray] - p->box.low[ray]) * p->words;
}

static uint32_t slab_volume(const inside *test, int64_t i)
{
    return (uint32_t)test->t.volume[test->triangle[i]];
}

/* One part for each volume that has triangles in the slab; the bits of all are zeroed. */
static int make_parts(const inside *test, int64_t number, inside_slab *slab, err *e)
{
    int64_t from = test->start[number], to = test->start[number + 1], words = 0;
    slab->parts = 0;
    for (int64_t i = from; i < to; i++) {
        if (i > from && slab_volume(test, i) == slab_volume(test, i - 1))
            continue;
        if (mem_grow(&slab->part, &slab->part_capacity, slab->parts + 1, sizeof *slab->part, "volumes", e))
            return -1;
        inside_part *p = &slab->part[slab->parts++];
        *p = part_of(test, (int32_t)slab_volume(test, i), number);
        words += part_words(test, p);
    }
    if (mem_grow(&slab->bits, &slab->capacity, words, sizeof *slab->bits, "cells", e))
        return -1;
    if (!words)
        return 0;
    memset(slab->bits, 0, (size_t)words * sizeof *slab->bits);
    words = 0;
    for (int64_t i = 0; i < slab->parts; i++) {
        slab->part[i].bits = slab->bits + words;
        words += part_words(test, &slab->part[i]);
    }
    return 0;
}

int inside_look(const inside *test, int64_t number, inside_slab *slab, err *e)
{
    if (make_parts(test, number, slab, e))
        return -1;
    int64_t i = test->start[number];
    for (int64_t n = 0; n < slab->parts; n++) {
        const inside_part *p = &slab->part[n];
        drawing d = {.test = test, .part = p};
        for (; i < test->start[number + 1] && slab_volume(test, i) == (uint32_t)p->volume; i++)
            draw_triangle(&d, test->triangle[i]);
        run_along(test, p);
    }
    return 0;
}

void inside_cross(const inside *test, int64_t number, inside_crossing *take, void *context)
{
    inside_part part = {.volume = -1};
    drawing d = {.test = test, .part = &part, .take = take, .context = context};
    for (int64_t i = test->start[number]; i < test->start[number + 1]; i++) {
        if (slab_volume(test, i) != (uint32_t)part.volume)
            part = part_of(test, (int32_t)slab_volume(test, i), number);
        draw_triangle(&d, test->triangle[i]);
    }
}

void inside_slab_free(inside_slab *slab)
{
    free(slab->part);
    free(slab->bits);
    *slab = (inside_slab){0};
}

double inside_slab_bytes(const inside *test)
{
    double words = 0;
    for (int32_t v = 0; v < test->volumes; v++) {
        const inside_box *b = &test->box[v];
        double size = (double)test->layers / WORD;
        if (b->low[0] > b->high[0])
            continue;
        size *= (double)b->high[test->mesh.ray] - b->low[test->mesh.ray];
        words += size * ((double)b->high[test->mesh.column] - b->low[test->mesh.column] + WORD);
    }
    return sizeof(uint64_t) * words;
}
