/* sinew-export: a model in the formats of other programs (VTU, Abaqus input, Gmsh, OBJ), or in either of its own. */
#include "base/mem.h"
#include "base/num.h"
#include "cli/frames.h"
#include "cli/outs.h"
#include "cli/tool.h"
#include "exchange/export_inp.h"
#include "exchange/export_model.h"
#include "exchange/export_msh.h"
#include "exchange/export_obj.h"
#include "exchange/export_vtu.h"
#include "model/finite.h"
#include "model/source.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MODEL, VTU, INP, OBJ, MSH };

struct options {
    opt_common common;
    int format, element;
    const char *frame, *surface, *unit;
    bool deformed, salvage;
    opt_numbers gravity;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_RESULT, 'f', "format", "model|vtu|inp|obj|msh", OPT_CHOICE, TO(format), 0, 0, "model|vtu|inp|obj|msh",
     OPT_REQUIRED, "format of the file (model: Sinew's own); required"},
    {OPT_INPUT, 0, "frame", FRAMES_ARG, OPT_TEXT, TO(frame), 0, 0, NULL, 0,
     "vtu, obj, msh: which frame [default last, else rest]"},
    {OPT_ACTION, 0, "deformed", NULL, OPT_FLAG, TO(deformed), 0, 0, NULL, 0,
     "vtu, obj: move the points as the frame says"},
    {OPT_INPUT, 0, "surface", "NAME", OPT_TEXT, TO(surface), 0, 0, "@surface.name", 0,
     "vtu, obj: this surface, in place of elements"},
    {OPT_RESULT, 0, "unit", NUM_UNITS_CHOICES, OPT_TEXT, TO(unit), 0, 0, NULL, 0,
     "obj: unit of length [default the model's]"},
    {OPT_ACTION, 'g', "gravity", "X,Y,Z", OPT_NUMBERS, TO(gravity), 3, 3, NULL, 0, "inp: gravity [m/s2; default none]"},
    {OPT_RESULT, 0, "element", "C3D8R|C3D8", OPT_CHOICE, TO(element), 0, 0, "C3D8R|C3D8", 0,
     "inp: type of hexahedra [default C3D8R]"},
    {OPT_RESULT, 0, "text", NULL, OPT_FLAG, TO(common.text), 0, 0, NULL, OPT_OUTPUT, "model: write the text encoding"},
    {OPT_RESULT, 'z', "gzip", NULL, OPT_FLAG, TO(common.gzip), 0, 0, NULL, OPT_OUTPUT,
     "model, inp, obj, msh: compress with gzip"},
    {OPT_INPUT, 0, "salvage", NULL, OPT_FLAG, TO(salvage), 0, 0, NULL, OPT_OUTPUT,
     "use the complete frames of an incomplete stream"},
    {0},
};

static const opt_tool table = {
    .name = "sinew-export",
    .command = "sinew export",
    .usage = "-f FORMAT [options] model > file\n-f FORMAT [options] < model > file",
    .purpose = "Converts a model to a file for other programs, or to text.",
    .example = "sinew export -f vtu --deformed smile.sinew > smile.vtu",
    .operands = "MODEL",
    .operands_max = 1,
    .options = option_list,
};

/* What was asked for, understood. */
typedef struct job {
    const struct options *o;
    const tool *t;
    frames_which which;
    int64_t index; /* of FRAMES_ONE; in the end, of the frame chosen */
    bool frame_given, chosen;
    num_unit unit;
    source s;
    export_shape x;
    notes warnings;
    char *stem; /* of the files of FRAMES_ALL: NAME of NAME.pvd */
    outs files; /* of FRAMES_ALL */
} job;

static int read_frame_option(job *j, err *e)
{
    const char *f = j->o->frame;
    j->frame_given = f != NULL;
    return frames_asked(f ? f : "last", &j->which, &j->index, e);
}

/* An option that says nothing to this format is a slip, not to be passed over. */
static int check_options(job *j, err *e)
{
    const struct options *o = j->o;
    if (o->format == MODEL && (o->frame || o->deformed || o->surface))
        return err_usage(
            e, "--frame is for vtu, obj and msh, --deformed and --surface for vtu and obj: model is the whole of it");
    if (o->format == INP && (o->frame || o->deformed || o->surface))
        return err_usage(
            e,
            "--frame is for vtu, obj and msh, --deformed and --surface for vtu and obj: inp holds the model at rest");
    if (o->format == MSH && (o->deformed || o->surface))
        return err_usage(e, "--deformed and --surface are for vtu and obj: msh holds the elements at rest");
    if (o->format != MODEL && o->common.text)
        return err_usage(e, "--text is for model");
    if (o->format != INP && (o->gravity.count || o->element))
        return err_usage(e, "--gravity and --element are for inp");
    if (o->format != OBJ && o->unit)
        return err_usage(e, "--unit is for obj; the others are in SI units");
    if (o->format == VTU && o->common.gzip)
        return err_usage(e, "-z is for model, inp, obj and msh; vtu is compressed as it is");
    if (o->unit && !num_unit_of(o->unit))
        return err_usage(e, "--unit '%s': expected " NUM_UNITS, o->unit);
    if (read_frame_option(j, e))
        return -1;
    if (j->which == FRAMES_REST && o->deformed)
        return err_usage(e, "--deformed needs a frame of results; --frame %s selects none", o->frame);
    if (j->which == FRAMES_ALL && o->format != VTU && o->format != MSH)
        return err_usage(e, "--frame all is for vtu and msh; sinew deform --frame all writes an OBJ a frame");
    return 0;
}

