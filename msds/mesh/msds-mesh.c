/* msds-mesh: meshes of tetrahedra over a box, over a volume image or what of it is tissue, or from a voxel model (PST
 * section IV). */
#include "base/mem.h"
#include "base/num.h"
#include "model/materials.h"
#include "model/stage.h"
#include "msds/mesh/mesh_border.h"
#include "msds/mesh/mesh_fix.h"
#include "msds/mesh/mesh_graded.h"
#include "msds/mesh/mesh_labels.h"
#include "msds/mesh/mesh_refine.h"
#include "msds/mesh/mesh_shape.h"
#include "msds/mesh/mesh_walls.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    const char *nodes, *like, *mask, *labels, *names, *smooth, *materials, *fix;
    opt_lengths size, origin, refine, around;
    int top;
    double young, poisson, density;
};

static const char sides[] = "xmin|xmax|ymin|ymax|zmin|zmax";

enum { ZMAX = 5 };

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_ACTION, 0, "nodes", "NXxNYxNZ", OPT_TEXT, TO(nodes), 0, 0, NULL, 0,
     "nodes along x, y, z [default from the voxels]"},
    {OPT_ACTION, 0, "size", "X,Y,Z", OPT_LENGTHS, TO(size), 3, 3, NULL, 0, "sides of the box [length]"},
    {OPT_ACTION, 0, "origin", "X,Y,Z", OPT_LENGTHS, TO(origin), 3, 3, NULL, 0,
     "lowest corner of the box [length; default 0,0,0]"},
    {OPT_INPUT, 0, "like", "VOLUME", OPT_TEXT, TO(like), 0, 0, NULL, OPT_FILE,
     "in place of --size: cover this volume image"},
    {OPT_INPUT, 0, "mask", "WORDS", OPT_TEXT, TO(mask), 0, 0, "above:|tissue:|air:|sector", 0,
     "leave out air: above:LEVEL, tissue:LABEL, air:LABEL, sector [default all is meshed]"},
    {OPT_INPUT, 0, "labels", "VOLUME", OPT_TEXT, TO(labels), 0, 0, NULL, OPT_FILE,
     "volumes by labels of this image [default one, tissue]"},
    {OPT_INPUT, 0, "names", "LABEL=NAME,...", OPT_TEXT, TO(names), 0, 0, NULL, 0,
     "names of labels [default as in the image, or labelN]"},
    {OPT_INPUT, 0, "smooth", "NAME,...", OPT_TEXT, TO(smooth), 0, 0, NULL, 0,
     "smooth borders of these volumes of --labels, such as vessels [default none]"},
    {OPT_INPUT, 0, "materials", "FILE", OPT_TEXT, TO(materials), 0, 0, NULL, OPT_FILE,
     "materials of the volumes [default one, tissue]"},
    {OPT_ACTION, 0, "refine", "DEPTH,...", OPT_LENGTHS, TO(refine), 1, MESH_LEVELS, NULL, 0,
     "halve cells down to a depth, and again to the next [length; default none]"},
    {OPT_ACTION, 0, "around", "X,Y,Z", OPT_LENGTHS, TO(around), 3, 3, NULL, 0,
     "with --refine: distances from here, not depths [length]"},
    {OPT_ACTION, 0, "top", "SIDE", OPT_CHOICE, TO(top), 0, 0, sides, 0, "where the probe is [default zmax]"},
    {OPT_ACTION, 0, "young", "E", OPT_NUMBER, TO(young), 1e-3, 1e12, NULL, 0, "Young's modulus [Pa; default 3000]"},
    {OPT_ACTION, 0, "poisson", "NU", OPT_NUMBER, TO(poisson), -0.99, 0.4999, NULL, 0, "Poisson's ratio [default 0.45]"},
    {OPT_ACTION, 0, "density", "RHO", OPT_NUMBER, TO(density), 1e-3, 1e6, NULL, 0,
     "mass density [kg/m3; default 1000]"},
    {OPT_ACTION, 0, "fix", "LIST", OPT_TEXT, TO(fix), 0, 0, "xmin|xmax|ymin|ymax|zmin|zmax|sides|none|@volume.name", 0,
     "fix these sides and volumes, or none [default opposite the top]"},
    {0},
};

