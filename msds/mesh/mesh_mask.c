#include "msds/mesh/mesh_mask.h"

#include "base/mem.h"
#include "base/num.h"
#include "msds/mesh/mesh_runs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD = 400, HALF_MOST = 19 /* voxels: (2 x 19 + 1)^3 can be counted in 16 bits */ };

/* ---- words */

typedef enum kind { ABOVE, TISSUE, AIR, SECTOR, KINDS } kind;

static const char *const heads[KINDS] = {"above:", "tissue:", "air:", "sector"};

typedef struct word {
    kind kind;
    char text[WORD]; /* after the colon */
    double level;
} word;

static int unknown(const char *text, err *e)
{
    return err_usage(e, "--mask: '%s'; expected above:LEVEL, tissue:LABEL, air:LABEL or sector, between commas", text);
}

/* The next word of the list, which moves past it and becomes NULL at the end. */
static int take_word(const char **list, word *to, err *e)
{
    char text[WORD];
    const size_t length = strcspn(*list, ",");
    snprintf(text, sizeof text, "%.*s", length < WORD ? (int)length : WORD - 1, *list);
    *list = (*list)[length] ? *list + length + 1 : NULL;
    for (int k = 0; k < KINDS; k++) {
        const size_t head = strlen(heads[k]);
        if (length >= WORD || strncmp(text, heads[k], head) || !text[head] != (k == SECTOR))
            continue;
        to->kind = (kind)k;
        snprintf(to->text, sizeof to->text, "%s", text + head);
        if (k == ABOVE && (num_double(to->text, &to->level) || !isfinite(to->level)))
            return unknown(text, e);
        return 0;
    }
    return unknown(text, e);
}

int mesh_mask_words(const char *list, bool *labels, err *e)
{
    word w;
    int levels = 0;
    *labels = false;
    while (list) {
        if (take_word(&list, &w, e))
            return -1;
        levels += w.kind == ABOVE;
        *labels |= w.kind == TISSUE || w.kind == AIR;
    }
    if (levels > 1)
        return err_usage(e, "--mask: above: stands twice; expected one level");
    return 0;
}

/* ---- what is above a level */

static int64_t count_of(const int64_t size[3])
{
    return size[0] * size[1] * size[2];
}

/* Sums over 2 half + 1 neighbours of a line, fewer at its ends; copy: of the line. */
static void sum_line(uint16_t *line, int64_t apart, int64_t count, int64_t half, uint16_t *copy)
{
    uint32_t sum = 0;
    for (int64_t i = 0; i < count; i++)
        copy[i] = line[i * apart];
    for (int64_t i = 0; i < half && i < count; i++)
        sum += copy[i];
    for (int64_t i = 0; i < count; i++) {
        sum += i + half < count ? copy[i + half] : 0;
        sum -= i > half ? copy[i - half - 1] : 0;
        line[i * apart] = (uint16_t)sum;
    }
}

static void sum_lines(uint16_t *sum, const int64_t size[3], const int64_t half[3], uint16_t *line)
{
    const int64_t apart[3] = {1, size[0], size[0] * size[1]};
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        for (int64_t j = 0; half[a] && j < size[c]; j++)
            for (int64_t i = 0; i < size[b]; i++)
                sum_line(sum + i * apart[b] + j * apart[c], apart[a], size[a], half[a], line);
    }
}

/* How many voxels of a line are within half of one. */
static int64_t near_count(int64_t at, int64_t size, int64_t half)
{
    const int64_t low = num_clamp_int(at - half, 0, size - 1), high = num_clamp_int(at + half, 0, size - 1);
    return high - low + 1;
}

static void take_half(uint8_t *mask, const uint16_t *sum, const int64_t size[3], const int64_t half[3])
{
    for (int64_t k = 0; k < size[2]; k++)
        for (int64_t j = 0; j < size[1]; j++) {
            const int64_t rows = near_count(k, size[2], half[2]) * near_count(j, size[1], half[1]);
            for (int64_t i = 0; i < size[0]; i++)
                *mask++ = 2 * (int64_t)*sum++ >= rows * near_count(i, size[0], half[0]);
        }
}

/* Whether at least half of what is around is: speckle goes. */
static int smooth(uint8_t *mask, const int64_t size[3], const double cell[3], err *e)
{
    int64_t half[3], longest = 0;
    for (int a = 0; a < 3; a++) {
        half[a] = (int64_t)fmin(cell[a] / 2, HALF_MOST);
        longest = size[a] > longest ? size[a] : longest;
    }
    uint16_t *sum = mem_array(count_of(size), sizeof *sum, "a mask", e);
    uint16_t *line = sum ? mem_array(longest, sizeof *line, "a mask", e) : NULL;
    for (int64_t i = 0; line && i < count_of(size); i++)
        sum[i] = mask[i];
    if (line) {
        sum_lines(sum, size, half, line);
        take_half(mask, sum, size, half);
    }
    free(sum);
    free(line);
    return line ? 0 : -1;
}

