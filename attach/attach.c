/* attach: fixes the nodes of a voxel model that lie at its rigid surfaces, and gives its muscles their contraction
 * centres and fibres. W&M section 3, Algorithm 2.
 */
#include "anchor.h"
#include "bone_contact.h"
#include "cli/tool.h"
#include "fibre_lines.h"
#include "fibre_rule.h"
#include "film.h"
#include "held_report.h"
#include "model/finite.h"
#include "model/stage.h"
#include "muscle_fibres.h"
#include "part.h"
#include "slide.h"
#include "surface/surface.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    const char *contact_file;
    opt_list rigid, part, fibre, lines_in, slide, slide_off, contact;
    const char *rigid_file, *lines;
    double strictness;
    bool surface, report;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_INPUT, 0, "rigid", "NAME,...", OPT_LIST, TO(rigid), 0, 0, "@group.name", 0,
     "rigid surfaces [default skull*,bone*,rigid*]"},
    {OPT_INPUT, 0, "rigid-file", "FILE.obj", OPT_TEXT, TO(rigid_file), 0, 0, NULL, OPT_FILE,
     "further rigid surfaces, in the model's unit"},
    {OPT_INPUT, 0, "part", "NAME=WHAT", OPT_LIST, TO(part), 0, 0, NULL, OPT_NAMED,
     "bone that moves by itself: jaw=skull_jaw,... or jaw=FILE.obj, a closed surface around it"},
    {OPT_INPUT, 0, "contact-file", "FILE.obj", OPT_TEXT, TO(contact_file), 0, 0, NULL, OPT_FILE,
     "surfaces that skin may not enter, which hold no node"},
    {OPT_ACTION, 0, "strictness", "S", OPT_NUMBER, TO(strictness), 0, 0, NULL, 0,
     "fix nodes this near to a surface, up to 1 [voxel sides; default 0.75]"},
    {OPT_ACTION, 0, "surface", NULL, OPT_FLAG, TO(surface), 0, 0, NULL, 0,
     "hold elements at the surface itself, by films of tissue, in place of nodes near it"},
    {OPT_ACTION, 0, "contact", "SURFACE,...[:REGION]", OPT_LIST, TO(contact), 0, 0, NULL, OPT_NAMED,
     "rigid surfaces that skin may not enter (bind --self-contact)"},
    {OPT_ACTION, 0, "slide", "SURFACE,...[:REGION]", OPT_LIST, TO(slide), 0, 0, NULL, OPT_NAMED,
     "nodes held there slide on the bone; region: FILE.obj or X0,Y0,Z0,X1,Y1,Z1"},
    {OPT_ACTION, 0, "slide-off", "SURFACE,...[:REGION]", OPT_LIST, TO(slide_off), 0, 0, NULL, OPT_NAMED,
     "the same, and may come off the bone"},
    {OPT_ACTION, 0, "fibre", "[MUSCLES=]RULE", OPT_LIST, TO(fibre), 0, 0, MUSCLE_RULE_NAMES "|@muscle.name=", 0,
     "how fibres run: " MUSCLE_RULE_NAMES " [default auto]"},
    {OPT_ACTION, 0, "fibre-lines", "FILE.obj", OPT_TEXT, TO(lines), 0, 0, NULL, OPT_FILE,
     "lines on the skin, as Langer's, that fibres of its layers follow"},
    {OPT_ACTION, 0, "fibre-lines-in", "VOLUME,...", OPT_LIST, TO(lines_in), 0, 0, "@volume.name", 0,
     "the volumes that follow them [default the layers of the skin]"},
    {OPT_RESULT, 0, "report", NULL, OPT_FLAG, TO(report), 0, 0, NULL, OPT_OUTPUT,
     "print what each surface and muscle got"},
    {0},
};

static const opt_tool table = {
    .name = "attach",
    .usage = "[options] < model > result",
    .purpose = "Fixes the nodes at rigid surfaces, and gives muscles contraction centres and\nfibre directions.",
    .example = "voxelise --unit mm -s 2.5 --fraction 4 --materials head.materials head.obj |\n"
               "      attach --fibre field > head.sinew",
    .operands = "",
    .writes_model = true,
    .threaded = true,
    .options = option_list,
};