static const opt_tool table = {
    .name = "msds-mesh",
    .usage = "--nodes NXxNYxNZ [options] > model\n[options] < voxels > model",
    .purpose = "Makes meshes of tetrahedra: over a box, over a volume image or what of it is\ntissue, or from a model "
               "of voxels on standard input.",
    .note = "Lengths are in m, unless they have a suffix (" NUM_UNITS_LIST "), e.g. 5cm.",
    .example = "msds-mesh --nodes 20x10x10 --size 8cm,4cm,4cm | sinew info",
    .operands = "",
    .writes_model = true,
    .reads_volumes = true,
    .options = option_list,
};

/* ---- options */

/* "32x16x16" */
static int parse_nodes(const char *text, int32_t nodes[3], err *e)
{
    const char *p = text;
    for (int a = 0; a < 3; a++) {
        char word[16];
        int64_t n;
        size_t length = strcspn(p, "x");
        snprintf(word, sizeof word, "%.*s", length < sizeof word ? (int)length : 0, p);
        if (num_int(word, 2, INT32_MAX, &n) || (p[length] == 'x') != (a < 2))
            return err_usage(e, "--nodes '%.100s': expected NXxNYxNZ, such as 32x16x16, each 2 or more", text);
        nodes[a] = (int32_t)n;
        p += length + 1;
    }
    return 0;
}

/* The first of the options that only a mesh made here can have; NULL: none is given. */
static const char *mesh_option(const struct options *o)
{
    const struct {
        bool given;
        const char *name;
    } options[] = {{o->size.count > 0, "--size"},     {o->origin.count > 0, "--origin"},
                   {o->like != NULL, "--like"},       {o->mask != NULL, "--mask"},
                   {o->labels != NULL, "--labels"},   {o->smooth != NULL, "--smooth"},
                   {o->refine.count > 0, "--refine"}, {o->top >= 0, "--top"},
                   {!isnan(o->young), "--young"},     {!isnan(o->poisson), "--poisson"},
                   {!isnan(o->density), "--density"}};
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        if (options[i].given)
            return options[i].name;
    return NULL;
}

static int check_model_options(const struct options *o, err *e)
{
    const char *given = mesh_option(o);
    if (given)
        return err_usage(e, "%s is for a mesh of --nodes NXxNYxNZ; expected both", given);
    return 0;
}

static int check_mask(const struct options *o, err *e)
{
    bool labels;
    if (!o->mask)
        return 0;
    if (mesh_mask_words(o->mask, &labels, e))
        return -1;
    if (!o->like)
        return err_usage(e, "--mask is for --like VOLUME; expected both");
    return labels && !o->labels ? err_usage(e, "--mask of labels is for --labels VOLUME; expected both") : 0;
}

static int check_refine(const struct options *o, err *e)
{
    const num_unit metre = num_unit_of("m");
    if (o->around.count && !o->refine.count)
        return err_usage(e, "--around is for --refine DEPTH,...; expected both");
    for (int i = 0; i < o->refine.count; i++) {
        const double here = num_length_in(o->refine.value[i], metre, metre);
        if (!(here > 0) || (i && !(here <= num_length_in(o->refine.value[i - 1], metre, metre))))
            return err_usage(e, "--refine: expected depths above 0, each at most the one before, such as 15mm,5mm");
    }
    return 0;
}

