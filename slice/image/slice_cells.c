#include "slice/image/slice_cells.h"

#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

slice_window slice_window_of(const volume *v)
{
    slice_window w = {(double)INFINITY, -(double)INFINITY};
    if (v->type == VOLUME_U8)
        return (slice_window){0, 255};
    for (int64_t i = 0, n = volume_count(v); i < n; i++) {
        double x = volume_value(v, i);
        if (isfinite(x)) {
            w.low = fmin(w.low, x);
            w.high = fmax(w.high, x);
        }
    }
    if (v->type != VOLUME_F32 && v->type != VOLUME_F64 && w.low >= 0 && w.high <= 255)
        return (slice_window){0, 255};
    return w.low <= w.high ? w : (slice_window){0, 0};
}

static uint8_t grey(double x, slice_window w)
{
    const double share = w.high > w.low ? (x - w.low) / (w.high - w.low) : x > w.low;
    return share > 0 ? (uint8_t)lrint(fmin(share, 1) * 255) : 0; /* also for a nan */
}

/* The voxels in 8 bits, at the beginning of their own memory. */
static void to_bytes(volume *v, slice_window w)
{
    uint8_t *to = v->data;
    if (v->type == VOLUME_U8 && w.low == 0 && w.high == 255)
        return;
    for (int64_t i = 0, n = volume_count(v); i < n; i++)
        to[i] = grey(volume_value(v, i), w);
}

enum { BRICK = 9, PAST = 16 }; /* bytes of a brick for each x; that the last load may read past the end */

/* Bricks along y and along z; after these a layer of them is black. */
static int64_t bricks(int64_t size)
{
    return (size + 2) / 2;
}

static double bytes_of(int64_t x, int64_t y, int64_t z)
{
    return BRICK * (double)(x + 2) * (double)bricks(y) * (double)(bricks(z) + 1) + PAST;
}

double slice_cells_bytes(const slice_cells *c)
{
    return bytes_of(c->size[0], c->size[1], c->size[2]);
}

double slice_cells_peak(const volume *v)
{
    return fmax(volume_memory(v), bytes_of(v->size[0], v->size[1], v->size[2]));
}

/* A layer of bricks that is made; the voxels wait at the end of the same memory. */
typedef struct laying {
    const slice_cells *c;
    const uint8_t *voxel;
    int64_t z;
} laying;

static int64_t within(int64_t at, int64_t size)
{
    return num_clamp_int(at, 0, size - 1);
}

/* A brick from its nine rows of voxels, of which the first and the last go on past their ends. */
static void lay_brick(const uint8_t *const row[BRICK], int64_t size, uint8_t *to)
{
    for (int64_t x = 0; x < size; x++)
        for (int i = 0; i < BRICK; i++)
            to[BRICK * (x + 1) + i] = row[i][x];
    memcpy(to, to + BRICK, BRICK);
    memcpy(to + BRICK * (size + 1), to + BRICK * size, BRICK);
}

static void lay_bricks(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const laying *l = context;
    const int32_t *size = l->c->size;
    (void)chunk;
    for (int64_t y = from; y < to; y++) {
        const uint8_t *row[BRICK];
        for (int i = 0; i < BRICK; i++)
            row[i] = l->voxel +
                     size[0] * (size[1] * within(2 * l->z - 1 + i / 3, size[2]) + within(2 * y - 1 + i % 3, size[1]));
        lay_brick(row, size[0], l->c->byte + (size_t)l->z * l->c->layer + (size_t)y * l->c->row);
    }
}

/* Layer by layer from the first: a layer of bricks is larger than its two of voxels, and the black one is free until
 * the end; so that layer z ends before voxels 2 z - 1 begin. */
static void lay(slice_cells *c, int64_t bytes, int64_t voxels, pool *threads)
{
    const int64_t layers = bricks(c->size[2]);
    laying l = {c, memmove(c->byte + bytes - voxels, c->byte, (size_t)voxels), 0};
    for (; l.z < layers; l.z++)
        pool_run(threads, bricks(c->size[1]), 16, lay_bricks, &l);
    memset(c->byte + (size_t)layers * c->layer, 0, (size_t)bytes - (size_t)layers * c->layer);
}

int slice_cells_check(const volume *v, const char *place, err *e)
{
    enum { SIDE_MOST = 32000 }; /* a place in fixed point has 31 bits */
    for (int a = 0; a < 3; a++)
        if (v->size[a] > SIDE_MOST)
            return err_set(e, place, 0,
                           "%lld voxels along axis %d; expected at most %d: us-import --crop keeps a part of them",
                           (long long)v->size[a], a, SIDE_MOST);
    return 0;
}

int slice_cells_make(slice_cells *c, volume *v, slice_window w, pool *threads, err *e)
{
    const volume_finder f = volume_finder_of(v);
    const double bytes = bytes_of(v->size[0], v->size[1], v->size[2]);
    *c = (slice_cells){0};
    if (slice_cells_check(v, NULL, e))
        return -1;
    for (int a = 0; a < 3; a++)
        c->size[a] = (int32_t)v->size[a];
    memcpy(c->origin, f.origin, sizeof c->origin);
    memcpy(c->axis, f.row, sizeof c->axis);
    c->row = BRICK * (uint32_t)(c->size[0] + 2);
    c->layer = c->row * (uint64_t)bricks(c->size[1]);
    c->black = 2 * (int32_t)bricks(c->size[2]) * SLICE_ONE;
    to_bytes(v, w);
    c->byte = realloc(v->data, (size_t)bytes);
    if (!c->byte)
        return err_memory(e, "a volume's cells");
    v->data = NULL;
    mem_large(c->byte, (size_t)bytes);
    lay(c, (int64_t)bytes, volume_count(v), threads);
    return 0;
}

void slice_cells_free(slice_cells *c)
{
    free(c->byte);
    *c = (slice_cells){0};
}
