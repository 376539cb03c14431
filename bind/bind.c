/* bind: surfaces to elements, so that they move with them (W&M section 3.3). */
#include "base/mem.h"
#include "base/num.h"
#include "base/pool.h"
#include "bind/nearest.h"
#include "bind/side.h"
#include "bind/tetra.h"
#include "bind/touch.h"
#include "mesh/hexahedron.h"
#include "mesh/weights.h"
#include "model/check.h"
#include "model/known.h"
#include "model/stage.h"
#include "surface/scale.h"
#include "surface/surface.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    const char *name;
    const char *unit;
    int motion;
    opt_list self_contact;
    opt_lengths contact_spacing;
};

enum { MOTION_BLENDED, MOTION_ELEMENT }; /* below 0: not given */

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_INPUT, 0, "name", "NAME", OPT_TEXT, TO(name), 0, 0, NULL, 0, "name of the surface [default that of the file]"},
    {OPT_INPUT, 0, "unit", NUM_UNITS_CHOICES, OPT_TEXT, TO(unit), 0, 0, NULL, 0,
     "unit of the OBJ [default the model's]"},
    {OPT_ACTION, 0, "motion", "blended|element", OPT_CHOICE, TO(motion), 0, 0, "blended|element", 0,
     "in voxels: vertices move with the elements around theirs too, or with theirs alone [default blended]"},
    {OPT_ACTION, 0, "self-contact", "SURFACE,...[:REGION]|auto", OPT_LIST, TO(self_contact), 0, 0, "auto", OPT_NAMED,
     "skin that may touch itself; region: FILE.obj or X0,Y0,Z0,X1,Y1,Z1; auto: about slits"},
    {OPT_ACTION, 0, "contact-spacing", "LENGTH", OPT_LENGTHS, TO(contact_spacing), 0, 1, NULL, 0,
     "how far apart samples of it may be [default a voxel]"},
    {0},
};

static const opt_tool table = {
    .name = "bind",
    .command = "sinew bind",
    .usage = "[options] [surface.obj...] < model > result",
    .purpose = "Binds surfaces to the elements of a model, so that they move with them.\nWithout surface.obj: the "
               "surfaces that the model carries.",
    .example = "sinew bind --unit mm vein.obj artery.obj < arm.sinew > bound.sinew",
    .operands = "surface.obj...",
    .operands_max = 1000,
    .writes_model = true,
    .threaded = true,
    .options = option_list,
};

/* What the surfaces are bound to. */
typedef struct target {
    nearest voxels;   /* or */
    side sides;       /* of slits between voxels */
    tetra tetrahedra; /* or hexahedra without a lattice */
    bool by_lattice;
    bool blended; /* how vertices will move: mesh/motion.h */
    pool *threads;
    const int32_t *node; /* elements x corners */
    int corners;
    const double *position; /* nodes x 3, m */
} target;

/* One surface on its way. */
typedef struct binding {
    const target *to;
    const double *position; /* vertices x 3, m */
    int32_t *element;       /* vertices */
    double *weight;         /* vertices x 3 (voxels) or 4 */
    const double *normal;   /* vertices x 3: of a surface that bounds slits; or NULL */
} binding;

static int check_model(const model *m, err *e)
{
    const model_array *node = model_need(m, "element.node", e), *position = model_need(m, "node.position", e);
    if (!node || !position)
        return -1;
    if (!node->rows)
        return err_set(e, NULL, 0, "the model has no elements; expected elements to bind to");
    return 0;
}

static int target_open(target *to, const model *m, const struct options *o, int threads, notes *warnings, err *e)
{
    to->corners = model_find(m, "element.node")->columns;
    to->by_lattice = to->corners == 8 && (model_meta_of(m, "lattice.spacing") || model_find(m, "element.lattice"));
    to->blended = to->by_lattice && o->motion != MOTION_ELEMENT;
    to->threads = pool_create(threads, e);
    if (!to->threads ||
        (to->by_lattice ? nearest_build(&to->voxels, m, to->threads, e) : tetra_build(&to->tetrahedra, m, e)))
        return -1;
    if (to->tetrahedra.flat)
        notes_add(warnings, "%lld of the %s have no volume, and nothing is bound to them",
                  (long long)to->tetrahedra.flat, to->corners == 4 ? "tetrahedra" : "hexahedra");
    return to->by_lattice && side_create(&to->sides, m, &to->voxels, threads, e) ? -1 : 0;
}

static void target_close(target *to)
{
    side_free(&to->sides);
    nearest_free(&to->voxels);
    tetra_free(&to->tetrahedra);
    if (to->threads)
        pool_destroy(to->threads);
}