static int check_options(const struct options *o, int32_t nodes[3], err *e)
{
    if (o->names && !o->labels)
        return err_usage(e, "--names is for --labels VOLUME; expected both");
    if (o->smooth && !o->labels)
        return err_usage(e, "--smooth is for --labels VOLUME; expected both");
    if (check_refine(o, e))
        return -1;
    if (!o->nodes)
        return check_model_options(o, e);
    if (parse_nodes(o->nodes, nodes, e))
        return -1;
    if (!o->size.count == !o->like)
        return err_usage(e, "%s; expected --size X,Y,Z or --like VOLUME",
                         o->like ? "--size and --like both say where the mesh is" : "no place for the mesh");
    if (o->origin.count && o->like)
        return err_usage(e, "--origin and --like both say where the mesh is; expected one of them");
    for (int a = 0; a < o->size.count; a++)
        if (!(o->size.value[a].value > 0))
            return err_usage(e, "--size: expected three lengths above 0");
    if (check_mask(o, e))
        return -1;
    if (o->like && o->labels && !strcmp(o->like, "-") && !strcmp(o->labels, "-"))
        return err_usage(e, "--like - and --labels -: standard input is read once; expected a file for one of them");
    bool standard = (o->like && !strcmp(o->like, "-")) || (o->labels && !strcmp(o->labels, "-"));
    return standard ? tool_need_stdin("a volume", e) : 0;
}

/* ---- where */

static void box_of_size(const struct options *o, mesh_box *b)
{
    num_unit metre = num_unit_of("m");
    for (int a = 0; a < 3; a++) {
        b->origin[a] = o->origin.count ? num_length_in(o->origin.value[a], metre, metre) : 0;
        b->edge[a][a] = num_length_in(o->size.value[a], metre, metre);
    }
}

/* From the outer face of the first voxels to that of the last. */
static void box_of_volume(const volume *v, mesh_box *b)
{
    static const double corner[3] = {-.5, -.5, -.5};
    volume_place(v, corner, b->origin);
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 3; i++)
            b->edge[a][i] = v->axis[a][i] * (double)v->size[a] / 1e3;
}

static int make_box(const struct options *o, mesh_box *b, model *m, err *e)
{
    volume like = {0};
    int status = 0;
    if (o->like) {
        status = volume_load(&like, o->like, &(volume_budget){.most = o->common.memory}, e);
        if (!status) {
            box_of_volume(&like, b);
            status = model_meta_set(m, "source.unit", "mm", e);
        }
        volume_free(&like);
    } else
        box_of_size(o, b);
    return status || mesh_box_add(m, b, e) ? -1 : 0;
}

/* ---- of what */

static int read_materials(const struct options *o, model *m, const material *usual, err *e)
{
    in *source = in_open(o->materials, e);
    int status = -1;
    if (source)
        status = usual ? materials_read_with(m, source, usual, e) : materials_override(m, source, e);
    in_close(source);
    return status;
}

static int make_materials(const struct options *o, model *m, err *e)
{
    material usual = materials_fallback();
    usual.law = law_of_form(FORM_LINEAR);
    usual.value[LAW_nu] = isnan(o->poisson) ? .45 : o->poisson;
    usual.value[LAW_E] = isnan(o->young) ? usual.value[LAW_E] : o->young;
    usual.density = isnan(o->density) ? usual.density : o->density;
    return o->materials ? read_materials(o, m, &usual, e) : materials_make(m, &usual, e);
}

static double labels_peak(const volume *v, const void *context)
{
    (void)context;
    return volume_memory(v) + MESH_REGION_BYTES * (double)volume_count(v);
}

static int load_labels(const struct options *o, volume *labels, err *e)
{
    if (!o->labels)
        return 0;
    const volume_budget budget = {.most = o->common.memory, .peak = o->smooth ? labels_peak : NULL};
    if (volume_load(labels, o->labels, &budget, e))
        return -1;
    return o->names ? mesh_label_names(labels, o->names, e) : 0;
}

