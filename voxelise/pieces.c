#include "voxelise/pieces.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum { WORD = 64 };

/* ---- lists */

void pieces_list_free(pieces_list *l)
{
    free(l->cell);
    free(l->bits);
    free(l->share);
    *l = (pieces_list){0};
}

double pieces_bytes(int samples)
{
    return 2 * (double)(sizeof(pieces_cell) + (size_t)pieces_words(samples) * sizeof(uint64_t));
}

int pieces_list_reserve(pieces_list *l, int64_t cells, int64_t words, int64_t shares, err *e)
{
    *l = (pieces_list){.cell_capacity = cells, .bits_capacity = words, .share_capacity = shares};
    l->cell = mem_array(cells, sizeof *l->cell, "parts of voxels", e);
    l->bits = l->cell ? mem_array(words, sizeof *l->bits, "parts of voxels", e) : NULL;
    l->share = l->bits ? mem_array(shares, sizeof *l->share, "parts of voxels", e) : NULL;
    return l->share ? 0 : -1;
}

static int make_room(pieces_list *l, int64_t cells, int64_t words, int64_t shares, err *e)
{
    return mem_grow(&l->cell, &l->cell_capacity, l->cells + cells, sizeof *l->cell, "parts of voxels", e) ||
                   mem_grow(&l->bits, &l->bits_capacity, l->words + words, sizeof *l->bits, "parts of voxels", e) ||
                   mem_grow(&l->share, &l->share_capacity, l->shares + shares, sizeof *l->share, "parts of voxels", e)
               ? -1
               : 0;
}

int pieces_list_join(pieces_list *to, const pieces_list *from, int64_t element, err *e)
{
    if (!from->cells)
        return 0;
    if (make_room(to, from->cells, from->words, from->shares, e))
        return -1;
    for (int64_t i = 0; i < from->cells; i++) {
        pieces_cell *c = &to->cell[to->cells + i];
        *c = from->cell[i];
        c->element += element;
        c->bits += to->words;
    }
    memcpy(to->bits + to->words, from->bits, (size_t)from->words * sizeof *to->bits);
    for (int64_t i = 0; i < from->shares; i++) {
        to->share[to->shares + i] = from->share[i];
        to->share[to->shares + i].cell += (int32_t)to->cells;
    }
    to->cells += from->cells, to->words += from->words, to->shares += from->shares;
    return 0;
}

const pieces_cell *pieces_of(const pieces_list *l, int64_t element)
{
    int64_t low = 0, high = l->cells;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (l->cell[middle].element < element)
            low = middle + 1;
        else
            high = middle;
    }
    return low < l->cells && l->cell[low].element == element ? &l->cell[low] : NULL;
}

const pieces_share *pieces_shares(const pieces_list *l, const pieces_cell *of, int64_t *count)
{
    const int64_t cell = of - l->cell;
    int64_t low = 0, high = l->shares;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (l->share[middle].cell < cell)
            low = middle + 1;
        else
            high = middle;
    }
    *count = 0;
    while (low + *count < l->shares && l->share[low + *count].cell == cell)
        ++*count;
    return l->share + low;
}

/* ---- samples */

static int64_t rows_of(const pieces *p)
{
    return (int64_t)p->samples * p->samples;
}

int pieces_create(pieces *p, const grid *g, int samples, const cuts *cut, err *e)
{
    *p = (pieces){.samples = samples, .cut = cut, .low = g->low[0] / samples};
    p->words = pool_chunks(grid_cells(g, 0), WORD) + 1; /* one more, so that bits across two words can be read */
    p->row = mem_array(rows_of(p) * p->words, sizeof *p->row, "a row", e);
    p->in = mem_array(rows_of(p), sizeof *p->in, "a row", e);
    p->part = mem_array(rows_of(p), sizeof *p->part, "a row", e);
    for (int a = 0; a < 3; a++)
        p->closed[a] = mem_array(rows_of(p), sizeof *p->closed[a], "a row", e);
    if (p->row && p->in && p->part && p->closed[0] && p->closed[1] && p->closed[2])
        return 0;
    pieces_free(p);
    return -1;
}

