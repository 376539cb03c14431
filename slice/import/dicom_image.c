#include "slice/import/dicom_image.h"

#include "base/mem.h"
#include "slice/import/dicom_file.h"
#include "slice/import/dicom_inflate.h"
#include "slice/import/dicom_pixels.h"
#include "slice/import/dicom_tags.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CENTIMETRES = 3, MOST_FRAMES = 30000 };

typedef struct reading {
    dicom_image *d;
    dicom_file *f;
    dicom_item *set;
    err *e;
} reading;

static int refuse(const reading *r, const char *what, const char *expected)
{
    return err_set(r->e, dicom_file_name(r->f), 0, "%s; expected %s", what, expected);
}

static int numbers(const reading *r, dicom_item *item, uint32_t tag, double *to, int most)
{
    return dicom_numbers(r->f, item, tag, to, most);
}

static double number(const reading *r, dicom_item *item, uint32_t tag, double otherwise)
{
    double value;
    return numbers(r, item, tag, &value, 1) == 1 ? value : otherwise;
}

/* ---- geometry */

static int set_axes(const reading *r, const double o[6])
{
    double length[2] = {0, 0}, dot = 0;
    for (int i = 0; i < 3; i++) {
        length[0] += o[i] * o[i];
        length[1] += o[3 + i] * o[3 + i];
        dot += o[i] * o[3 + i];
    }
    if (!(fabs(length[0] - 1) < .01 && fabs(length[1] - 1) < .01 && fabs(dot) < .01))
        return refuse(r, "an invalid orientation of rows and columns", "two unit vectors at a right angle");
    for (int i = 0; i < 3; i++) {
        r->d->along_row[i] = o[i] / sqrt(length[0]);
        r->d->along_column[i] = o[3 + i] / sqrt(length[1]);
    }
    return 0;
}

/* PixelSpacing is between rows, then between columns. */
static void set_spacing(const reading *r, dicom_item *item)
{
    double s[2];
    if (numbers(r, item, TAG_PIXEL_SPACING, s, 2) == 2) {
        r->d->spacing[0] = s[1];
        r->d->spacing[1] = s[0];
    }
    double between = number(r, item, TAG_BETWEEN_SLICES, (double)NAN);
    if (isfinite(between))
        r->d->spacing[2] = fabs(between);
}

/* Pixels of an ultrasound region: whether it is in cm, and mm. */
static bool region_spacing(const reading *r, dicom_item *item, double mm[2])
{
    double dx = number(r, item, TAG_DELTA_X, (double)NAN), dy = number(r, item, TAG_DELTA_Y, (double)NAN);
    double ux = number(r, item, TAG_UNITS_X, 0), uy = number(r, item, TAG_UNITS_Y, 0);
    mm[0] = 10 * fabs(dx);
    mm[1] = 10 * fabs(dy);
    return fabs(ux - CENTIMETRES) < .5 && fabs(uy - CENTIMETRES) < .5 && mm[0] > 0 && mm[1] > 0;
}

/* An image may have traces beside it, whose regions are no cm. Where regions in cm
 * differ, nothing tells which is meant. */
static void set_regions_spacing(const reading *r)
{
    double *to = r->d->spacing, mm[2];
    dicom_item *region;
    bool found = false;
    for (int64_t at = 0; (region = dicom_inner(r->f, r->set, TAG_REGIONS, at)); at++) {
        if (!region_spacing(r, region, mm))
            continue;
        if (found && !(fabs(mm[0] - to[0]) <= .01 * to[0] && fabs(mm[1] - to[1]) <= .01 * to[1])) {
            to[0] = to[1] = (double)NAN;
            return;
        }
        if (!found)
            memcpy(to, mm, sizeof mm);
        found = true;
    }
}

static void set_spacings(const reading *r)
{
    double mm[2];
    set_spacing(r, r->set);
    if (!isfinite(r->d->spacing[0]) && region_spacing(r, r->set, mm))
        memcpy(r->d->spacing, mm, sizeof mm);
    if (!isfinite(r->d->spacing[0]))
        set_regions_spacing(r);
}

