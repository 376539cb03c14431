/* us-slice: for each frame, the ultrasound image that its probe sees of a deformed volume (PST section IV). */
#include "base/mem.h"
#include "cli/progress.h"
#include "cli/tool.h"
#include "model/source.h"
#include "probe/poses.h"
#include "slice/image/slice_cut.h"
#include "slice/image/slice_files.h"
#include "slice/image/slice_grey.h"
#include "slice/image/slice_overlay.h"
#include "slice/image/slice_view.h"
#include "slice/image/slice_write.h"
#include "volume/body.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SLICES = 5, SLICES_MOST = 99 };

struct options {
    opt_common common;
    bool rigid;
    int method;
    const char *poses, *transform, *body, *size, *probe, *labels, *cut, *thickness;
    opt_lengths depth, width;
    opt_numbers tgc, range, window;
    double gain;
    int64_t regions;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_INPUT, 0, "poses", "FILE", OPT_TEXT, TO(poses), 0, 0, NULL, OPT_FILE, "poses [default those of the frames]"},
    {OPT_INPUT, 0, "transform", "NAME", OPT_TEXT, TO(transform), 0, 0, NULL, 0, "which transform of a PLUS sequence"},
    {OPT_INPUT, 0, "rigid", NULL, OPT_FLAG, TO(rigid), 0, 0, NULL, 0, "read no model: the volume is not deformed"},
    {OPT_INPUT, 0, "body", "FILE", OPT_TEXT, TO(body), 0, 0, NULL, OPT_FILE, "where the volume lies for --poses"},
    {OPT_RESULT, 0, "size", "COLUMNSxROWS", OPT_TEXT, TO(size), 0, 0, NULL, 0,
     "one side alone: to scale [pixels; default 512 columns]"},
    {OPT_ACTION, 0, "probe", "SHAPE", OPT_TEXT, TO(probe), 0, 0, "linear:|curved:|phased:", 0,
     "linear:W,T, curved:R,ANGLE,T or phased:ANGLE [default the probe that pressed]"},
    {OPT_ACTION, 0, "depth", "D", OPT_LENGTHS, TO(depth), 0, 1, NULL, 0, "depth along a beam [length; default 5cm]"},
    {OPT_ACTION, 0, "width", "W", OPT_LENGTHS, TO(width), 0, 1, NULL, 0, "width [length; default the probe's]"},
    {OPT_ACTION, 0, "thickness", "T[,N]", OPT_TEXT, TO(thickness), 0, 0, NULL, 0,
     "thickness of the beam: the mean of N slices, 5 if not given [length; default one slice]"},
    {OPT_ACTION, 0, "gain", "DB", OPT_NUMBER, TO(gain), -200, 200, NULL, 0, "gain [dB; default 0]"},
    {OPT_ACTION, 0, "tgc", "DB,...", OPT_NUMBERS, TO(tgc), 1, 6, NULL, 0,
     "time-gain compensation: gains from face to depth [dB]"},
    {OPT_ACTION, 0, "dynamic-range", "DB[,DB]", OPT_NUMBERS, TO(range), 1, 2, NULL, 0,
     "dynamic range [dB; default 60,60]"},
    {OPT_ACTION, 0, "window", "LOW,HIGH", OPT_NUMBERS, TO(window), 2, 2, NULL, 0,
     "values of black and white [default 0,255 or extremes]"},
    {OPT_INPUT, 0, "labels", "FILE", OPT_TEXT, TO(labels), 0, 0, NULL, OPT_FILE, "tint what this label image marks"},
    {OPT_RESULT, 0, "cut", "FILE.obj", OPT_TEXT, TO(cut), 0, 0, NULL, OPT_OUTPUT | OPT_WRITES,
     "write the polygons where the slice cuts tetrahedra"},
    {OPT_NUMERICS, 0, "method", "spans|paper", OPT_CHOICE, TO(method), 0, 0, "spans|paper", OPT_OUTPUT,
     "fill of rows; paper: Petrinec et al. [default spans]"},
    {OPT_NUMERICS, 0, "regions", "R", OPT_INT, TO(regions), 1, SLICE_SIDE_MOST, NULL, OPT_OUTPUT,
     "lists of tetrahedra [default 32]"},
    {0}};

