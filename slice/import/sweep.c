#include "slice/import/sweep.h"

#include "base/mem.h"
#include "base/num.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool sweep_is(const char *header, size_t size)
{
    static const char key[] = "Seq_Frame";
    const char *end = header + size;
    for (const char *line = header; line && (size_t)(end - line) > sizeof key; line++) {
        if (!memcmp(line, key, sizeof key - 1))
            return true;
        line = memchr(line, '\n', (size_t)(end - line));
        if (!line)
            break;
    }
    return false;
}

void sweep_free(sweep *s)
{
    free(s->one);
    *s = (sweep){0};
}

/* a b, of 3 x 4 matrices whose fourth row is 0 0 0 1. */
static void product(const double *a, const double *b, double to[12])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            to[4 * i + j] = j == 3 ? a[4 * i + 3] : 0;
            for (int k = 0; k < 3; k++)
                to[4 * i + j] += a[4 * i + k] * b[4 * k + j];
        }
}

static int add_frame(sweep *s, const plus *p, const double m[16], const double *image_to_probe, err *e)
{
    bool probe = !strcmp(p->from, "Probe");
    if (MEM_ROOM(&s->one, &s->capacity, s->count + 1, "frames", e))
        return -1;
    sweep_frame *f = &s->one[s->count++];
    f->image = p->frame.number;
    if (!probe) {
        memcpy(f->m, m, sizeof f->m);
        return 0;
    }
    if (!image_to_probe)
        return err_set(e, in_name(p->source), p->frame.line,
                       "says where the probe is, not the image; expected ImageTo... transforms, or --calibration");
    product(m, image_to_probe, f->m);
    return 0;
}

/* Two letters, of which a third may follow where probes are of volumes. What is not said, or XX, is as PLUS has it. */
static int take_orientation(sweep *s, const plus *p, err *e)
{
    const char *o = p->orientation;
    if (!*o || !strcasecmp(o, "XX"))
        return 0;
    char column = (char)toupper((unsigned char)o[0]), row = (char)toupper((unsigned char)o[1]);
    s->flipped[0] = column == 'U';
    s->flipped[1] = row == 'N';
    if ((column == 'M' || column == 'U') && (row == 'F' || row == 'N'))
        return 0;
    return err_set(e, in_name(p->source), 0, "UltrasoundImageOrientation: '%s'; expected MF, MN, UF or UN", o);
}

void sweep_unflip(sweep *s, const int64_t size[3])
{
    for (int c = 0; c < 2; c++)
        for (int64_t i = 0; s->flipped[c] && i < s->count; i++)
            for (int a = 0; a < 3; a++) {
                double *m = s->one[i].m + 4 * a;
                m[3] += m[c] * (double)(size[c] - 1);
                m[c] = -m[c];
            }
    s->flipped[0] = s->flipped[1] = false;
}

int sweep_read(sweep *s, in *source, const char *transform, const double *image_to_probe, err *e)
{
    plus p;
    double time, m[16];
    int64_t line;
    int more = plus_open(&p, source, transform, e) ? -1 : 1;
    while (more > 0) {
        more = plus_next(&p, &time, &line, m, e);
        if (more > 0 && add_frame(s, &p, m, image_to_probe, e))
            more = -1;
    }
    s->skipped = p.skipped;
    snprintf(s->from, sizeof s->from, "%s", p.from);
    snprintf(s->to, sizeof s->to, "%s", p.to);
    if (!more && !s->count)
        return err_set(e, in_name(source), 0, "no frame that was tracked");
    return more ? more : take_orientation(s, &p, e);
}

/* ---- where it lies */

static void place(const sweep_frame *f, double column, double row, double to[3])
{
    for (int a = 0; a < 3; a++)
        to[a] = f->m[4 * a] * column + f->m[4 * a + 1] * row + f->m[4 * a + 3];
}

static double pitch(const sweep_frame *f, int column)
{
    return sqrt(f->m[column] * f->m[column] + f->m[4 + column] * f->m[4 + column] +
                f->m[8 + column] * f->m[8 + column]);
}

