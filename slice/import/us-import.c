/* us-import: DICOM series and volumes, MetaImage, NRRD and tracked sweeps to a
 * volume in NRRD, without what names anybody. */
#include "base/mem.h"
#include "cli/length.h"
#include "cli/tool.h"
#include "slice/import/crop.h"
#include "slice/import/import_files.h"
#include "slice/import/import_hide.h"
#include "slice/import/import_report.h"
#include "slice/import/series.h"
#include "slice/import/sweep.h"
#include "volume/nrrd.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    bool report, raw;
    opt_numbers crop;
    opt_lengths spacing, voxel;
    int64_t series, time, fill;
    int splat;
    const char *data, *transform, *calibration;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_RESULT, 0, "report", NULL, OPT_FLAG, TO(report), 0, 0, NULL, OPT_OUTPUT,
     "print what was used and what was left out"},
    {OPT_INPUT, 0, "crop", "X0,Y0[,Z0],X1,Y1[,Z1]", OPT_NUMBERS, TO(crop), 4, 6, NULL, 0,
     "keep these columns, rows, slices [voxels; default all]"},
    {OPT_INPUT, 0, "spacing", "DX,DY,DZ", OPT_LENGTHS, TO(spacing), 0, 3, NULL, 0,
     "DICOM: between columns, rows and slices [length]"},
    {OPT_INPUT, 0, "series", "N", OPT_INT, TO(series), 1, 1e9, NULL, 0, "DICOM: the N-th series"},
    {OPT_INPUT, 0, "time", "N", OPT_INT, TO(time), 1, 1e9, NULL, 0, "DICOM: the N-th volume in time"},
    {OPT_INPUT, 0, "data", "KIND", OPT_TEXT, TO(data), 0, 0, NULL, 0,
     "DICOM: this kind of data, e.g. TISSUE_INTENSITY"},
    {OPT_ACTION, 0, "voxel", "SIDE", OPT_LENGTHS, TO(voxel), 0, 1, NULL, 0,
     "sweep: side of a voxel [length; default from the pixels and frames]"},
    {OPT_ACTION, 0, "splat", "nearest|linear", OPT_CHOICE, TO(splat), 0, 0, "nearest|linear", 0,
     "sweep: add to one voxel, or to eight [default linear]"},
    {OPT_ACTION, 0, "fill", "VOXELS", OPT_INT, TO(fill), 0, 10000, NULL, 0,
     "sweep: widest gap that is filled [voxels; default 8]"},
    {OPT_INPUT, 0, "transform", "NAME", OPT_TEXT, TO(transform), 0, 0, NULL, 0,
     "sweep: which transform, e.g. ImageToReference"},
    {OPT_INPUT, 0, "calibration", "FILE", OPT_TEXT, TO(calibration), 0, 0, NULL, OPT_FILE,
     "sweep: 4 x 4 matrix, pixels to mm of the probe"},
    {OPT_RESULT, 0, "raw", NULL, OPT_FLAG, TO(raw), 0, 0, NULL, OPT_OUTPUT, "do not compress"},
    {0},
};

static const opt_tool table = {
    .name = "us-import",
    .usage = "[options] folder > volume.nrrd\n[options] file... > volume.nrrd",
    .purpose = "Converts DICOM, MetaImage, NRRD or a tracked sweep to one volume image (NRRD).",
    .note = "A length needs its unit, e.g. 0.5mm or 1cm.",
    .example = "us-import --report dicom/ -o volume.nrrd",
    .operands = "DIR|FILE...",
    .operands_min = 1,
    .operands_max = 1 << 20,
    .reads_volumes = true,
    .options = option_list,
};

typedef struct job {
    const struct options *o;
    const tool *t;
    import_files files;
    import_report report;
    bool found;            /* files */
    char of[IMPORT_LABEL]; /* the file that an error is of, without its name; "": none is at hand */
    volume v;
    series dicom;
    double pixels; /* bytes: of DICOM files */
    notes warnings;
} job;