static const opt_tool table = {
    .name = "us-slice",
    .usage = "[options] volume < result > images\n--rigid --poses FILE [options] volume > images",
    .purpose = "Makes ultrasound images of a volume image as the results of a model deform it:\na stream of PGM or "
               "PPM, or files, also PNG.",
    .note = "Lengths are in m, unless they have a suffix (" NUM_UNITS_LIST "), e.g. 5cm.",
    .example = "us-slice --depth 5cm -o image_%04d.png volume.nrrd < out.sinew",
    .operands = "volume",
    .operands_min = 1,
    .operands_max = 1,
    .threaded = true,
    .reads_volumes = true,
    .options = option_list,
};

typedef struct job {
    const struct options *o;
    const tool *t;
    pool *threads;
    slice_cells cells;
    source model;
    slice_mesh mesh;
    in *pose_source;
    poses poses;
    bool more_poses;
    pose place; /* of the volume */
    slice_view view;
    slice_cutter *cutter;
    slice_grey grey;
    slice_overlay overlay;
    slice_writer writer;
    double thickness; /* m */
    int slices;
    uint8_t *image, *colour, *one; /* rows x columns, x 3; a slice of several */
    uint16_t *sum;
    int64_t images;
    bool lit;  /* some image was not black */
    bool said; /* where poses come from */
    notes warnings;
} job;

/* ---- options */

static double metres(const opt_lengths *l, double otherwise)
{
    return l->count ? num_length_in(l->value[0], num_unit_of("m"), num_unit_of("m")) : otherwise;
}

/* Of an image of tissue; a slip of the units is mostly not. */
static bool is_side(double length)
{
    return length >= .999e-6 && length <= 10;
}

static int check_options(const struct options *o, err *e)
{
    if (o->rigid && !o->poses)
        return err_usage(e, "--rigid without --poses; expected where the probe is");
    if (o->rigid && o->cut)
        return err_usage(e, "--cut with --rigid: there are no tetrahedra to cut");
    if (o->body && !o->poses)
        return err_usage(e, "--body without --poses, whose frame it is; poses in frames are in the volume's");
    if (o->transform && !o->poses)
        return err_usage(e, "--transform without --poses");
    if (!is_side(metres(&o->depth, 1)))
        return err_usage(e, "--depth: %g m; expected 1 um to 10 m", metres(&o->depth, 1));
    if (!is_side(metres(&o->width, 1)))
        return err_usage(e, "--width: %g m; expected 1 um to 10 m", metres(&o->width, 1));
    for (int i = 0; i < o->range.count; i++)
        if (!(o->range.value[i] >= 1 && o->range.value[i] <= 200))
            return err_usage(e, "--dynamic-range %g; expected 1 to 200 dB", o->range.value[i]);
    for (int i = 0; i < o->tgc.count; i++)
        if (!(o->tgc.value[i] >= -200 && o->tgc.value[i] <= 200))
            return err_usage(e, "--tgc %g; expected -200 to 200 dB", o->tgc.value[i]);
    if (o->window.count && !(o->window.value[0] < o->window.value[1]))
        return err_usage(e, "--window %g,%g; expected LOW below HIGH", o->window.value[0], o->window.value[1]);
    return 0;
}

static int read_thickness(job *j, err *e)
{
    char copy[64];
    num_length length;
    int64_t slices = SLICES;
    const char *text = j->o->thickness;
    j->slices = 1;
    if (!text)
        return 0;
    if (strlen(text) >= sizeof copy)
        return err_usage(e, "--thickness %.60s; expected T or T,N, as 3mm,5", text);
    char *comma = strchr(strcpy(copy, text), ',');
    if (comma)
        *comma++ = '\0';
    if (num_length_of(copy, &length) || (comma && num_int(comma, 1, SLICES_MOST, &slices)))
        return err_usage(e, "--thickness %.60s; expected T or T,N, as 3mm,5, with N from 1 to %d", text, SLICES_MOST);
    j->thickness = num_length_in(length, num_unit_of("m"), num_unit_of("m"));
    j->slices = (int)slices;
    return j->thickness > 0 ? 0 : err_usage(e, "--thickness %.60s; expected more than 0", text);
}