void pieces_free(pieces *p)
{
    free(p->row);
    free(p->runs.run);
    free(p->in);
    free(p->part);
    for (int a = 0; a < 3; a++)
        free(p->closed[a]);
    *p = (pieces){0};
}

static int64_t within(int64_t at, int samples)
{
    return (at % samples + samples) % samples;
}

/* The row of a voxel that a run of samples is in. */
static int64_t row_of(const pieces *p, const climb_run *run)
{
    return within(run->k, p->samples) * p->samples + within(run->j, p->samples);
}

int pieces_add(pieces *p, const climb_run *run, err *e)
{
    uint64_t *row = p->row + row_of(p, run) * p->words;
    for (int64_t i = run->from - p->low * p->samples, to = run->to - p->low * p->samples; i < to;) {
        const int64_t bit = i % WORD, count = to - i < WORD - bit ? to - i : WORD - bit;
        row[i / WORD] |= (count == WORD ? ~(uint64_t)0 : ((uint64_t)1 << count) - 1) << bit;
        i += count;
    }
    return climb_add_run(&p->runs, *run, e);
}

/* A voxel's samples; whether all are inside. */
static bool take_samples(const pieces *p, int32_t cell)
{
    const int64_t at = (cell - p->low) * p->samples, bit = at % WORD;
    const uint64_t all = ((uint64_t)1 << p->samples) - 1;
    bool full = true;
    for (int64_t r = 0; r < rows_of(p); r++) {
        const uint64_t *word = p->row + r * p->words + at / WORD;
        const uint64_t bits = (word[0] >> bit | (bit ? word[1] << (WORD - bit) : 0)) & all;
        p->in[r] = (uint16_t)bits;
        full = full && bits == all;
    }
    return full;
}

/* Takes the cuts between samples of a voxel from those that begin at index i; whether there is one. */
static bool take_cuts(const pieces *p, const int32_t *cell, int64_t i)
{
    const int n = p->samples;
    bool any = false;
    for (int a = 0; a < 3; a++)
        memset(p->closed[a], 0, (size_t)rows_of(p) * sizeof *p->closed[a]);
    for (; i < p->cut->count && !cuts_order(p->cut->cut[i].cell, cell); i++) {
        const cuts_cut *c = &p->cut->cut[i];
        const int at[3] = {c->sample % n, c->sample / n % n, c->sample / n / n};
        p->closed[c->axis][c->sample / n] |= (uint16_t)(1u << at[0]);
        any = any || at[c->axis] < n - 1;
    }
    return any;
}

/* ---- parts */

/* Widens one row of a part along x, and by what its neighbours along y and z hand on. */
static bool widen_row(const pieces *p, int64_t r)
{
    const int n = p->samples;
    const int64_t y = r % n, z = r / n;
    const unsigned in = p->in[r], was = p->part[r], closed = p->closed[0][r];
    unsigned now = was;
    if (y)
        now |= p->part[r - 1] & ~(unsigned)p->closed[1][r - 1] & in;
    if (y < n - 1)
        now |= p->part[r + 1] & ~(unsigned)p->closed[1][r] & in;
    if (z)
        now |= p->part[r - n] & ~(unsigned)p->closed[2][r - n] & in;
    if (z < n - 1)
        now |= p->part[r + n] & ~(unsigned)p->closed[2][r] & in;
    for (unsigned last = 0; now && last != now;) {
        last = now;
        now |= ((now & ~closed) << 1 | (now >> 1 & ~closed)) & in;
    }
    p->part[r] = (uint16_t)now;
    return now != was;
}

/* The part of the lowest sample that is in none yet: p->part; it leaves p->in. Whether there was one. */
static bool take_part(const pieces *p, uint16_t *left)
{
    const int64_t rows = rows_of(p);
    int64_t first = 0;
    while (first < rows && !left[first])
        first++;
    if (first == rows)
        return false;
    memset(p->part, 0, (size_t)rows * sizeof *p->part);
    p->part[first] = (uint16_t)(left[first] & -left[first]);
    for (bool grows = true; grows;) {
        grows = false;
        for (int64_t r = 0; r < rows; r++)
            grows |= widen_row(p, r);
        for (int64_t r = rows - 1; r >= 0; r--)
            grows |= widen_row(p, r);
    }
    for (int64_t r = 0; r < rows; r++)
        left[r] &= (uint16_t)~p->part[r];
    return true;
}