/* The part that --crop keeps of a volume of this size; what has no Z keeps all slices. */
static int crop_box(const struct options *o, const int64_t size[3], samples_box *box, err *e)
{
    int dims = o->crop.count / 2;
    *box = (samples_box){.high = {size[0], size[1], size[2]}};
    for (int a = 0; a < dims; a++) {
        double low = o->crop.value[a], high = o->crop.value[dims + a];
        if (low != floor(low) || high != floor(high) || !(low >= 0 && low < high && high <= (double)size[a]))
            return err_usage(e, "--crop: %g to %g along axis %d; expected whole numbers from 0 to %" PRId64, low, high,
                             a, size[a]);
        box->low[a] = (int64_t)low;
        box->high[a] = (int64_t)high;
    }
    return 0;
}

static int crop(job *j, err *e)
{
    samples_box box;
    if (!j->o->crop.count)
        return 0;
    if (crop_box(j->o, j->v.size, &box, e))
        return -1;
    crop_to(&j->v, &box);
    return 0;
}

/* ---- DICOM */

/* File i is the one at hand. What messages call it: its name only with -v. */
static const char *call_file(job *j, int64_t i)
{
    snprintf(j->of, sizeof j->of, "file %" PRId64 " of %" PRId64, i + 1, j->files.count);
    return j->o->common.verbose ? import_base(j->files.path[i]) : j->of;
}

/* Pixels are kept until the volume is made of them, so they count twice. */
static int afford_pixels(const job *j, err *e)
{
    char need[NUM_TEXT], most[NUM_TEXT];
    const double most_bytes = (double)j->o->common.memory;
    if (!(most_bytes > 0 && 2 * j->pixels > most_bytes))
        return 0;
    return err_set(e, NULL, 0,
                   "pixels of %s by %s, and the volume that is made of them, take more memory than --memory allows, %s",
                   num_size_text(j->pixels, need), j->of, num_size_text(most_bytes, most));
}

static double peak_of_series(const volume *v, const void *context)
{
    const job *j = context;
    return j->pixels + volume_memory(v);
}

static int read_dicom_file(job *j, const char *name, const char *bytes, int64_t size, err *e)
{
    dicom_image image = {0};
    int code = dicom_read(&image, bytes, (size_t)size, name, &j->report.elements, e);
    if (code < 0)
        return -1;
    if (code == 1) {
        j->files.other++;
        return 0;
    }
    j->pixels += (double)(image.frames * image.rows * image.columns) * image.bytes;
    if (afford_pixels(j, e)) {
        dicom_free(&image);
        return -1;
    }
    j->report.burned += image.burned == DICOM_BURNED;
    j->report.unsaid += image.burned == DICOM_NOT_SAID;
    j->report.own_frame |= image.own_frame;
    j->report.private_geometry |= image.private_geometry;
    return series_add(&j->dicom, name, &image, e);
}

static int read_dicom(job *j, err *e)
{
    const volume_budget budget = {.most = j->o->common.memory, .peak = peak_of_series, .context = j};
    series_wish wish = {{(double)NAN, (double)NAN, (double)NAN}, j->o->series, j->o->time, j->o->data, &budget};
    if (j->o->spacing.count && length_mm(&j->o->spacing, "--spacing", wish.spacing, e))
        return -1;
    for (int64_t i = 0; i < j->files.count; i++) {
        char *bytes = NULL;
        const char *name = call_file(j, i);
        int64_t size = import_read(&j->files, i, &bytes, e);
        int code = size < 0 ? -1 : 0;
        if (size > 0)
            code = read_dicom_file(j, name, bytes, size, e);
        free(bytes);
        if (code)
            return -1;
    }
    *j->of = '\0'; /* the series names its files itself */
    if (j->files.other)
        notes_add(&j->warnings, "%" PRId64 " file%s without a DICOM image left out", j->files.other,
                  j->files.other == 1 ? "" : "s");
    if (series_volume(&j->v, &j->dicom, &wish, e))
        return -1;
    series_free(&j->dicom);
    if (j->report.burned && !j->o->crop.count)
        notes_add(&j->warnings,
                  "%" PRId64 " file%s annotation burned into the image, which may name people; --crop removes it",
                  j->report.burned, j->report.burned == 1 ? " says that it has" : "s say that they have");
    return crop(j, e);
}