/* Reads the OBJ into a model of its own, in metres. */
static int read_surfaces(const char *option, const char *path, bool nameless, const model *m, model *file,
                         notes *warnings, err *e)
{
    const char *unit_name = model_meta_of(m, "source.unit");
    num_unit unit = unit_name ? num_unit_of(unit_name) : 0, metre = num_unit_of("m");
    if (!unit)
        return err_set(e, NULL, 0, "%s: the model's source.unit is %s; expected " NUM_UNITS, option,
                       unit_name ? unit_name : "not given");
    obj o = {0};
    char name[MODEL_NAME];
    surface_name(nameless ? "surface_1" : path, name, sizeof name);
    in *source = in_open(path, e);
    int rc = source ? obj_read(&o, source, e) : -1;
    if (!rc) {
        obj_notes(&o, warnings);
        rc = surface_add(file, name, &o, num_length_in((num_length){1, unit}, unit, metre), e);
    }
    obj_free(&o);
    in_close(source);
    return rc;
}

static int collect(const struct options *o, const model *m, model *file, rigid *r, notes *warnings, err *e)
{
    if (rigid_collect(r, m, &o->rigid, e))
        return -1;
    if (o->rigid_file && (read_surfaces("--rigid-file", o->rigid_file, o->common.anonymous, m, file, warnings, e) ||
                          rigid_collect_all(r, file, e)))
        return -1;
    if (!r->primitives)
        notes_add(warnings, "no surface of the model is rigid (skull*, bone*, rigid*); --rigid names others");
    return 0;
}

/* What holds no node and skin may not enter. */
static int collect_loose(const struct options *o, const model *m, model *file, rigid *r, notes *warnings, err *e)
{
    return o->contact_file &&
                   (read_surfaces("--contact-file", o->contact_file, o->common.anonymous, m, file, warnings, e) ||
                    rigid_collect_all(r, file, e))
               ? -1
               : 0;
}

/* Whether all that was rigid was too far from the voxels. */
static void check_held(const rigid *r, notes *warnings)
{
    for (int64_t i = 0; i < r->surfaces; i++)
        if (r->surface[i].primitives && r->surface[i].idle == r->surface[i].primitives)
            notes_add(warnings, "%s holds no node: all of it is too far from the voxels", r->surface[i].name);
}

/* With -v, a line for each muscle. */
static void say_rules(const tool *t, const muscles *list)
{
    for (int64_t i = 0; i < list->count; i++)
        tool_detail(t, "%s: fibres by the rule '%s': %s", list->of[i].name, fibre_rules[list->of[i].rule].name,
                    fibre_rules[list->of[i].rule].what);
}

static bool has_film(const model *m, int64_t which)
{
    const model_array *anchor = model_find(m, "bone.anchor");
    for (int64_t i = 0; i < anchor->rows; i++)
        if (anchor->i32[i] == which)
            return true;
    return false;
}

/* Warns of rigid surfaces that hold nodes but no film. */
static void check_films(const model *m, const rigid *r, notes *warnings)
{
    for (int64_t i = 0; i < r->surfaces; i++)
        if (r->surface[i].idle < r->surface[i].primitives && !has_film(m, i))
            notes_add(warnings, "%s holds nothing by --surface: it has no faces with tissue beside them",
                      r->surface[i].name);
}

/* Films in place of rigid nodes, once all is known that these are for besides. */
static int hold_surface(const tool *t, model *m, const rigid *r, notes *warnings, err *e)
{
    double area = 0;
    if (film_make(m, r, &area, warnings, e))
        return -1;
    check_films(m, r, warnings);
    tool_say(t, "bone holds the tissue by %lld films, of %.4g cm2", (long long)model_count(m, "bone"), 1e4 * area);
    return 0;
}

/* Nodes slide once all is known that they are rigid for. */
static int let_slide(const struct options *o, const tool *t, model *m, const rigid *r, pool *threads,
                     bone_fields *fields, notes *warnings, err *e)
{
    const slide_options how = {&o->slide, &o->slide_off};
    slide_found found;
    if (slide_make(m, r, &how, threads, fields, &found, warnings, e))
        return -1;
    if (found.nodes)
        tool_say(t, "%lld nodes slide on bone, at most %.3g voxels away from it, by %lld distance field%s",
                 (long long)found.nodes, found.worst, (long long)found.fields, found.fields == 1 ? "" : "s");
    return 0;
}

/* What skin may not enter, and what nodes slide on. */
static int make_fields(const struct options *o, const tool *t, model *m, const rigid *r, const rigid *loose,
                       pool *threads, notes *warnings, err *e)
{
    const bone_contact_options how = {&o->contact, &o->part, r, loose};
    bone_fields fields = {0};
    model_axis_drop(m, "field", warnings);
    model_axis_drop(m, "distance", warnings);
    int failed = bone_contact_make(m, &how, threads, &fields, warnings, e);
    if (!failed && fields.count)
        tool_say(t, "skin may not enter bone by %lld distance field%s", (long long)fields.count,
                 fields.count == 1 ? "" : "s");
    failed = failed || let_slide(o, t, m, r, threads, &fields, warnings, e) ||
             (fields.count && bone_fields_write(m, &fields, model_find(m, "node.body") != NULL, e));
    bone_fields_free(&fields);
    return failed ? -1 : 0;
}

