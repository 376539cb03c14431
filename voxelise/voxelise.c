/* voxelise: closed surfaces become hexahedral elements, one a voxel (W&M section 3, Algorithm 1). */
#include "base/clock.h"
#include "base/mem.h"
#include "base/num.h"
#include "base/pool.h"
#include "mesh/extent.h"
#include "model/materials.h"
#include "model/stage.h"
#include "surface/surface.h"
#include "voxelise/build.h"
#include "voxelise/gaps.h"
#include "voxelise/layers.h"
#include "voxelise/report.h"
#include "voxelise/slits.h"
#include "voxelise/solids.h"
#include "voxelise/summary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    const char *unit, *volumes, *materials, *layers;
    opt_lengths size, origin, box;
    int64_t cells, fraction;
    double least;
    int slits;  /* a slits_choice */
    int strain; /* a strain_choice */
    int mixed;  /* --mixed: 0 is between, 1 laminate, -1 not given: between */
    bool allow_open, check;
};

/* --strain, as its choices are in order. */
enum strain_choice { STRAIN_NOT_GIVEN = -1, STRAIN_ENCLOSED, STRAIN_CENTRE };

/* --slits, likewise; what is not given follows --fraction and --layers. */
enum slits_choice { SLITS_NOT_GIVEN = -1, SLITS_ON, SLITS_OFF };

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_INPUT, 0, "unit", "mm|cm|m|in|um", OPT_TEXT, TO(unit), 0, 0, NULL, 0,
     "unit of the OBJ and of lengths; required"},
    {OPT_ACTION, 's', NULL, "H|HX,HY,HZ", OPT_LENGTHS, TO(size), 1, 3, NULL, 0,
     "side of a voxel, or its x, y and z sides [length]"},
    {OPT_ACTION, 'n', NULL, "CELLS", OPT_INT, TO(cells), 1, 1e9, NULL, 0,
     "in place of -s: voxels along the longest side"},
    {OPT_ACTION, 0, "origin", "X,Y,Z", OPT_LENGTHS, TO(origin), 3, 3, NULL, 0,
     "a corner of the lattice [length; default centred]"},
    {OPT_ACTION, 0, "box", "X0,Y0,Z0,X1,Y1,Z1", OPT_LENGTHS, TO(box), 6, 6, NULL, 0,
     "keep voxels with centres in it [length; default all]"},
    {OPT_INPUT, 0, "volumes", "FILE", OPT_TEXT, TO(volumes), 0, 0, NULL, OPT_FILE,
     "surfaces that bound each volume [default by name]"},
    {OPT_INPUT, 0, "materials", "FILE", OPT_TEXT, TO(materials), 0, 0, NULL, OPT_FILE,
     "materials of the volumes [default one, tissue]"},
    {OPT_INPUT, 0, "layers", "FILE", OPT_TEXT, TO(layers), 0, 0, NULL, OPT_FILE,
     "layers of given thickness from the skin inward"},
    {OPT_ACTION, 0, "fraction", "N", OPT_INT, TO(fraction), 1, SHARES_MOST, NULL, 0,
     "make elements of voxels that are partly enclosed, with their share from N^3 samples"},
    {OPT_ACTION, 0, "least", "SHARE", OPT_NUMBER, TO(least), 0, 1, NULL, 0,
     "smallest share that makes an element [default any]"},
    {OPT_ACTION, 0, "strain", "enclosed|centre", OPT_CHOICE, TO(strain), 0, 0, "enclosed|centre", 0,
     "where the strain of a partly enclosed voxel is taken [default enclosed]"},
    {OPT_ACTION, 0, "mixed", "between|laminate", OPT_CHOICE, TO(mixed), 0, 0, "between|laminate", 0,
     "how a voxel of two volumes takes its moduli [default between]"},
    {OPT_ACTION, 0, "slits", "on|off", OPT_CHOICE, TO(slits), 0, 0, "on|off", 0,
     "part what a surface lies between [default on with --fraction or --layers]"},
    {OPT_INPUT, 0, "allow-open", NULL, OPT_FLAG, TO(allow_open), 0, 0, NULL, 0, "accept open surfaces, with a warning"},
    {OPT_RESULT, 0, "check", NULL, OPT_FLAG, TO(check), 0, 0, NULL, 0, "write a report on the surfaces, and no model"},
    {0}};

