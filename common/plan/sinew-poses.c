/* sinew-poses: a file of poses from a plan of what a probe does, a line each. */
#include "cli/tool.h"
#include "plan/plan.h"

#include <inttypes.h>
#include <string.h>

struct options {
    opt_common common;
    const char *volume, *surface, *unit;
    double rate;
};

#define TO(field) offsetof(struct options, field)
static const opt option_table[] = {
    {OPT_INPUT, 0, "volume", "VOLUME", OPT_TEXT, TO(volume), 0, 0, NULL, OPT_FILE,
     "NRRD or MetaImage: of places voxel:I,J,K, axes i, j, k"},
    {OPT_INPUT, 0, "surface", "OBJ", OPT_TEXT, TO(surface), 0, 0, NULL, OPT_FILE,
     "the skin: of places surface:X,Y,Z, vertex:N, and of normals"},
    {OPT_INPUT, 0, "unit", NUM_UNITS_CHOICES, OPT_TEXT, TO(unit), 0, 0, NULL, 0,
     "unit of the OBJ, and of lengths without a suffix [default m]"},
    {OPT_ACTION, 0, "rate", "HZ", OPT_NUMBER, TO(rate), 1e-3, 1e6, NULL, OPT_OUTPUT, "poses a second [Hz; default 60]"},
    {0}};

static const opt_tool table = {
    .name = "sinew-poses",
    .command = "sinew poses",
    .usage = "[options] plan > poses.tum\n[options] < plan > poses.tum",
    .purpose =
        "Writes the poses of a probe that is put on a voxel, a place or a skin, and is\npressed, swept, fanned or "
        "held from there: PLAN has a line for each.",
    .note = "Lines: at PLACE [into AXIS] [columns AXIS]; press DEPTH SECONDS;\n"
            "sweep X,Y,Z SECONDS; fan, rock or turn DEGREES SECONDS; move PLACE ... SECONDS;\n"
            "hold SECONDS; tremor LENGTH HZ.",
    .example = "sinew poses --surface skin.obj --unit mm plan > press.tum",
    .operands = "PLAN",
    .operands_max = 1,
    .options = option_table,
};

/* All of one run. */
typedef struct job {
    const tool *t;
    const struct options *o;
    stand places;
    plan plan;
    notes warnings;
} job;

static int read_places(job *j, err *e)
{
    const struct options *o = j->o;
    if (o->unit && !(j->places.unit = num_unit_of(o->unit)))
        return err_usage(e, "--unit '%.100s': expected " NUM_UNITS, o->unit);
    if (o->surface && !o->unit)
        return err_usage(e, "--surface without --unit; expected " NUM_UNITS ": an OBJ does not tell its unit");
    if (o->volume && stand_volume(&j->places, o->volume, e))
        return -1;
    return o->surface ? stand_surface(&j->places, o->surface, j->places.unit, &j->warnings, e) : 0;
}

static int take_lines(job *j, in *source, err *e)
{
    keyfile k;
    int got;
    keyfile_open(&k, source);
    while ((got = keyfile_next(&k, e)) > 0)
        if (plan_take(&j->plan, &k, e))
            return -1;
    return got < 0 ? -1 : plan_end(&j->plan, &k, e);
}

static int write_poses(job *j, const char *path, err *e)
{
    in *source = in_open(path, e);
    out *to = source ? out_open(j->o->common.output, false, e) : NULL;
    j->plan = (plan){.s = &j->places, .to = to, .rate = j->o->rate};
    const int failed = !to || take_lines(j, source, e);
    in_close(source);
    if (to && out_end(to, failed, e))
        return -1;
    if (!failed)
        tool_say(j->t, "%" PRId64 " poses, %.6g s", j->plan.poses, j->plan.time);
    return failed ? -1 : 0;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.rate = 60};
    err e = {0};
    tool t = {0};
    job j = {.t = &t, .o = &o};
    if (!tool_begin(&t, &table, argc, argv, &o, &e) && !t.done) {
        const char *path = t.operands ? t.operand[0] : "-";
        if ((strcmp(path, "-") != 0 || !tool_need_stdin("a plan", &e)) && !read_places(&j, &e))
            write_poses(&j, path, &e);
    }
    tool_warn(&t, &j.warnings);
    stand_free(&j.places);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