/* Columns along the top's axis: how many voxels, seen from the top, and where they are. */
typedef struct columns {
    int64_t along, apart[2], count[2], begin, step;
} columns;

static columns columns_of(const int64_t size[3], int top)
{
    const int64_t apart[3] = {1, size[0], size[0] * size[1]};
    const int axis = top / 2, u = axis == 0, v = axis == 2 ? 1 : 2;
    columns c = {.along = size[axis], .apart = {apart[u], apart[v]}, .count = {size[u], size[v]}};
    c.step = top % 2 ? -apart[axis] : apart[axis];
    c.begin = top % 2 ? apart[axis] * (size[axis] - 1) : 0;
    return c;
}

static int64_t first_tissue(const uint8_t *mask, const columns *c, int64_t u, int64_t v)
{
    const uint8_t *at = mask + c->begin + u * c->apart[0] + v * c->apart[1];
    int64_t n = 0;
    while (n < c->along && !at[n * c->step])
        n++;
    return n;
}

static void fill_below(uint8_t *mask, const int64_t size[3], int top)
{
    const columns c = columns_of(size, top);
    for (int64_t v = 0; v < c.count[1]; v++)
        for (int64_t u = 0; u < c.count[0]; u++) {
            uint8_t *at = mask + c.begin + u * c.apart[0] + v * c.apart[1];
            for (int64_t n = first_tissue(mask, &c, u, v); n < c.along; n++)
                at[n * c.step] = 1;
        }
}

static int take_above(uint8_t *mask, const volume *like, double level, int top, const double cell[3], err *e)
{
    for (int64_t i = 0; i < volume_count(like); i++)
        mask[i] = volume_value(like, i) > level;
    if (smooth(mask, like->size, cell, e) || mesh_runs_largest(mask, like->size, e))
        return -1;
    fill_below(mask, like->size, top);
    return 0;
}

static int take_sector(uint8_t *mask, const volume *like, err *e)
{
    for (int64_t i = 0; i < volume_count(like); i++) {
        const double value = volume_value(like, i);
        mask[i] = (uint8_t)(value < 0 || value > 0);
    }
    return mesh_runs_fill(mask, like->size, e) || mesh_runs_largest(mask, like->size, e) ? -1 : 0;
}

int mesh_mask_grey(mesh_mask *m, const char *list, const volume *like, int top, const double cell[3], err *e)
{
    const int64_t count = volume_count(like);
    word w;
    m->place = *like;
    m->place.data = NULL;
    m->place.label = NULL;
    m->place.labels = 0;
    m->top = top;
    m->tissue = mem_array(count, 1, "a mask", e);
    uint8_t *one = m->tissue ? mem_array(count, 1, "a mask", e) : NULL;
    int status = one ? 0 : -1;
    if (one)
        memset(m->tissue, 1, (size_t)count);
    while (!status && list) {
        status = take_word(&list, &w, e);
        if (status || (w.kind != ABOVE && w.kind != SECTOR))
            continue;
        status = w.kind == ABOVE ? take_above(one, like, w.level, top, cell, e) : take_sector(one, like, e);
        for (int64_t i = 0; !status && i < count; i++)
            m->tissue[i] &= one[i];
    }
    free(one);
    return status;
}

/* ---- what has a label */

bool mesh_mask_leaves(const void *m, int64_t label)
{
    const mesh_mask *mask = m;
    return (mask->only.count && !mesh_chosen_has(&mask->only, label)) || mesh_chosen_has(&mask->air, label);
}

static int choose_all(mesh_mask *m, const char *list, const volume *labels, err *e)
{
    word w;
    while (list) {
        if (take_word(&list, &w, e))
            return -1;
        if (w.kind != TISSUE && w.kind != AIR)
            continue;
        mesh_chosen *to = w.kind == TISSUE ? &m->only : &m->air;
        if (mesh_chosen_add(to, labels, "--mask", w.text, e))
            return -1;
    }
    return 0;
}

