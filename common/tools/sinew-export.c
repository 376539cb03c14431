/* sinew-export: a model in the formats of other programs: VTU, Abaqus input, OBJ. */
#include "base/mem.h"
#include "base/num.h"
#include "base/outs.h"
#include "base/tool.h"
#include "model/source.h"
#include "tools/export_inp.h"
#include "tools/export_obj.h"
#include "tools/export_vtu.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VTU, INP, OBJ };
enum { REST, LAST, ALL, ONE };

struct options {
    opt_common common;
    int format, element;
    const char *frame, *surface, *unit;
    bool deformed;
    opt_numbers gravity;
};

static const opt option_table[] = {{'f', "format", "vtu|inp|obj", OPT_CHOICE, offsetof(struct options, format), 0, 0,
                                    "vtu|inp|obj", OPT_REQUIRED, "the format"},
                                   {0, "frame", "N|last|all|rest", OPT_TEXT, offsetof(struct options, frame), 0, 0,
                                    NULL, 0, "vtu, obj: which frame (last, if any)"},
                                   {0, "deformed", NULL, OPT_FLAG, offsetof(struct options, deformed), 0, 0, NULL, 0,
                                    "vtu, obj: points as the frame moved them"},
                                   {0, "surface", "NAME", OPT_TEXT, offsetof(struct options, surface), 0, 0, NULL, 0,
                                    "vtu, obj: a carried surface, not the elements"},
                                   {0, "unit", "mm|cm|m|in", OPT_TEXT, offsetof(struct options, unit), 0, 0, NULL, 0,
                                    "obj: unit of length (the model's source.unit)"},
                                   {'g', "gravity", "X,Y,Z", OPT_NUMBERS, offsetof(struct options, gravity), 3, 3, NULL,
                                    0, "inp: gravity, m/s2 (none)"},
                                   {0, "element", "C3D8R|C3D8", OPT_CHOICE, offsetof(struct options, element), 0, 0,
                                    "C3D8R|C3D8", 0, "inp: type of hexahedra (C3D8R)"},
                                   {'z', "gzip", NULL, OPT_FLAG, offsetof(struct options, common.gzip), 0, 0, NULL,
                                    OPT_OUTPUT, "inp, obj: gzip the file"},
                                   {0}};

static const opt_tool table = {
    .name = "sinew-export",
    .purpose = "Writes the model on standard input (or MODEL) for other programs.",
    .operands = "MODEL",
    .operands_max = 1,
    .options = option_table,
};

/* What was asked for, understood. */
typedef struct job {
    const struct options *o;
    int which;     /* REST, LAST, ALL or ONE */
    int64_t index; /* of ONE */
    bool frame_given;
    num_unit unit;
    source s;
    export_shape x;
    notes warnings;
    char *stem; /* of the files of ALL: NAME of NAME.pvd */
    outs files; /* of ALL */
} job;

static int read_frame_option(job *j, err *e)
{
    const char *f = j->o->frame;
    j->frame_given = f != NULL;
    j->which = !f || !strcmp(f, "last") ? LAST : !strcmp(f, "all") ? ALL : !strcmp(f, "rest") ? REST : ONE;
    if (j->which != ONE || !num_int(f, INT64_MIN, INT64_MAX, &j->index))
        return 0;
    return err_usage(e, "--frame '%s': expected a frame's index, last, all or rest", f);
}

/* An option that says nothing to this format is a slip, not to be passed over. */
static int check_options(job *j, err *e)
{
    const struct options *o = j->o;
    if (o->format == INP && (o->frame || o->deformed || o->surface))
        return err_usage(e, "--frame, --deformed and --surface are for vtu and obj: inp holds the model at rest");
    if (o->format != INP && (o->gravity.count || o->element))
        return err_usage(e, "--gravity and --element are for inp");
    if (o->format != OBJ && o->unit)
        return err_usage(e, "--unit is for obj; vtu and inp are in SI units");
    if (o->format == VTU && o->common.gzip)
        return err_usage(e, "-z is for inp and obj; vtu is compressed as it is");
    if (o->unit && !num_unit_of(o->unit))
        return err_usage(e, "--unit: expected " NUM_UNITS);
    if (read_frame_option(j, e))
        return -1;
    if (j->which == REST && o->deformed)
        return err_usage(e, "--deformed wants a frame; --frame rest has none");
    if (j->which == ALL && o->format != VTU)
        return err_usage(e, "--frame all is for vtu; sinew deform --frame all writes an OBJ a frame");
    return 0;
}

