#include "voxelise/split.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int split_create(split *s, const pieces_list *of, err *e)
{
    *s = (split){.of = of};
    s->first = mem_array(of->cells + 1, sizeof *s->first, "parts of voxels", e);
    if (!s->first)
        return -1;
    for (int64_t i = 0; i < of->cells; i++)
        s->first[i + 1] = s->first[i] + (of->cell[i].parts > 1 ? of->cell[i].parts : 0);
    s->parts = s->first[of->cells];
    s->lowest = mem_array(s->parts, sizeof *s->lowest, "parts of voxels", e);
    s->past = mem_array(s->parts, sizeof *s->past, "parts of voxels", e);
    s->order = mem_array(s->parts, sizeof *s->order, "parts of voxels", e);
    s->before = mem_array(of->cells + 1, sizeof *s->before, "parts of voxels", e);
    if (!s->lowest || !s->past || !s->order || !s->before) {
        split_free(s);
        return -1;
    }
    for (int64_t c = 0; c < of->cells; c++)
        for (int64_t i = s->first[c]; i < s->first[c + 1]; i++)
            s->lowest[i] = i, s->past[i] = s->first[c + 1];
    return 0;
}

void split_free(split *s)
{
    free(s->first);
    free(s->lowest);
    free(s->past);
    free(s->order);
    free(s->before);
    *s = (split){0};
}

int64_t split_number(const split *s, const pieces_cell *of)
{
    return s->first[of - s->of->cell];
}

bool split_are_one(const split *s, int64_t one, int64_t other)
{
    return s->lowest[one] == s->lowest[other];
}

void split_unite(split *s, int64_t one, int64_t other)
{
    const int64_t a = s->lowest[one], b = s->lowest[other], low = a < b ? a : b, high = a < b ? b : a;
    for (int64_t i = high; low != high && i < s->past[high]; i++)
        if (s->lowest[i] == high)
            s->lowest[i] = low;
}

int64_t split_largest(const split *s, const pieces_cell *of)
{
    const int64_t first = split_number(s, of);
    int64_t best = first, most = -1, count;
    const pieces_share *share = pieces_shares(s->of, of, &count);
    for (int64_t n = first; n < first + of->parts; n++) {
        int64_t samples = 0;
        for (int64_t i = 0; i < count; i++)
            samples += s->lowest[first + share[i].part] == n ? share[i].samples : 0;
        if (samples > most)
            best = n, most = samples;
    }
    return best;
}

void split_number_elements(split *s)
{
    for (int64_t c = 0; c < s->of->cells; c++) {
        int32_t count = 0;
        for (int64_t n = s->first[c]; n < s->first[c + 1]; n++)
            s->order[n] = s->lowest[n] == n ? count++ : s->order[s->lowest[n]];
        s->before[c + 1] = s->before[c] + (count ? count - 1 : 0);
    }
}

int64_t split_element(const split *s, int64_t element, int64_t part)
{
    int64_t low = 0, high = s->of->cells;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (s->of->cell[middle].element < element)
            low = middle + 1;
        else
            high = middle;
    }
    return element + s->before[low] + (part < 0 ? 0 : s->order[part]);
}

/* ---- voxels */

/* Elements of a voxel. */
static int64_t elements_of(const split *s, int64_t cell)
{
    return 1 + s->before[cell + 1] - s->before[cell];
}

/* What one element of a voxel has of a volume's samples; those of a third volume are between the first two. */
typedef struct counted {
    int64_t first, second, all; /* samples */
    int32_t volume, mix;
} counted;

static int64_t samples_of(const split *s, int64_t cell, int32_t order, int32_t volume)
{
    int64_t sum = 0, count;
    const pieces_share *share = pieces_shares(s->of, &s->of->cell[cell], &count);
    for (int64_t i = 0; i < count; i++) {
        const pieces_share *one = &share[i];
        const bool mine = order < 0 || s->order[s->first[cell] + one->part] == order;
        sum += mine && (volume < 0 || one->volume == volume) ? one->samples : 0;
    }
    return sum;
}

/* As shares.c has it for whole voxels. */
static counted count_element(const split *s, int64_t cell, int32_t order)
{
    int64_t count;
    const pieces_share *share = pieces_shares(s->of, &s->of->cell[cell], &count);
    counted c = {.all = samples_of(s, cell, order, -1), .volume = -1, .mix = -1};
    for (int second = 0; second < 2; second++)
        for (int64_t i = 0; i < count; i++) {
            const int32_t volume = share[i].volume, best = second ? c.mix : c.volume;
            const int64_t samples = samples_of(s, cell, order, volume), most = second ? c.second : c.first;
            if ((second && volume == c.volume) || samples == 0 || samples < most || (samples == most && volume >= best))
                continue;
            *(second ? &c.mix : &c.volume) = volume;
            *(second ? &c.second : &c.first) = samples;
        }
    return c;
}

static void put_element(voxels *to, int64_t at, const counted *c, int samples)
{
    to->fraction[at] = (float)((double)c->all / pow(samples, 3));
    if (!to->mix)
        return;
    to->mix[at] = c->mix;
    to->mixture[at] = c->mix < 0 ? 0 : (float)((double)c->second / (double)(c->first + c->second));
}