/* Voxels whose centres have the labels. */
static int take_labels(mesh_mask *m, const volume *labels, const char *where, err *e)
{
    const volume_finder f = volume_finder_of(labels);
    const int64_t *size = m->place.size;
    int64_t label;
    uint8_t *to = m->tissue;
    for (int64_t k = 0; k < size[2]; k++)
        for (int64_t j = 0; j < size[1]; j++)
            for (int64_t i = 0; i < size[0]; i++, to++) {
                const double voxel[3] = {(double)i, (double)j, (double)k};
                double at[3];
                volume_place(&m->place, voxel, at);
                if (mesh_chosen_read(labels, volume_nearest(labels, &f, at), where, &label, e))
                    return -1;
                *to &= !mesh_mask_leaves(m, label);
            }
    return 0;
}

static int find_skin(mesh_mask *m, err *e)
{
    const columns c = columns_of(m->place.size, m->top);
    bool any = false;
    m->skin = mem_array(c.count[0] * c.count[1], sizeof *m->skin, "a mask", e);
    for (int64_t v = 0; m->skin && v < c.count[1]; v++)
        for (int64_t u = 0; u < c.count[0]; u++) {
            const int64_t n = first_tissue(m->tissue, &c, u, v);
            m->skin[v * c.count[0] + u] = (int32_t)n;
            any |= n < c.along;
        }
    if (m->skin && !any)
        return err_set(e, NULL, 0, "--mask: no voxel is tissue; expected a lower level, or other labels");
    return m->skin ? 0 : -1;
}

int mesh_mask_labels(mesh_mask *m, const char *list, const volume *labels, const char *where, err *e)
{
    if (labels && (choose_all(m, list, labels, e) || take_labels(m, labels, where, e)))
        return -1;
    return find_skin(m, e);
}

void mesh_mask_free(mesh_mask *m)
{
    free(m->tissue);
    free(m->skin);
    *m = (mesh_mask){0};
}

/* ---- what cells and nodes ask */

/* The voxels whose centres lie from one place of a box to another; at least the one at the middle. */
static void voxels_between(int64_t size, int32_t from, int32_t to, int32_t units, int64_t range[2])
{
    const double scale = (double)size / units;
    range[0] = (int64_t)ceil(from * scale - .5);
    range[1] = (int64_t)ceil(to * scale - .5);
    if (range[0] < range[1])
        return;
    range[0] = (int64_t)fmin(floor((from + to) * scale / 2), (double)(size - 1));
    range[1] = range[0] + 1;
}

double mesh_mask_share(const mesh_mask *m, const mesh_cells *c, const mesh_cell *of)
{
    const int64_t *size = m->place.size;
    int64_t range[3][2], sum = 0;
    for (int a = 0; a < 3; a++)
        voxels_between(size[a], of->at[a], of->at[a] + of->side, c->size[a], range[a]);
    for (int64_t k = range[2][0]; k < range[2][1]; k++)
        for (int64_t j = range[1][0]; j < range[1][1]; j++)
            for (int64_t i = range[0][0]; i < range[0][1]; i++)
                sum += m->tissue[(k * size[1] + j) * size[0] + i];
    return (double)sum / ((double)(range[0][1] - range[0][0]) * (double)(range[1][1] - range[1][0]) *
                          (double)(range[2][1] - range[2][0]));
}

mesh_span mesh_mask_skin(const mesh_mask *m, const mesh_cells *c, const mesh_cell *of)
{
    const columns x = columns_of(m->place.size, m->top);
    const int axis = m->top / 2, u = axis == 0, v = axis == 2 ? 1 : 2;
    int64_t i[2], j[2];
    mesh_span span = {INT64_MAX, -1};
    voxels_between(x.count[0], of->at[u], of->at[u] + of->side, c->size[u], i);
    voxels_between(x.count[1], of->at[v], of->at[v] + of->side, c->size[v], j);
    for (int64_t l = j[0]; l < j[1]; l++)
        for (int64_t k = i[0]; k < i[1]; k++) {
            const int64_t n = m->skin[l * x.count[0] + k];
            if (n == x.along)
                continue;
            span.low = n < span.low ? n : span.low;
            span.high = n > span.high ? n : span.high;
        }
    return span;
}

double mesh_mask_at(const mesh_mask *m, const double voxel[3])
{
    const int64_t *size = m->place.size;
    int64_t low[3], high[3];
    double share[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        const double at = fmin(fmax(voxel[a], 0), (double)(size[a] - 1));
        low[a] = (int64_t)at;
        high[a] = low[a] + 1 < size[a] ? low[a] + 1 : low[a];
        share[a] = at - (double)low[a];
    }
    for (int v = 0; v < 8; v++) {
        double part = 1;
        int64_t at = 0;
        for (int a = 2; a >= 0; a--) {
            const bool up = v >> a & 1;
            part *= up ? share[a] : 1 - share[a];
            at = at * size[a] + (up ? high[a] : low[a]);
        }
        sum += part * m->tissue[at];
    }
    return sum;
}