/* ---- what is there before the first image */

static double peak_of_volume(const volume *v, const void *context)
{
    (void)context;
    return slice_cells_peak(v);
}

/* Beside the cells. */
static double peak_of_labels(const volume *labels, const void *context)
{
    const slice_cells *c = context;
    return volume_memory(labels) + slice_cells_bytes(c);
}

static int read_volume(job *j, const char *path, err *e)
{
    volume v = {0};
    const volume_budget budget = {.most = j->o->common.memory, .peak = peak_of_volume, .check = slice_cells_check};
    if (!j->o->rigid && !strcmp(path, "-"))
        return err_usage(e, "the volume is '-', but standard input holds the model; expected a file");
    if (volume_load(&v, path, &budget, e))
        return -1;
    slice_window w = slice_window_of(&v);
    if (j->o->window.count)
        w = (slice_window){j->o->window.value[0], j->o->window.value[1]};
    if (w.low != 0 || w.high != 255)
        tool_say(j->t, "black is %.6g, white %.6g", w.low, w.high);
    const int failed = slice_cells_make(&j->cells, &v, w, j->threads, e);
    volume_free(&v);
    return failed;
}

/* The array that pressed, as the model says it. 1: it makes no image, or none is known, and *p is as it was; why says
 * which. -1: e filled. */
static int pressed_by(const job *j, slice_probe *p, char *why, size_t size, err *e)
{
    const char *text = j->o->rigid ? NULL : model_meta_of(&j->model.body, "probe.shape");
    err wrong = {0};
    if (!text) {
        snprintf(why, size, j->o->rigid ? "no --probe" : "the model has no probe.shape");
        return 1;
    }
    const int none = !strncmp(text, "convex:", 7) ? 1 : slice_probe_of(p, text, &wrong);
    snprintf(why, size, "the model's probe.shape, %.100s, makes no image", text);
    return none < 0
               ? err_set(e, source_name(&j->model), 0,
                         "metadata, probe.shape: '%.100s' is not a probe; expected one as msds-run writes it", text)
               : none;
}

/* The image's array: --probe's; else that of the model; else a usual one. */
static int choose_probe(job *j, slice_probe *p, err *e)
{
    slice_probe pressed = {0};
    char why[160];
    const int none = pressed_by(j, &pressed, why, sizeof why, e);
    if (none < 0)
        return -1;
    *p = pressed;
    if (!j->o->probe) {
        if (none)
            *p = (slice_probe){.array = SLICE_LINEAR, .width = .04};
        tool_say(j->t,
                 none ? "%s: the image is that of a linear array of 4 cm; --probe says another"
                      : "probe: %s, the model's probe.shape",
                 none ? why : model_meta_of(&j->model.body, "probe.shape"));
        return 0;
    }
    const int bad = slice_probe_of(p, j->o->probe, e);
    if (bad > 0)
        return err_usage(e, "--probe %.100s makes no image; expected linear:W,T, curved:R,ANGLE,T or phased:ANGLE",
                         j->o->probe);
    if (!bad && !none && p->array != SLICE_PHASED && !slice_probe_same(p, &pressed)) {
        const char *text = model_meta_of(&j->model.body, "probe.shape");
        notes_add(&j->warnings,
                  "the image is that of %.100s, but %.100s pressed (the model's probe.shape); expected --probe %.100s, "
                  "or none",
                  j->o->probe, text, text);
        tool_warn(j->t, &j->warnings);
    }
    return bad ? -1 : 0;
}

/* Where pixels are not square, in two sides that were asked for; or in one that could only be 2. */
static void say_scale(const job *j, slice_size asked)
{
    const double *pixel = j->view.pixel, off = fabs(pixel[0] - pixel[1]) / fmin(pixel[0], pixel[1]);
    const bool both = asked.columns && asked.rows;
    char remedy[40] = "more pixels are";
    if (both)
        snprintf(remedy, sizeof remedy, "--size %d is", (int)asked.columns);
    if (off > (both ? .01 : .2))
        tool_say(j->t, "pixels are %.4g mm wide and %.4g mm high: the image is not to scale; %s", 1e3 * pixel[0],
                 1e3 * pixel[1], remedy);
}