static int make_volumes(const struct options *o, model *m, notes *warnings, err *e)
{
    volume labels = {0};
    int status = load_labels(o, &labels, e);
    if (!status)
        status = mesh_label(m, o->labels ? &labels : NULL, o->labels, NULL, NULL, warnings, e);
    volume_free(&labels);
    return status;
}

/* ---- of cells, where some are left out or halved */

typedef struct graded {
    mesh_refine refine;
    double around[3]; /* m */
    mesh_mask mask;
    mesh_cells cells;
    mesh_graded mesh;
    mesh_moved moved;
    mesh_smoothed smoothed;
    int64_t *label; /* of tetrahedra, where borders are smooth; owned */
} graded;

static void graded_free(graded *g)
{
    mesh_mask_free(&g->mask);
    mesh_cells_free(&g->cells);
    mesh_graded_free(&g->mesh);
    free(g->label);
}

static double mask_peak(const volume *v, const void *context)
{
    (void)context;
    return volume_memory(v) + MESH_MASK_BYTES * (double)volume_count(v);
}

/* The box, and what of the image's voxels is tissue, but for labels. */
static int look_at_image(const struct options *o, graded *g, mesh_box *b, model *m, err *e)
{
    const volume_budget budget = {.most = o->common.memory, .peak = o->mask ? mask_peak : NULL};
    volume like = {0};
    int status = volume_load(&like, o->like, &budget, e);
    if (!status) {
        double cell[3];
        box_of_volume(&like, b);
        for (int a = 0; a < 3; a++)
            cell[a] = (double)like.size[a] / (b->nodes[a] - 1) / (1 << o->refine.count);
        status = model_meta_set(m, "source.unit", "mm", e);
        if (!status && o->mask)
            status = mesh_mask_grey(&g->mask, o->mask, &like, g->refine.top, cell, e);
    }
    volume_free(&like);
    return status;
}

static void plan_refine(const struct options *o, graded *g, const mesh_box *b)
{
    const num_unit metre = num_unit_of("m");
    g->refine.box = b;
    g->refine.mask = o->mask ? &g->mask : NULL;
    g->refine.top = o->top < 0 ? ZMAX : o->top;
    g->refine.levels = o->refine.count;
    for (int i = 0; i < o->refine.count; i++)
        g->refine.within[i] = num_length_in(o->refine.value[i], metre, metre);
    for (int a = 0; a < o->around.count; a++)
        g->around[a] = num_length_in(o->around.value[a], metre, metre);
    g->refine.around = o->around.count ? g->around : NULL;
}

/* Cells that have no tissue are left out before there are tetrahedra. */
static int leave_out(graded *g, err *e)
{
    uint8_t *tissue = mem_array(g->cells.count, 1, "cells", e);
    if (!tissue)
        return -1;
    for (int64_t i = 0; i < g->cells.count; i++)
        tissue[i] = mesh_mask_share(&g->mask, &g->cells, &g->cells.cell[i]) > 0;
    mesh_cells_keep(&g->cells, tissue);
    free(tissue);
    return 0;
}

static int make_cells(const struct options *o, graded *g, const mesh_box *b, err *e)
{
    if (mesh_cells_make(&g->cells, b->nodes, g->refine.levels, mesh_refine_wish(&g->refine), e) ||
        (o->mask && leave_out(g, e)) || mesh_graded_make(&g->mesh, b, &g->cells, e))
        return -1;
    return o->mask ? mesh_border_fit(&g->mesh, b, &g->cells, &g->mask, &g->moved, e) : 0;
}

/* Crumbs at the border are not worth a word. */
static const double crumbs = .01; /* of the mesh */

static void note_left(const graded *g, notes *warnings)
{
    const mesh_left *left = &g->moved.left;
    if ((double)left->tets > crumbs * (double)g->mesh.tets)
        notes_add(warnings, "left out: %lld tetrahedra of tissue, in %lld part%s that no face joins to the rest",
                  (long long)left->tets, (long long)left->parts, left->parts == 1 ? "" : "s");
}

