#include "slice/image/slice_overlay.h"

#include "base/mem.h"
#include "volume/samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Told apart by people of any colour vision (Okabe & Ito 2008), without the black. */
static const uint8_t colours[][3] = {{213, 94, 0},  {86, 180, 233},  {0, 158, 115}, {240, 228, 66},
                                     {0, 114, 178}, {204, 121, 167}, {230, 159, 0}};

enum { COLOURS = sizeof colours / sizeof *colours, ARTERY = 0, VEIN = 1, BONE = 3 };

/* What a reader of images expects: arteries are red, veins blue, as the surfaces of the console are. */
static const struct {
    const char *word;
    uint8_t colour;
} known[] = {{"artery", ARTERY}, {"vein", VEIN}, {"bone", BONE}};

static bool has(const char *name, const char *word)
{
    const size_t n = strlen(word);
    while (*name && strncasecmp(name, word, n) != 0)
        name++;
    return *name;
}

/* The first label with a known word in its name has that word's colour; the others have those that are left, in their
 * order, and when none is left, all of them again. to: count. */
static void choose_colours(const volume *labels, const samples_label *list, int64_t count, uint8_t *to)
{
    enum { NONE = 255 };
    bool taken[COLOURS] = {false};
    memset(to, NONE, (size_t)count);
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        for (int64_t i = 0; i < count && !taken[known[k].colour]; i++) {
            const char *name = volume_label_of(labels, list[i].value);
            if (to[i] == NONE && name && has(name, known[k].word)) {
                to[i] = known[k].colour;
                taken[to[i]] = true;
            }
        }
    int next = 0;
    for (int64_t i = 0; i < count; i++) {
        while (next < COLOURS && taken[next])
            next++;
        if (to[i] == NONE)
            to[i] = (uint8_t)next++;
        if (next == COLOURS) {
            memset(taken, 0, sizeof taken);
            next = 0;
        }
    }
}

/* Colours in the place of labels, in the memory of the label image. */
static int take_voxels(slice_overlay *o, volume *labels, err *e)
{
    samples_label *list = NULL;
    const int64_t count = samples_labels(labels, &list, e), voxels = volume_count(labels);
    uint8_t *to = labels->data, *colour = mem_array(count > 0 ? count : 0, 1, "colours of labels", e);
    const bool failed = count < 0 || !colour;
    if (!failed)
        choose_colours(labels, list, count, colour);
    for (int64_t i = 0; !failed && i < voxels; i++) {
        const int64_t value = (int64_t)volume_value(labels, i);
        int64_t low = 0, high = count; /* list[low - 1] < value <= list[high] */
        while (value && low < high) {
            const int64_t middle = (low + high) / 2;
            if (list[middle].value < value)
                low = middle + 1;
            else
                high = middle;
        }
        to[i] = (uint8_t)(value ? 1 + colour[low] : 0);
    }
    free(list);
    free(colour);
    if (failed)
        return -1;
    uint8_t *less = realloc(to, (size_t)voxels);
    o->voxel = less ? less : to;
    labels->data = NULL;
    return 0;
}

/* The inverse of cells->axis: cells to metres. */
static void invert(double m[3][3], double to[3][3])
{
    double six = 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            to[b][a] = m[(a + 1) % 3][(b + 1) % 3] * m[(a + 2) % 3][(b + 2) % 3] -
                       m[(a + 1) % 3][(b + 2) % 3] * m[(a + 2) % 3][(b + 1) % 3];
    for (int b = 0; b < 3; b++)
        six += m[0][b] * to[b][0];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            to[a][b] /= six;
}

int slice_overlay_make(slice_overlay *o, volume *labels, const slice_cells *c, slice_size size, err *e)
{
    volume_finder f = volume_finder_of(labels);
    double axis[3][3], back[3][3], zero[3], place[3];
    *o = (slice_overlay){.black = c->black};
    for (int a = 0; a < 3; a++) {
        o->size[a] = labels->size[a];
        for (int b = 0; b < 3; b++)
            axis[a][b] = c->axis[a][b];
    }
    invert(axis, back);
    for (int a = 0; a < 3; a++)
        zero[a] = c->origin[a] - (back[a][0] + back[a][1] + back[a][2]); /* where cell place 0 0 0 is, m */
    volume_voxel(&f, zero, place);
    for (int a = 0; a < 3; a++) {
        o->from[a] = place[a];
        for (int b = 0; b < 3; b++)
            o->axis[a][b] =
                (f.row[a][0] * back[0][b] + f.row[a][1] * back[1][b] + f.row[a][2] * back[2][b]) / SLICE_ONE;
    }
    o->seen = mem_array((int64_t)size.columns * size.rows, 1, "labels of an image", e);
    return o->seen ? take_voxels(o, labels, e) : -1;
}

void slice_overlay_free(slice_overlay *o)
{
    free(o->voxel);
    free(o->seen);
    *o = (slice_overlay){0};
}

static uint8_t label_at(const slice_overlay *o, const double p[3])
{
    int64_t at = 0;
    for (int a = 2; a >= 0; a--) {
        const double voxel =
            floor(o->from[a] + o->axis[a][0] * p[0] + o->axis[a][1] * p[1] + o->axis[a][2] * p[2] + .5);
        if (!(voxel >= 0 && voxel < (double)o->size[a]))
            return 0;
        at = at * o->size[a] + (int64_t)voxel;
    }
    return o->voxel[at];
}

void slice_overlay_take(void *context, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                        int64_t offset)
{
    slice_overlay *o = context;
    for (int64_t i = 0; i < count; i++)
        o->seen[offset + i] = z[i] == o->black ? 0 : label_at(o, (double[3]){x[i], y[i], z[i]});
}

void slice_overlay_paint(const slice_overlay *o, const uint8_t *grey, int64_t count, uint8_t *to)
{
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            to[3 * i + k] = o->seen[i] ? (uint8_t)((grey[i] + colours[o->seen[i] - 1][k] + 1) / 2) : grey[i];
}