static int make_view(job *j, err *e)
{
    const struct options *o = j->o;
    slice_probe p;
    slice_size size;
    if (slice_size_of(&size, o->size, e) || choose_probe(j, &p, e) ||
        slice_view_make(&j->view, &p, size, metres(&o->depth, .05), metres(&o->width, 0), e))
        return -1;
    say_scale(j, size);
    return 0;
}

static int make_grey(job *j, err *e)
{
    const struct options *o = j->o;
    slice_knobs k = {o->gain, o->tgc.value, o->tgc.count, 60, 60};
    k.shown = o->range.count ? o->range.value[0] : k.shown;
    k.recorded = o->range.count > 1 ? o->range.value[1] : k.recorded;
    return slice_grey_make(&j->grey, &j->view, &k, e);
}

static int make_overlay(job *j, err *e)
{
    volume labels = {0};
    const volume_budget budget = {.most = j->o->common.memory, .peak = peak_of_labels, .context = &j->cells};
    if (!j->o->labels)
        return 0;
    const int failed = volume_load(&labels, j->o->labels, &budget, e) ||
                       slice_overlay_make(&j->overlay, &labels, &j->cells, j->view.size, e);
    volume_free(&labels);
    return failed ? -1 : 0;
}

static int make_images(job *j, err *e)
{
    const int64_t count = (int64_t)j->view.size.columns * j->view.size.rows;
    j->image = mem_array(count, 1, "an image", e);
    if (!j->image)
        return -1;
    j->colour = j->o->labels ? mem_array(3 * count, 1, "an image", e) : NULL;
    if (j->o->labels && !j->colour)
        return -1;
    if (j->slices < 2)
        return 0;
    j->sum = mem_array(count, sizeof *j->sum, "an image", e);
    j->one = j->sum ? mem_array(count, 1, "an image", e) : NULL;
    return j->one ? 0 : -1;
}

static int make_cutter(job *j, err *e)
{
    const slice_lanes *lanes = slice_lanes_choose(e);
    const slice_setup s = {.cells = &j->cells,
                           .mesh = j->o->rigid ? NULL : &j->mesh,
                           .size = j->view.size,
                           .shown = j->view.shown,
                           .lanes = lanes,
                           .method = j->o->method ? SLICE_PAPER : SLICE_SPANS,
                           .regions = (int)j->o->regions,
                           .threads = j->threads};
    if (!lanes)
        return -1;
    j->cutter = slice_cutter_make(&s, e);
    return j->cutter ? 0 : -1;
}

static int read_body(job *j, err *e)
{
    body b;
    j->place = pose_none();
    if (!j->o->body)
        return 0;
    in *s = in_open(j->o->body, e);
    const int failed = s ? body_read(&b, s, e) : -1;
    in_close(s);
    if (failed)
        return -1;
    j->place = b.volume;
    body_free(&b);
    return 0;
}

/* The poses last: a FIFO opens when its writer comes. */
static int prepare(job *j, const char *path, err *e)
{
    const int threads = tool_threads(j->t, e);
    j->threads = threads > 0 ? pool_create(threads, e) : NULL;
    if (!j->threads || read_thickness(j, e) || read_body(j, e) || slice_writer_open(&j->writer, j->o->common.output, e))
        return -1;
    if (read_volume(j, path, e) || (!j->o->rigid && source_open(&j->model, NULL, e)) || make_view(j, e))
        return -1;
    if (!j->o->rigid && slice_mesh_of(&j->mesh, &j->model.body, &j->cells, source_name(&j->model), e))
        return -1;
    if (make_grey(j, e) || make_overlay(j, e) || make_images(j, e) || make_cutter(j, e))
        return -1;
    if (!j->o->poses)
        return 0;
    j->pose_source = in_open(j->o->poses, e);
    j->more_poses = true;
    return j->pose_source ? poses_open(&j->poses, j->pose_source, j->o->transform, e) : -1;
}

/* ---- images */

