#include "slice/image/slice_session.h"

#include "base/checksum.h"
#include "base/clock.h"
#include "base/mem.h"
#include "live/stop.h"
#include "slice/image/slice_cut.h"
#include "slice/image/slice_files.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* Of its voxels and where they lie. */
static uint32_t checksum_of(const volume *v)
{
    uint32_t crc = checksum_add(0, v->size, sizeof v->size);
    crc = checksum_add(crc, v->origin, sizeof v->origin);
    crc = checksum_add(crc, v->axis, sizeof v->axis);
    return checksum_add(crc, v->data, (size_t)volume_count(v) * volume_type_size(v->type));
}

static int read_volume(slice_session *s, const char *path, err *e)
{
    volume v = {0};
    const volume_budget budget = {.most = s->o.common.memory, .peak = peak_of_volume, .check = slice_cells_check};
    if (!s->o.rigid && !strcmp(path, "-"))
        return err_usage(e, "the volume is '-', but standard input holds the model; expected a file");
    if (volume_load(&v, path, &budget, e))
        return -1;
    slice_window w = slice_window_of(&v);
    if (s->o.window.count)
        w = (slice_window){s->o.window.value[0], s->o.window.value[1]};
    s->window = w;
    if (s->o.record || s->o.replay)
        s->volume_crc = checksum_of(&v);
    if (w.low != 0 || w.high != 255)
        tool_say(s->t, "black is %.6g, white %.6g", w.low, w.high);
    const int failed = slice_cells_make(&s->cells, &v, w, s->threads, e);
    volume_free(&v);
    return failed;
}

/* The array that pressed, as the model says it. 1: it makes no image, or none is known, and *p is as it was; why says
 * which. -1: e filled. */
static int pressed_by(const slice_session *s, slice_probe *p, char *why, size_t size, err *e)
{
    const char *text = s->o.rigid ? NULL : model_meta_of(&s->model.body, "probe.shape");
    err wrong = {0};
    if (!text) {
        snprintf(why, size, s->o.rigid ? "no --probe" : "the model has no probe.shape");
        return 1;
    }
    const int none = !strncmp(text, "convex:", 7) ? 1 : slice_probe_of(p, text, &wrong);
    snprintf(why, size, "the model's probe.shape, %.100s, makes no image", text);
    return none < 0
               ? err_set(e, source_name(&s->model), 0,
                         "metadata, probe.shape: '%.100s' is not a probe; expected one as msds-run writes it", text)
               : none;
}

/* The text of the image's array, for a record. */
static void keep_probe(slice_session *s, const char *otherwise)
{
    snprintf(s->probe, sizeof s->probe, "%s", s->o.probe ? s->o.probe : otherwise);
}

/* The image's array: --probe's; else that of the model; else a usual one. */
static int choose_probe(slice_session *s, slice_probe *p, err *e)
{
    slice_probe pressed = {0};
    char why[160];
    const int none = pressed_by(s, &pressed, why, sizeof why, e);
    if (none < 0)
        return -1;
    *p = pressed;
    keep_probe(s, none ? "linear:4cm,1cm" : model_meta_of(&s->model.body, "probe.shape"));
    if (!s->o.probe) {
        if (none)
            *p = (slice_probe){.array = SLICE_LINEAR, .width = .04};
        tool_say(s->t,
                 none ? "%s: the image is that of a linear array of 4 cm; --probe says another"
                      : "probe: %s, the model's probe.shape",
                 none ? why : model_meta_of(&s->model.body, "probe.shape"));
        return 0;
    }
    const int bad = slice_probe_of(p, s->o.probe, e);
    if (bad > 0)
        return err_usage(e, "--probe %.100s makes no image; expected linear:W,T, curved:R,ANGLE,T or phased:ANGLE",
                         s->o.probe);
    if (!bad && !none && p->array != SLICE_PHASED && !slice_probe_same(p, &pressed)) {
        const char *text = model_meta_of(&s->model.body, "probe.shape");
        notes_add(&s->warnings,
                  "the image is that of %.100s, but %.100s pressed (the model's probe.shape); expected --probe %.100s, "
                  "or none",
                  s->o.probe, text, text);
        tool_warn(s->t, &s->warnings);
    }
    return bad ? -1 : 0;
}