static const opt_tool table = {
    .name = "voxelise",
    .usage = "[options] surface.obj > model\n[options] - < surface.obj > model",
    .purpose = "Converts closed surfaces to a finite element model of voxels (hexahedra).",
    .note = "Lengths are in --unit, unless they have a suffix (" NUM_UNITS_LIST "), e.g. 2mm.",
    .example = "voxelise --unit mm -s 2.5 --fraction 4 --materials head.materials head.obj |\n"
               "      attach --fibre field | sinew bind > head.sinew",
    .operands = "surface.obj|-",
    .operands_min = 1,
    .operands_max = 1,
    .writes_model = true,
    .threaded = true,
    .options = option_list,
};

/* All that one run makes on its way. */
typedef struct job {
    const struct options *o;
    const tool *t;
    const char *path;
    num_unit unit;
    obj surface;
    volumes plan;
    layers layer;
    solids solid;
    grid g, samples;
    inside test;
    cuts cut;
    voxels x;
    slits slit;
    pool *threads;
    notes warnings;
} job;

static void job_free(job *j)
{
    slits_free(&j->slit);
    voxels_free(&j->x);
    cuts_free(&j->cut);
    inside_free(&j->test);
    solids_free(&j->solid);
    layers_free(&j->layer);
    volumes_free(&j->plan);
    obj_free(&j->surface);
    if (j->threads)
        pool_destroy(j->threads);
}

/* ---- options */

static bool all_positive(const opt_lengths *l)
{
    for (int i = 0; i < l->count; i++)
        if (!(l->value[i].value > 0))
            return false;
    return true;
}

/* Lengths in the OBJ's unit. */
static void in_source_unit(const job *j, const opt_lengths *l, double *to)
{
    for (int i = 0; i < l->count; i++)
        to[i] = num_length_in(l->value[i], j->unit, j->unit);
}

/* Also where no unit is given yet: that is asked for later. */
static bool box_is_upright(const job *j)
{
    double box[6] = {0};
    if (!j->o->box.count || !j->unit)
        return true;
    in_source_unit(j, &j->o->box, box);
    return box[0] < box[3] && box[1] < box[4] && box[2] < box[5];
}

static int check_options(job *j, err *e)
{
    const struct options *o = j->o;
    j->unit = o->unit ? num_unit_of(o->unit) : 0;
    if (o->unit && !j->unit)
        return err_usage(e, "--unit '%s': expected mm, cm, m, in or um", o->unit);
    if (o->unit && !o->size.count && o->cells < 0 && !o->check)
        return err_usage(e, "no voxel size; expected -s H, -s HX,HY,HZ or -n CELLS");
    if (o->size.count && o->cells >= 0)
        return err_usage(e, "-s and -n both give the voxel size; expected one of them");
    if (o->size.count == 2 || !all_positive(&o->size))
        return err_usage(e, "-s: expected one length, or three between commas, above 0");
    if (o->check && (o->fraction > 0 || !isnan(o->least) || o->slits >= 0 || o->strain >= 0 || o->mixed >= 0 ||
                     o->origin.count || o->box.count))
        return err_usage(e, "--check looks at surfaces and makes no voxels; expected it without --fraction, --least, "
                            "--strain, --mixed, --slits, --origin and --box");
    if (!isnan(o->least) && o->fraction < 0)
        return err_usage(e, "--least is for --fraction N; expected both, or neither");
    if ((o->strain >= 0 || o->mixed >= 0) && o->fraction < 0)
        return err_usage(e, "--%s is for --fraction N; expected both, or neither", o->strain >= 0 ? "strain" : "mixed");
    if (!box_is_upright(j))
        return err_usage(e, "--box: expected X0,Y0,Z0,X1,Y1,Z1 with X0 < X1, Y0 < Y1 and Z0 < Z1");
    return strcmp(j->path, "-") ? 0 : tool_need_stdin("an OBJ", e);
}

/* ---- read */

static int read_surface(job *j, err *e)
{
    in *source = in_open(j->path, e);
    int status = source ? obj_read(&j->surface, source, e) : -1;
    in_close(source);
    if (!status)
        obj_notes(&j->surface, &j->warnings);
    if (!status && j->surface.faces == 0)
        status = volumes_no_polygons(&j->surface, e);
    return status;
}