/* ---- say */

static int say_volumes(const tool *t, const model *m, notes *warnings, err *e)
{
    static const char *const heads[] = {"<volume", ">tetrahedra", "<material", NULL};
    const model_array *of = model_find(m, "element.volume"), *name = model_find(m, "volume.name");
    const model_array *of_volume = model_find(m, "volume.material"), *called = model_find(m, "material.name");
    if (!of || !name || !of_volume || !called)
        return 0;
    text_table *rows = text_table_create(heads, e);
    for (int64_t v = 0; rows && v < name->rows; v++) {
        int64_t count = 0;
        for (int64_t n = 0; n < of->rows; n++)
            count += of->i32[n] == v;
        text_table_cell(rows, "%s", name->str[v]);
        text_table_count(rows, count);
        text_table_cell(rows, "%s", called->str[of_volume->i32[v]]);
    }
    const char *plural = name->rows == 1 ? "" : "s";
    const int rc = rows ? tool_table(t, rows, e, "%lld volume%s", (long long)name->rows, plural) : -1;
    text_table_free(rows);
    for (int64_t i = 0; i < called->rows; i++) {
        bool used = false;
        for (int64_t v = 0; v < of_volume->rows; v++)
            used |= of_volume->i32[v] == i;
        if (!used)
            notes_add(warnings, "material %s belongs to no volume", called->str[i]);
    }
    return rc;
}

static void say_smoothed(const tool *t, const mesh_smoothed *s)
{
    if (s->nodes)
        tool_say(t, "%lld of %lld nodes of smooth borders lie on them, moved by at most %.3g mm",
                 (long long)(s->nodes - s->off), (long long)s->nodes, 1e3 * s->largest);
    if (s->off)
        tool_say(t, "the others are at most %.3g mm beside them", 1e3 * s->farthest);
}

static void say_cells(const tool *t, const mesh_box *b, const graded *g)
{
    int32_t least = MESH_UNITS(g->cells.levels);
    double side[3];
    for (int64_t i = 0; i < g->cells.count; i++)
        least = g->cells.cell[i].side < least ? g->cells.cell[i].side : least;
    const double finest = (double)MESH_UNITS(g->cells.levels) / least;
    for (int a = 0; a < 3; a++)
        side[a] = 1e3 * shape_length(b->edge[a]) / (b->nodes[a] - 1);
    if (g->refine.levels)
        tool_say(t, "cells of %.6g x %.6g x %.6g mm, the finest %.6g x %.6g x %.6g mm", side[0], side[1], side[2],
                 side[0] / finest, side[1] / finest, side[2] / finest);
    else
        tool_say(t, "cells of %.6g x %.6g x %.6g mm", side[0], side[1], side[2]);
    if (g->moved.nodes)
        tool_say(t, "%lld of %lld nodes of the skin lie on the border of tissue, moved by at most %.3g mm",
                 (long long)(g->moved.nodes - g->moved.off), (long long)g->moved.nodes, 1e3 * g->moved.largest);
    say_smoothed(t, &g->smoothed);
}

static int say_all(const tool *t, const model *m, notes *warnings, err *e)
{
    int64_t fixed = mesh_fixed(m);
    if (say_volumes(t, m, warnings, e))
        return -1;
    tool_say(t, "%lld nodes, %lld of them fixed; %lld tetrahedra", (long long)model_count(m, "node"), (long long)fixed,
             (long long)model_count(m, "element"));
    if (!fixed)
        notes_add(warnings, "no node is fixed: nothing holds the mesh");
    return 0;
}

/* ---- the ways to a mesh */

/* What is fixed where nothing is said: the side opposite the top. */
static void fix_usual(const struct options *o, char word[8])
{
    const int opposite = (o->top < 0 ? ZMAX : o->top) ^ 1;
    snprintf(word, 8, "%.4s", sides + opposite * 5);
}