/* Where pixels are not square, in two sides that were asked for; or in one that could only be 2. */
static void say_scale(const slice_session *s, slice_size asked)
{
    const double *pixel = s->view.pixel, off = fabs(pixel[0] - pixel[1]) / fmin(pixel[0], pixel[1]);
    const bool both = asked.columns && asked.rows;
    char remedy[40] = "more pixels are";
    if (both)
        snprintf(remedy, sizeof remedy, "--size %d is", (int)asked.columns);
    if (off > (both ? .01 : .2))
        tool_say(s->t, "pixels are %.4g mm wide and %.4g mm high: the image is not to scale; %s", 1e3 * pixel[0],
                 1e3 * pixel[1], remedy);
}

static int make_view(slice_session *s, err *e)
{
    const slice_options *o = &s->o;
    slice_probe p;
    slice_size size;
    if (slice_size_of(&size, o->size, e) || choose_probe(s, &p, e) ||
        slice_view_make(&s->view, &p, size, slice_options_metres(&o->depth, SLICE_DEPTH),
                        slice_options_metres(&o->width, 0), e))
        return -1;
    say_scale(s, size);
    return 0;
}

/* R of slice_grey.h. */
static double recorded_range(const slice_options *o)
{
    return o->range.count > 1 ? o->range.value[1] : SLICE_RANGE;
}

static int make_grey(const slice_session *s, const slice_view *view, slice_grey *to, err *e)
{
    const slice_options *o = &s->o;
    slice_knobs k = {o->gain, o->tgc.value, o->tgc.count, SLICE_RANGE, recorded_range(o)};
    k.shown = o->range.count ? o->range.value[0] : k.shown;
    return slice_grey_make(to, view, &k, e);
}

static int make_coupling(const slice_session *s, const slice_view *view, slice_coupling *to, err *e)
{
    const double gap = slice_options_metres(&s->o.coupling, 0);
    *to = (slice_coupling){0};
    return gap > 0 ? slice_coupling_make(to, view, gap, recorded_range(&s->o), e) : 0;
}

static int take_labels(slice_session *s, volume *labels, err *e)
{
    if (s->o.record || s->o.replay)
        s->labels_crc = checksum_of(labels);
    s->labels = true;
    return slice_overlay_make(&s->overlay, labels, &s->cells, s->view.size, e);
}

static int make_overlay(slice_session *s, err *e)
{
    volume labels = {0};
    const volume_budget budget = {.most = s->o.common.memory, .peak = peak_of_labels, .context = &s->cells};
    if (!s->o.labels)
        return 0;
    const int failed = volume_load(&labels, s->o.labels, &budget, e) || take_labels(s, &labels, e);
    volume_free(&labels);
    return failed ? -1 : 0;
}

/* Room for the mean of several slices. */
static int make_sum(slice_session *s, err *e)
{
    const int64_t count = (int64_t)s->view.size.columns * s->view.size.rows;
    if (s->slices > 1 && !s->sum)
        s->sum = mem_array(count, sizeof *s->sum, "an image", e);
    if (s->slices > 1 && s->sum && !s->one)
        s->one = mem_array(count, 1, "an image", e);
    return s->slices < 2 || s->one ? 0 : -1;
}

static int make_images(slice_session *s, err *e)
{
    const int64_t count = (int64_t)s->view.size.columns * s->view.size.rows;
    s->image = mem_array(count, 1, "an image", e);
    if (!s->image)
        return -1;
    s->colour = s->o.labels ? mem_array(3 * count, 1, "an image", e) : NULL;
    if (s->o.labels && !s->colour)
        return -1;
    return make_sum(s, e);
}

/* NULL with e filled. */
static slice_cutter *make_cutter(const slice_session *s, const slice_view *view, err *e)
{
    const slice_lanes *lanes = slice_lanes_choose(e);
    const slice_setup setup = {.cells = &s->cells,
                               .mesh = s->o.rigid ? NULL : &s->mesh,
                               .size = view->size,
                               .shown = view->shown,
                               .lanes = lanes,
                               .method = s->o.method ? SLICE_PAPER : SLICE_SPANS,
                               .regions = (int)s->o.regions,
                               .threads = s->threads};
    return lanes ? slice_cutter_make(&setup, e) : NULL;
}

/* What is drawn with, once the volume and the model are there. */
static int make_tools(slice_session *s, err *e)
{
    if (make_grey(s, &s->view, &s->grey, e) || make_coupling(s, &s->view, &s->coupling, e) || make_overlay(s, e) ||
        make_images(s, e))
        return -1;
    s->cutter = make_cutter(s, &s->view, e);
    return s->cutter ? 0 : -1;
}

static int open_inputs(slice_session *s, const char *path, err *e)
{
    return read_volume(s, path, e) || (!s->o.rigid && source_open(&s->model, NULL, e)) ? -1 : 0;
}