/* NAME.pvd gives NAME; the files of frames stand beside it. */
static int read_stem(job *j, err *e)
{
    const char *path = j->o->common.output;
    size_t n = path ? strlen(path) : 0;
    if (n < 5 || strcmp(path + n - 4, ".pvd") != 0 || path[n - 5] == '/')
        return err_usage(e, "--frame all needs -o NAME.pvd; the frames go to NAME_0000.vtu and so on");
    j->stem = mem_text(path, e);
    if (!j->stem)
        return -1;
    j->stem[n - 4] = 0;
    return 0;
}

/* The k-th frame's file; the caller frees it. */
static char *frame_file(const job *j, int64_t k, err *e)
{
    size_t size = strlen(j->stem) + 32;
    char *name = mem_array((int64_t)size, 1, "a file name", e);
    if (name)
        snprintf(name, size, "%s_%04" PRId64 ".vtu", j->stem, k);
    return name;
}

static int put_frame_file(job *j, const char *file, err *e)
{
    out *to = tool_check_written(j->t, "-o", file, e) ? NULL : outs_open(&j->files, file, e);
    return out_end(to, to && export_vtu(&j->x, j->o->deformed, to, e), e);
}

/* What could not be moved is not passed off as moved. */
static int check_moved(const job *j, err *e)
{
    if (!j->o->deformed || j->x.displacement)
        return 0;
    if (!frame_find(j->x.f, "node.displacement"))
        return err_set(e, source_name(&j->s), 0, "--deformed: the frame has no node.displacement%s",
                       j->x.is_surface ? ", nor that of the surface" : "");
    return err_set(e, source_name(&j->s), 0, "--deformed: surface %s is not bound; expected a model from sinew bind",
                   j->o->surface);
}

/* Which frame is written now, if any. */
static void note_frame(job *j, const frame *f)
{
    j->chosen = f != NULL;
    j->index = f ? f->index : j->index;
}

/* Each frame as it comes, in a file of its own. */
static int put_all_frames(job *j, out *collection, err *e)
{
    int got;
    export_pvd_begin(collection);
    while ((got = source_next(&j->s, e)) > 0) {
        char *file = frame_file(j, j->s.frames - 1, e);
        note_frame(j, &j->s.frame);
        int bad = !file || export_shape_move(&j->x, &j->s.frame, e) || check_moved(j, e) || put_frame_file(j, file, e);
        if (!bad) {
            const char *slash = strrchr(file, '/');
            export_pvd_add(collection, j->s.frame.time, slash ? slash + 1 : file);
        }
        free(file);
        if (bad)
            return -1;
    }
    export_pvd_end(collection);
    if (!got && !j->s.frames)
        return source_no_frame(&j->s, "all", e);
    return got;
}

/* Each frame as it comes, in the one file. */
static int put_all_data(job *j, out *to, err *e)
{
    int got;
    export_msh(&j->x, to);
    while ((got = source_next(&j->s, e)) > 0) {
        note_frame(j, &j->s.frame);
        if (export_shape_move(&j->x, &j->s.frame, e))
            return -1;
        export_msh_frame(&j->x, to);
    }
    if (!got && !j->s.frames)
        return source_no_frame(&j->s, "all", e);
    return got;
}

/* Reads to the end of the stream, keeping the frame asked for in *kept (it is f's
 * from then on). NULL in *chosen: rest. */
static int choose_frame(job *j, frame *kept, const frame **chosen, err *e)
{
    int got;
    *chosen = NULL;
    while ((got = source_next(&j->s, e)) > 0)
        if (j->which == FRAMES_ONE && !*chosen && j->s.frame.index == j->index) {
            *kept = j->s.frame;
            j->s.frame = (frame){.index = kept->index};
            *chosen = kept;
        }
    if (got < 0)
        return -1;
    if (j->which == FRAMES_LAST && j->s.frames)
        *chosen = &j->s.frame;
    if (!*chosen && (j->which == FRAMES_ONE || (j->which == FRAMES_LAST && j->frame_given)))
        return source_no_frame(&j->s, j->o->frame, e);
    if (!*chosen && j->o->deformed)
        return err_set(e, source_name(&j->s), 0,
                       "--deformed: the model has no frames; expected results, from tled-run");
    return 0;
}

