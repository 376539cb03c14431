/* The last part of import_mesh.h: from a mesh as it came to a model. */
#include "base/mem.h"
#include "exchange/import_mesh.h"
#include "exchange/inp_law.h"
#include "mesh/lattice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const double flat = 1e-9; /* of the cube over its longest side: less is no inside */

/* ---- elements */

static const double *place(const import_mesh *m, int64_t element, int corner)
{
    return m->position + 3 * (int64_t)m->corner[element * m->columns + corner];
}

static double determinant(double a[3][3])
{
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) + a[0][1] * (a[1][2] * a[2][0] - a[1][0] * a[2][2]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/* Six times the tetrahedron's volume; *longest gets its longest side from corner 0. */
static double inside_of_tet(const import_mesh *m, int64_t element, double *longest)
{
    double side[3][3];
    *longest = 0;
    for (int c = 0; c < 3; c++) {
        double square = 0;
        for (int a = 0; a < 3; a++) {
            side[c][a] = place(m, element, c + 1)[a] - place(m, element, 0)[a];
            square += side[c][a] * side[c][a];
        }
        *longest = fmax(*longest, sqrt(square));
    }
    return determinant(side);
}

/* What the map from a cube does to volume at a corner. */
static double corner_of_hex(const import_mesh *m, int64_t element, int c)
{
    static const int along[3] = {1, 3,
                                 4}; /* the corner that differs along an axis: c ^ along, as lattice_vtk numbers them */
    double side[3][3];
    for (int axis = 0; axis < 3; axis++) {
        const double *other = place(m, element, c ^ along[axis]), *own = place(m, element, c);
        for (int a = 0; a < 3; a++)
            side[axis][a] = (other[a] - own[a]) * (lattice_vtk[c][axis] ? -1 : 1);
    }
    return determinant(side);
}

/* And at the middle; *longest gets the longest of its three mean sides. */
static double middle_of_hex(const import_mesh *m, int64_t element, double *longest)
{
    double side[3][3] = {{0}};
    *longest = 0;
    for (int axis = 0; axis < 3; axis++) {
        double square = 0;
        for (int a = 0; a < 3; a++) {
            for (int c = 0; c < 8; c++)
                side[axis][a] += (lattice_vtk[c][axis] ? .25 : -.25) * place(m, element, c)[a];
            square += side[axis][a] * side[axis][a];
        }
        *longest = fmax(*longest, sqrt(square));
    }
    return determinant(side);
}

static int check_corners(const import_mesh *m, int64_t element, err *e)
{
    const int32_t *corner = m->corner + element * m->columns;
    for (int c = 0; c < m->columns; c++)
        for (int d = 0; d < c; d++)
            if (corner[c] == corner[d])
                return err_set(
                    e, m->name, m->line[element],
                    "element %lld has one node at two of its corners; expected %d different ones: wedges and "
                    "pyramids are not read, nor as collapsed hexahedra",
                    (long long)element, m->columns);
    return 0;
}

/* *twisted counts hexahedra that are inside out at a corner, but not in the middle. */
static int check_element(const import_mesh *m, int64_t element, int64_t *twisted, err *e)
{
    double longest, inside;
    if (check_corners(m, element, e))
        return -1;
    inside = m->columns == 8 ? middle_of_hex(m, element, &longest) : inside_of_tet(m, element, &longest);
    double least = flat * longest * longest * longest;
    if (!(fabs(inside) > least))
        return err_set(e, m->name, m->line[element], "element %lld has no inside; expected one with a volume",
                       (long long)element);
    if (!(inside > 0))
        return err_set(e, m->name, m->line[element],
                       "element %lld is inside out; expected its %d corners in the order that the format gives",
                       (long long)element, m->columns);
    bool twists = false;
    for (int c = 0; m->columns == 8 && c < 8 && !twists; c++)
        twists = !(corner_of_hex(m, element, c) > 0);
    *twisted += twists;
    return 0;
}

static int check_elements(const import_mesh *m, notes *warnings, err *e)
{
    int64_t twisted = 0;
    if (!m->elements)
        return err_set(e, m->name, 0, "no hexahedra and no tetrahedra; expected a mesh of either");
    for (int64_t i = 0; i < 3 * m->nodes; i++)
        if (!isfinite(m->position[i]))
            return err_set(e, m->name, 0, "node %lld is not in a place of finite numbers", (long long)(i / 3));
    for (int64_t i = 0; i < m->elements; i++)
        if (check_element(m, i, &twisted, e))
            return -1;
    if (twisted)
        notes_add(warnings, "%lld element%s inside out at a corner, though not in the middle", (long long)twisted,
                  twisted == 1 ? " is" : "s are");
    return 0;
}

/* ---- nodes */

/* Nodes in use stay in their order; the others go. */
static int drop_nodes(import_mesh *m, notes *warnings, err *e)
{
    int32_t *place_of = mem_array(m->nodes, sizeof *place_of, "nodes", e), used = 0;
    if (!place_of)
        return -1;
    for (int64_t i = 0; i < m->elements * m->columns; i++)
        place_of[m->corner[i]] = 1;
    for (int64_t n = 0; n < m->nodes; n++)
        if (place_of[n]) {
            memmove(m->position + 3 * (int64_t)used, m->position + 3 * n, 3 * sizeof *m->position);
            if (m->rigid)
                m->rigid[used] = m->rigid[n];
            place_of[n] = used++;
        }
    for (int64_t i = 0; i < m->elements * m->columns; i++)
        m->corner[i] = place_of[m->corner[i]];
    if (used < m->nodes)
        notes_add(warnings, "%lld of the %lld nodes are in no element: left out", (long long)(m->nodes - used),
                  (long long)m->nodes);
    m->nodes = used;
    free(place_of);
    return 0;
}

/* ---- materials and volumes */

/* In SI. */
static int convert_material(const import_mesh *mesh, const import_material *from, const import_wishes *w, material *to,
                            notes *warnings, err *e)
{
    const material usual = materials_fallback();
    if (!from->of.law)
        return err_set(e, mesh->name, from->line,
                       "material %.200s has no law; expected *ELASTIC or *HYPERELASTIC, " INP_LAW_NAMES, from->name);
    if (isnan(from->of.density))
        notes_add(warnings, "material %.200s has no density: taken as %g kg/m3", from->name, usual.density);
    *to = from->of;
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        if (!strcmp(law_key_unit((law_key)k), "Pa"))
            to->value[k] *= w->stress;
    to->density = isnan(from->of.density) ? usual.density : from->of.density * w->density;
    to->peak = usual.peak;
    return 0;
}

/* Those of the file become the model's. */
static int put_materials(const import_mesh *mesh, const import_wishes *w, model *m, notes *warnings, err *e)
{
    if (!(w->stress > 0) || !(w->density > 0))
        return err_set(
            e, mesh->name, mesh->material[0].line,
            "the file does not say the units of its materials; expected --stress Pa|kPa|MPa|GPa and --density "
            "kg/m3|g/cm3|t/mm3, or --materials FILE, where --unit is not m");
    const char **name = mem_array(mesh->materials, sizeof *name, "materials", e);
    material *of = name ? mem_array(mesh->materials, sizeof *of, "materials", e) : NULL;
    int status = of ? 0 : -1;
    for (int64_t i = 0; !status && i < mesh->materials; i++) {
        name[i] = mesh->material[i].name;
        status = convert_material(mesh, &mesh->material[i], w, &of[i], warnings, e);
    }
    status = status ? status : materials_put(m, name, of, mesh->materials, e);
    free(of);
    free(name);
    for (int64_t i = 0; !status && i < mesh->materials; i++) {
        material check;
        err why = {0};
        if (materials_of(m, i, &check, &why))
            status = err_set(e, mesh->name, mesh->material[i].line, "%.900s", why.text);
    }
    return status;
}

static int make_materials(const import_mesh *mesh, const import_wishes *w, model *m, notes *warnings, err *e)
{
    if (w->own_materials)
        return 0;
    return mesh->materials ? put_materials(mesh, w, m, warnings, e) : materials_default(m, e);
}

/* Of the model's table, in which names have a case though the file's have none: as it is written, or
 * the first that differs by case alone. */
static int32_t find_material(const import_mesh *mesh, const model *m, const char *name)
{
    const model_array *a = model_find(m, "material.name");
    int32_t at = materials_find(m, name);
    for (int64_t i = 0; mesh->any_case && at < 0 && i < a->rows; i++)
        if (!strcasecmp(a->str[i], name))
            at = (int32_t)i;
    return at;
}

/* A volume is of the material that the file says; else of the one asked for; else of one that is named
 * as the volume is; else of the only one. */
static int32_t material_of(const import_mesh *mesh, const import_wishes *w, const model *m, const import_volume *v,
                           err *e)
{
    const char *name = w->material;
    if (v->material >= 0 && !w->own_materials)
        return v->material; /* the model's table is the file's */
    if (v->material >= 0)
        name = mesh->material[v->material].name;
    int32_t at = find_material(mesh, m, name ? name : v->name);
    const char *written = v->material >= 0 ? mesh->material[v->material].written : NULL;
    if (at < 0 && name && !(w->own_materials && model_count(m, "material") == 1))
        return v->material < 0
                   ? materials_unknown(m, name, "--material", 0, e)
                   : materials_unknown(m, written ? written : name, mesh->name, mesh->material[v->material].line, e);
    if (at < 0 && model_count(m, "material") > 1)
        return err_set(e, mesh->name, 0,
                       "no material is given for volume %.200s; expected --material NAME, or a material of "
                       "the volume's name",
                       v->name);
    return at < 0 ? 0 : at;
}

static int put_volumes(const import_mesh *mesh, const import_wishes *w, model *m, err *e)
{
    static const char *const array_names[] = {"volume.level", "volume.priority", "volume.name", "volume.material",
                                              "volume.muscle"};
    if (model_axis_add(m, "volume", mesh->volume_count, e))
        return -1;
    for (int i = 0; i < 5; i++)
        if (!model_add(m, array_names[i], e))
            return -1;
    for (int64_t i = 0; i < mesh->volume_count; i++) {
        const import_volume *v = &mesh->volumes[i];
        int32_t of = material_of(mesh, w, m, v, e);
        if (of < 0 || model_set_text(model_find(m, "volume.name"), i, v->name, e))
            return -1;
        model_find(m, "volume.material")->i32[i] = of;
        model_find(m, "volume.muscle")->u8[i] = !strncasecmp(v->name, "muscle", 6);
    }
    return 0;
}

/* Elements that the file puts in no volume are of one of their own. */
static int name_the_rest(import_mesh *mesh, const import_wishes *w, err *e)
{
    int32_t rest = -1;
    for (int64_t i = 0; i < mesh->elements; i++) {
        if (mesh->volume[i] >= 0)
            continue;
        if (rest < 0 && (rest = import_add_volume(mesh, w->volume, e)) < 0)
            return -1;
        mesh->volume[i] = rest;
    }
    return 0;
}

/* An array of directions over the elements, where the mesh has any. */
static int put_directions(model *m, const char *name, const float *along, err *e)
{
    model_array *to = along ? model_add(m, name, e) : NULL;
    if (to)
        memcpy(to->f32, along, 3 * (size_t)to->rows * sizeof *along);
    return along && !to ? -1 : 0;
}

static int put_mesh(const import_mesh *mesh, const import_wishes *w, model *m, err *e)
{
    if (model_axis_add(m, "node", mesh->nodes, e) || model_axis_add(m, "element", mesh->elements, e))
        return -1;
    model_array *position = model_add(m, "node.position", e);
    if (!position)
        return -1;
    for (int64_t i = 0; i < 3 * mesh->nodes; i++)
        position->f64[i] = mesh->position[i] * w->scale;
    if (mesh->rigid) {
        model_array *rigid = model_add(m, "node.rigid", e);
        if (!rigid)
            return -1;
        for (int64_t i = 0; i < mesh->nodes; i++)
            rigid->u8[i] = mesh->rigid[i] != 0;
    }
    model_array *node = model_add_as(m, "element.node", MODEL_I32, "@node", "element", mesh->columns, e);
    if (!node)
        return -1;
    memcpy(node->i32, mesh->corner, (size_t)(mesh->elements * mesh->columns) * sizeof *mesh->corner);
    model_array *volume = model_add(m, "element.volume", e);
    if (!volume)
        return -1;
    memcpy(volume->i32, mesh->volume, (size_t)mesh->elements * sizeof *mesh->volume);
    return put_directions(m, "element.fibre", mesh->fibre, e) || put_directions(m, "element.normal", mesh->normal, e)
               ? -1
               : 0;
}

int import_build(import_mesh *mesh, const import_wishes *w, model *m, notes *warnings, err *e)
{
    if (check_elements(mesh, warnings, e) || drop_nodes(mesh, warnings, e) || name_the_rest(mesh, w, e) ||
        make_materials(mesh, w, m, warnings, e) || put_mesh(mesh, w, m, e) || put_volumes(mesh, w, m, e))
        return -1;
    for (int64_t i = 0; mesh->rigid && i < mesh->nodes; i++)
        if (mesh->rigid[i])
            return 0;
    notes_add(warnings, "no node is rigid: nothing holds the model; --rigid names what does");
    return 0;
}