static int by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

double sweep_voxel(const sweep *s, const volume *images, err *e)
{
    double *gap = mem_array(s->count, sizeof *gap, "frames", e), before[3] = {0}, here[3], side = 0;
    for (int64_t i = 0; gap && i < s->count; i++) {
        place(&s->one[i], .5 * (double)(images->size[0] - 1), .5 * (double)(images->size[1] - 1), here);
        if (i)
            gap[i - 1] =
                .5 * sqrt(pow(here[0] - before[0], 2) + pow(here[1] - before[1], 2) + pow(here[2] - before[2], 2));
        memcpy(before, here, sizeof before);
        side = fmax(side, fmax(pitch(&s->one[i], 0), pitch(&s->one[i], 1)));
    }
    if (gap && s->count > 1) {
        qsort(gap, (size_t)s->count - 1, sizeof *gap, by_value);
        side = fmax(side, gap[(s->count - 1) / 2]);
    }
    free(gap);
    return gap ? side : -1;
}

/* Axes along the columns and rows of the middle frame, and square to both: a sweep
 * fills little of a box along other axes. */
static int find_axes(const sweep *s, double axis[3][3], err *e)
{
    const double *m = s->one[s->count / 2].m;
    double dot = 0, length[3] = {0};
    for (int b = 0; b < 3; b++) {
        axis[0][b] = m[4 * b];
        axis[1][b] = m[4 * b + 1];
        length[0] += m[4 * b] * m[4 * b];
        dot += m[4 * b] * m[4 * b + 1];
    }
    for (int b = 0; b < 3; b++) {
        axis[1][b] -= dot / length[0] * axis[0][b];
        length[1] += axis[1][b] * axis[1][b];
    }
    for (int b = 0; b < 3; b++)
        axis[2][b] = axis[0][(b + 1) % 3] * axis[1][(b + 2) % 3] - axis[0][(b + 2) % 3] * axis[1][(b + 1) % 3];
    length[2] = length[0] * length[1];
    if (!(length[2] > 1e-12 * length[0] * length[0]) || !isfinite(length[2]))
        return err_set(e, NULL, 0,
                       "an image whose columns and rows are parallel; expected a transform that keeps them apart");
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            axis[a][b] /= sqrt(length[a]);
    return 0;
}

static int find_box(const sweep *s, const volume *images, double axis[3][3], double low[3], double high[3], err *e)
{
    double corner[3];
    for (int a = 0; a < 3; a++) {
        low[a] = INFINITY;
        high[a] = -INFINITY;
    }
    for (int64_t i = 0; i < s->count; i++) {
        const sweep_frame *f = &s->one[i];
        if (f->image >= images->size[2])
            return err_set(e, NULL, 0,
                           "frame %" PRId64 " is tracked, and there are images of %" PRId64 "; expected one a frame",
                           f->image, images->size[2]);
        for (int c = 0; c < 4; c++) {
            const int64_t column = c % 2 * (images->size[0] - 1), row = c / 2 * (images->size[1] - 1);
            place(f, (double)column, (double)row, corner);
            for (int a = 0; a < 3; a++) {
                double at = axis[a][0] * corner[0] + axis[a][1] * corner[1] + axis[a][2] * corner[2];
                low[a] = fmin(low[a], at);
                high[a] = fmax(high[a], at);
            }
        }
    }
    return 0;
}

/* A volume may have this many voxels, or so many for each pixel: two images that a bad transform puts
 * far apart may not ask for any memory. */
static const double voxels_free = 1 << 24, voxels_each = 1000;

static int refuse(double need, double memory, double side, err *e)
{
    char has[NUM_TEXT], most[NUM_TEXT];
    return err_set(e, NULL, 0,
                   "the images, and their volume in voxels of %g mm, take %s of memory or more; --memory allows %s: "
                   "expected a larger --voxel, or more",
                   side, num_size_text(need, has), num_size_text(memory, most));
}