/* The moments of an element of a voxel, from the samples of its parts. */
static int put_moments(const split *s, int64_t cell, int32_t order, voxels *to, int64_t at, int samples, err *e)
{
    const pieces_cell *c = &s->of->cell[cell];
    const int64_t words = pieces_words(samples), n = samples;
    moments_sums sums = {0};
    for (int32_t part = 0; part < c->parts; part++) {
        const uint64_t *bits = &s->of->bits[c->bits + part * words];
        if (s->order[s->first[cell] + part] != order)
            continue;
        for (int64_t i = 0; i < n * n * n; i++)
            if (bits[i / 64] >> (i % 64) & 1)
                moments_add_sample(&sums, samples, (int)(i % n), (int)(i / n % n), (int)(i / n / n));
    }
    return moments_list_add(&to->cut, at, &sums, samples, e);
}

/* Those of a voxel that is one element; *next: the first in x's list that is not taken yet. */
static int copy_moments(moments_list *to, int64_t at, const moments_list *x, int64_t from, int64_t *next, err *e)
{
    while (*next < x->count && x->voxel[*next].element < from)
        ++*next;
    if (*next == x->count || x->voxel[*next].element != from)
        return 0;
    const moments_list one = {.voxel = &x->voxel[*next], .count = 1};
    return moments_list_join(to, &one, at - from, e);
}

static void copy_element(voxels *to, int64_t at, const voxels *x, int64_t from)
{
    to->fraction[at] = x->fraction[from];
    if (to->mix) {
        to->mix[at] = x->mix[from];
        to->mixture[at] = x->mixture[from];
    }
}

static int add_run(climb_runs *to, climb_run run, err *e)
{
    return run.from < run.to ? climb_add_run(to, run, e) : 0;
}

/* All voxels again, those of several elements repeated. */
static int repeat(const split *s, const voxels *x, voxels *to, int samples, err *e)
{
    climb_runs runs = {0};
    int64_t element = 0, at = 0, cell = 0, cut = 0, border = 0;
    int status = 0;
    for (int64_t r = 0; r < x->runs && !status; r++) {
        climb_run rest = x->run[r];
        for (int32_t i = rest.from; i < x->run[r].to && !status; i++, element++) {
            while (cell < s->of->cells && s->of->cell[cell].element < element)
                cell++;
            const bool here = cell < s->of->cells && s->of->cell[cell].element == element;
            if (!here || elements_of(s, cell) == 1) {
                copy_element(to, at, x, element);
                status = copy_moments(&to->cut, at, &x->cut, element, &cut, e) ||
                                 copy_moments(&to->border, at, &x->border, element, &border, e)
                             ? -1
                             : 0;
                at++;
                continue;
            }
            status = add_run(&runs, (climb_run){rest.from, i, rest.j, rest.k, rest.volume}, e);
            for (int32_t n = 0; n < elements_of(s, cell) && !status; n++) {
                const counted c = count_element(s, cell, n);
                put_element(to, at, &c, samples);
                status = x->moments && put_moments(s, cell, n, to, at, samples, e) ? -1 : 0;
                at++;
                status = status ? -1 : add_run(&runs, (climb_run){i, i + 1, rest.j, rest.k, c.volume}, e);
            }
            rest.from = i + 1;
        }
        status = status ? -1 : add_run(&runs, rest, e);
    }
    to->run = runs.run;
    to->runs = runs.runs;
    return status;
}

static void count_kept(voxels *x, int32_t volumes)
{
    for (int32_t v = 0; v < volumes; v++)
        x->count[v].kept = x->count[v].mixed = 0;
    for (int64_t r = 0; r < x->runs; r++)
        x->count[x->run[r].volume].kept += x->run[r].to - x->run[r].from;
    for (int64_t i = 0; x->mix && i < x->elements; i++)
        if (x->mix[i] >= 0)
            x->count[x->mix[i]].mixed++;
}

int split_voxels(const split *s, voxels *x, int samples, int32_t volumes, err *e)
{
    const int64_t more = s->before[s->of->cells];
    voxels to = {.elements = x->elements + more};
    if (!more)
        return 0;
    to.fraction = mem_array(to.elements, sizeof *to.fraction, "shares of voxels", e);
    to.mix = x->mix ? mem_array(to.elements, sizeof *to.mix, "shares of voxels", e) : NULL;
    to.mixture = x->mix ? mem_array(to.elements, sizeof *to.mixture, "shares of voxels", e) : NULL;
    if (!to.fraction || (x->mix && (!to.mix || !to.mixture)) || repeat(s, x, &to, samples, e)) {
        voxels_free(&to);
        return -1;
    }
    free(x->run);
    free(x->fraction);
    free(x->mix);
    free(x->mixture);
    free(x->cut.voxel);
    free(x->border.voxel);
    x->cut = to.cut;
    x->border = to.border;
    x->run = to.run, x->fraction = to.fraction, x->mix = to.mix, x->mixture = to.mixture;
    x->runs = to.runs, x->elements = to.elements;
    count_kept(x, volumes);
    return 0;
}
