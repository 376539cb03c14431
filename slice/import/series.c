#include "slice/import/series.h"

#include "base/mem.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What positions written with a few digits may differ by: of the distance between slices, and mm. */
#define EVEN_SHARE 0.02
#define EVEN_MM    1e-3

/* One frame of the volume. */
typedef struct slice {
    const series_file *file;
    int64_t frame;
    double position[3], along, time;
    const char *kind; /* of data */
} slice;

typedef struct stack {
    const series_wish *wish;
    const series_file **file; /* those of the series; owned */
    int64_t files;
    const dicom_image *first;
    double spacing[3], normal[3];
    slice *one; /* owned */
    int64_t count;
} stack;

int series_add(series *s, const char *name, dicom_image *d, err *e)
{
    char *copy = mem_text(name, e);
    if (!copy || MEM_ROOM(&s->file, &s->capacity, s->count + 1, "DICOM files", e)) {
        free(copy);
        dicom_free(d);
        return -1;
    }
    s->file[s->count++] = (series_file){copy, *d};
    *d = (dicom_image){0};
    return 0;
}

void series_free(series *s)
{
    for (int64_t i = 0; i < s->count; i++) {
        free(s->file[i].name);
        dicom_free(&s->file[i].image);
    }
    free(s->file);
    *s = (series){0};
}

/* ---- which files */

/* The number of the series of file i, from 1, in order of first files. */
static int64_t number_of(const series *s, int64_t i, const int64_t *number)
{
    int64_t most = 0;
    for (int64_t j = 0; j < i; j++) {
        if (!strcmp(s->file[j].image.series, s->file[i].image.series))
            return number[j];
        if (number[j] > most)
            most = number[j];
    }
    return most + 1;
}

static int refuse_many(const series *s, const int64_t *number, int64_t last, int64_t wanted, err *e)
{
    char list[600] = "";
    for (int64_t n = 1; n <= last && strlen(list) < sizeof list - 120; n++) {
        int64_t files = 0, first = -1;
        for (int64_t i = 0; i < s->count; i++)
            if (number[i] == n) {
                files++;
                first = first < 0 ? i : first;
            }
        const dicom_image *d = &s->file[first].image;
        const char *comma = n > 1 ? "," : "";
        snprintf(list + strlen(list), 120, "%s %" PRId64 ": %" PRId64 " file%s of %" PRId64 " x %" PRId64 " from %.40s",
                 comma, n, files, files == 1 ? "" : "s", d->columns, d->rows, s->file[first].name);
    }
    if (wanted < 0)
        return err_set(e, NULL, 0, "%" PRId64 " series:%s; expected --series N to choose one", last, list);
    if (last == 1)
        return err_set(e, NULL, 0,
                       "--series %" PRId64 ": there is one series, of %" PRId64 " file%s; expected 1, or no --series",
                       wanted, s->count, s->count == 1 ? "" : "s");
    return err_set(e, NULL, 0, "--series %" PRId64 ": there are %" PRId64 " series:%s; expected 1 to %" PRId64, wanted,
                   last, list, last);
}

static int choose_files(stack *k, const series *s, err *e)
{
    int64_t *number = mem_array(s->count, sizeof *number, "series", e), last = 0, wanted = k->wish->number;
    k->file = mem_array(s->count, sizeof(void *), "series", e);
    int result = number && k->file ? 0 : -1;
    if (!result) {
        for (int64_t i = 0; i < s->count; i++) {
            number[i] = number_of(s, i, number);
            last = number[i] > last ? number[i] : last;
        }
        if (wanted > last || (wanted < 0 && last > 1))
            result = refuse_many(s, number, last, wanted, e);
        for (int64_t i = 0; i < s->count; i++)
            if (number[i] == (wanted < 0 ? 1 : wanted))
                k->file[k->files++] = &s->file[i];
    }
    free(number);
    return result;
}

static bool near_enough(double a, double b, double tolerance)
{
    return isnan(a) ? isnan(b) : fabs(a - b) <= tolerance;
}