/* Whether axes come or go once the muscles are there. */
static bool changes_axes(const struct options *o, const model *m)
{
    static const char *const dropped[] = {"field", "distance", "slide"};
    bool is_dropped = false;
    for (size_t i = 0; i < sizeof dropped / sizeof *dropped; i++)
        is_dropped = is_dropped || model_count(m, dropped[i]) >= 0;
    return is_dropped || o->surface || o->slide.count || o->slide_off.count || o->contact.count;
}

static bool is_fibres(const model_array *a)
{
    return !strcmp(a->name, "element.fibre") || !strcmp(a->name, "element.mixfibre");
}

/* The muscles; of a large model, where axes stay from then on, all but the fibres is written while these are laid. */
static int make_muscles(const struct options *o, stage *s, model *m, muscles *list, pool *threads, notes *warnings,
                        err *e)
{
    if (muscle_find(m, &o->fibre, list, warnings, e))
        return -1;
    const bool ahead = pool_threads(threads) > 1 && !changes_axes(o, m) && stage_is_large(m);
    if (ahead && stage_write_ahead(s, m, is_fibres, e))
        return -1;
    return muscle_fibres(m, &o->fibre, threads, list, warnings, e) ||
                   (o->lines && fibre_lines_apply(m, o->lines, &o->lines_in, threads, e))
               ? -1
               : 0;
}

static int work(const struct options *o, const tool *t, stage *s, model *m, notes *warnings, err *e)
{
    rigid r = {0}, loose = {0};
    model file = {0}, loose_file = {0};
    muscles list = {0};
    pool *threads = NULL;
    int rc = -1, count = tool_threads(t, e);
    if (count < 0 || finite_elements(m, NULL, e))
        return -1;
    film_drop(m, warnings);
    threads = pool_create(count, e);
    if (!threads || collect(o, m, &file, &r, warnings, e) || collect_loose(o, m, &loose_file, &loose, warnings, e) ||
        anchor_nodes(m, &r, o->strictness, threads, warnings, e) || part_make(m, &o->part, &loose, warnings, e) ||
        make_muscles(o, s, m, &list, threads, warnings, e) || make_fields(o, t, m, &r, &loose, threads, warnings, e) ||
        (o->surface && hold_surface(t, m, &r, warnings, e)))
        goto out;
    check_held(&r, warnings);
    say_rules(t, &list);
    rc = o->report && (held_report_surfaces(t, &r, e) || held_report_muscles(t, &list, &r, e)) ? -1 : 0;
out:
    muscles_free(&list);
    pool_destroy(threads);
    rigid_free(&r);
    rigid_free(&loose);
    model_free(&file);
    model_free(&loose_file);
    return rc;
}

static int check_options(const struct options *o, err *e)
{
    if (!(o->strictness > 0 && o->strictness <= 1))
        return err_usage(e, "--strictness %g: expected a number above 0, at most 1", o->strictness);
    if (o->rigid_file && !strcmp(o->rigid_file, "-"))
        return err_usage(e, "--rigid-file -: standard input is the model's; expected the name of a file");
    if (o->lines && !strcmp(o->lines, "-"))
        return err_usage(e, "--fibre-lines -: standard input is the model's; expected the name of a file");
    if (o->contact_file && !strcmp(o->contact_file, "-"))
        return err_usage(e, "--contact-file -: standard input is the model's; expected the name of a file");
    if (o->surface && (o->slide.count || o->slide_off.count))
        return err_usage(e, "--surface with --slide: films hold all of what they touch; expected one of them");
    if (o->lines_in.count && !o->lines)
        return err_usage(e, "--fibre-lines-in needs --fibre-lines FILE.obj, which has the lines");
    return fibre_rules_check(&o->fibre, e);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.strictness = 0.75};
    err e = {0};
    tool t = {0};
    stage s = {0};
    model m = {0};
    notes warnings = {0};
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done || check_options(&o, &e))
        goto out;
    if (!stage_open_output(&s, &t, &e) && !stage_read(&s, &m, &e) && !stage_drop_frames(&s, &m, &warnings, &e) &&
        !work(&o, &t, &s, &m, &warnings, &e))
        stage_write(&s, &m, &e);
out:
    tool_warn(&t, &warnings);
    if (!t.done)
        stage_close(&s, &t, &e);
    model_free(&m);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