/* How many samples of a run, in the voxel, are of a part. */
static int32_t samples_in(const pieces *p, const climb_run *run, int32_t cell, const uint64_t *part)
{
    const int64_t low = (int64_t)cell * p->samples;
    const int64_t from = run->from > low ? run->from - low : 0;
    const int64_t to = run->to < low + p->samples ? run->to - low : p->samples;
    const int64_t row = row_of(p, run) * p->samples;
    int32_t count = 0;
    for (int64_t i = row + from; i < row + to; i++)
        count += (int32_t)(part[i / WORD] >> (i % WORD) & 1);
    return count;
}

/* first: of the voxel's shares. */
static int add_share(pieces_list *to, int64_t first, const pieces_share *one, err *e)
{
    for (int64_t i = first; i < to->shares; i++)
        if (to->share[i].part == one->part && to->share[i].volume == one->volume) {
            to->share[i].samples += one->samples;
            return 0;
        }
    if (make_room(to, 0, 0, 1, e))
        return -1;
    to->share[to->shares++] = *one;
    return 0;
}

/* Of a voxel of several parts: what each has of each volume. */
static int count_volumes(const pieces *p, pieces_list *to, const pieces_cell *c, err *e)
{
    const int64_t first = to->shares, words = pieces_words(p->samples);
    for (int32_t n = 0; n < c->parts; n++)
        for (int64_t r = 0; r < p->runs.runs; r++) {
            const climb_run *run = &p->runs.run[r];
            const int32_t samples = samples_in(p, run, c->cell[0], &to->bits[c->bits + n * words]);
            if (samples && add_share(to, first, &(pieces_share){(int32_t)to->cells, n, run->volume, samples}, e))
                return -1;
        }
    return 0;
}

/* The samples of the part at hand. */
static int add_bits(const pieces *p, pieces_list *to, err *e)
{
    const int64_t words = pieces_words(p->samples);
    if (make_room(to, 0, words, 0, e))
        return -1;
    uint64_t *bits = to->bits + to->words;
    memset(bits, 0, (size_t)words * sizeof *bits);
    for (int64_t r = 0; r < rows_of(p); r++) {
        const int64_t at = r * p->samples, bit = at % WORD;
        bits[at / WORD] |= (uint64_t)p->part[r] << bit;
        if (bit && bit > WORD - p->samples) /* the rest is in the next word */
            bits[at / WORD + 1] |= (uint64_t)p->part[r] >> (WORD - bit);
    }
    to->words += words;
    return 0;
}

static int add_cell(const pieces *p, const int32_t *cell, int64_t element, pieces_list *to, err *e)
{
    const int64_t rows = rows_of(p);
    pieces_cell c = {{cell[0], cell[1], cell[2]}, 0, element, to->words};
    uint16_t left[256];
    memcpy(left, p->in, (size_t)rows * sizeof *left);
    while (take_part(p, left)) {
        if (add_bits(p, to, e))
            return -1;
        c.parts++;
    }
    if (make_room(to, 1, 0, 0, e) || (c.parts > 1 && count_volumes(p, to, &c, e)))
        return -1;
    to->cell[to->cells++] = c;
    return 0;
}

int pieces_row(pieces *p, const climb_run *run, int64_t runs, int64_t element, pieces_list *to, err *e)
{
    int status = 0;
    int64_t cut = runs ? cuts_from(p->cut, (int32_t[3]){run->from, run->j, run->k}) : 0;
    for (int64_t r = 0; r < runs; r++)
        for (int32_t i = run[r].from; i < run[r].to && !status; i++, element++) {
            const int32_t cell[3] = {i, run[r].j, run[r].k};
            while (cut < p->cut->count && cuts_order(p->cut->cut[cut].cell, cell) < 0)
                cut++;
            const bool full = take_samples(p, i), slit = take_cuts(p, cell, cut);
            if (!full || slit)
                status = add_cell(p, cell, element, to, e);
        }
    memset(p->row, 0, (size_t)(rows_of(p) * p->words) * sizeof *p->row);
    p->runs.runs = 0;
    return status;
}