static int read_materials(const job *j, model *m, err *e)
{
    if (!j->o->materials)
        return materials_default(m, e);
    in *source = in_open(j->o->materials, e);
    int status = source ? materials_read(m, source, e) : -1;
    in_close(source);
    return status;
}

static int read_plan(job *j, const model *m, err *e)
{
    in *source = in_open(j->o->volumes, e);
    int status = source ? volumes_read(&j->plan, source, &j->surface, m, &j->warnings, e) : -1;
    in_close(source);
    return status;
}

static int read_layers(job *j, const model *m, err *e)
{
    if (!j->o->layers)
        return 0;
    in *source = in_open(j->o->layers, e);
    int status = source ? layers_read(&j->layer, source, j->unit, &j->plan, m, e) : -1;
    in_close(source);
    return status;
}

static int make_plan(job *j, const model *m, err *e)
{
    bool by_name = !j->o->volumes;
    if (by_name ? volumes_by_name(&j->plan, &j->surface, m, e) : read_plan(j, m, e))
        return -1;
    volumes_notes(&j->plan, by_name, &j->warnings);
    return read_layers(j, m, e);
}

/* ---- the lattice and what is inside */

static int find_spacing(const job *j, double *spacing, err *e)
{
    const solids *s = &j->solid;
    double longest = 0;
    in_source_unit(j, &j->o->size, spacing);
    for (int a = 0; a < 3; a++)
        longest = fmax(longest, s->high[a] - s->low[a]);
    if (j->o->size.count == 0) {
        if (!(longest > 0))
            return err_set(e, j->surface.name, 0, "all vertices are at one place; expected closed surfaces");
        spacing[0] = longest / (double)j->o->cells;
    }
    if (j->o->size.count < 3)
        spacing[1] = spacing[2] = spacing[0];
    return 0;
}

static int make_grid(job *j, err *e)
{
    const solids *s = &j->solid;
    double spacing[3] = {0}, origin[3] = {0}, box[6] = {0};
    if (find_spacing(j, spacing, e))
        return -1;
    in_source_unit(j, &j->o->origin, origin);
    in_source_unit(j, &j->o->box, box);
    if (j->o->origin.count ? grid_fix(&j->g, s->low, s->high, spacing, origin, e)
                           : grid_cover(&j->g, s->low, s->high, spacing, e))
        return -1;
    if (j->o->origin.count && j->o->fraction > 0 && grid_widen(&j->g, e))
        return -1;
    return j->o->box.count ? grid_clip(&j->g, box, box + 3, e) : 0;
}

/* Whether slits are opened: of closed surfaces. */
static bool wants_slits(const struct options *o)
{
    return o->slits == SLITS_NOT_GIVEN ? o->fraction > 0 || o->layers : o->slits == SLITS_ON;
}

static bool opens_slits(const job *j)
{
    return wants_slits(j->o) && !solids_are_open(&j->solid, &j->plan);
}

/* What is inside, by centres or by samples; samples: the lattice of the one or the other. */
static int look_inside(job *j, const grid *samples, const shares_rule *rule, const voxels_strata *strata, err *e)
{
    const inside_triangles t = solids_triangles(&j->solid, &j->plan, false);
    const inside_triangles lowest = solids_triangles(&j->solid, &j->plan, true);
    const int each = rule ? rule->samples : 1;
    if (opens_slits(j) && cuts_find(&j->cut, &lowest, samples, each, j->threads, e))
        return -1;
    if (inside_create(&j->test, samples, &t, CLIMB_RAY, each, j->threads, e))
        return -1;
    int32_t *level = mem_array(j->plan.volumes, sizeof *level, "volumes", e);
    if (!level)
        return -1;
    for (int32_t v = 0; v < j->plan.volumes; v++)
        level[v] = j->plan.volume[v].level;
    progress shown;
    progress_start(&shown, table.name, "slabs", (double)j->test.slabs, j->t->common->quiet);
    const cuts *cut = opens_slits(j) ? &j->cut : NULL;
    int status = voxels_find(&j->x, &j->test, level, j->plan.volumes, rule, cut, strata, j->threads, &shown, e);
    progress_stop(&shown);
    free(level);
    return status;
}