/* ---- volumes and sweeps */

/* Whether the error's place is another file than the one at hand: a long path stands there by its end. */
static bool is_beside(const job *j, const err *e)
{
    const int skip = strncmp(e->text, "...", 3) ? 0 : 3;
    const size_t place = (size_t)(e->place - skip), length = strlen(j->files.path[0]);
    return place > length || memcmp(e->text + skip, j->files.path[0] + length - place, place) != 0;
}

/* Volumes have their voxels in the file at hand, or in one that its header names. */
static int read_volume(job *j, volume *to, err *e)
{
    const volume_budget budget = {.most = j->o->common.memory};
    if (!volume_load(to, j->files.path[0], &budget, e))
        return 0;
    if (e->place && is_beside(j, e))
        snprintf(j->of, sizeof j->of, "the data file of file 1 of 1");
    return -1;
}

static int parse_calibration(const char *path, char *text, double m[16], err *e)
{
    int count = 0;
    char *rest = NULL;
    for (char *word = strtok_r(text, " \t\r\n,", &rest); word; word = strtok_r(NULL, " \t\r\n,", &rest)) {
        if (count == 16 || num_double(word, &m[count]))
            return err_set(e, path, 0, "'%.40s' at number %d; expected 16 numbers, row by row", word, count + 1);
        count++;
    }
    if (count != 16 || m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
        return err_set(e, path, 0, "not a transform; expected 16 numbers, row by row, the last 0 0 0 1");
    return 0;
}

static int read_calibration(const char *path, double m[16], err *e)
{
    in *s = in_open(path, e);
    char *text = NULL;
    int result = -1;
    if (s && in_peek(s, e) != -2 && in_all(s, &text, e) >= 0) /* without a byte order mark */
        result = parse_calibration(path, text, m, e);
    free(text);
    in_close(s);
    return result;
}

/* Images cropped: pixel 0 0 of what is left lies further in. */
static int crop_images(job *j, volume *images, sweep *s, err *e)
{
    samples_box box;
    if (!j->o->crop.count)
        return 0;
    if (j->o->crop.count != 4)
        return err_usage(e, "--crop of a sweep: expected X0,Y0,X1,Y1, of the images");
    if (crop_box(j->o, images->size, &box, e))
        return -1;
    crop_to(images, &box);
    for (int64_t i = 0; i < s->count; i++)
        for (int a = 0; a < 3; a++)
            s->one[i].m[4 * a + 3] +=
                s->one[i].m[4 * a] * (double)box.low[0] + s->one[i].m[4 * a + 1] * (double)box.low[1];
    return 0;
}

static void say_transform(const job *j, const sweep *s)
{
    const char *more = "";
    if (!strcmp(s->from, "Probe"))
        more = ", after --calibration";
    else if (j->o->calibration)
        more = ", which says where the image is: --calibration is not used";
    tool_say(j->t, "transform: %sTo%s%s", s->from, s->to, more);
}

static int put_together(job *j, volume *images, sweep *s, const double *image_to_probe, err *e)
{
    const char *path = j->files.path[0];
    sweep_wish wish = {j->o->splat == 1, j->o->fill, (double)NAN, (double)j->o->common.memory};
    int64_t filled[2] = {0};
    if (j->o->voxel.count && length_mm(&j->o->voxel, "--voxel", &wish.voxel, e))
        return -1;
    if (j->o->voxel.count && !(wish.voxel > 0))
        return err_usage(e, "--voxel: expected more than 0");
    call_file(j, 0);
    in *source = in_open(path, e);
    int code = !source || sweep_read(s, source, j->o->transform, image_to_probe, e) || read_volume(j, images, e);
    in_close(source);
    if (code)
        return -1;
    say_transform(j, s);
    sweep_unflip(s, images->size);
    if (crop_images(j, images, s, e) || sweep_volume(&j->v, s, images, &wish, filled, e))
        return -1;
    double percent = 100 / (double)volume_count(&j->v);
    tool_say(j->t,
             "%" PRId64 " frames (%" PRId64 " without tracking left out) to %" PRId64 " x %" PRId64 " x %" PRId64
             " voxels of %.4g mm: %.1f %% from pixels, %.1f %% from gaps",
             s->count, s->skipped, j->v.size[0], j->v.size[1], j->v.size[2], volume_spacing(&j->v, 0),
             percent * (double)filled[0], percent * (double)filled[1]);
    return 0;
}

static int read_sweep(job *j, err *e)
{
    double calibration[16];
    volume images = {0};
    sweep s = {0};
    snprintf(j->of, sizeof j->of, "the calibration");
    if (j->o->calibration && read_calibration(j->o->calibration, calibration, e))
        return -1;
    const int result = put_together(j, &images, &s, j->o->calibration ? calibration : NULL, e);
    volume_free(&images);
    sweep_free(&s);
    return result;
}

/* ---- main */

static int check_options(const struct options *o, import_kind kind, err *e)
{
    bool sweeps = o->voxel.count || o->splat >= 0 || o->fill >= 0 || o->transform || o->calibration;
    if (o->crop.count == 5)
        return err_usage(e, "--crop: expected X0,Y0,X1,Y1 or X0,Y0,Z0,X1,Y1,Z1");
    if (o->spacing.count && o->spacing.count != 3)
        return err_usage(e, "--spacing: expected DX,DY,DZ");
    if (kind != IMPORT_DICOM && (o->spacing.count || o->series >= 0 || o->time >= 0 || o->data))
        return err_usage(e, "--spacing, --series, --time and --data are for DICOM");
    if (kind != IMPORT_SWEEP && sweeps)
        return err_usage(e,
                         "--voxel, --splat, --fill, --transform and --calibration are for sweeps with tracked frames");
    return 0;
}

static int read_all(job *j, struct options *o, err *e)
{
    call_file(j, 0);
    import_kind kind;
    if (import_kind_of(&j->files, &kind, e) || check_options(o, kind, e))
        return -1;
    o->splat = o->splat < 0 ? 1 : o->splat;
    o->fill = o->fill < 0 ? 8 : o->fill;
    j->report.kind = kind;
    if (kind == IMPORT_DICOM)
        return read_dicom(j, e);
    if (kind == IMPORT_SWEEP)
        return read_sweep(j, e);
    return read_volume(j, &j->v, e) || crop(j, e) ? -1 : 0;
}

/* Names of files and what is in them, out of the error. */
static void hide(const job *j, char *const *operand, err *e)
{
    char of[IMPORT_LABEL];
    snprintf(of, sizeof of, "argument %d of %d", j->files.operand + 1, j->t->operands);
    if (e->status && (e->status != STATUS_USAGE || e->place))
        import_hide(e, j->found ? j->of : of);
    for (int i = 0; i < j->t->operands; i++)
        import_hide_word(e, operand[i]);
    if (j->o->common.output)
        import_hide_word(e, j->o->common.output);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.series = -1, .time = -1, .fill = -1, .splat = -1};
    err e = {0};
    tool t = {0};
    job j = {.o = &o, .t = &t};
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (import_find(&j.files, argv + 1, t.operands, &e))
        goto out;
    j.found = true;
    if (read_all(&j, &o, &e))
        goto out;
    if (o.report && import_print(&j.report, &j.v, &t, &e))
        goto out;
    snprintf(j.of, sizeof j.of, "the output");
    out *to = out_open(o.common.output, false, &e);
    out_end(to, to && nrrd_write(&j.v, !o.raw, to, &e), &e);
out:
    if (!o.common.verbose)
        hide(&j, argv + 1, &e);
    tool_warn(&t, &j.warnings);
    import_free(&j.files);
    dicom_elements_free(&j.report.elements);
    series_free(&j.dicom);
    volume_free(&j.v);
    dicom_end();
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