static int read_plain_geometry(const reading *r)
{
    double p[3], o[6] = {0};
    dicom_image *d = r->d;
    set_spacings(r);
    if (numbers(r, r->set, TAG_ORIENTATION, o, 6) == 6 && set_axes(r, o))
        return -1;
    if (numbers(r, r->set, TAG_POSITION, p, 3) == 3) {
        d->placed = d->frames == 1;
        memcpy(d->position, p, sizeof p);
    }
    return 0;
}

/* The frame's own functional groups go before those that all frames share. */
typedef struct groups {
    dicom_item *frame, *shared;
    int64_t at;
} groups;

static dicom_item *group_of(const reading *r, const groups *g, uint32_t tag)
{
    dicom_item *own = dicom_inner(r->f, g->frame, tag, 0);
    return own ? own : dicom_inner(r->f, g->shared, tag, 0);
}

static double time_of(const reading *r, const groups *g)
{
    double time = number(r, group_of(r, g, TAG_GROUP_TIME), TAG_TIME_OFFSET, (double)NAN);
    return isfinite(time) ? time : number(r, group_of(r, g, TAG_GROUP_CONTENT), TAG_TIME_INDEX, 0);
}

static int frame_without(const reading *r, const groups *g, const char *what)
{
    return err_set(r->e, dicom_file_name(r->f), 0, "frame %lld has no %s; expected one in its functional groups",
                   (long long)g->at + 1, what);
}

/* Where a frame lies: in the volume's own frame of reference, else the patient's. */
static int read_place(const reading *r, const groups *g, double turn[6])
{
    dicom_item *place = group_of(r, g, TAG_GROUP_POSITION_VOL), *turned = group_of(r, g, TAG_GROUP_TURN_VOL);
    bool own = place != NULL, own_turn = turned != NULL;
    r->d->own_frame = own;
    if (!own)
        place = group_of(r, g, TAG_GROUP_POSITION);
    if (!own_turn)
        turned = group_of(r, g, TAG_GROUP_TURN);
    if (numbers(r, place, own ? TAG_POSITION_VOL : TAG_POSITION, r->d->position + 3 * g->at, 3) != 3)
        return frame_without(r, g, "position");
    if (numbers(r, turned, own_turn ? TAG_ORIENTATION_VOL : TAG_ORIENTATION, turn, 6) != 6)
        return frame_without(r, g, "orientation");
    return 0;
}

/* A frame's pixels lie as far apart as the first's. */
static int check_spacing(const reading *r, const groups *g)
{
    double s[2];
    const double *first = r->d->spacing;
    if (numbers(r, group_of(r, g, TAG_GROUP_MEASURES), TAG_PIXEL_SPACING, s, 2) != 2 || !isfinite(first[0]) ||
        (fabs(s[1] - first[0]) <= 1e-4 * first[0] && fabs(s[0] - first[1]) <= 1e-4 * first[1]))
        return 0;
    return err_set(r->e, dicom_file_name(r->f), 0,
                   "frame %lld has pixels of %g x %g mm, frame 1 of %g x %g; expected frames that are alike",
                   (long long)g->at + 1, s[1], s[0], first[0], first[1]);
}

static int read_frame_groups(const reading *r, const groups *g, double first[6])
{
    dicom_image *d = r->d;
    double turn[6] = {0};
    if (read_place(r, g, turn))
        return -1;
    for (int i = 0; g->at && i < 6; i++)
        if (fabs(turn[i] - first[i]) > 1e-4)
            return err_set(r->e, dicom_file_name(r->f), 0,
                           "frame %lld is turned against frame 1; expected parallel frames", (long long)g->at + 1);
    d->time[g->at] = time_of(r, g);
    dicom_text(r->f, group_of(r, g, TAG_GROUP_DATA_TYPE), TAG_DATA_TYPE, d->kind[g->at], sizeof d->kind[g->at]);
    dicom_item *values = group_of(r, g, TAG_GROUP_VALUES);
    d->scale[g->at].slope = number(r, values, TAG_SLOPE, d->slope);
    d->scale[g->at].intercept = number(r, values, TAG_INTERCEPT, d->intercept);
    if (g->at)
        return check_spacing(r, g);
    memcpy(first, turn, sizeof turn);
    set_spacing(r, group_of(r, g, TAG_GROUP_MEASURES));
    return set_axes(r, turn);
}

