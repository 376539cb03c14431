/* sinew-render: pictures of a model, ray-traced. */
#include "base/mem.h"
#include "cli/outs.h"
#include "cli/progress.h"
#include "cli/tool.h"
#include "model/source.h"
#include "picture/png.h"
#include "render/render_plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TO(field) offsetof(render_options, field)
static const opt option_table[] = {
    {OPT_ACTION, 0, "show", "THING,...", OPT_LIST, TO(show), 0, 0,
     "surface|voxels|muscles|rigid|centres|probe|@surface.name|@group.name", 0,
     "surface, voxels, muscles, rigid, centres, probe, or names of surfaces and groups [default surface, else voxels]"},
    {OPT_ACTION, 0, "clear", "THING,...", OPT_LIST, TO(clear), 0, 0,
     "surface|voxels|muscles|probe|@surface.name|@group.name", 0, "draw these of them transparent"},
    {OPT_ACTION, 0, "view", "VIEW", OPT_TEXT, TO(view), 0, 0, NULL, 0,
     "front, back, left, right, top, bottom, three-quarter or X,Y,Z [default three-quarter]"},
    {OPT_ACTION, 0, "camera", "EYE,TARGET", OPT_LENGTHS, TO(camera), 0, 6, NULL, 0,
     "position of the camera and of the point in the middle of the picture: X,Y,Z,X,Y,Z [length]"},
    {OPT_ACTION, 0, "angle", "DEGREES", OPT_NUMBER, TO(angle), 0, 120, NULL, 0,
     "field of view; 0: parallel [degrees; default 20]"},
    {OPT_ACTION, 0, "up", "AXIS", OPT_TEXT, TO(up), 0, 0, NULL, 0,
     "axis that points up: x, y, z, -x, -y, -z [default y]"},
    {OPT_ACTION, 0, "front", "AXIS", OPT_TEXT, TO(front), 0, 0, NULL, 0,
     "axis that faces the front [default z, or y if z is up]"},
    {OPT_ACTION, 0, "colour", "FIELD", OPT_TEXT, TO(colour), 0, 0,
     "displacement|strain|strain.max|stress|quality.j.centre|quality.j.corner|volume|material|@array.name", 0,
     "displacement, strain, stress, material, volume, quality.j.corner, ... or an array"},
    {OPT_ACTION, 0, "range", "A,B", OPT_LENGTHS, TO(range), 0, 2, NULL, 0,
     "ends of the colour scale [SI unit or length; default the extremes]"},
    {OPT_ACTION, 0, "cut", "AXIS=POS", OPT_LIST, TO(cut), 0, 0, NULL, 0,
     "open the voxels at a plane, e.g. x=0, +y=2cm [length]"},
    {OPT_INPUT, 0, "body", "FILE", OPT_TEXT, TO(body), 0, 0, NULL, OPT_FILE,
     "draw surfaces of a body file, as us-slice --body"},
    {OPT_INPUT, 0, "slice", "FILE.pgm", OPT_TEXT, TO(slice), 0, 0, NULL, OPT_FILE,
     "draw an image of us-slice where it lies"},
    {OPT_INPUT, 0, "frame", FRAMES_ARG, OPT_TEXT, TO(frame), 0, 0, NULL, 0,
     "all: a file each, -o f_%04d.png [default last]"},
    {OPT_ACTION, 0, "sheet", "PANEL,...", OPT_LIST, TO(sheet), 0, 0, NULL, 0,
     "several panels, such as rest and smile=deformed@front:7: a caption, what is drawn, its view and its frame"},
    {OPT_RESULT, 0, "size", "WxH", OPT_TEXT, TO(size), 0, 0, NULL, 0, "size of the picture [pixels; default 1280x720]"},
    {OPT_RESULT, 0, "transparent", NULL, OPT_FLAG, TO(transparent), 0, 0, NULL, 0, "leave the background transparent"},
    {OPT_RESULT, 0, "format", "png|ppm", OPT_CHOICE, TO(format), 0, 0, "png|ppm", 0,
     "ppm: a stream, e.g. for ffmpeg [default png]"},
    {OPT_RESULT, 0, "font", "FILE", OPT_TEXT, TO(font), 0, 0, NULL, OPT_FILE,
     "font of the words [default DejaVu Sans]"},
    {OPT_INPUT, 0, "salvage", NULL, OPT_FLAG, TO(salvage), 0, 0, NULL, OPT_OUTPUT,
     "use the complete frames of an incomplete stream"},
    {0}};