static int put_one(job *j, out *to, err *e)
{
    if (j->o->format == VTU)
        return export_vtu(&j->x, j->o->deformed, to, e);
    if (j->o->format == OBJ)
        return export_obj(&j->x, j->o->deformed, j->unit, to, e);
    if (j->o->format == MSH) {
        export_msh(&j->x, to);
        export_msh_frame(&j->x, to);
        return 0;
    }
    export_inp_options options = {.element = j->o->element ? "C3D8" : "C3D8R"};
    memcpy(options.gravity, j->o->gravity.value, sizeof options.gravity);
    return export_inp(&j->s.body, &options, to, &j->warnings, e);
}

/* An OBJ overlays the one that the model was made from, unless another unit is asked for. */
static int choose_unit(job *j, err *e)
{
    const char *name = j->o->unit ? j->o->unit : model_meta_of(&j->s.body, "source.unit");
    j->unit = num_unit_of(name ? name : "m");
    return j->unit ? 0 : err_set(e, source_name(&j->s), 0, "source.unit '%.40s': expected " NUM_UNITS, name);
}

/* Where other programs calculate, an element needs an inside. */
static int check_rest(const job *j, err *e)
{
    return j->o->surface ? 0 : finite_elements(&j->s.body, source_name(&j->s), e);
}

static int work(job *j, out *to, err *e)
{
    frame kept = {0};
    const frame *chosen;
    if (choose_unit(j, e) || check_rest(j, e))
        return -1;
    if (j->o->format != INP && export_shape_of(&j->x, &j->s.body, j->o->surface, e))
        return -1;
    if (j->which == FRAMES_ALL)
        return j->o->format == MSH ? put_all_data(j, to, e) : put_all_frames(j, to, e);
    int bad = choose_frame(j, &kept, &chosen, e);
    if (!bad && j->o->format != INP)
        bad = export_shape_move(&j->x, chosen, e) || check_moved(j, e) ? -1 : 0;
    note_frame(j, chosen);
    if (!bad)
        bad = put_one(j, to, e);
    frame_free(&kept);
    return bad;
}

/* -v: what was written. */
static void say(const job *j, const tool *t)
{
    if (j->o->format == MODEL)
        tool_detail(t, "%" PRId64 " frame%s written", j->s.frames, j->s.frames == 1 ? " is" : "s are");
    else if (j->o->format == INP)
        tool_detail(t, "%" PRId64 " nodes and %" PRId64 " elements at rest", model_count(&j->s.body, "node"),
                    model_count(&j->s.body, "element"));
    else if (j->which == FRAMES_ALL)
        tool_detail(t, "%" PRId64 " points and %" PRId64 " cells in each of %" PRId64 " frames", j->x.points,
                    j->x.cells, j->s.frames);
    else if (j->chosen)
        tool_detail(t, "%" PRId64 " points and %" PRId64 " cells, %s frame %" PRId64, j->x.points, j->x.cells,
                    j->o->deformed ? "moved by" : "at rest, with", j->index);
    else
        tool_detail(t, "%" PRId64 " points and %" PRId64 " cells at rest", j->x.points, j->x.cells);
}

/* Writes what is not a model: a file, or a collection of files. */
static void put_file(job *j, const char *path, err *e)
{
    const opt_common *c = &j->o->common;
    if (source_open_part(&j->s, path, j->o->salvage, e))
        return;
    out *to = j->which == FRAMES_ALL && j->o->format == VTU ? outs_open(&j->files, c->output, e)
                                                            : out_open(c->output, c->gzip, e);
    if (!out_end(to, to && work(j, to, e), e))
        outs_commit(&j->files, e);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {0};
    err e = {0};
    tool t = {0};
    job j = {.o = &o, .t = &t};
    stage copy = {0};

    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (check_options(&j, &e) || (j.which == FRAMES_ALL && o.format == VTU && read_stem(&j, &e)))
        goto out;
    if (o.format == MODEL)
        export_model(&j.s, t.operands ? argv[1] : NULL, o.salvage, &copy, &t, &e);
    else
        put_file(&j, t.operands ? argv[1] : NULL, &e);
    if (!e.status)
        say(&j, &t);
out:
    if (!t.done && o.format == MODEL)
        stage_close(&copy, &t, &e);
    outs_free(&j.files);
    if (!e.status)
        tool_warn(&t, &j.warnings);
    source_end(&j.s, &e);
    notes_free(&j.warnings);
    export_shape_free(&j.x);
    source_close(&j.s);
    free(j.stem);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