static void bind_to_voxel(const binding *b, int64_t v)
{
    const double *point = &b->position[3 * v];
    const double *normal = b->normal ? &b->normal[3 * v] : NULL;
    b->element[v] = side_element(&b->to->sides, point, normal, nearest_element(&b->to->voxels, point));
    weights_box box = weights_box_of(&b->to->node[8 * (int64_t)b->element[v]], b->to->position);
    weights_of(&box, point, &b->weight[3 * v]);
}

static void bind_to_tetrahedron(const binding *b, int64_t v)
{
    const double *point = &b->position[3 * v];
    b->element[v] = tetra_element(&b->to->tetrahedra, point);
    weights_tetrahedron(&b->to->node[4 * (int64_t)b->element[v]], b->to->position, point, &b->weight[4 * v]);
}

static void bind_to_hexahedron(const binding *b, int64_t v)
{
    const double *point = &b->position[3 * v];
    b->element[v] = tetra_element(&b->to->tetrahedra, point);
    hexahedron_weights(&b->to->node[8 * (int64_t)b->element[v]], b->to->position, point, &b->weight[3 * v]);
}

static void bind_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const binding *b = context;
    (void)chunk;
    for (int64_t v = from; v < to; v++)
        if (b->to->by_lattice)
            bind_to_voxel(b, v);
        else if (b->to->corners == 8)
            bind_to_hexahedron(b, v);
        else
            bind_to_tetrahedron(b, v);
}

/* How far outside the elements a surface's vertices lie. */
typedef struct outside {
    int64_t count; /* of those further than a voxel, or than their tetrahedron is long */
    double furthest;
} outside;

/* A voxel's longest side, or a tetrahedron's; of another hexahedron its longest diagonal. */
static double length_of(const target *to, int32_t element)
{
    double longest = 0;
    const double *spacing = to->voxels.grid.spacing;
    const int32_t *node = &to->node[to->corners * (int64_t)element];
    if (to->by_lattice)
        return fmax(fmax(spacing[0], spacing[1]), spacing[2]);
    for (int i = 0; i < to->corners; i++)
        for (int j = 0; j < i; j++) {
            double square = 0;
            for (int a = 0; a < 3; a++) {
                double d = to->position[3 * (int64_t)node[i] + a] - to->position[3 * (int64_t)node[j] + a];
                square += d * d;
            }
            longest = fmax(longest, square);
        }
    return sqrt(longest);
}

static void add_outside(outside *o, const binding *b, int64_t v)
{
    const int32_t *node = &b->to->node[b->to->corners * (int64_t)b->element[v]];
    double d;
    if (b->to->by_lattice) {
        weights_box box = weights_box_of(node, b->to->position);
        d = weights_outside(&box, &b->weight[3 * v]);
    } else if (b->to->corners == 8) {
        d = hexahedron_outside(node, b->to->position, &b->position[3 * v]);
    } else {
        d = weights_tetrahedron_outside(node, b->to->position, &b->position[3 * v]);
    }
    o->count += d > 0 && d > length_of(b->to, b->element[v]) * (1 + 1e-9);
    o->furthest = fmax(o->furthest, d);
}

/* Warns of vertices so far from the elements that extrapolation means little. Those that no face uses do not matter,
 * unless there are no faces. */
static int warn_of_far(const binding *b, const surface *s, num_unit unit, notes *warnings, err *e)
{
    outside o = {0};
    bool *used = mem_array(s->vertices, sizeof *used, "vertices", e);
    if (!used)
        return -1;
    for (int64_t c = 0; c < s->corners; c++)
        used[s->vertex[c]] = true;
    for (int64_t v = 0; v < s->vertices; v++)
        if (used[v] || !s->corners)
            add_outside(&o, b, v);
    free(used);
    if (o.count)
        notes_add(warnings,
                  "surface %s: %lld of %lld vertices lie further than a%s outside the elements, the furthest %.4g %s; "
                  "sinew deform --within leaves such vertices where they are",
                  s->name, (long long)o.count, (long long)s->vertices, b->to->by_lattice ? " voxel" : "n element",
                  o.furthest / scale_of(unit), num_unit_name(unit));
    return 0;
}

static int check_finite(const surface *s, err *e)
{
    for (int64_t i = 0; i < 3 * s->vertices; i++)
        if (!isfinite(s->position[i]))
            return err_set(e, NULL, 0, "surface %s, vertex %lld: its position is not finite; expected finite numbers",
                           s->name, (long long)(i / 3));
    return 0;
}