/* What all files of a volume must have in common. */
static int check_alike(const stack *k, err *e)
{
    const dicom_image *a = k->first;
    for (int64_t i = 1; i < k->files; i++) {
        const dicom_image *b = &k->file[i]->image;
        const char *what = NULL;
        if (a->columns != b->columns || a->rows != b->rows)
            what = "another size";
        else if (a->bytes != b->bytes || a->negative != b->negative ||
                 !near_enough(a->slope, b->slope, 1e-9 * fabs(a->slope)) ||
                 !near_enough(a->intercept, b->intercept, 1e-9))
            what = "samples of another kind";
        for (int c = 0; c < 3; c++) {
            if (!near_enough(a->along_row[c], b->along_row[c], 1e-3) ||
                !near_enough(a->along_column[c], b->along_column[c], 1e-3))
                what = "another orientation";
            if (c < 2 && !near_enough(a->spacing[c], b->spacing[c], 1e-4 * fabs(a->spacing[c])))
                what = "another distance between pixels";
        }
        if (what)
            return err_set(e, k->file[i]->name, 0, "%s than %s; expected images that are alike", what,
                           k->file[0]->name);
    }
    return 0;
}

/* ---- where frames lie */

static void find_normal(stack *k)
{
    const double *r = k->first->along_row, *c = k->first->along_column;
    double length = 0;
    for (int a = 0; a < 3; a++) {
        int b = (a + 1) % 3, d = (a + 2) % 3;
        k->normal[a] = r[b] * c[d] - r[d] * c[b];
        length += k->normal[a] * k->normal[a];
    }
    for (int a = 0; a < 3; a++)
        k->normal[a] /= sqrt(length);
}

static int find_spacing(stack *k, err *e)
{
    for (int a = 0; a < 3; a++) {
        k->spacing[a] = isnan(k->wish->spacing[a]) ? k->first->spacing[a] : k->wish->spacing[a];
        if (a < 2 && !(k->spacing[a] > 0 && k->spacing[a] < 1e6))
            return err_set(e, k->file[0]->name, 0,
                           "no distance between pixels; expected PixelSpacing, or ultrasound regions in cm that agree, "
                           "or --spacing");
    }
    return 0;
}

static int place_frame(const stack *k, const series_file *f, int64_t frame, slice *to, err *e)
{
    const dicom_image *d = &f->image;
    double behind = 0;
    const double *position = d->position + 3 * frame;
    if (!d->placed) {
        if (k->files > 1)
            return err_set(e, f->name, 0, "one of several images has no position; expected ImagePositionPatient");
        if (frame && !(k->spacing[2] > 0))
            return err_set(e, f->name, 0,
                           "%" PRId64
                           " frames, and no distance between them; expected SpacingBetweenSlices, or --spacing",
                           d->frames);
        position = d->position;
        behind = frame ? k->spacing[2] * (double)frame : 0;
    }
    *to = (slice){.file = f, .frame = frame, .time = d->time[frame], .kind = d->kind[frame]};
    for (int a = 0; a < 3; a++) {
        to->position[a] = (isnan(position[a]) ? 0 : position[a]) + behind * k->normal[a];
        to->along += to->position[a] * k->normal[a];
    }
    return 0;
}

static int place_frames(stack *k, err *e)
{
    int64_t frames = 0;
    for (int64_t i = 0; i < k->files; i++)
        frames += k->file[i]->image.frames;
    k->one = mem_array(frames, sizeof *k->one, "slices", e);
    for (int64_t i = 0; k->one && i < k->files; i++)
        for (int64_t f = 0; f < k->file[i]->image.frames; f++)
            if (place_frame(k, k->file[i], f, &k->one[k->count++], e))
                return -1;
    return k->one ? 0 : -1;
}

static int by_kind(const void *a, const void *b)
{
    return strcmp(((const slice *)a)->kind, ((const slice *)b)->kind);
}

/* Keeps the frames of the kind of data that is wanted: tissue, flow and the like share their places. */
static int choose_kind(stack *k, err *e)
{
    char list[200] = "";
    int64_t kinds = 0, kept = 0;
    const char *wanted = k->wish->kind;
    qsort(k->one, (size_t)k->count, sizeof *k->one, by_kind);
    for (int64_t i = 0; i < k->count; i++) {
        const char *kind = k->one[i].kind;
        size_t used = strlen(list);
        if (i && !strcmp(kind, k->one[i - 1].kind))
            continue;
        kinds++;
        const char *comma = used ? ", " : "";
        snprintf(list + used, sizeof list - used, "%s%s", comma, *kind ? kind : "(not said)");
    }
    for (int64_t i = 0; i < k->count; i++)
        if (!wanted || !strcmp(k->one[i].kind, wanted))
            k->one[kept++] = k->one[i];
    if (!kept)
        return err_set(e, k->file[0]->name, 0, "no frames of %.40s; expected --data of: %s", wanted, list);
    if (!wanted && kinds > 1)
        return err_set(e, k->file[0]->name, 0, "frames of several kinds of data; expected --data, one of: %s", list);
    k->count = kept;
    return 0;
}