static int from_nodes(const struct options *o, mesh_box *b, model *m, notes *warnings, err *e)
{
    char opposite[8];
    fix_usual(o, opposite);
    if (make_box(o, b, m, e) || make_materials(o, m, e) || make_volumes(o, m, warnings, e))
        return -1;
    return mesh_fix(m, o->fix ? o->fix : opposite, b->nodes, e);
}

static int smooth(const struct options *o, graded *g, const mesh_box *b, const volume *labels, err *e)
{
    mesh_regions regions = {0};
    g->label = mem_array(g->mesh.tets, sizeof *g->label, "labels", e);
    int status = g->label ? mesh_regions_make(&regions, o->smooth, labels, o->labels, e) : -1;
    if (!status)
        status = mesh_walls_smooth(&g->mesh, b, &g->cells, &regions, labels, g->label, &g->smoothed, e);
    mesh_regions_free(&regions);
    return status;
}

static int mesh_of_cells(const struct options *o, graded *g, mesh_box *b, model *m, const volume *labels, err *e)
{
    if (o->mask && mesh_mask_labels(&g->mask, o->mask, labels, o->labels, e))
        return -1;
    if (make_cells(o, g, b, e) || (o->smooth && smooth(o, g, b, labels, e)))
        return -1;
    return mesh_graded_add(&g->mesh, m, e);
}

static int from_cells(const struct options *o, graded *g, mesh_box *b, model *m, notes *warnings, err *e)
{
    volume labels = {0};
    char opposite[8];
    plan_refine(o, g, b);
    fix_usual(o, opposite);
    if (!o->like)
        box_of_size(o, b);
    int status = (o->like && look_at_image(o, g, b, m, e)) || load_labels(o, &labels, e);
    if (!status) {
        const volume *of = o->labels ? &labels : NULL;
        const mesh_without without = {mesh_mask_leaves, &g->mask};
        status = mesh_of_cells(o, g, b, m, of, e) || make_materials(o, m, e) ||
                 mesh_label(m, of, o->labels, g->label, &without, warnings, e);
    }
    volume_free(&labels);
    note_left(g, warnings);
    const mesh_made made = {&g->mesh, b, &g->cells};
    return status || mesh_fix_made(m, o->fix ? o->fix : opposite, &made, e) ? -1 : 0;
}

static int from_model(const struct options *o, stage *s, model *m, notes *warnings, err *e)
{
    if (stage_read(s, m, e) || stage_drop_frames(s, m, warnings, e) || mesh_split(m, warnings, e))
        return -1;
    if (o->materials && read_materials(o, m, NULL, e))
        return -1;
    return o->fix ? mesh_fix(m, o->fix, NULL, e) : 0;
}

static int make_mesh(const struct options *o, stage *s, graded *g, mesh_box *b, model *m, notes *warnings, err *e)
{
    if (!o->nodes)
        return from_model(o, s, m, warnings, e);
    return o->mask || o->smooth || o->refine.count ? from_cells(o, g, b, m, warnings, e)
                                                   : from_nodes(o, b, m, warnings, e);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.young = NAN, .poisson = NAN, .density = NAN, .top = -1};
    graded g = {0};
    mesh_box b = {0};
    err e = {0};
    tool t = {0};
    stage s = {0};
    model m = {0};
    notes warnings = {0};
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done || check_options(&o, b.nodes, &e))
        goto out;
    if (stage_open_output(&s, &t, &e) || make_mesh(&o, &s, &g, &b, &m, &warnings, &e))
        goto out;
    if (o.nodes)
        say_cells(&t, &b, &g);
    if (say_all(&t, &m, &warnings, &e))
        goto out;
    stage_write(&s, &m, &e);
out:
    tool_warn(&t, &warnings);
    if (!t.done)
        stage_close(&s, &t, &e);
    graded_free(&g);
    model_free(&m);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
