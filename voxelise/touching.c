#include "voxelise/touching.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum { WORD = 64 };

static int add(touching *c, const int32_t *cell, int i, int j, int k, err *e)
{
    if (mem_grow(&c->point, &c->capacity, c->count + 1, sizeof *c->point, "slits", e))
        return -1;
    int32_t *to = c->point[c->count++];
    to[0] = cell[0] + i, to[1] = cell[1] + j, to[2] = cell[2] + k;
    return 0;
}

/* The corners of a voxel; axis >= 0: of its face on the high side along it. */
static int add_corners(touching *c, const int32_t *cell, int axis, err *e)
{
    for (int n = 0; n < 8; n++)
        if ((axis < 0 || n >> axis & 1) && add(c, cell, n & 1, n >> 1 & 1, n >> 2, e))
            return -1;
    return 0;
}

/* ---- faces with cuts between voxels */

static int add_cut_faces(touching *c, const joins *j, err *e)
{
    const int n = j->samples;
    const cuts_cut *done = NULL;
    for (const cuts_cut *cut = j->cut->cut; cut < j->cut->cut + j->cut->count; cut++) {
        const int at[3] = {cut->sample % n, cut->sample / n % n, cut->sample / n / n};
        int32_t next[3] = {cut->cell[0], cut->cell[1], cut->cell[2]};
        next[cut->axis]++;
        if (at[cut->axis] != n - 1 || (done && done->axis == cut->axis && !cuts_order(done->cell, cut->cell)))
            continue;
        done = cut;
        if (joins_element(j, cut->cell) >= 0 && joins_element(j, next) >= 0 && add_corners(c, cut->cell, cut->axis, e))
            return -1;
    }
    return 0;
}

/* ---- voxels that are not all inside */

static int add_face(touching *c, joins *j, const joins_part *one, int axis, int side, err *e)
{
    joins_part other = {.at = {one->at[0], one->at[1], one->at[2]}};
    other.at[axis] += side ? 1 : -1;
    other.element = joins_element(j, other.at);
    if (other.element < 0)
        return 0;
    other.cell = pieces_of(&j->x->part, other.element);
    if ((other.cell && other.cell->parts > 1) || joins_are_joined(j, one, &other))
        return 0;
    return add_corners(c, side ? one->at : other.at, axis, e);
}

static int add_parts(touching *c, joins *j, err *e)
{
    for (int64_t i = 0; i < j->x->part.cells; i++) {
        const pieces_cell *p = &j->x->part.cell[i];
        joins_part one = {{p->cell[0], p->cell[1], p->cell[2]}, p->element, p, 0};
        if (p->parts > 1 && add_corners(c, p->cell, -1, e))
            return -1;
        for (int side = 0; side < 6 && p->parts == 1; side++)
            if (add_face(c, j, &one, side / 2, side % 2, e))
                return -1;
    }
    return 0;
}

/* ---- voxels that touch at an edge or a corner only */

/* The voxels of one layer: a bit each. */
typedef struct plane {
    int64_t low[2], rows, words; /* low: of the rectangle, along i and j */
} plane;

static plane find_plane(const voxels *x)
{
    int64_t low[2] = {INT32_MAX, INT32_MAX}, high[2] = {INT32_MIN, INT32_MIN};
    for (int64_t n = 0; n < x->runs; n++) {
        const climb_run *a = &x->run[n];
        low[0] = a->from < low[0] ? a->from : low[0];
        low[1] = a->j < low[1] ? a->j : low[1];
        high[0] = a->to > high[0] ? a->to : high[0];
        high[1] = a->j + 1 > high[1] ? a->j + 1 : high[1];
    }
    /* One row more at either end, and one voxel more along i. */
    plane p = {{low[0], low[1] - 1}, high[1] - low[1] + 2, pool_chunks(high[0] - low[0] + 1, WORD)};
    return p;
}

