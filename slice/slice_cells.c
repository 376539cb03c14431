#include "slice/slice_cells.h"

#include "base/mem.h"

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

/* The voxels in 8 bits: the volume's own, where it has them, or *made, which the caller frees. */
static const uint8_t *voxels(const volume *v, slice_window w, uint8_t **made, err *e)
{
    *made = NULL;
    if (v->type == VOLUME_U8 && w.low == 0 && w.high == 255)
        return v->data;
    *made = mem_array(volume_count(v), 1, "a volume in 8 bits", e);
    for (int64_t i = 0, n = *made ? volume_count(v) : 0; i < n; i++)
        (*made)[i] = grey(volume_value(v, i), w);
    return *made;
}

typedef struct laying {
    const slice_cells *c;
    const uint8_t *voxel;
} laying;

static int32_t within(int32_t at, int32_t size)
{
    return at < 0 ? 0 : at < size ? at : size - 1;
}

/* A row of cells from the four rows of voxels around it. */
static void lay_row(uint64_t *word, const uint8_t *const around[4], int32_t size)
{
    for (int32_t x = 0; x <= size; x++) {
        const int32_t left = within(x - 1, size), right = within(x, size);
        uint64_t w = 0;
        for (int i = 3; i >= 0; i--)
            w = w << 16 | (uint64_t)around[i][right] << 8 | (uint64_t)around[i][left];
        word[x] = w;
    }
}

static void lay(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const laying *l = context;
    const int32_t *size = l->c->size;
    (void)chunk;
    for (int64_t z = from; z < to; z++)
        for (int32_t y = 0; y <= size[1]; y++) {
            const uint8_t *around[4];
            for (int i = 0; i < 4; i++)
                around[i] = l->voxel + size[0] * ((int64_t)size[1] * within((int32_t)z - 1 + i / 2, size[2]) +
                                                  within(y - 1 + i % 2, size[1]));
            lay_row(l->c->word + z * l->c->layer + (int64_t)y * l->c->row, around, size[0]);
        }
}

int slice_cells_make(slice_cells *c, const volume *v, slice_window w, pool *threads, err *e)
{
    enum { SIDE_MOST = 32000 };
    volume_finder f = volume_finder_of(v);
    uint8_t *made;
    double words = (double)(v->size[2] + 2); /* a layer of them black */
    *c = (slice_cells){0};
    for (int a = 0; a < 3; a++) {
        if (v->size[a] > SIDE_MOST)
            return err_set(e, NULL, 0, "the volume has %lld voxels along an axis; expected at most %d",
                           (long long)v->size[a], SIDE_MOST);
        c->size[a] = (int32_t)v->size[a];
        words *= a < 2 ? (double)(v->size[a] + 1) : 1;
    }
    if (words > INT32_MAX)
        return err_set(e, NULL, 0, "the volume has %.3g voxels; expected at most 2e9", words);
    memcpy(c->origin, f.origin, sizeof c->origin);
    memcpy(c->axis, f.row, sizeof c->axis);
    c->row = c->size[0] + 1;
    c->layer = c->row * (c->size[1] + 1);
    c->black = (c->size[2] + 1) * SLICE_ONE;
    c->word = mem_array((int64_t)words, sizeof *c->word, "a volume's cells", e);
    const uint8_t *voxel = c->word ? voxels(v, w, &made, e) : NULL;
    if (!voxel)
        return -1;
    pool_run(threads, c->size[2] + 1, 4, lay, &(laying){c, voxel});
    free(made);
    return 0;
}

void slice_cells_free(slice_cells *c)
{
    free(c->word);
    *c = (slice_cells){0};
}