static int open_output(slice_session *s, err *e)
{
    if (s->o.live)
        stop_catch();
    return slice_writer_open(&s->writer, s->o.common.output, e);
}

/* While a live run waits for its model, a signal ends it at once. */
static int open_streams(slice_session *s, const char *path, err *e)
{
    if (s->o.live)
        return open_inputs(s, path, e) || open_output(s, e) ? -1 : 0;
    return open_output(s, e) || open_inputs(s, path, e) ? -1 : 0;
}

int slice_session_open(slice_session *s, const slice_options *o, const tool *t, const char *path, err *e)
{
    *s = (slice_session){.t = t, .o = *o};
    const int threads = tool_threads(t, e);
    s->threads = threads > 0 ? pool_create(threads, e) : NULL;
    if (!s->threads || slice_options_thickness(&s->o, &s->thick, &s->slices, e) ||
        placing_read(&s->placing, s->o.body, s->o.marker, NULL, e) || open_streams(s, path, e) || make_view(s, e))
        return -1;
    if (!s->o.rigid && slice_mesh_of(&s->mesh, &s->model.body, &s->cells, source_name(&s->model), e))
        return -1;
    return make_tools(s, e);
}

void slice_session_close(slice_session *s, err *e)
{
    slice_writer_close(&s->writer, e);
    slice_cutter_free(s->cutter);
    slice_overlay_free(&s->overlay);
    slice_coupling_free(&s->coupling);
    slice_grey_free(&s->grey);
    slice_view_free(&s->view);
    slice_mesh_free(&s->mesh);
    slice_cells_free(&s->cells);
    source_close(&s->model);
    pool_destroy(s->threads);
    free(s->image);
    free(s->colour);
    free(s->one);
    free(s->sum);
}

/* ---- settings that change */

int slice_session_set_grey(slice_session *s, err *e)
{
    slice_grey grey;
    slice_coupling coupling = {0};
    if (make_grey(s, &s->view, &grey, e))
        return -1;
    if (make_coupling(s, &s->view, &coupling, e)) {
        slice_coupling_free(&coupling);
        slice_grey_free(&grey);
        return -1;
    }
    slice_coupling_free(&s->coupling);
    slice_grey_free(&s->grey);
    s->coupling = coupling;
    s->grey = grey;
    return 0;
}

static int make_new_view(const slice_session *s, slice_view *to, err *e)
{
    slice_probe p;
    /* A line opens no file. */
    const int bad = strncmp(s->probe, "convex:", 7) ? slice_probe_of(&p, s->probe, e) : 1;
    if (bad > 0)
        return err_usage(e, "--probe %.100s makes no image; expected linear:W,T, curved:R,ANGLE,T or phased:ANGLE",
                         s->probe);
    return bad || slice_view_make(to, &p, s->view.size, slice_options_metres(&s->o.depth, SLICE_DEPTH),
                                  slice_options_metres(&s->o.width, 0), e)
               ? -1
               : 0;
}

int slice_session_set_view(slice_session *s, err *e)
{
    slice_view view = {0};
    slice_grey grey = {0};
    slice_coupling coupling = {0};
    slice_cutter *cutter = NULL;
    if (!make_new_view(s, &view, e) && !make_grey(s, &view, &grey, e) && !make_coupling(s, &view, &coupling, e))
        cutter = make_cutter(s, &view, e);
    if (!cutter) {
        slice_coupling_free(&coupling);
        slice_grey_free(&grey);
        slice_view_free(&view);
        return -1;
    }
    slice_cutter_free(s->cutter);
    slice_coupling_free(&s->coupling);
    slice_grey_free(&s->grey);
    slice_view_free(&s->view);
    s->coupling = coupling;
    s->cutter = cutter;
    s->grey = grey;
    s->view = view;
    return 0;
}

int slice_session_set_thickness(slice_session *s, err *e)
{
    double thick = 0;
    int slices;
    if (slice_options_thickness(&s->o, &thick, &slices, e))
        return -1;
    s->thick = thick;
    s->slices = slices;
    return make_sum(s, e);
}

/* ---- images */

/* One slice, in which beams that enter no tissue are dark. */
static int draw_slice(slice_session *s, const slice_plane *at, const double *displacement, uint8_t *to, err *e)
{
    if (slice_cutter_image(s->cutter, at, displacement, to, NULL, e))
        return -1;
    if (!s->coupling.beams)
        return 0;
    slice_coupling_find(&s->coupling, s->cutter);
    slice_coupling_darken(&s->coupling, to);
    return 0;
}

