/* sinew-import: a mesh of another program (Abaqus input, Gmsh, VTU) as a model. */
#include "base/mem.h"
#include "base/num.h"
#include "exchange/import_inp.h"
#include "exchange/import_msh.h"
#include "exchange/import_vtu.h"
#include "mesh/extent.h"
#include "model/stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct format {
    const char *begins; /* first bytes by which files of it are told apart */
    import_reader *read;
} format;

/* In the order of the words of -f; AUTO: by the first byte of the file. */
enum { AUTO, INP, MSH, VTU, FORMATS };
static const format formats[FORMATS] = {
    [INP] = {"*\n\r ", import_inp}, [MSH] = {"$", import_msh}, [VTU] = {"<", import_vtu}};

struct options {
    opt_common common;
    int format, stress, density;
    const char *unit, *volume, *material, *materials;
    opt_list rigid;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_INPUT, 'f', "format", "inp|msh|vtu", OPT_CHOICE, TO(format), 0, 0, "auto|inp|msh|vtu", 0,
     "format of the mesh [default recognised]"},
    {OPT_INPUT, 0, "unit", NUM_UNITS_CHOICES, OPT_TEXT, TO(unit), 0, 0, NULL, OPT_REQUIRED,
     "unit of lengths in the mesh; required"},
    {OPT_INPUT, 0, "rigid", "SET,...", OPT_LIST, TO(rigid), 0, 0, NULL, 0,
     "fix the nodes of these sets, groups or arrays"},
    {OPT_INPUT, 0, "volume", "NAME", OPT_TEXT, TO(volume), 0, 0, NULL, 0,
     "volume of elements in none [default tissue]"},
    {OPT_INPUT, 0, "material", "NAME", OPT_TEXT, TO(material), 0, 0, NULL, 0,
     "material of volumes that have none [default by name]"},
    {OPT_INPUT, 0, "materials", "FILE", OPT_TEXT, TO(materials), 0, 0, NULL, OPT_FILE,
     "materials, in place of those of the mesh"},
    {OPT_INPUT, 0, "stress", "Pa|kPa|MPa|GPa", OPT_CHOICE, TO(stress), 0, 0, "auto|Pa|kPa|MPa|GPa", 0,
     "unit of moduli [default Pa, if --unit is m]"},
    {OPT_INPUT, 0, "density", "kg/m3|g/cm3|t/mm3", OPT_CHOICE, TO(density), 0, 0, "auto|kg/m3|g/cm3|t/mm3", 0,
     "unit of densities [default kg/m3, if --unit is m]"},
    {0},
};

static const opt_tool table = {
    .name = "sinew-import",
    .command = "sinew import",
    .usage = "--unit UNIT [options] mesh > model\n--unit UNIT [options] - < mesh > model",
    .purpose = "Converts a mesh of hexahedra or tetrahedra to a model.",
    .example = "sinew import --unit mm --rigid porta liver.msh > liver.sinew",
    .operands = "mesh|-",
    .operands_min = 1,
    .operands_max = 1,
    .writes_model = true,
    .options = option_list,
};

/* The names of --rigid, one by one. */
typedef struct rigid_names {
    char *text[64];
    const char *name[256];
    int count;
} rigid_names;

static int cut_names(rigid_names *n, const opt_list *list, err *e)
{
    for (int i = 0; i < list->count; i++) {
        n->text[i] = mem_text(list->value[i], e);
        if (!n->text[i])
            return -1;
        for (char *at = n->text[i], *next; at; at = next) {
            if ((next = strchr(at, ',')))
                *next++ = '\0';
            if (!*at)
                return err_usage(e, "--rigid '%.200s': an empty name; expected SET,...", list->value[i]);
            if (n->count == 256)
                return err_usage(e, "--rigid: more than 256 names");
            n->name[n->count++] = at;
        }
    }
    return 0;
}