static bool takes_moments(const struct options *o)
{
    return o->fraction > 0 && o->strain != STRAIN_CENTRE;
}

static int look_by_shares(job *j, const model *m, err *e)
{
    shares_rule rule = {.samples = (int)j->o->fraction,
                        .least = isnan(j->o->least) ? 0 : j->o->least,
                        .moments = takes_moments(j->o),
                        .borders = j->o->mixed > 0};
    layers_samples of = {0};
    if (grid_divide(&j->samples, &j->g, rule.samples, e) ||
        (j->layer.layers && layers_sample(&of, &j->layer, &j->plan, m, &j->surface, &j->samples, rule.samples, e)))
        return -1;
    rule.modulus = of.modulus, rule.lowest = of.strata.lowest, rule.layers = of.strata.layers;
    const int status = look_inside(j, &j->samples, &rule, of.made ? &of.strata : NULL, e);
    layers_samples_free(&of);
    return status;
}

static int find_voxels(job *j, const model *m, err *e)
{
    bool by_shares = j->o->fraction > 0;
    if (by_shares ? look_by_shares(j, m, e) : look_inside(j, &j->g, NULL, NULL, e))
        return -1;
    if (j->x.elements)
        return 0;
    const char *what = by_shares ? "enough of it" : "its centre";
    return err_set(e, j->surface.name, 0, "no voxel has %s inside; expected smaller voxels%s (%g x %g x %g %s)", what,
                   j->o->box.count ? ", or another --box" : "", j->g.spacing[0], j->g.spacing[1], j->g.spacing[2],
                   num_unit_name(j->unit));
}

static int open_slits(job *j, err *e)
{
    const inside_triangles lowest = solids_triangles(&j->solid, &j->plan, true);
    const bool by_shares = j->o->fraction > 0;
    return slits_find(&j->slit, &j->x, &j->cut, &lowest, by_shares ? &j->samples : &j->g,
                      by_shares ? (int)j->o->fraction : 1, j->plan.volumes + (by_shares ? (int32_t)j->layer.layers : 0),
                      e);
}

/* Where slits stay as they are: what elements fill. */
static int find_gaps(job *j, err *e)
{
    gaps found;
    if (solids_are_open(&j->solid, &j->plan))
        return 0;
    if (gaps_find(&found, &j->solid, &j->plan, &j->x, &j->g, j->threads, e))
        return -1;
    const double least = isnan(j->o->least) ? 0 : j->o->least;
    report_gaps(&j->warnings, &found, &j->g, j->x.fraction ? least : NAN, j->unit);
    gaps_free(&found);
    return 0;
}

static double in_metres(const job *j, double length)
{
    return num_length_in((num_length){length, j->unit}, j->unit, num_unit_of("m"));
}

static int make_model(const job *j, model *m, err *e)
{
    lattice l;
    char name[MODEL_NAME];
    for (int a = 0; a < 3; a++) {
        l.origin[a] = in_metres(j, j->g.origin[a] + j->g.offset[a]);
        l.spacing[a] = in_metres(j, j->g.spacing[a]);
    }
    surface_name(j->o->common.anonymous ? "surface_1" : j->path, name, sizeof name);
    if (model_meta_set(m, "source.unit", num_unit_name(j->unit), e) || lattice_save(&l, m, e) ||
        build_elements(m, &j->x, &j->slit, &l, j->threads, e) || build_volumes(m, &j->plan, e) ||
        (j->slit.nodes && build_slits(m, &j->plan, name, e)) ||
        (j->layer.layers && layers_normals(&j->layer, &j->plan, &j->surface, &j->g, m, j->threads, e)))
        return -1;
    return surface_add(m, name, &j->surface, in_metres(j, 1), e);
}

/* ---- say */