static int read_functional_groups(const reading *r)
{
    double first[6] = {0};
    groups g = {.shared = dicom_inner(r->f, r->set, TAG_SHARED_GROUPS, 0)};
    for (; g.at < r->d->frames; g.at++) {
        g.frame = dicom_inner(r->f, r->set, TAG_FRAME_GROUPS, g.at);
        if (read_frame_groups(r, &g, first))
            return -1;
    }
    r->d->placed = true;
    return 0;
}

static int make_frames(const reading *r, int64_t frames)
{
    dicom_image *d = r->d;
    free(d->position);
    free(d->time);
    free(d->kind);
    free(d->scale);
    d->frames = frames;
    d->position = mem_array(frames, 3 * sizeof *d->position, "frames", r->e);
    d->time = mem_array(frames, sizeof *d->time, "frames", r->e);
    d->kind = mem_array(frames, sizeof *d->kind, "frames", r->e);
    d->scale = mem_array(frames, sizeof *d->scale, "frames", r->e);
    if (!d->position || !d->time || !d->kind || !d->scale)
        return -1;
    for (int64_t i = 0; i < 3 * frames; i++)
        d->position[i] = (double)NAN;
    for (int64_t i = 0; i < frames; i++)
        d->scale[i] = (dicom_scale){d->slope, d->intercept};
    return 0;
}

/* A volume in time of which NumberOfFrames counts the times, and private elements the planes. */
static int read_philips_geometry(const reading *r)
{
    dicom_image *d = r->d;
    double depth = number(r, r->set, TAG_PHILIPS_DEPTH, 0);
    double between = number(r, r->set, TAG_PHILIPS_DELTA_Z, (double)NAN);
    if (!(depth >= 1 && depth <= 65535) || !isfinite(between))
        return refuse(r, "a Philips volume without the private elements of its depth", "(3001,1001) and (3001,1003)");
    int64_t planes = (int64_t)depth, times = d->frames;
    if (depth * (double)(times * d->rows * d->columns) > (double)dicom_pixels_size(r->f))
        return refuse(r, "fewer pixels than the planes of its depth need", "frames x planes x rows x columns of them");
    if (make_frames(r, times * planes))
        return -1;
    set_spacings(r);
    d->spacing[2] = 10 * fabs(between);
    for (int64_t f = 0; f < planes * times; f++) {
        int64_t time = f / planes;
        d->time[f] = (double)time;
        d->position[3 * f] = d->position[3 * f + 1] = 0;
        d->position[3 * f + 2] = d->spacing[2] * (double)(f % planes);
    }
    d->placed = d->own_frame = d->private_geometry = true;
    return 0;
}

static int read_geometry(const reading *r)
{
    char object[DICOM_UID];
    dicom_image *d = r->d;
    d->along_row[0] = d->along_column[1] = 1;
    d->slope = number(r, r->set, TAG_SLOPE, 1);
    d->intercept = number(r, r->set, TAG_INTERCEPT, 0);
    dicom_text(r->f, r->set, TAG_SOP_CLASS, object, sizeof object);
    if (make_frames(r, d->frames))
        return -1;
    if (dicom_has(r->f, TAG_FRAME_GROUPS))
        return read_functional_groups(r);
    if (!strcmp(object, PHILIPS_VOLUME) || (dicom_has(r->f, TAG_PHILIPS_DEPTH) && dicom_has(r->f, TAG_PHILIPS_DELTA_Z)))
        return read_philips_geometry(r);
    return read_plain_geometry(r);
}