static int make_wishes(const struct options *o, const rigid_names *n, import_wishes *w, err *e)
{
    static const double stress[] = {0, 1, 1e3, 1e6, 1e9}, density[] = {0, 1, 1e3, 1e12};
    const num_unit unit = num_unit_of(o->unit), metre = num_unit_of("m");
    if (!unit)
        return err_usage(e, "--unit '%s': expected " NUM_UNITS, o->unit);
    *w = (import_wishes){.scale = num_length_in((num_length){1, unit}, unit, metre),
                         .stress = stress[o->stress ? o->stress : unit == metre],
                         .density = density[o->density ? o->density : unit == metre],
                         .volume = o->volume ? o->volume : "tissue",
                         .material = o->material,
                         .rigid = n->name,
                         .rigids = n->count,
                         .own_materials = o->materials != NULL};
    return 0;
}

/* By the first byte; what it is not, its reader says. */
static int recognise(in *s, const char *name, err *e)
{
    const int first = in_peek(s, e);
    const char *what = "a file that begins like none that is read";
    if (first == -2)
        return -1;
    for (int i = AUTO + 1; i < FORMATS; i++)
        if (first > 0 && strchr(formats[i].begins, first))
            return i;
    if (first < 0)
        what = "an empty file";
    if (first == '#')
        what = "VTK's legacy format, or a comment";
    return err_set(e, name, 1, "%s; expected Abaqus input, Gmsh's MSH or VTK's VTU, or -f to say which", what);
}

static int read_mesh(import_mesh *mesh, const char *path, const struct options *o, const import_wishes *w,
                     notes *warnings, err *e)
{
    in *s = in_open(path, e);
    int which = s ? o->format : -1;
    if (which == AUTO)
        which = recognise(s, mesh->name, e);
    const int result = which < 0 ? -1 : formats[which].read(mesh, s, w, warnings, e);
    in_close(s);
    return result;
}

static int read_materials(const struct options *o, model *m, err *e)
{
    in *s = o->materials ? in_open(o->materials, e) : NULL;
    int result = o->materials && (!s || materials_read(m, s, e)) ? -1 : 0;
    in_close(s);
    return result;
}

/* The sides of the box about all nodes, in the file's unit. */
static void find_sides(const import_mesh *mesh, double side[3])
{
    for (int a = 0; a < 3; a++) {
        double low = INFINITY, high = -INFINITY;
        for (int64_t n = 0; n < mesh->nodes; n++) {
            low = fmin(low, mesh->position[3 * n + a]);
            high = fmax(high, mesh->position[3 * n + a]);
        }
        side[a] = high - low;
    }
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.format = AUTO};
    err e = {0};
    tool t = {0};
    stage s = {0};
    model m = {0};
    rigid_names rigid = {.count = 0};
    import_wishes w = {0};
    import_mesh mesh = {0};
    notes warnings = {0};
    double side[3];
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (stage_open_output(&s, &t, &e) || cut_names(&rigid, &o.rigid, &e) || make_wishes(&o, &rigid, &w, &e))
        goto out;
    mesh.name = strcmp(argv[1], "-") ? argv[1] : "stdin";
    if (!strcmp(argv[1], "-") && tool_need_stdin("a mesh", &e))
        goto out;
    if (read_materials(&o, &m, &e) || read_mesh(&mesh, argv[1], &o, &w, &warnings, &e) ||
        model_meta_set(&m, "source.unit", o.unit, &e) || import_build(&mesh, &w, &m, &warnings, &e) ||
        stage_write(&s, &m, &e))
        goto out;
    find_sides(&mesh, side);
    extent_note(&warnings, mesh.name, side, num_unit_of(o.unit));
    tool_say(&t, "a mesh of %.4g x %.4g x %.4g %s", side[0], side[1], side[2], o.unit);
    tool_say(&t, "%lld nodes, %lld elements of %d corners, %lld volumes", (long long)mesh.nodes,
             (long long)mesh.elements, (int)mesh.columns, (long long)mesh.volume_count);
out:
    tool_warn(&t, &warnings);
    if (!t.done)
        stage_close(&s, &t, &e);
    for (int i = 0; i < rigid.count && i < 64; i++)
        free(rigid.text[i]);
    import_free(&mesh);
    model_free(&m);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