static int set_geometry(volume *v, const sweep *s, const volume *images, double side, double memory, err *e)
{
    double axis[3][3], low[3], high[3], count = 1;
    double most = fmax(voxels_free, voxels_each * (double)volume_count(images));
    if (find_axes(s, axis, e) || find_box(s, images, axis, low, high, e))
        return -1;
    v->type = images->type;
    for (int a = 0; a < 3; a++) {
        double cells = ceil((high[a] - low[a]) / side - 1e-6) + 1;
        count *= cells;
        const double need = count * (2 * sizeof(float) + (double)volume_type_size(v->type));
        if (memory > 0 && need + volume_memory(images) > memory)
            return refuse(need + volume_memory(images), memory, side, e);
        if (!(need < (double)mem_available()))
            return err_set(
                e, NULL, 0,
                "a volume of %g x %g x %g mm, in voxels of %g mm, is more than memory holds; expected a larger --voxel",
                high[0] - low[0], high[1] - low[1], high[2] - low[2], side);
        if (count > most)
            return err_set(
                e, NULL, 0,
                "a volume of %g x %g x %g mm has more than %g voxels of %g mm for each pixel: images lie far "
                "apart; expected a larger --voxel",
                high[0] - low[0], high[1] - low[1], high[2] - low[2], voxels_each, side);
        v->size[a] = (int64_t)cells;
        for (int b = 0; b < 3; b++) {
            v->axis[a][b] = axis[a][b] * side;
            v->origin[b] += axis[a][b] * low[a];
        }
    }
    return volume_check(v, NULL, 0, e);
}

/* ---- adding up */

typedef struct splat {
    const volume *v;
    double side;
    float *sum, *weight; /* a voxel */
    float *row;          /* an image's row */
} splat;

static void add_near(const splat *s, const double at[3], float value)
{
    int64_t index = 0;
    for (int a = 2; a >= 0; a--) {
        int64_t i = (int64_t)(at[a] + .5);
        index = index * s->v->size[a] + (i < s->v->size[a] ? i : s->v->size[a] - 1);
    }
    s->sum[index] += value;
    s->weight[index] += 1;
}

static void add_linear(const splat *s, const double at[3], float value)
{
    const int64_t *n = s->v->size;
    int64_t i[3];
    float high[3];
    for (int a = 0; a < 3; a++) {
        i[a] = (int64_t)at[a];
        i[a] = i[a] > n[a] - 2 && n[a] > 1 ? n[a] - 2 : i[a];
        high[a] = (float)(at[a] - (double)i[a]);
    }
    for (int c = 0; c < 8; c++) {
        int64_t x = i[0] + (c & 1), y = i[1] + (c >> 1 & 1), z = i[2] + (c >> 2);
        float part[3];
        for (int a = 0; a < 3; a++)
            part[a] = c >> a & 1 ? high[a] : 1 - high[a];
        float share = part[0] * part[1] * part[2];
        if (share <= 0 || x >= n[0] || y >= n[1] || z >= n[2])
            continue;
        int64_t index = (z * n[1] + y) * n[0] + x;
        s->sum[index] += share * value;
        s->weight[index] += share;
    }
}

/* What takes pixels to voxels. */
static void to_voxels(const splat *s, const sweep_frame *f, double m[12])
{
    for (int a = 0; a < 3; a++)
        for (int j = 0; j < 4; j++) {
            m[4 * a + j] = 0;
            for (int b = 0; b < 3; b++)
                m[4 * a + j] +=
                    s->v->axis[a][b] / (s->side * s->side) * (f->m[4 * b + j] - (j == 3 ? s->v->origin[b] : 0));
        }
}

static void add_image(const splat *s, const sweep_frame *f, const volume *images, bool linear)
{
    int64_t wide = images->size[0], first = f->image * wide * images->size[1];
    double m[12], at[3];
    to_voxels(s, f, m);
    for (int64_t r = 0; r < images->size[1]; r++) {
        for (int64_t c = 0; c < wide; c++)
            s->row[c] = (float)volume_value(images, first + r * wide + c);
        for (int64_t c = 0; c < wide; c++) {
            for (int a = 0; a < 3; a++) {
                double x = m[4 * a] * (double)c + m[4 * a + 1] * (double)r + m[4 * a + 3];
                at[a] = fmin(fmax(x, 0), (double)(s->v->size[a] - 1));
            }
            if (linear)
                add_linear(s, at, s->row[c]);
            else
                add_near(s, at, s->row[c]);
        }
    }
}