/* Adds S/vertex.blended, or takes it away. */
static int bind_motion(const target *to, model *m, const char *name, err *e)
{
    char blended[MODEL_NAME];
    snprintf(blended, sizeof blended, "%s/vertex.blended", name);
    if (!to->blended) {
        model_remove(m, blended);
        return 0;
    }
    model_array *a = model_add(m, blended, e);
    if (a && a->rows)
        memset(a->u8, 1, (size_t)a->rows);
    return a ? 0 : -1;
}

/* Adds S/vertex.element, S/vertex.weight and S/vertex.blended, or makes them anew. */
static int bind_surface(const tool *t, target *to, model *m, const char *name, num_unit unit, notes *warnings, err *e)
{
    char element[MODEL_NAME], weight[MODEL_NAME], axis[MODEL_NAME];
    surface s;
    snprintf(element, sizeof element, "%s/vertex.element", name);
    snprintf(weight, sizeof weight, "%s/vertex.weight", name);
    snprintf(axis, sizeof axis, "%s/vertex", name);
    if (model_find(m, element))
        tool_say(t, "surface %s was bound already; the new binding replaces the old one", name);
    if (!model_add(m, element, e) || !model_add_as(m, weight, MODEL_F64, "1", axis, to->corners == 8 ? 3 : 4, e) ||
        bind_motion(to, m, name, e) || surface_of(m, name, &s, e) || check_finite(&s, e))
        return -1;
    to->node = model_find(m, "element.node")->i32;
    to->position = model_find(m, "node.position")->f64;
    double *normal = to->sides.beside ? side_normals(&to->sides, &s, m, e) : NULL;
    if (to->sides.beside && !normal)
        return -1;
    binding b = {to, s.position, model_find(m, element)->i32, model_find(m, weight)->f64, normal};
    pool_run(to->threads, s.vertices, 1024, bind_some, &b);
    free(normal);
    b.normal = NULL;
    if (warn_of_far(&b, &s, unit, warnings, e))
        return -1;
    tool_detail(t, "surface %s: %lld vertices bound", name, (long long)s.vertices);
    return 0;
}

static int check_surface_name(const char *name, err *e)
{
    if (strlen(name) <= SURFACE_NAME_MOST && check_name(name) && !strchr(name, '/') && !known_users(name))
        return 0;
    return err_usage(e, "--name '%s': expected at most %d letters, digits and . _ -, not x- first", name,
                     SURFACE_NAME_MOST);
}

/* Carries the OBJ under this name, unless the model does already. */
static int carry(model *m, const char *name, const obj *o, double scale, err *e)
{
    surface s;
    if (!o->vertices)
        return err_set(e, o->name, 0, "no vertices; expected a surface");
    if (!surface_there(m, name))
        return surface_add(m, name, o, scale, e);
    if (surface_of(m, name, &s, e))
        return -1;
    if (!surface_is(&s, o, scale, e))
        return 0;
    /* What differs is in e; say the way out too. */
    size_t n = strlen(e->text);
    snprintf(e->text + n, sizeof e->text - n, ", or --name with a name that is free");
    return -1;
}

static int bind_file(const tool *t, target *to, model *m, const char *path, const struct options *o, notes *warnings,
                     err *e)
{
    char from_path[SURFACE_NAME_MOST + 1];
    const char *name = o->name ? o->name : from_path;
    num_unit unit = scale_unit(o->unit, m, e);
    obj file = {0};
    if (!unit)
        return -1;
    in *s = in_open(path, e);
    int code = s ? obj_read(&file, s, e) : -1;
    in_close(s);
    if (!code)
        obj_notes(&file, warnings);
    if (!code && o->common.anonymous)
        surface_nameless(m, &file, scale_of(unit), from_path, sizeof from_path);
    else
        surface_name(path, from_path, sizeof from_path);
    if (!code && !carry(m, name, &file, scale_of(unit), e))
        code = bind_surface(t, to, m, name, unit, warnings, e);
    else
        code = -1;
    obj_free(&file);
    return code;
}

/* Two files of one name would be one surface: the second is refused where they differ, and where they do not. */
static int bind_files(const tool *t, target *to, model *m, char *const *path, const struct options *o, notes *warnings,
                      err *e)
{
    char name[SURFACE_NAME_MOST + 1], other[SURFACE_NAME_MOST + 1];
    for (int i = 0; i < t->operands; i++) {
        surface_name(path[i], name, sizeof name);
        for (int j = 0; j < i && !o->common.anonymous; j++) {
            surface_name(path[j], other, sizeof other);
            if (!strcmp(name, other))
                return err_set(
                    e, path[i], 0,
                    "would be named surface %s, as %s is; expected another name, or --name in a separate run", name,
                    path[j]);
        }
        if (bind_file(t, to, m, path[i], o, warnings, e))
            return -1;
    }
    return 0;
}