static void mark_layer(const plane *p, const joins *j, int64_t layer, uint64_t *bits)
{
    memset(bits, 0, (size_t)(p->rows * p->words) * sizeof *bits);
    if (layer < 0 || layer >= j->layer.count)
        return;
    for (int64_t n = j->layer.run[layer]; n < j->layer.run[layer + 1]; n++) {
        const climb_run *a = &j->x->run[n];
        uint64_t *row = bits + (a->j - p->low[1]) * p->words;
        for (int64_t i = a->from - p->low[0], to = a->to - p->low[0]; i < to;) {
            const int64_t bit = i % WORD, count = to - i < WORD - bit ? to - i : WORD - bit;
            row[i / WORD] |= (count == WORD ? ~(uint64_t)0 : ((uint64_t)1 << count) - 1) << bit;
            i += count;
        }
    }
}

/* Whether voxels of 8 about a point (bit: i + 2 j + 4 k) do not all hang together by faces. */
static bool touches(unsigned cells)
{
    unsigned part = cells & -cells;
    for (unsigned last = 0; last != part;) {
        last = part;
        part |= ((part & 0x55) << 1 | (part & 0xaa) >> 1 | (part & 0x33) << 2 | (part & 0xcc) >> 2 |
                 (part & 0x0f) << 4 | (part & 0xf0) >> 4) &
                cells;
    }
    return part != cells;
}

/* The points of one word of a row of points: row r of voxels follows them. */
static int add_word(touching *c, const plane *p, uint64_t *const *layer, int64_t row, int64_t word, int64_t k,
                    const bool *apart, err *e)
{
    uint64_t cell[8], any = 0, all = ~(uint64_t)0;
    for (int n = 0; n < 4; n++) {
        const uint64_t *bits = layer[n >> 1] + (row - 1 + (n & 1)) * p->words + word;
        cell[2 * n + 1] = bits[0];
        cell[2 * n] = bits[0] << 1 | (word ? bits[-1] >> (WORD - 1) : 0);
    }
    for (int n = 0; n < 8; n++)
        any |= cell[n], all &= cell[n];
    for (uint64_t mixed = any & ~all; mixed; mixed &= mixed - 1) {
        const int bit = __builtin_ctzll(mixed);
        unsigned cells = 0;
        for (int n = 0; n < 8; n++)
            cells |= (unsigned)(cell[n] >> bit & 1) << n;
        const int32_t at[3] = {(int32_t)(p->low[0] + word * WORD + bit), (int32_t)(p->low[1] + row), (int32_t)k};
        if (apart[cells] && add(c, at, 0, 0, 0, e))
            return -1;
    }
    return 0;
}

static int add_touching(touching *c, const joins *j, err *e)
{
    const plane p = find_plane(j->x);
    bool apart[256];
    for (unsigned n = 0; n < 256; n++)
        apart[n] = touches(n);
    uint64_t *layer[2] = {mem_array(p.rows * p.words, sizeof(uint64_t), "a layer of voxels", e), NULL};
    layer[1] = layer[0] ? mem_array(p.rows * p.words, sizeof(uint64_t), "a layer of voxels", e) : NULL;
    int status = layer[1] ? 0 : -1;
    for (int64_t k = 0; !status && k <= j->layer.count; k++) {
        uint64_t *swap = layer[0];
        layer[0] = layer[1], layer[1] = swap;
        mark_layer(&p, j, k, layer[1]);
        for (int64_t row = 1; !status && row < p.rows; row++)
            for (int64_t word = 0; !status && word < p.words; word++)
                status = add_word(c, &p, layer, row, word, j->layer.low + k, apart, e);
    }
    free(layer[0]);
    free(layer[1]);
    return status;
}

/* ---- all */

static int by_place(const void *a, const void *b)
{
    return cuts_order(a, b);
}

int touching_find(touching *c, joins *j, err *e)
{
    *c = (touching){0};
    if (add_cut_faces(c, j, e) || add_parts(c, j, e) || add_touching(c, j, e)) {
        touching_free(c);
        return -1;
    }
    int64_t kept = 0;
    if (c->count)
        qsort(c->point, (size_t)c->count, sizeof *c->point, by_place);
    for (int64_t i = 0; i < c->count; i++)
        if (!kept || cuts_order(c->point[kept - 1], c->point[i]))
            memmove(c->point[kept++], c->point[i], sizeof *c->point);
    c->count = kept;
    return 0;
}

void touching_free(touching *c)
{
    free(c->point);
    *c = (touching){0};
}
