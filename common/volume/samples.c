#include "volume/samples.h"

#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

samples_box samples_whole(const volume *v)
{
    return (samples_box){.high = {v->size[0], v->size[1], v->size[2]}};
}

int64_t samples_count(const samples_box *b)
{
    return (b->high[0] - b->low[0]) * (b->high[1] - b->low[1]) * (b->high[2] - b->low[2]);
}

samples_box samples_wider(const volume *v, const samples_box *b, const int64_t by[3])
{
    samples_box wider = *b;
    for (int a = 0; a < 3; a++) {
        wider.low[a] = b->low[a] > by[a] ? b->low[a] - by[a] : 0;
        wider.high[a] = b->high[a] < v->size[a] - by[a] ? b->high[a] + by[a] : v->size[a];
    }
    return wider;
}

/* Runs `line(from, count, to)` over the rows of a box, with the row's first voxel as `from`. */
#define EACH_ROW(v, b, of, body)                                                                                       \
    do {                                                                                                               \
        int64_t count = (b)->high[0] - (b)->low[0];                                                                    \
        for (int64_t z = (b)->low[2]; z < (b)->high[2]; z++)                                                           \
            for (int64_t y = (b)->low[1]; y < (b)->high[1]; y++) {                                                     \
                const of *from = (const of *)(v)->data + (z * (v)->size[1] + y) * (v)->size[0] + (b)->low[0];          \
                body;                                                                                                  \
            }                                                                                                          \
    } while (0)

void samples_take(const volume *v, const samples_box *b, float *to)
{
    switch (v->type) {
#define TAKE(name, of, nrrd, meta, low_, high_)                                                                        \
    case VOLUME_##name:                                                                                                \
        EACH_ROW(v, b, of, for (int64_t i = 0; i < count; i++) to[i] = (float)from[i]; to += count);                   \
        break;
        VOLUME_TYPES(TAKE)
    default:
        break;
    }
}

void samples_mark(const volume *v, const samples_box *b, int64_t value, float *to)
{
    switch (v->type) {
#define MARK(name, of, nrrd, meta, low_, high_)                                                                        \
    case VOLUME_##name:                                                                                                \
        EACH_ROW(v, b, of, for (int64_t i = 0; i < count; i++) to[i] = from[i] == (of)value; to += count);             \
        break;
        VOLUME_TYPES(MARK)
    default:
        break;
    }
}

/* ---- labels */

typedef struct found {
    samples_label *one;
    int64_t count, capacity;
} found;