static int by_time(const void *a, const void *b)
{
    double p = ((const slice *)a)->time, q = ((const slice *)b)->time;
    return (p > q) - (p < q);
}

/* Keeps the slices of the time that is wanted. */
static int choose_time(stack *k, err *e)
{
    int64_t times = 0, kept = 0, wanted = k->wish->time < 0 ? 1 : k->wish->time;
    qsort(k->one, (size_t)k->count, sizeof *k->one, by_time);
    for (int64_t i = 0; i < k->count; i++) {
        times += !i || k->one[i].time > k->one[i - 1].time;
        if (times == wanted)
            kept++;
    }
    if (wanted > times || (k->wish->time < 0 && times > 1))
        return err_set(e, k->file[0]->name, 0, "volumes of %" PRId64 " time%s; expected --time 1 to %" PRId64, times,
                       times == 1 ? "" : "s", times);
    int64_t from = 0;
    for (int64_t time = 0; from < k->count; from++) {
        time += !from || k->one[from].time > k->one[from - 1].time;
        if (time == wanted)
            break;
    }
    memmove(k->one, k->one + from, (size_t)kept * sizeof *k->one);
    k->count = kept;
    return 0;
}

/* ---- the order, and what is wrong with it */

static int by_place(const void *a, const void *b)
{
    const slice *p = a, *q = b;
    if (p->along != q->along)
        return p->along > q->along ? 1 : -1;
    int order = (p->file > q->file) - (p->file < q->file);
    return order ? order : (p->frame > q->frame) - (p->frame < q->frame);
}

enum { SLICE_NAME = 160 };

static const char *slice_name(const slice *s, char to[SLICE_NAME])
{
    if (s->file->image.frames > 1)
        snprintf(to, SLICE_NAME, "frame %" PRId64, s->frame + 1);
    else
        snprintf(to, SLICE_NAME, "%.100s", s->file->name);
    return to;
}

static int by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* The usual distance between slices: the median. */
static int usual_gap(const stack *k, double *gap, err *e)
{
    double *all = mem_array(k->count, sizeof *all, "slices", e);
    if (!all)
        return -1;
    for (int64_t i = 1; i < k->count; i++)
        all[i - 1] = k->one[i].along - k->one[i - 1].along;
    qsort(all, (size_t)k->count - 1, sizeof *all, by_value);
    *gap = all[(k->count - 1) / 2];
    free(all);
    return 0;
}

/* What is wrong between a slice and the next, added to a list of such; "" where nothing is. */
static void say_gap(const slice *a, const slice *b, double usual, char *list, size_t size)
{
    char one[SLICE_NAME], two[SLICE_NAME];
    double gap = b->along - a->along, whole = floor(gap / usual + .5);
    double tolerance = EVEN_SHARE * usual + EVEN_MM;
    size_t used = strlen(list);
    if (fabs(gap - usual) <= tolerance || size - used < 420)
        return;
    slice_name(a, one);
    slice_name(b, two);
    const char *also = used ? "; " : "";
    if (gap <= tolerance)
        snprintf(list + used, size - used, "%s%s and %s lie at one place", also, one, two);
    else if (whole >= 2 && fabs(gap - whole * usual) <= tolerance * whole)
        snprintf(list + used, size - used, "%s%.0f missing between %s and %s", also, whole - 1, one, two);
    else
        snprintf(list + used, size - used, "%s%s and %s lie %.6g mm apart", also, one, two, gap);
}

static int check_even(const stack *k, double usual, err *e)
{
    char list[900] = "", one[SLICE_NAME];
    for (int64_t i = 1; i < k->count; i++)
        say_gap(&k->one[i - 1], &k->one[i], usual, list, sizeof list);
    if (*list)
        return err_set(e, NULL, 0, "slices: %s; expected all %.6g mm apart", list, usual);
    const slice *first = &k->one[0], *last = &k->one[k->count - 1];
    for (int64_t i = 1; i < k->count; i++) {
        const slice *s = &k->one[i];
        double off = 0;
        for (int a = 0; a < 3; a++) {
            double beside = s->position[a] - first->position[a] - (s->along - first->along) * k->normal[a];
            off += beside * beside;
        }
        if (sqrt(off) > EVEN_MM + EVEN_SHARE * (s->along - first->along + usual))
            return err_set(
                e, NULL, 0,
                "slices: %s lies %.6g mm beside the normal of the first slice; expected a straight stack (no tilt)",
                slice_name(s, one), sqrt(off));
    }
    return last->along > first->along ? 0 : -1;
}