static const opt_tool table = {
    .name = "sinew-render",
    .command = "sinew render",
    .usage = "[options] model > picture.png\n[options] < model > picture.png",
    .purpose = "Draws a model as a picture (PNG), or its frames as a film.",
    .note = "Lengths are in m, unless they have a suffix (" NUM_UNITS_LIST "), e.g. 5cm.",
    .example = "sinew render --up z --sheet rest,deformed smile.sinew > smile.png",
    .operands = "MODEL",
    .operands_max = 1,
    .threaded = true,
    .options = option_table,
};

typedef struct job {
    const render_options *o;
    const tool *t;
    render_plan plan;
    source s;
    font *font;
    pool *threads;
    picture picture;
    uint8_t *bytes; /* the picture as it is written */
    out *sink;      /* of one picture, or of the stream */
    outs files;
    int64_t drawn;
    frame kept[PICTURE_PANELS]; /* of panels with frames of their own: at the first that names it */
} job;

static int open_sink(job *j, err *e)
{
    if (j->plan.files)
        return 0;
    j->sink = out_open(j->o->common.output, false, e);
    if (!j->sink || !out_is_terminal(j->sink))
        return j->sink ? 0 : -1;
    return err_option(e, j->o->common.output ? j->o->common.output : "stdout",
                      "is a terminal, and a picture is not for reading; expected -o FILE or a pipe");
}

static int open_picture(job *j, err *e)
{
    const picture_spec *s = &j->plan.spec;
    int threads = tool_threads(j->t, e);
    const bool has_text = s->captions || s->field || j->o->font;
    j->threads = threads > 0 ? pool_create(threads, e) : NULL;
    if (!j->threads)
        return -1;
    j->font = has_text ? font_open(j->o->font, e) : NULL;
    if (has_text && !j->font)
        return -1;
    if (picture_open(&j->picture, s, j->font, j->threads, e))
        return -1;
    j->bytes = mem_array(4 * (int64_t)s->width * s->height, 1, "a picture", e);
    return j->bytes ? 0 : -1;
}

/* A bare --range is in SI; one with a unit of length is for lengths. */
static int check_range(const job *j, const frame *f, err *e)
{
    const picture_spec *s = &j->plan.spec;
    field of = {0};
    if (!s->ranged || j->plan.ranged_bare)
        return 0;
    int bad = field_of(&of, &j->s.body, f, s->field, e);
    if (!bad && strcmp(of.si, "m") != 0)
        bad = err_set(e, NULL, 0, "--range: %s is not a length; expected numbers without a unit%s%s", s->field,
                      of.si[0] ? ", in " : "", of.si);
    field_free(&of);
    return bad;
}

static void report(const job *j)
{
    const trace_report *r = &j->picture.report;
    tool_detail(j->t, "%lld faces, %lld spheres, %.2f million rays; tree %.0f ms, rays %.0f ms", (long long)r->faces,
                (long long)r->spheres, (double)r->rays / 1e6, 1e3 * r->build, 1e3 * r->trace);
}

static int put(job *j, out *to, err *e)
{
    const picture_spec *s = &j->plan.spec;
    int channels = s->transparent ? 4 : 3;
    image_bytes(&j->picture.image, channels, j->bytes, j->threads);
    if (j->o->format == RENDER_PNG)
        return png_put(j->bytes, s->width, s->height, channels, to, e);
    out_format(to, "P6\n%d %d\n255\n", s->width, s->height);
    out_write(to, j->bytes, 3 * (size_t)s->width * (size_t)s->height);
    out_flush(to);
    return 0;
}

/* The first panel that names a frame of this index, or -1. */
static int keeps(const job *j, int64_t index)
{
    const picture_spec *s = &j->plan.spec;
    for (int i = 0; i < s->panels; i++)
        if (s->panel[i].framed && s->panel[i].index == index)
            return i;
    return -1;
}

/* Keeps the frame that was read, if a panel names it. */
static void keep(job *j)
{
    const int i = keeps(j, j->s.frame.index);
    if (i < 0 || j->kept[i].arrays.count)
        return;
    j->kept[i] = j->s.frame;
    j->s.frame = (frame){.index = j->kept[i].index, .time = j->kept[i].time};
}

/* The frame that moves a panel, where others are moved by f; NULL: it was not there. */
static const frame *frame_of(const job *j, int panel, const frame *f)
{
    const picture_panel *p = &j->plan.spec.panel[panel];
    const int i = keeps(j, p->framed ? p->index : f ? f->index : -1);
    if (i >= 0)
        return j->kept[i].arrays.count ? &j->kept[i] : NULL;
    return f;
}