static int64_t place_of(const found *f, int64_t value)
{
    int64_t low = 0, high = f->count;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (f->one[middle].value < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* A run of voxels of one value, not 0. */
static int add_run(found *f, int64_t value, const int64_t at[3], int64_t length, err *e)
{
    int64_t i = place_of(f, value);
    if (i == f->count || f->one[i].value != value) {
        if (f->count == SAMPLES_LABELS)
            return err_set(e, NULL, 0, "more than %d values; expected a label image", SAMPLES_LABELS);
        if (MEM_ROOM(&f->one, &f->capacity, f->count + 1, "labels", e))
            return -1;
        memmove(f->one + i + 1, f->one + i, (size_t)(f->count++ - i) * sizeof *f->one);
        f->one[i] = (samples_label){.value = value, .box = {{at[0], at[1], at[2]}, {at[0], at[1], at[2]}}};
    }
    samples_label *l = &f->one[i];
    l->count += length;
    for (int a = 0; a < 3; a++) {
        int64_t end = at[a] + (a ? 1 : length);
        l->box.low[a] = at[a] < l->box.low[a] ? at[a] : l->box.low[a];
        l->box.high[a] = end > l->box.high[a] ? end : l->box.high[a];
    }
    return 0;
}

#define FIND(name, of, nrrd, meta, low_, high_)                                                                        \
    static int find_##name(const volume *v, const samples_box *b, found *f, err *e)                                    \
    {                                                                                                                  \
        EACH_ROW(                                                                                                      \
            v, b, of, for (int64_t i = 0, end; i < count; i = end) {                                                   \
                for (end = i + 1; end < count && from[end] == from[i]; end++)                                          \
                    ;                                                                                                  \
                if (from[i] != 0 && add_run(f, (int64_t)from[i], (int64_t[]){i, y, z}, end - i, e))                    \
                    return -1;                                                                                         \
            });                                                                                                        \
        return 0;                                                                                                      \
    }
VOLUME_TYPES(FIND)

int64_t samples_labels(const volume *v, samples_label **list, err *e)
{
#define FINDER(name, of, nrrd, meta, low_, high_) find_##name,
    static int (*const find[])(const volume *, const samples_box *, found *, err *) = {VOLUME_TYPES(FINDER)};
    found f = {0};
    samples_box whole = samples_whole(v);
    *list = NULL;
    if (v->type == VOLUME_F32 || v->type == VOLUME_F64)
        return err_set(e, NULL, 0, "voxels that are not whole numbers; expected a label image");
    if (find[v->type](v, &whole, &f, e)) {
        free(f.one);
        return -1;
    }
    *list = f.one;
    return f.count;
}

/* ---- Gaussian filter */

int64_t samples_reach(double sigma)
{
    return sigma > 0 ? (int64_t)ceil(3 * sigma) : 0;
}

/* reach + 1 weights, from the middle outwards; they sum up to 1 over both sides. */
static void weigh(double sigma, int64_t reach, float *weight)
{
    double sum = 0;
    for (int64_t i = 0; i <= reach; i++)
        sum += (i ? 2 : 1) * exp(-.5 * (double)(i * i) / (sigma * sigma));
    for (int64_t i = 0; i <= reach; i++)
        weight[i] = (float)(exp(-.5 * (double)(i * i) / (sigma * sigma)) / sum);
}

/* Rows of a sheet, the first and last repeated beyond its ends. */
static const float *row_of(const float *sheet, int64_t rows, int64_t wide, int64_t row)
{
    return sheet + num_clamp_int(row, 0, rows - 1) * wide;
}

/* Filters across `rows` rows of `wide` samples, which lie `apart` in value. sheet: a copy's room. */
static void filter_sheet(float *value, int64_t rows, int64_t wide, int64_t apart, const float *weight, int64_t reach,
                         float *sheet)
{
    for (int64_t r = 0; r < rows; r++)
        memcpy(sheet + r * wide, value + r * apart, (size_t)wide * sizeof *sheet);
    for (int64_t r = 0; r < rows; r++) {
        float *to = value + r * apart;
        for (int64_t x = 0; x < wide; x++)
            to[x] *= weight[0];
        for (int64_t i = 1; i <= reach; i++) {
            const float *a = row_of(sheet, rows, wide, r - i), *b = row_of(sheet, rows, wide, r + i);
            float w = weight[i];
            for (int64_t x = 0; x < wide; x++)
                to[x] += w * (a[x] + b[x]);
        }
    }
}

static void filter_row(float *row, int64_t count, const float *weight, int64_t reach, float *copy)
{
    for (int64_t i = 0; i < count + 2 * reach; i++)
        copy[i] = row[num_clamp_int(i - reach, 0, count - 1)];
    for (int64_t x = 0; x < count; x++)
        row[x] = weight[0] * copy[x + reach];
    for (int64_t i = 1; i <= reach; i++)
        for (int64_t x = 0; x < count; x++)
            row[x] += weight[i] * (copy[x + reach - i] + copy[x + reach + i]);
}

static int filter_along(float *value, const int64_t size[3], int a, double sigma, err *e)
{
    const int64_t reach = samples_reach(sigma), plane = size[0] * size[1];
    float *weight = mem_array(reach + 1, sizeof *weight, "a filter", e);
    float *copy = mem_array(a ? size[0] * size[a] : size[0] + 2 * reach, sizeof *copy, "a filter", e);
    const bool made = weight && copy;
    if (made) {
        weigh(sigma, reach, weight);
        for (int64_t r = 0; a == 0 && r < size[1] * size[2]; r++)
            filter_row(value + r * size[0], size[0], weight, reach, copy);
        for (int64_t z = 0; a == 1 && z < size[2]; z++)
            filter_sheet(value + z * plane, size[1], size[0], size[0], weight, reach, copy);
        for (int64_t y = 0; a == 2 && y < size[1]; y++)
            filter_sheet(value + y * size[0], size[2], size[0], plane, weight, reach, copy);
    }
    free(weight);
    free(copy);
    return made ? 0 : -1;
}

int samples_filter(float *value, const int64_t size[3], const double sigma[3], err *e)
{
    for (int a = 0; a < 3; a++)
        if (samples_reach(sigma[a]) && filter_along(value, size, a, sigma[a], e))
            return -1;
    return 0;
}

/* ---- plane by plane */

/* The planes around the one that is to be given, filtered along x and y, each in the place of its number modulo
 * `count`. */
typedef struct ring {
    const int64_t *size;
    int64_t reach[3], count;
    float *weight[3]; /* owned, as the rest; NULL: not along that axis */
    float *plane, *out, *sheet, *row;
} ring;

static int64_t ring_planes(const int64_t size[3], int64_t reach)
{
    return 2 * reach + 1 < size[2] ? 2 * reach + 1 : size[2];
}

double samples_planes_bytes(const int64_t size[3], const double sigma[3])
{
    const double area = (double)size[0] * (double)size[1];
    return sizeof(float) * area * (double)(ring_planes(size, samples_reach(sigma[2])) + 2);
}

static int ring_make(ring *r, const int64_t size[3], const double sigma[3], err *e)
{
    const int64_t area = size[0] * size[1];
    *r = (ring){.size = size};
    for (int a = 0; a < 3; a++) {
        r->reach[a] = samples_reach(sigma[a]);
        if (!r->reach[a])
            continue;
        r->weight[a] = mem_array(r->reach[a] + 1, sizeof(float), "a filter", e);
        if (!r->weight[a])
            return -1;
        weigh(sigma[a], r->reach[a], r->weight[a]);
    }
    r->count = ring_planes(size, r->reach[2]);
    r->plane = mem_array(r->count * area, sizeof(float), "planes of samples", e);
    r->out = r->plane ? mem_array(area, sizeof(float), "a plane of samples", e) : NULL;
    r->sheet = r->out ? mem_array(area, sizeof(float), "a plane of samples", e) : NULL;
    r->row = r->sheet ? mem_array(size[0] + 2 * r->reach[0], sizeof(float), "a row of samples", e) : NULL;
    return r->row ? 0 : -1;
}

static void ring_free(ring *r)
{
    for (int a = 0; a < 3; a++)
        free(r->weight[a]);
    free(r->plane);
    free(r->out);
    free(r->sheet);
    free(r->row);
}

static float *ring_at(const ring *r, int64_t z)
{
    const int64_t last = r->size[2] - 1;
    z = num_clamp_int(z, 0, last);
    return r->plane + z % r->count * r->size[0] * r->size[1];
}

static void ring_take(const ring *r, const samples_planes *p, int64_t z)
{
    float *plane = ring_at(r, z);
    p->take(p->context, z, plane);
    for (int64_t y = 0; r->weight[0] && y < r->size[1]; y++)
        filter_row(plane + y * r->size[0], r->size[0], r->weight[0], r->reach[0], r->row);
    if (r->weight[1])
        filter_sheet(plane, r->size[1], r->size[0], r->size[0], r->weight[1], r->reach[1], r->sheet);
}

static const float *ring_filter(const ring *r, int64_t z)
{
    const int64_t area = r->size[0] * r->size[1];
    const float *here = ring_at(r, z);
    if (!r->weight[2])
        return here;
    for (int64_t i = 0; i < area; i++)
        r->out[i] = here[i] * r->weight[2][0];
    for (int64_t k = 1; k <= r->reach[2]; k++) {
        const float *a = ring_at(r, z - k), *b = ring_at(r, z + k), w = r->weight[2][k];
        for (int64_t i = 0; i < area; i++)
            r->out[i] += w * (a[i] + b[i]);
    }
    return r->out;
}

int samples_filter_planes(const samples_planes *p, const int64_t size[3], const double sigma[3], int64_t from,
                          int64_t to, err *e)
{
    ring r;
    const int failed = ring_make(&r, size, sigma, e);
    if (!failed) {
        int64_t next = from > r.reach[2] ? from - r.reach[2] : 0;
        for (int64_t z = from; z < to; z++) {
            for (; next < size[2] && next <= z + r.reach[2]; next++)
                ring_take(&r, p, next);
            p->give(p->context, z, ring_filter(&r, z));
        }
    }
    ring_free(&r);
    return failed;
}