/* NAME.pvd gives NAME; the files of frames stand beside it. */
static int read_stem(job *j, err *e)
{
    const char *path = j->o->common.output;
    size_t n = path ? strlen(path) : 0;
    if (n < 5 || strcmp(path + n - 4, ".pvd") != 0 || path[n - 5] == '/')
        return err_usage(e, "--frame all wants -o NAME.pvd; the frames go to NAME_0000.vtu and so on");
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
    out *to = outs_open(&j->files, file, e);
    if (!to)
        return -1;
    if (export_vtu(&j->x, j->o->deformed, to, e)) {
        out_discard(to);
        return -1;
    }
    return out_close(to, e);
}

/* What could not be moved is not passed off as moved. */
static int check_moved(const job *j, err *e)
{
    if (!j->o->deformed || j->x.displacement)
        return 0;
    if (!frame_find(j->x.f, "node.displacement"))
        return err_set(e, source_name(&j->s), 0, "--deformed: the frame has no node.displacement");
    return err_set(e, source_name(&j->s), 0, "--deformed: surface %s is not bound; expected a model from sinew bind",
                   j->o->surface);
}

/* Each frame as it comes, in a file of its own. */
static int put_all_frames(job *j, out *collection, err *e)
{
    int got;
    export_pvd_begin(collection);
    while ((got = source_next(&j->s, e)) > 0) {
        char *file = frame_file(j, j->s.frames - 1, e);
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
        return err_set(e, source_name(&j->s), 0, "--frame all: the model has no frames");
    return got;
}

static int no_frame(const job *j, int64_t first, err *e)
{
    if (!j->s.frames)
        return err_set(e, source_name(&j->s), 0, "--frame %s: the model has no frames", j->o->frame);
    return err_set(e, source_name(&j->s), 0, "--frame %s: no such index; the model has frames %" PRId64 " to %" PRId64,
                   j->o->frame, first, j->s.frame.index);
}

/* Reads to the end of the stream, keeping the frame asked for in *kept (it is f's from then on). NULL in *chosen: rest. */
static int choose_frame(job *j, frame *kept, const frame **chosen, err *e)
{
    int64_t first = 0;
    int got;
    *chosen = NULL;
    while ((got = source_next(&j->s, e)) > 0) {
        first = j->s.frames == 1 ? j->s.frame.index : first;
        if (j->which == ONE && !*chosen && j->s.frame.index == j->index) {
            *kept = j->s.frame;
            j->s.frame = (frame){.index = kept->index};
            *chosen = kept;
        }
    }
    if (got < 0)
        return -1;
    if (j->which == LAST && j->s.frames)
        *chosen = &j->s.frame;
    if (!*chosen && (j->which == ONE || (j->which == LAST && j->frame_given)))
        return no_frame(j, first, e);
    if (!*chosen && j->o->deformed)
        return err_set(e, source_name(&j->s), 0, "--deformed: the model has no frames");
    return 0;
}

static int put_one(job *j, out *to, err *e)
{
    if (j->o->format == VTU)
        return export_vtu(&j->x, j->o->deformed, to, e);
    if (j->o->format == OBJ)
        return export_obj(&j->x, j->o->deformed, j->unit, to, e);
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

static int work(job *j, out *to, err *e)
{
    frame kept = {0};
    const frame *chosen;
    if (choose_unit(j, e))
        return -1;
    if (j->o->format != INP && export_shape_of(&j->x, &j->s.body, j->o->surface, e))
        return -1;
    if (j->which == ALL)
        return put_all_frames(j, to, e);
    int bad = choose_frame(j, &kept, &chosen, e);
    if (!bad && j->o->format != INP)
        bad = export_shape_move(&j->x, chosen, e) || check_moved(j, e) ? -1 : 0;
    if (!bad)
        bad = put_one(j, to, e);
    frame_free(&kept);
    return bad;
}

int main(int argc, char **argv)
{
    struct options o = {0};
    job j = {.o = &o};
    err e = {0};
    tool t = {0};
    out *to = NULL;

    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (check_options(&j, &e) || (j.which == ALL && read_stem(&j, &e)))
        goto out;
    if (source_open(&j.s, t.operands ? argv[1] : NULL, &e))
        goto out;
    to = j.which == ALL ? outs_open(&j.files, o.common.output, &e) : out_open(o.common.output, o.common.gzip, &e);
    if (to && !work(&j, to, &e)) {
        out_close(to, &e);
        to = NULL;
    }
    if (!e.status)
        outs_commit(&j.files, &e);
out:
    out_discard(to);
    outs_free(&j.files);
    if (!e.status)
        tool_warn(&t, &j.warnings);
    notes_free(&j.warnings);
    export_shape_free(&j.x);
    source_close(&j.s);
    free(j.stem);
    return tool_end(&t, &e);
}