static int say_volumes(job *j, const model *m, err *e)
{
    const summary s = {.plan = &j->plan,
                       .layer = &j->layer,
                       .x = &j->x,
                       .g = &j->g,
                       .unit = j->unit,
                       .material = (const char *const *)model_find(m, "material.name")->str,
                       .samples = j->x.fraction ? j->o->fraction : 1,
                       .boxed = j->o->box.count > 0,
                       .laminates = j->o->mixed > 0,
                       .verbose = j->t->common->verbose};
    text_table *rows = summary_table(&s, e);
    const char *plural = j->plan.volumes == 1 ? "" : "s";
    int rc = rows ? tool_table(j->t, rows, e, "%d volume%s", (int)j->plan.volumes, plural) : -1;
    text_table_free(rows);
    return rc ? -1 : summary_warn(&s, &j->warnings, e);
}

static int say_plan(job *j, const model *m, err *e)
{
    const grid *g = &j->g;
    double d[3];
    report_sides(&j->surface, d);
    tool_say(j->t, "surfaces of %.4g x %.4g x %.4g %s", d[0], d[1], d[2], num_unit_name(j->unit));
    tool_say(j->t, "lattice of %lld x %lld x %lld cells, %g x %g x %g %s each", (long long)grid_cells(g, 0),
             (long long)grid_cells(g, 1), (long long)grid_cells(g, 2), g->spacing[0], g->spacing[1], g->spacing[2],
             num_unit_name(j->unit));
    if (say_volumes(j, m, e))
        return -1;
    if (j->x.fraction)
        tool_say(j->t, "the surfaces enclose the volume of %.9g voxels, in %lld elements", summary_enclosed(&j->x),
                 (long long)j->x.elements);
    tool_say(j->t, "%lld elements, %lld nodes", (long long)model_count(m, "element"),
             (long long)model_count(m, "node"));
    report_slits(j->t, &j->slit);
    if (j->o->slits == SLITS_ON && !opens_slits(j))
        notes_add(&j->warnings, "slits are not looked for (--slits on), as a volume of level 0 is open");
    if (!j->plan.rigid)
        notes_add(&j->warnings, "nothing is rigid: no surface begins skull, bone or rigid");
    return 0;
}

/* With -v: how long each step took. */
static double say_time(const job *j, const char *what, double since)
{
    double now = clock_now();
    tool_detail(j->t, "%s: %.1f ms", what, 1e3 * (now - since));
    return now;
}

/* ---- --check */

/* What --check needs for all surfaces and volumes. */
typedef struct checking {
    job *j;
    const double *voxel; /* NULL: none was given */
    int64_t *face;       /* room for all of the OBJ's */
    text_table *surfaces, *volumes;
    listing *thin;
    out *detail; /* with -v */
} checking;

static int look_at(const checking *c, bool (*is_of)(const volumes *v, int32_t group, int32_t number), int32_t number,
                   check_result *r, err *e)
{
    const obj *o = &c->j->surface;
    int64_t count = 0;
    for (int64_t f = 0; f < o->faces; f++)
        if (o->face_start[f + 1] - o->face_start[f] >= 3 && is_of(&c->j->plan, o->face_group[f], number))
            c->face[count++] = f;
    return check_surface(r, o, c->face, count, c->voxel, pool_threads(c->j->threads), e);
}

static int check_surfaces(const checking *c, err *e)
{
    job *j = c->j;
    for (int32_t s = 0; s < j->plan.surfaces; s++) {
        check_result r;
        if (j->plan.surface[s].polygons == 0)
            continue;
        if (look_at(c, volumes_is_of_surface, s, &r, e))
            return -1;
        report_surface_row(c->surfaces, j->plan.surface[s].name, &r, c->voxel != NULL);
        report_surface(c->detail, &j->plan, s, &r, num_unit_name(j->unit));
        report_warn(&j->warnings, c->thin, "surface", j->plan.surface[s].name, &r);
    }
    return 0;
}

/* A volume of one surface is as that is. */
static int check_volumes(const checking *c, err *e)
{
    job *j = c->j;
    for (int32_t v = 0; v < j->plan.volumes; v++) {
        const volumes_volume *a = &j->plan.volume[v];
        check_result r;
        bool several = strchr(a->surfaces, ' ') != NULL;
        if (several && look_at(c, volumes_is_of_volume, v, &r, e))
            return -1;
        report_volume_row(c->volumes, a, j->solid.open[v]);
        report_volume(c->detail, a, several ? &r : NULL, j->solid.open[v], j->solid.open_at[v], num_unit_name(j->unit));
        if (several)
            report_warn(&j->warnings, c->thin, "volume", a->name, &r);
    }
    return 0;
}