static int put_in_order(stack *k, err *e)
{
    double usual = 0;
    qsort(k->one, (size_t)k->count, sizeof *k->one, by_place);
    if (k->count == 1) {
        if (k->spacing[2] > 0)
            return 0;
        return err_set(e, k->file[0]->name, 0,
                       "one slice, and no distance to a next one; expected more slices, or --spacing");
    }
    if (usual_gap(k, &usual, e))
        return -1;
    if (!(usual > EVEN_MM)) {
        char one[SLICE_NAME], two[SLICE_NAME];
        int64_t at = 1;
        while (at + 1 < k->count && k->one[at].along - k->one[at - 1].along > EVEN_MM)
            at++;
        return err_set(e, NULL, 0, "slices: %s and %s lie at one place, as most do; expected one slice a place",
                       slice_name(&k->one[at - 1], one), slice_name(&k->one[at], two));
    }
    if (check_even(k, usual, e))
        return -1;
    k->spacing[2] = (k->one[k->count - 1].along - k->one[0].along) / (double)(k->count - 1);
    return 0;
}

/* ---- voxels */

static void set_geometry(volume *v, const stack *k)
{
    const dicom_image *d = k->first;
    v->size[0] = d->columns;
    v->size[1] = d->rows;
    v->size[2] = k->count;
    for (int a = 0; a < 3; a++) {
        v->origin[a] = k->one[0].position[a];
        v->axis[0][a] = d->along_row[a] * k->spacing[0];
        v->axis[1][a] = d->along_column[a] * k->spacing[1];
        v->axis[2][a] = k->normal[a] * k->spacing[2];
    }
}

static double stored_value(const dicom_image *d, const unsigned char *p)
{
    if (d->bytes == 1)
        return d->negative ? (double)(int8_t)p[0] : (double)p[0];
    uint16_t two = (uint16_t)(p[0] | p[1] << 8);
    return d->negative ? (double)(int16_t)two : (double)two;
}

/* What makes a slice's values of what is stored. */
static dicom_scale scale_of(const slice *s)
{
    const dicom_image *d = &s->file->image;
    return d->scale ? d->scale[s->frame] : (dicom_scale){d->slope, d->intercept};
}

static int fill(volume *v, const stack *k, err *e)
{
    const dicom_image *d = k->first;
    bool scaled = false;
    for (int64_t s = 0; s < k->count; s++) {
        dicom_scale scale = scale_of(&k->one[s]);
        scaled |= scale.slope != 1 || scale.intercept != 0;
    }
    if (scaled)
        v->type = VOLUME_F32;
    else if (d->bytes == 1)
        v->type = d->negative ? VOLUME_I8 : VOLUME_U8;
    else
        v->type = d->negative ? VOLUME_I16 : VOLUME_U16;
    if (volume_afford(k->wish->budget, v, NULL, e) || volume_make(v, e))
        return -1;
    int64_t plane = v->size[0] * v->size[1];
    for (int64_t s = 0; s < k->count; s++) {
        const dicom_image *from = &k->one[s].file->image;
        const unsigned char *p = from->pixels + k->one[s].frame * plane * d->bytes;
        if (!scaled) {
            memcpy((char *)v->data + s * plane * d->bytes, p, (size_t)(plane * d->bytes));
            continue;
        }
        float *to = (float *)v->data + s * plane;
        dicom_scale scale = scale_of(&k->one[s]);
        for (int64_t i = 0; i < plane; i++)
            to[i] = (float)(stored_value(d, p + i * d->bytes) * scale.slope + scale.intercept);
    }
    return 0;
}

int series_volume(volume *v, const series *s, const series_wish *wish, err *e)
{
    stack k = {.wish = wish};
    int result = -1;
    if (s->count < 1)
        return err_set(e, NULL, 0, "no DICOM images; expected one or more");
    if (choose_files(&k, s, e))
        goto out;
    k.first = &k.file[0]->image;
    if (check_alike(&k, e) || find_spacing(&k, e))
        goto out;
    find_normal(&k);
    if (place_frames(&k, e) || choose_kind(&k, e) || choose_time(&k, e) || put_in_order(&k, e))
        goto out;
    set_geometry(v, &k);
    if (!volume_check(v, k.file[0]->name, 0, e))
        result = fill(v, &k, e);
out:
    free(k.file);
    free(k.one);
    return result;
}