/* The mean of the slices; labels are those of the middle one. */
static int draw(job *j, const pose *posed, const double *displacement, slice_plane *at, err *e)
{
    const int64_t count = (int64_t)j->view.size.columns * j->view.size.rows;
    const int n = j->slices;
    *at = slice_view_plane(&j->view, posed, 0);
    if (j->overlay.seen)
        slice_cutter_also(j->cutter, slice_overlay_take, &j->overlay);
    if (slice_cutter_image(j->cutter, at, displacement, j->image, NULL, e))
        return -1;
    if (n == 1)
        return 0;
    slice_cutter_also(j->cutter, NULL, NULL);
    memset(j->sum, 0, (size_t)count * sizeof *j->sum);
    for (int i = 0; i < n; i++) {
        const double off = j->thickness * ((i + .5) / n - .5);
        const slice_plane beside = slice_view_plane(&j->view, posed, off);
        const bool middle = 2 * i + 1 == n;
        if (!middle && slice_cutter_image(j->cutter, &beside, displacement, j->one, NULL, e))
            return -1;
        const uint8_t *from = middle ? j->image : j->one;
        for (int64_t k = 0; k < count; k++)
            j->sum[k] = (uint16_t)(j->sum[k] + from[k]);
    }
    for (int64_t k = 0; k < count; k++)
        j->image[k] = (uint8_t)((2 * j->sum[k] + n) / (2 * n));
    return 0;
}

static int write_cut(job *j, const slice_plane *at, int64_t index, err *e)
{
    int64_t count = 0;
    if (!j->o->cut)
        return 0;
    char *name = slice_files_cut(j->o->cut, index, e);
    out *to = name ? out_open(name, false, e) : NULL;
    free(name);
    if (!to)
        return -1;
    out_text(to, "# us-slice " SINEW_VERSION ": where the slice cuts the tetrahedra; mm, LPS\n");
    const int bad = slice_cut_write(j->cutter, at, &j->model.body, to, &count, e);
    if (!bad)
        tool_detail(j->t, "image %lld: the slice cuts %lld tetrahedra", (long long)index, (long long)count);
    return out_end(to, bad, e);
}

/* Where the image is in the frame that the poses are in. */
static slice_plane placed(const job *j, const slice_plane *at)
{
    pose turn = j->place;
    slice_plane p = {0};
    memset(turn.position, 0, sizeof turn.position);
    pose_apply(&j->place, at->origin, p.origin);
    pose_apply(&turn, at->column, p.column);
    pose_apply(&turn, at->row, p.row);
    return p;
}

/* from: where the probe is, in the volume's frame. */
static int put_image(job *j, int64_t index, const pose *from, const double *displacement, err *e)
{
    const int64_t count = (int64_t)j->view.size.columns * j->view.size.rows;
    const double start = progress_clock();
    slice_plane at;
    if (slice_files_check(j->t, &j->writer, j->o->cut, index, e) || draw(j, from, displacement, &at, e))
        return -1;
    for (int64_t i = 0; !j->lit && i < count; i++)
        j->lit = j->image[i] > 0;
    slice_grey_apply(&j->grey, j->image, 0, count);
    if (j->overlay.seen)
        slice_overlay_paint(&j->overlay, j->image, count, j->colour);
    const double took = progress_clock() - start;
    const slice_plane out_at = placed(j, &at);
    j->images++;
    if (slice_writer_put(&j->writer, index, &out_at, &j->view, j->overlay.seen ? j->colour : j->image,
                         j->overlay.seen ? 3 : 1, e) ||
        write_cut(j, &at, index, e))
        return -1;
    tool_detail(j->t, "image %lld: %.3f ms", (long long)index, 1e3 * took);
    return 0;
}

/* Where poses come from, once the first is there: which transform a sequence gives, it says itself. */
static void say_poses(job *j)
{
    const plus *p = &j->poses.frames;
    const char *in_frame = j->o->body ? "that of the body, in which the volume lies as --body says" : "the volume's";
    if (j->said)
        return;
    j->said = true;
    if (!j->more_poses)
        tool_say(j->t, "poses: those of the frames");
    else if (j->poses.sequence)
        tool_say(j->t, "poses: %sTo%s of %s; their frame is %s", p->from, p->to, in_name(j->pose_source), in_frame);
    else
        tool_say(j->t, "poses: lines of %s; their frame is %s", in_name(j->pose_source), in_frame);
}