static int find_report(checking *c, err *e)
{
    c->face = mem_array(c->j->surface.faces, sizeof *c->face, "polygons", e);
    c->detail = c->face ? out_memory(e) : NULL;
    c->surfaces = c->detail ? report_surfaces(c->voxel != NULL, e) : NULL;
    c->volumes = c->surfaces ? report_volumes(e) : NULL;
    return c->volumes && !check_surfaces(c, e) && !check_volumes(c, e)
               ? report_write(c->j->t, c->surfaces, c->volumes, c->detail, e)
               : -1;
}

/* Writes the report; fails where a volume is open, as a run without --check would. */
static int check(job *j, err *e)
{
    double spacing[3] = {0};
    bool sized = j->o->size.count || j->o->cells >= 0;
    if (sized && find_spacing(j, spacing, e))
        return -1;
    listing thin = {0};
    checking c = {.j = j, .voxel = sized ? spacing : NULL, .thin = &thin};
    int status = find_report(&c, e);
    report_thin(&j->warnings, &thin);
    free(c.face);
    text_table_free(c.surfaces);
    text_table_free(c.volumes);
    out_discard(c.detail);
    if (status)
        return -1;
    int64_t open = 0;
    for (int32_t v = 0; v < j->plan.volumes; v++)
        open += j->solid.open[v];
    if (!open || j->o->allow_open)
        return 0;
    return err_set(e, j->surface.name, 0,
                   "%lld open edges; expected every edge to join two polygons (--allow-open accepts open edges)",
                   (long long)open);
}

/* ---- work */

static int prepare(job *j, model *m, err *e)
{
    double side[3];
    double clock = clock_now();
    if (read_surface(j, e))
        return -1;
    if (!j->unit)
        return report_ask_for_unit(&j->surface, e);
    report_sides(&j->surface, side);
    extent_note(&j->warnings, j->surface.name, side, j->unit);
    clock = say_time(j, "reading", clock);
    int threads = tool_threads(j->t, e);
    j->threads = threads > 0 ? pool_create(threads, e) : NULL;
    bool allow_open = j->o->allow_open || j->o->check;
    if (!j->threads || read_materials(j, m, e) || make_plan(j, m, e) ||
        solids_build(&j->solid, &j->surface, &j->plan, j->unit, wants_slits(j->o) && !j->o->check, allow_open,
                     &j->warnings, e))
        return -1;
    say_time(j, "checking surfaces", clock);
    return 0;
}

static int work(job *j, model *m, err *e)
{
    double clock = clock_now();
    if (make_grid(j, e) || find_voxels(j, m, e))
        return -1;
    clock = say_time(j, "finding what is inside", clock);
    if (opens_slits(j) ? open_slits(j, e) : find_gaps(j, e))
        return -1;
    clock = say_time(j, opens_slits(j) ? "opening slits" : "finding gaps", clock);
    if (j->layer.layers) {
        if (layers_apply(&j->layer, &j->x, &j->plan, &j->surface, &j->g, j->threads, e))
            return -1;
        clock = say_time(j, "finding layers", clock);
    }
    const int status = make_model(j, m, e);
    say_time(j, "building the model", clock);
    return status ? -1 : say_plan(j, m, e);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {
        .cells = -1, .fraction = -1, .least = NAN, .slits = SLITS_NOT_GIVEN, .strain = STRAIN_NOT_GIVEN};
    o.mixed = -1;
    err e = {0};
    tool t = {0};
    stage s = {0};
    model m = {0};
    job j = {.o = &o, .t = &t};
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    j.path = argv[1];
    /* Without a unit there will be no model: that is said whatever stdout is. */
    if (check_options(&j, &e) || (!o.check && j.unit && stage_open_output(&s, &t, &e)) || prepare(&j, &m, &e))
        goto out;
    if (o.check)
        check(&j, &e);
    else if (!work(&j, &m, &e))
        stage_write(&s, &m, &e);
out:
    tool_warn(&t, &j.warnings);
    if (!t.done && !o.check)
        stage_close(&s, &t, &e);
    job_free(&j);
    model_free(&m);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