static int draw(job *j, const frame *f, err *e)
{
    const frame *of[PICTURE_PANELS];
    for (int i = 0; i < PICTURE_PANELS; i++)
        of[i] = frame_of(j, i, f);
    if ((!j->drawn && check_range(j, of[0], e)) || picture_draw(&j->picture, &j->s.body, of, e))
        return -1;
    j->drawn++;
    report(j);
    if (!j->plan.files || !f)
        return put(j, j->sink, e);
    char *name = numbered_name(&j->plan.names, f->index, e);
    out *to = name && !tool_check_written(j->t, "-o", name, e) ? outs_open(&j->files, name, e) : NULL;
    free(name);
    return out_end(to, to && put(j, to, e), e);
}

static int no_frame(const job *j, int64_t first, const char *option, const char *asked, err *e)
{
    if (!j->s.frames)
        return err_set(e, source_name(&j->s), 0, "%s%s: the model has no frames; expected results, from tled-run",
                       option, asked);
    return err_set(e, source_name(&j->s), 0, "%s%s: no such index; the model has frames %lld to %lld", option, asked,
                   (long long)first, (long long)j->s.frame.index);
}

/* Whether each panel has its frame. */
static int check_kept(const job *j, int64_t first, err *e)
{
    const picture_spec *s = &j->plan.spec;
    char asked[32];
    for (int i = 0; i < s->panels; i++) {
        if (!s->panel[i].framed || frame_of(j, i, NULL))
            continue;
        snprintf(asked, sizeof asked, "%lld", (long long)s->panel[i].index);
        return no_frame(j, first, "--sheet PANEL:", asked, e);
    }
    return 0;
}

/* Reads to the end of the stream, whatever is wanted: only there is it known that the run went well. */
static int draw_frames(job *j, err *e)
{
    int64_t first = 0;
    int got;
    const frames_which which = j->plan.frames;
    bool found = false;
    progress bar = {0};
    progress_start(&bar, "sinew-render", "frames", 0, j->o->common.quiet || which != FRAMES_ALL);
    while ((got = source_next(&j->s, e)) > 0) {
        bool one = which == FRAMES_ONE && !found && j->s.frame.index == j->plan.index;
        first = j->s.frames == 1 ? j->s.frame.index : first;
        found |= one;
        keep(j);
        if ((one || which == FRAMES_ALL) && draw(j, &j->s.frame, e)) {
            got = -1;
            break;
        }
        progress_at(&bar, (double)j->s.frames);
    }
    progress_stop(&bar);
    if (got)
        return -1;
    if ((which == FRAMES_ONE && !found) ||
        (!j->s.frames && (which == FRAMES_ALL || (which == FRAMES_LAST && j->plan.frame_given))))
        return no_frame(j, first, "--frame ", j->plan.frame_given ? j->o->frame : "last", e);
    if (check_kept(j, first, e))
        return -1;
    if (which == FRAMES_REST || which == FRAMES_LAST)
        return draw(j, which == FRAMES_LAST && j->s.frames ? &j->s.frame : NULL, e);
    return 0;
}

static int finish(job *j, err *e)
{
    if (j->plan.files)
        return outs_commit(&j->files, e);
    out *sink = j->sink;
    j->sink = NULL;
    return out_close(sink, e);
}

static void job_close(job *j)
{
    out_discard(j->sink);
    outs_free(&j->files);
    picture_close(&j->picture);
    for (int i = 0; i < PICTURE_PANELS; i++)
        frame_free(&j->kept[i]);
    font_close(j->font);
    if (j->threads)
        pool_destroy(j->threads);
    free(j->bytes);
    source_close(&j->s);
    render_plan_free(&j->plan);
}

static int run_tool(int argc, char **argv)
{
    render_options o = {.size = "1280x720", .angle = 20};
    err e = {0};
    tool t = {0};
    job j = {.o = &o, .t = &t};

    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (render_plan_of(&j.plan, &o, &e) || open_sink(&j, &e) ||
        source_open_part(&j.s, t.operands ? argv[1] : NULL, o.salvage, &e))
        goto out;
    if (open_picture(&j, &e) || draw_frames(&j, &e))
        goto out;
    finish(&j, &e);
out:
    source_end(&j.s, &e);
    job_close(&j);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