/* Every surface that the model carries, or the one named. */
static int bind_carried(const tool *t, target *to, model *m, const struct options *o, notes *warnings, err *e)
{
    char name[MODEL_NAME];
    const char *source = model_meta_of(m, "source.unit");
    num_unit unit = source ? num_unit_of(source) : 0; /* for messages only */
    unit = unit ? unit : num_unit_of("m");
    if (!model_surface(m, &(int){0}, name, sizeof name))
        return err_set(e, NULL, 0, "the model carries no surface; expected an OBJ: sinew bind surface.obj");
    if (o->name && !surface_there(m, o->name))
        return err_set(e, NULL, 0, "the model carries no surface %s; the first that it carries is %s", o->name, name);
    if (o->name)
        return bind_surface(t, to, m, o->name, unit, warnings, e);
    for (int at = 0; model_surface(m, &at, name, sizeof name);)
        if (bind_surface(t, to, m, name, unit, warnings, e))
            return -1;
    return 0;
}

/* What bind_surface makes anew. */
static bool is_made(const model_array *a)
{
    const char *of = strchr(a->name, '/');
    return of && (!strcmp(of, "/vertex.element") || !strcmp(of, "/vertex.weight") || !strcmp(of, "/vertex.blended"));
}

/* Where no axis and no surface is added, all that came is written while surfaces are bound. */
static int write_ahead(const tool *t, stage *s, model *m, const struct options *o, int threads, err *e)
{
    const bool adds = t->operands || o->self_contact.count;
    return adds || threads < 2 || !stage_is_large(m) ? 0 : stage_write_ahead(s, m, is_made, e);
}

/* Once the model carries the surfaces. */
static int touch_itself(const tool *t, const target *to, model *m, const struct options *o, int threads,
                        notes *warnings, err *e)
{
    touch_skin_options with = {.regions = &o->self_contact, .blended = to->blended};
    touch_found found;
    if (!o->self_contact.count)
        return 0;
    if (!to->by_lattice)
        return err_set(e, NULL, 0, "--self-contact: the elements are no voxels; expected a model of voxels");
    if (o->contact_spacing.count) {
        const num_unit unit = scale_unit(o->unit, m, e);
        if (!unit)
            return -1;
        with.apart = num_length_in(o->contact_spacing.value[0], unit, num_unit_of("m"));
    }
    if (touch_make(m, &to->sides, &with, threads, to->threads, &found, warnings, e))
        return -1;
    tool_say(t, "self-contact: %lld samples of skin; distances at %lld nodes, off at samples by %.2g voxels at most",
             (long long)found.samples, (long long)found.nodes, found.worst / length_of(to, 0));
    return 0;
}

static int check_options(const struct options *o, int count, char *const *path, err *e)
{
    if (o->name && check_surface_name(o->name, e))
        return -1;
    for (int i = 0; i < count; i++)
        if (!strcmp(path[i], "-"))
            return err_usage(e, "'-': the model comes on standard input; expected the name of an OBJ file");
    if (count > 1 && o->name)
        return err_usage(e, "--name names one surface, but %d files are given", count);
    if (o->contact_spacing.count && !o->self_contact.count)
        return err_usage(e, "--contact-spacing is for samples of --self-contact, which is not given");
    if (o->contact_spacing.count && !(o->contact_spacing.value[0].value > 0))
        return err_usage(e, "--contact-spacing: expected a length above 0");
    if (!count && o->unit)
        return err_usage(e, "--unit is for an OBJ, and none is given; surfaces in the model are in metres");
    return 0;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.motion = -1};
    err e = {0};
    tool t = {0};
    stage s = {0};
    model m = {0};
    target to = {0};
    notes warnings = {0};
    int threads;

    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (stage_open_output(&s, &t, &e) || check_options(&o, t.operands, argv + 1, &e) ||
        (threads = tool_threads(&t, &e)) < 0)
        goto out;
    if (stage_read(&s, &m, &e) || check_model(&m, &e) || write_ahead(&t, &s, &m, &o, threads, &e) ||
        target_open(&to, &m, &o, threads, &warnings, &e))
        goto out;
    if (t.operands ? bind_files(&t, &to, &m, argv + 1, &o, &warnings, &e)
                   : bind_carried(&t, &to, &m, &o, &warnings, &e))
        goto out;
    if (touch_itself(&t, &to, &m, &o, threads, &warnings, &e))
        goto out;
    if (!stage_write(&s, &m, &e))
        stage_copy_frames(&s, &m, &e);
out:
    tool_warn(&t, &warnings);
    if (!t.done)
        stage_close(&s, &t, &e);
    target_close(&to);
    model_free(&m);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
