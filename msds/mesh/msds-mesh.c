/* msds-mesh: regular meshes of tetrahedra over a box, over a volume image, or from a voxel model (PST section IV). */
#include "base/num.h"
#include "model/materials.h"
#include "model/stage.h"
#include "msds/mesh/mesh_fix.h"
#include "msds/mesh/mesh_labels.h"
#include "msds/mesh/mesh_tets.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct options {
    opt_common common;
    const char *nodes, *like, *labels, *names, *materials, *fix;
    opt_lengths size, origin;
    double young, poisson, density;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_ACTION, 0, "nodes", "NXxNYxNZ", OPT_TEXT, TO(nodes), 0, 0, NULL, 0,
     "nodes along x, y, z [default from the voxels]"},
    {OPT_ACTION, 0, "size", "X,Y,Z", OPT_LENGTHS, TO(size), 3, 3, NULL, 0, "sides of the box [length]"},
    {OPT_ACTION, 0, "origin", "X,Y,Z", OPT_LENGTHS, TO(origin), 3, 3, NULL, 0,
     "lowest corner of the box [length; default 0,0,0]"},
    {OPT_INPUT, 0, "like", "VOLUME", OPT_TEXT, TO(like), 0, 0, NULL, OPT_FILE,
     "in place of --size: cover this volume image"},
    {OPT_INPUT, 0, "labels", "VOLUME", OPT_TEXT, TO(labels), 0, 0, NULL, OPT_FILE,
     "volumes by labels of this image [default one, tissue]"},
    {OPT_INPUT, 0, "names", "LABEL=NAME,...", OPT_TEXT, TO(names), 0, 0, NULL, 0,
     "names of labels [default as in the image, or labelN]"},
    {OPT_INPUT, 0, "materials", "FILE", OPT_TEXT, TO(materials), 0, 0, NULL, OPT_FILE,
     "materials of the volumes [default one, tissue]"},
    {OPT_ACTION, 0, "young", "E", OPT_NUMBER, TO(young), 1e-3, 1e12, NULL, 0, "Young's modulus [Pa; default 3000]"},
    {OPT_ACTION, 0, "poisson", "NU", OPT_NUMBER, TO(poisson), -0.99, 0.4999, NULL, 0, "Poisson's ratio [default 0.45]"},
    {OPT_ACTION, 0, "density", "RHO", OPT_NUMBER, TO(density), 1e-3, 1e6, NULL, 0,
     "mass density [kg/m3; default 1000]"},
    {OPT_ACTION, 0, "fix", "LIST", OPT_TEXT, TO(fix), 0, 0, "xmin|xmax|ymin|ymax|zmin|zmax|sides|none|@volume.name", 0,
     "fix these sides and volumes, or none [default zmin]"},
    {0},
};

static const opt_tool table = {
    .name = "msds-mesh",
    .usage = "--nodes NXxNYxNZ [options] > model\n[options] < voxels > model",
    .purpose = "Makes regular meshes of tetrahedra: over a box, over a volume image, or from\na model of voxels on "
               "standard input.",
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
    } options[] = {{o->size.count > 0, "--size"},    {o->origin.count > 0, "--origin"},
                   {o->like != NULL, "--like"},      {o->labels != NULL, "--labels"},
                   {!isnan(o->young), "--young"},    {!isnan(o->poisson), "--poisson"},
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

static int check_options(const struct options *o, int32_t nodes[3], err *e)
{
    if (o->names && !o->labels)
        return err_usage(e, "--names is for --labels VOLUME; expected both");
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

static int make_volumes(const struct options *o, model *m, notes *warnings, err *e)
{
    volume labels = {0};
    if (!o->labels)
        return mesh_label(m, NULL, NULL, warnings, e);
    int status = volume_load(&labels, o->labels, &(volume_budget){.most = o->common.memory}, e);
    if (!status && o->names)
        status = mesh_label_names(&labels, o->names, e);
    if (!status)
        status = mesh_label(m, &labels, o->labels, warnings, e);
    volume_free(&labels);
    return status;
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

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void say_cells(const tool *t, const mesh_box *b)
{
    double side[3];
    for (int a = 0; a < 3; a++)
        side[a] = 1e3 * length_of(b->edge[a]) / (b->nodes[a] - 1);
    tool_say(t, "cells of %.6g x %.6g x %.6g mm", side[0], side[1], side[2]);
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

/* ---- the two ways to a mesh */

static int from_nodes(const struct options *o, mesh_box *b, model *m, notes *warnings, err *e)
{
    if (make_box(o, b, m, e) || make_materials(o, m, e) || make_volumes(o, m, warnings, e))
        return -1;
    return mesh_fix(m, o->fix ? o->fix : "zmin", b->nodes, e);
}

static int from_model(const struct options *o, stage *s, model *m, notes *warnings, err *e)
{
    if (stage_read(s, m, e) || stage_drop_frames(s, m, warnings, e) || mesh_split(m, warnings, e))
        return -1;
    if (o->materials && read_materials(o, m, NULL, e))
        return -1;
    return o->fix ? mesh_fix(m, o->fix, NULL, e) : 0;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.young = NAN, .poisson = NAN, .density = NAN};
    mesh_box b = {0};
    err e = {0};
    tool t = {0};
    stage s = {0};
    model m = {0};
    notes warnings = {0};
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done || check_options(&o, b.nodes, &e))
        goto out;
    if (stage_open_output(&s, &t, &e) ||
        (o.nodes ? from_nodes(&o, &b, &m, &warnings, &e) : from_model(&o, &s, &m, &warnings, &e)))
        goto out;
    if (o.nodes)
        say_cells(&t, &b);
    if (say_all(&t, &m, &warnings, &e))
        goto out;
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