/* The means; a weight of no account counts as none. Returns how many voxels have one. */
static int64_t settle(const splat *s)
{
    const float least = 1e-3F;
    int64_t filled = 0, count = volume_count(s->v);
    for (int64_t i = 0; i < count; i++) {
        bool some = s->weight[i] > least;
        s->sum[i] = some ? s->sum[i] / s->weight[i] : 0;
        s->weight[i] = some ? -1 : 0; /* -1: has a value of pixels; what gaps give is added up as it was */
        filled += some;
    }
    return filled;
}

/* Gaps of a line, of at most `widest` voxels without pixels between two that have them: what is linear between these,
 * weighted by one over the gap. */
static void fill_line(const splat *s, int64_t first, int64_t count, int64_t apart, int64_t widest)
{
    int64_t before = -1;
    for (int64_t i = 0; i < count; i++) {
        int64_t at = first + i * apart;
        if (s->weight[at] >= 0)
            continue;
        int64_t gap = i - before - 1;
        if (before >= 0 && gap > 0 && gap <= widest) {
            float a = s->sum[first + before * apart], b = s->sum[at], w = 1 / (float)gap;
            for (int64_t j = before + 1; j < i; j++) {
                float share = (float)(j - before) / (float)(gap + 1);
                s->sum[first + j * apart] += w * (a + share * (b - a));
                s->weight[first + j * apart] += w;
            }
        }
        before = i;
    }
}

static int64_t fill_gaps(const splat *s, int64_t widest)
{
    const int64_t *n = s->v->size;
    int64_t filled = 0, apart[3] = {1, n[0], n[0] * n[1]};
    for (int a = 0; a < 3; a++) {
        int b = (a + 1) % 3, c = (a + 2) % 3;
        for (int64_t j = 0; j < n[c]; j++)
            for (int64_t i = 0; i < n[b]; i++)
                fill_line(s, i * apart[b] + j * apart[c], n[a], apart[a], widest);
    }
    for (int64_t i = 0; i < volume_count(s->v); i++)
        if (s->weight[i] > 0) {
            s->sum[i] /= s->weight[i];
            filled++;
        }
    return filled;
}

static void put(volume *v, const float *value)
{
    int64_t count = volume_count(v);
    switch (v->type) {
#define PUT(name, of, nrrd, meta, low, high)                                                                           \
    case VOLUME_##name:                                                                                                \
        for (int64_t i = 0; i < count; i++)                                                                            \
            ((of *)v->data)[i] = (of)(VOLUME_##name < VOLUME_F32 ? floorf(value[i] + .5F) : value[i]);                 \
        break;
        VOLUME_TYPES(PUT)
    default:
        break;
    }
}

int sweep_volume(volume *v, const sweep *s, const volume *images, const sweep_wish *wish, int64_t filled[2], err *e)
{
    double side = isnan(wish->voxel) ? sweep_voxel(s, images, e) : wish->voxel;
    splat to = {.v = v, .side = side};
    if (side < 0 || set_geometry(v, s, images, side, wish->memory, e) || volume_make(v, e))
        return -1;
    to.sum = mem_array(volume_count(v), sizeof *to.sum, "voxels", e);
    to.weight = mem_array(volume_count(v), sizeof *to.weight, "voxels", e);
    to.row = mem_array(images->size[0], sizeof *to.row, "a row of pixels", e);
    const bool made = to.sum && to.weight && to.row;
    if (made) {
        for (int64_t i = 0; i < s->count; i++)
            add_image(&to, &s->one[i], images, wish->linear);
        filled[0] = settle(&to);
        filled[1] = fill_gaps(&to, wish->fill);
        put(v, to.sum);
    }
    free(to.sum);
    free(to.weight);
    free(to.row);
    return made ? 0 : -1;
}