/* ---- the image */

/* Rows, columns and frames, against how many bytes there are: before memory is asked for, frame by frame. A compressed
 * frame has an item of its own, and flat images shrink a lot, but not without end. */
static int read_size(const reading *r)
{
    const char *name = dicom_file_name(r->f);
    double rows = number(r, r->set, TAG_ROWS, 0), columns = number(r, r->set, TAG_COLUMNS, 0);
    double frames = number(r, r->set, TAG_FRAMES, 1), all = rows * columns * frames;
    size_t size = dicom_file_size(r->f);
    if (!(rows >= 1 && columns >= 1))
        return err_set(r->e, name, 0, "an image of %g rows and %g columns; expected 1 or more", rows, columns);
    if (!(frames >= 1 && frames <= INT_MAX && frames == floor(frames)))
        return err_set(r->e, name, 0, "%g frames; expected 1 or more", frames);
    int64_t pixels = dicom_pixels_size(r->f);
    if (pixels < 0)
        return refuse(r, "no pixels", "PixelData");
    bool plain = dicom_file_packing(r->f, NULL) == DICOM_PLAIN;
    if (plain && (double)pixels < all)
        return err_set(r->e, name, 0, "%lld bytes of pixels; expected %g or more", (long long)pixels, all);
    if (!plain && (frames > MOST_FRAMES || all > 1000 * (double)size + 16e6))
        return err_set(r->e, name, 0, "%g frames of %g x %g pixels in %lu bytes; expected fewer", frames, columns, rows,
                       (unsigned long)size);
    r->d->rows = (int64_t)rows;
    r->d->columns = (int64_t)columns;
    r->d->frames = (int64_t)frames;
    return 0;
}

typedef struct taken {
    dicom_image *d;
    bool none; /* no image */
} taken;

int dicom_file_take(dicom_file *f, void *to, err *e)
{
    taken *t = to;
    char burned[8];
    dicom_image *d = t->d;
    reading r = {d, f, dicom_file_set(f), e};
    t->none = !dicom_has(f, TAG_ROWS) && !dicom_has(f, TAG_PIXELS);
    if (t->none)
        return 0;
    if (read_size(&r))
        return -1;
    dicom_text(f, r.set, TAG_SERIES, d->series, sizeof d->series);
    dicom_text(f, r.set, TAG_BURNED_IN, burned, sizeof burned);
    d->burned = DICOM_NOT_SAID;
    if (!strcmp(burned, "YES"))
        d->burned = DICOM_BURNED;
    else if (!strcmp(burned, "NO"))
        d->burned = DICOM_CLEAN;
    for (int i = 0; i < 3; i++)
        d->spacing[i] = (double)NAN;
    return read_geometry(&r) || dicom_pixels_read(d, f, e) ? -1 : 0;
}

bool dicom_is(const void *bytes, size_t size)
{
    return size >= 132 && !memcmp((const char *)bytes + 128, "DICM", 4);
}

int dicom_read(dicom_image *d, const void *bytes, size_t size, const char *name, dicom_elements *seen, err *e)
{
    unsigned char *inflated = NULL;
    taken t = {.d = d};
    if (!dicom_is(bytes, size))
        return err_set(e, name, 0, "not a DICOM file; expected DICM after 128 bytes");
    int code = dicom_inflate(bytes, size, &inflated, &size, name, e);
    if (code >= 0)
        code = dicom_file_read(inflated ? inflated : bytes, size, name, seen, &t, e);
    free(inflated);
    if (code || t.none)
        dicom_free(d);
    return code ? -1 : t.none;
}

void dicom_free(dicom_image *d)
{
    free(d->position);
    free(d->time);
    free(d->kind);
    free(d->scale);
    free(d->pixels);
    *d = (dicom_image){0};
}

void dicom_end(void)
{
    dicom_file_end();
}