/* The next pose, in the volume's frame. 1, 0 at the end, -1. */
static int next_pose(job *j, pose *to, err *e)
{
    poses_event at;
    int got;
    do
        got = poses_next(&j->poses, &at, e);
    while (got > 0 && at.kind != POSES_POSE);
    if (got <= 0)
        return got;
    say_poses(j);
    *to = pose_relative(&j->place, &at.at);
    return 1;
}

static int frame_pose(job *j, pose *to, err *e)
{
    const model_array *row = frame_find(&j->model.frame, "probe.pose");
    if (!row || row->rows < 1)
        return err_set(e, source_name(&j->model), 0,
                       "frame %lld holds no probe.pose; expected frames of msds-run with --poses, or --poses here",
                       (long long)j->model.frame.index);
    say_poses(j);
    *to = pose_of_row(row->f64);
    pose_unit(to->quaternion); /* the model's reader has seen that it is nearly one */
    return 0;
}

/* The displacement of the last frame read; NULL where there was no frame: at rest. */
static int displacement_of(const job *j, const double **to, err *e)
{
    const model_array *u = j->model.frames ? frame_find(&j->model.frame, "node.displacement") : NULL;
    *to = u ? u->f64 : NULL;
    if (!u && j->model.frames)
        return err_set(e, source_name(&j->model), 0,
                       "frame %lld holds no node.displacement; expected frames of msds-run or tled-run",
                       (long long)j->model.frame.index);
    return 0;
}

/* A frame an image. */
static int slice_frames(job *j, err *e)
{
    int got;
    while ((got = source_next(&j->model, e)) > 0) {
        pose from;
        const double *u;
        int posed = j->more_poses ? next_pose(j, &from, e) : 1;
        if (posed < 0 || (!j->more_poses && frame_pose(j, &from, e)) || displacement_of(j, &u, e))
            return -1;
        if (!posed)
            return err_set(e, in_name(j->pose_source), 0,
                           "has %lld poses, fewer than there are frames; expected one each", (long long)j->images);
        if (put_image(j, j->model.frame.index, &from, u, e))
            return -1;
    }
    if (!got && !j->model.frames && !j->more_poses)
        return err_set(e, source_name(&j->model), 0, "the model has no frames; expected those of msds-run, or --poses");
    return got;
}

/* A pose an image: of the volume as it lies, or as the last frame leaves it. */
static int slice_poses(job *j, err *e)
{
    pose from;
    const double *u = NULL;
    int got;
    if (!j->o->rigid && displacement_of(j, &u, e))
        return -1;
    while ((got = next_pose(j, &from, e)) > 0)
        if (put_image(j, j->images, &from, u, e))
            return -1;
    if (!got && !j->images)
        return err_set(e, in_name(j->pose_source), 0, "no pose; expected lines `time tx ty tz qx qy qz qw`");
    return got;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.regions = SLICE_REGIONS};
    err e = {0};
    tool t = {0};
    job j = {.o = &o, .t = &t};
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done || check_options(&o, &e))
        goto out;
    if (prepare(&j, argv[1], &e) || (!o.rigid && slice_frames(&j, &e)) || (j.more_poses && slice_poses(&j, &e)))
        goto out;
    if (!j.lit)
        notes_add(&j.warnings,
                  "every image (of %lld) is black; expected poses in metres, in the volume's frame%s, that look "
                  "into it",
                  (long long)j.images, o.rigid ? "" : " (which is the model's too)");
out:
    tool_warn(&t, &j.warnings);
    slice_writer_close(&j.writer, &e);
    slice_cutter_free(j.cutter);
    slice_overlay_free(&j.overlay);
    slice_grey_free(&j.grey);
    slice_view_free(&j.view);
    slice_mesh_free(&j.mesh);
    slice_cells_free(&j.cells);
    source_close(&j.model);
    in_close(j.pose_source);
    pool_destroy(j.threads);
    free(j.image);
    free(j.colour);
    free(j.one);
    free(j.sum);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