/* The mean of the slices; labels are those of the middle one. */
static int draw(slice_session *s, const pose *posed, const double *displacement, slice_plane *at, err *e)
{
    const int64_t count = (int64_t)s->view.size.columns * s->view.size.rows;
    const int n = s->slices;
    *at = slice_view_plane(&s->view, posed, 0);
    if (s->labels)
        slice_cutter_also(s->cutter, slice_overlay_take, &s->overlay);
    if (draw_slice(s, at, displacement, s->image, e))
        return -1;
    if (s->labels)
        slice_coupling_hide(&s->coupling, s->overlay.seen);
    if (n == 1)
        return 0;
    slice_cutter_also(s->cutter, NULL, NULL);
    memset(s->sum, 0, (size_t)count * sizeof *s->sum);
    for (int i = 0; i < n; i++) {
        const double off = s->thick * ((i + .5) / n - .5);
        const slice_plane beside = slice_view_plane(&s->view, posed, off);
        const bool middle = 2 * i + 1 == n;
        if (!middle && draw_slice(s, &beside, displacement, s->one, e))
            return -1;
        const uint8_t *from = middle ? s->image : s->one;
        for (int64_t k = 0; k < count; k++)
            s->sum[k] = (uint16_t)(s->sum[k] + from[k]);
    }
    for (int64_t k = 0; k < count; k++)
        s->image[k] = (uint8_t)((2 * s->sum[k] + n) / (2 * n));
    return 0;
}

static int write_cut(slice_session *s, const slice_plane *at, int64_t index, err *e)
{
    int64_t count = 0;
    if (!s->o.cut)
        return 0;
    char *name = slice_files_cut(s->o.cut, index, e);
    out *to = name ? out_open(name, false, e) : NULL;
    free(name);
    if (!to)
        return -1;
    out_text(to, "# us-slice " SINEW_VERSION ": where the slice cuts the tetrahedra; mm, LPS\n");
    const int bad = slice_cut_write(s->cutter, at, &s->model.body, to, &count, e);
    if (!bad)
        tool_detail(s->t, "image %lld: the slice cuts %lld tetrahedra", (long long)index, (long long)count);
    return out_end(to, bad, e);
}

/* Where the image is in the frame that the poses are in. */
static slice_plane placed(const slice_session *s, const slice_plane *at)
{
    pose turn = s->placing.body;
    slice_plane p = {0};
    memset(turn.position, 0, sizeof turn.position);
    pose_apply(&s->placing.body, at->origin, p.origin);
    pose_apply(&turn, at->column, p.column);
    pose_apply(&turn, at->row, p.row);
    return p;
}

/* from: where the probe is, in the volume's frame. */
int slice_session_put(slice_session *s, int64_t index, const pose *from, const double *displacement, err *e)
{
    const int64_t count = (int64_t)s->view.size.columns * s->view.size.rows;
    const double start = clock_now();
    slice_plane at;
    if (slice_files_check(s->t, &s->writer, s->o.cut, index, e) || draw(s, from, displacement, &at, e))
        return -1;
    for (int64_t i = 0; !s->lit && i < count; i++)
        s->lit = s->image[i] > 0;
    slice_grey_apply(&s->grey, s->image, 0, count);
    if (s->overlay.seen)
        slice_overlay_paint(&s->overlay, s->image, count, s->colour);
    const double took = clock_now() - start;
    const slice_plane out_at = placed(s, &at);
    s->images++;
    if (slice_writer_put(&s->writer, index, &out_at, &s->view, s->overlay.seen ? s->colour : s->image,
                         s->overlay.seen ? 3 : 1, e) ||
        write_cut(s, &at, index, e))
        return -1;
    tool_detail(s->t, "image %lld: %.3f ms", (long long)index, 1e3 * took);
    return 0;
}

const double *slice_session_displacement(const slice_session *s, const frame *f, err *e)
{
    const model_array *u = frame_find(f, "node.displacement");
    if (!u)
        err_set(e, source_name(&s->model), 0,
                "frame %lld holds no node.displacement; expected frames of msds-run or tled-run", (long long)f->index);
    return u ? u->f64 : NULL;
}

int slice_session_pose(const slice_session *s, const frame *f, pose *to, err *e)
{
    const model_array *row = frame_find(f, "probe.pose");
    if (!row || row->rows < 1)
        return err_set(e, source_name(&s->model), 0,
                       "frame %lld holds no probe.pose; expected frames of msds-run with --poses, or --poses here",
                       (long long)f->index);
    *to = pose_of_row(row->f64);
    pose_unit(to->quaternion); /* the model's reader has seen that it is nearly one */
    return 0;
}
