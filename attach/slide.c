#include "slide.h"

#include "base/mem.h"
#include "base/near.h"
#include "mesh/lattice.h"
#include "surface/pseudonormal.h"
#include "surface/scale.h"
#include "surface/surface.h"
#include "surface/surface_region.h"
#include "surface/triangle_tree.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BEYOND = 8 }; /* voxels that a field goes beyond its nodes */
enum { KEEPS = 1, LIFTS };

/* The triangles of the surfaces on which some node slides, each with corners of its own. */
typedef struct skin {
    double *position;
    int32_t *corner;
    int32_t *anchor; /* triangles */
    int64_t triangles, position_room, corner_room, anchor_room;
} skin;

typedef struct slider {
    model *m;
    const rigid *r;
    const lattice *grid;
    const double *position;
    uint8_t *rigid;
    int32_t *anchor, *body; /* body: NULL without bodies */
    int64_t nodes;
    uint8_t *mark;   /* nodes: 0, KEEPS or LIFTS */
    double *beside;  /* nodes x 3, m: the mean of the middles of its elements */
    bool *is_turned; /* rigid surfaces: whether their triangles face the bone */
    pool *threads;
    err *e;
} slider;

/* ---- which nodes */

static int find_surface(const slider *s, const char *option, const char *name, bool *is)
{
    bool any = false;
    for (int64_t i = 0; i < s->r->surfaces; i++) {
        const bool mine = surface_in_group(s->r->surface[i].name, name);
        is[i] |= mine;
        any |= mine;
    }
    return any ? 0
               : near_option(s->e, option, "rigid surface", name, (const char *const *)s->r->names.name,
                             s->r->names.count);
}

/* The surfaces that the names between commas stand for. */
static int find_surfaces(const slider *s, const char *option, const char *text, bool *is)
{
    char name[MODEL_NAME];
    int found;
    for (const char *p = text; (found = surface_region_name(&p, name, sizeof name)) > 0;)
        if (find_surface(s, option, name, is))
            return -1;
    return found ? err_usage(s->e, "%s '%.200s': expected names of rigid surfaces between commas", option, text) : 0;
}

static int mark_nodes(slider *s, const char *option, const char *text, const bool *is, const uint8_t *inside, int as)
{
    int64_t held = 0, marked = 0;
    for (int64_t n = 0; n < s->nodes; n++) {
        if (!s->rigid[n] || s->anchor[n] < 0 || !is[s->anchor[n]])
            continue;
        held++;
        if (!inside[n])
            continue;
        s->mark[n] = (uint8_t)as;
        marked++;
    }
    if (!held)
        return err_set(s->e, NULL, 0, "%s '%.200s': no node is held there; expected a surface that holds some", option,
                       text);
    if (!marked)
        return err_set(s->e, NULL, 0,
                       "%s '%.200s': the region has none of the %" PRId64
                       " nodes that are held; expected one around some, in the model's place and unit",
                       option, text, held);
    return 0;
}

static int take_option(slider *s, const char *option, const char *text, int as)
{
    const char *colon = strchr(text, ':');
    const num_unit unit = colon ? scale_unit(NULL, s->m, s->e) : num_unit_of("m");
    if (!unit)
        return -1;
    if (!*text || colon == text || (colon && !colon[1]))
        return err_usage(s->e, "%s '%.200s': expected SURFACE,...[:REGION], such as skull:lips.obj", option, text);
    bool *is = mem_array(s->r->surfaces + 1, sizeof *is, "the rigid surfaces", s->e);
    uint8_t *inside = is ? mem_array(s->nodes, 1, "the nodes", s->e) : NULL;
    const int failed = !inside || find_surfaces(s, option, text, is) ||
                       surface_region_of_option(option, colon ? colon + 1 : NULL, unit, s->position, s->nodes,
                                                s->threads, inside, s->e) ||
                       mark_nodes(s, option, text, is, inside, as);
    free(inside);
    free(is);
    return failed ? -1 : 0;
}

/* ---- triangles */

static int add_triangle(skin *to, const double *corner, int32_t anchor, bool is_turned, err *e)
{
    const int64_t t = to->triangles;
    if (mem_grow(&to->position, &to->position_room, 9 * (t + 1), sizeof *to->position, "the triangles", e) ||
        mem_grow(&to->corner, &to->corner_room, 3 * (t + 1), sizeof *to->corner, "the triangles", e) ||
        mem_grow(&to->anchor, &to->anchor_room, t + 1, sizeof *to->anchor, "the triangles", e))
        return -1;
    memcpy(to->position + 9 * t, corner, 9 * sizeof *corner);
    for (int i = 0; i < 3; i++)
        to->corner[3 * t + i] = (int32_t)(3 * t + (is_turned && i ? 3 - i : i));
    to->anchor[to->triangles++] = anchor;
    return 0;
}

/* The triangles of the surfaces that `is` says, turned where they face the bone. */
static int collect(skin *to, const slider *s, const bool *is)
{
    closest_shape shape = {0};
    int failed = 0;
    *to = (skin){.triangles = 0};
    for (int64_t i = 0; i < s->r->primitives && !failed; i++) {
        const rigid_primitive *p = &s->r->primitive[i];
        if (!is[p->surface] || p->corners < 3)
            continue;
        failed = closest_shape_of(&shape, p->position, p->vertex, p->corners, s->e);
        for (int64_t k = 0; k < shape.parts && !failed && shape.corners == 3; k++)
            failed = add_triangle(to, shape.point + 9 * k, p->surface, s->is_turned[p->surface], s->e);
    }
    closest_shape_free(&shape);
    return failed;
}

static void skin_free(skin *of)
{
    free(of->position);
    free(of->corner);
    free(of->anchor);
}

/* ---- a field */

typedef struct measure {
    skin skin;
    triangle_tree *tree;
    pseudonormal side;
} measure;

static void measure_free(measure *d)
{
    triangle_tree_destroy(d->tree);
    pseudonormal_free(&d->side);
    skin_free(&d->skin);
    *d = (measure){.tree = NULL};
}

/* d is to be freed all the same. */
static int measure_make(measure *d, const slider *s, const bool *is)
{
    *d = (measure){.tree = NULL};
    if (collect(&d->skin, s, is))
        return -1;
    const skin *k = &d->skin;
    if (!k->triangles)
        return err_set(s->e, NULL, 0, "--slide: surfaces of points and lines alone; expected polygons to slide on");
    if (pseudonormal_of(&d->side, k->position, 3 * k->triangles, k->corner, k->triangles, s->e))
        return -1;
    if (d->side.turned)
        return err_set(s->e, NULL, 0,
                       "--slide: at %" PRId64 " edges of %s and what slides beside it, two faces face different sides; "
                       "expected surfaces, and all that touch, whose faces all face the tissue, or all the bone",
                       d->side.turned, s->r->surface[k->anchor[0]].name);
    d->tree = triangle_tree_create(k->position, k->corner, k->triangles, s->e);
    return d->tree ? 0 : -1;
}

static double distance_at(const measure *d, const double x[3], int64_t *guess)
{
    const triangle_hit hit = triangle_tree_nearest(d->tree, x, *guess);
    *guess = hit.triangle;
    return pseudonormal_outside(&d->side, &hit, x) ? sqrt(hit.distance2) : -sqrt(hit.distance2);
}

/* Nodes of one body, -1: of none; which surfaces hold some of them; and the box of their corners. */
typedef struct field {
    int32_t body, first[3], samples[3];
    bool *is;
    float *value;
} field;

/* What a field is sampled by. */
typedef struct sampling {
    const field *f;
    const measure *by;
    const lattice *grid;
} sampling;

static void sample_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const sampling *s = context;
    const field *f = s->f;
    (void)chunk;
    for (int64_t row = from; row < to; row++) {
        const int32_t j = (int32_t)(row % f->samples[1]), k = (int32_t)(row / f->samples[1]);
        int64_t guess = -1;
        for (int32_t i = 0; i < f->samples[0]; i++) {
            const int32_t at[3] = {f->first[0] + i, f->first[1] + j, f->first[2] + k};
            double x[3];
            lattice_corner(s->grid, at, x);
            f->value[row * f->samples[0] + i] = (float)distance_at(s->by, x, &guess);
        }
    }
}

static bool is_in(const slider *s, int64_t node, int32_t body)
{
    return s->mark[node] && (s->body ? s->body[node] : -1) == body;
}

/* Whether the tissue beside the nodes is behind the triangles of each surface, by more than half of these. */
static int find_turned(slider *s, const field *f, const measure *d)
{
    int64_t *votes = mem_array(s->r->surfaces + 1, sizeof *votes, "the rigid surfaces", s->e), guess = -1;
    for (int64_t n = 0; votes && n < s->nodes; n++) {
        if (!is_in(s, n, f->body))
            continue;
        const double *x = s->beside + 3 * n;
        const triangle_hit hit = triangle_tree_nearest(d->tree, x, guess);
        guess = hit.triangle;
        votes[d->skin.anchor[hit.triangle]] += pseudonormal_outside(&d->side, &hit, x) ? 1 : -1;
    }
    for (int64_t i = 0; votes && i < s->r->surfaces; i++)
        s->is_turned[i] = votes[i] < 0;
    const int failed = votes ? 0 : -1;
    free(votes);
    return failed;
}

/* false: no node of the body slides. */
static bool field_bounds(const slider *s, field *f)
{
    int32_t high[3] = {INT32_MIN, INT32_MIN, INT32_MIN};
    bool any = false;
    for (int a = 0; a < 3; a++)
        f->first[a] = INT32_MAX;
    for (int64_t n = 0; n < s->nodes; n++) {
        if (!is_in(s, n, f->body))
            continue;
        any = f->is[s->anchor[n]] = true;
        for (int a = 0; a < 3; a++) {
            const double at = (s->position[3 * n + a] - s->grid->origin[a]) / s->grid->spacing[a];
            const int32_t corner = (int32_t)lround(at);
            f->first[a] = corner < f->first[a] ? corner : f->first[a];
            high[a] = corner > high[a] ? corner : high[a];
        }
    }
    for (int a = 0; a < 3 && any; a++) {
        f->first[a] -= BEYOND;
        f->samples[a] = high[a] + BEYOND + 1 - f->first[a];
    }
    return any;
}

static int64_t count_samples(const field *f)
{
    return (int64_t)f->samples[0] * f->samples[1] * f->samples[2];
}

/* The most that a node of the field is away from the bone, in voxels' longest sides; tells how many are more than half
 * of one away. */
static double find_worst(const slider *s, const field *f, const measure *by, int64_t *far)
{
    const double *h = s->grid->spacing, voxel = fmax(h[0], fmax(h[1], h[2]));
    double worst = 0;
    int64_t guess = -1;
    for (int64_t n = 0; n < s->nodes; n++) {
        if (!is_in(s, n, f->body))
            continue;
        const double away = fabs(distance_at(by, s->position + 3 * n, &guess)) / voxel;
        worst = fmax(worst, away);
        *far += away > .5 * (1 + 1e-6);
    }
    return worst;
}

/* ---- arrays */

static int add_slides(const slider *s, const field *of, int64_t fields, int64_t nodes)
{
    model *m = s->m;
    if (model_axis_add(m, "slide", nodes, s->e))
        return -1;
    model_array *node = model_add(m, "slide.node", s->e), *at = node ? model_add(m, "slide.field", s->e) : NULL;
    model_array *lifts = at ? model_add(m, "slide.lifts", s->e) : NULL;
    int64_t k = 0;
    if (!lifts)
        return -1;
    node = model_find(m, "slide.node"), at = model_find(m, "slide.field");
    for (int64_t n = 0; n < s->nodes; n++)
        for (int64_t f = 0; f < fields; f++)
            if (is_in(s, n, of[f].body)) {
                node->i32[k] = (int32_t)n;
                at->i32[k] = (int32_t)f;
                lifts->u8[k++] = s->mark[n] == LIFTS;
            }
    return 0;
}

static int add_fields(const slider *s, const field *of, int64_t fields)
{
    model *m = s->m;
    int64_t samples = 0, at = 0;
    for (int64_t f = 0; f < fields; f++)
        samples += count_samples(&of[f]);
    if (model_axis_add(m, "field", fields, s->e) || model_axis_add(m, "distance", samples, s->e) ||
        (s->body && !model_add(m, "field.body", s->e)) || !model_add(m, "field.first", s->e) ||
        !model_add(m, "field.samples", s->e) || !model_add(m, "distance.value", s->e))
        return -1;
    for (int64_t f = 0; f < fields; f++) {
        if (s->body)
            model_find(m, "field.body")->i32[f] = of[f].body;
        memcpy(model_find(m, "field.first")->i32 + 3 * f, of[f].first, sizeof of[f].first);
        memcpy(model_find(m, "field.samples")->i32 + 3 * f, of[f].samples, sizeof of[f].samples);
        memcpy(model_find(m, "distance.value")->f32 + at, of[f].value, (size_t)count_samples(&of[f]) * sizeof(float));
        at += count_samples(&of[f]);
    }
    return 0;
}

/* ---- all */

/* The mean of the middles of each node's elements: in the tissue. */
static int find_beside(slider *s)
{
    const model_array *of = model_need(s->m, "element.node", s->e);
    int32_t *count = of ? mem_array(s->nodes, sizeof *count, "the nodes", s->e) : NULL;
    s->beside = count ? mem_array(s->nodes, 3 * sizeof *s->beside, "the nodes", s->e) : NULL;
    for (int64_t i = 0; s->beside && i < of->rows; i++) {
        const int32_t *node = of->i32 + of->columns * i;
        double middle[3] = {0, 0, 0};
        for (int c = 0; c < of->columns; c++)
            for (int a = 0; a < 3; a++)
                middle[a] += s->position[3 * (int64_t)node[c] + a] / of->columns;
        for (int c = 0; c < of->columns; c++) {
            count[node[c]]++;
            for (int a = 0; a < 3; a++)
                s->beside[3 * (int64_t)node[c] + a] += middle[a];
        }
    }
    for (int64_t i = 0; s->beside && i < 3 * s->nodes; i++)
        s->beside[i] /= count[i / 3] ? count[i / 3] : 1;
    free(count);
    return s->beside ? 0 : -1;
}

/* Samples a field, and finds which way its surfaces face. */
static int fill_field(slider *s, field *f, slide_found *found, int64_t *far)
{
    measure d;
    int failed = measure_make(&d, s, f->is);
    if (!failed) {
        failed = find_turned(s, f, &d);
        measure_free(&d);
        failed = failed || measure_make(&d, s, f->is);
    }
    f->value = failed ? NULL : mem_array(count_samples(f), sizeof *f->value, "the distance field", s->e);
    if (f->value) {
        sampling work = {f, &d, s->grid};
        pool_run(s->threads, (int64_t)f->samples[1] * f->samples[2], 16, sample_work, &work);
        found->worst = fmax(found->worst, find_worst(s, f, &d, far));
    }
    measure_free(&d);
    memset(s->is_turned, 0, (size_t)s->r->surfaces * sizeof *s->is_turned);
    return f->value ? 0 : -1;
}

static int make_fields(slider *s, field *of, slide_found *found, notes *warnings)
{
    const model_array *bodies = s->body ? model_find(s->m, "body.name") : NULL;
    const int64_t count = bodies ? bodies->rows : 0;
    int64_t far = 0;
    for (int64_t b = -1; b < count; b++) {
        field *f = &of[found->fields];
        *f = (field){.body = (int32_t)b, .is = mem_array(s->r->surfaces + 1, sizeof *f->is, "the surfaces", s->e)};
        if (!f->is)
            return -1;
        if (!field_bounds(s, f)) {
            free(f->is);
            continue;
        }
        found->fields++;
        if (fill_field(s, f, found, &far))
            return -1;
    }
    if (far)
        notes_add(warnings,
                  "%" PRId64 " of %" PRId64
                  " sliding nodes are more than half a voxel away from the bone, the furthest "
                  "%.3g voxels; they keep that distance from it",
                  far, found->nodes, found->worst);
    return 0;
}

static void let_go(slider *s)
{
    for (int64_t n = 0; n < s->nodes; n++)
        if (s->mark[n]) {
            s->rigid[n] = 0;
            s->anchor[n] = -1;
            if (s->body)
                s->body[n] = -1;
        }
}

static int make_all(slider *s, slide_found *found, notes *warnings)
{
    const model_array *bodies = s->body ? model_find(s->m, "body.name") : NULL;
    const int64_t most = 1 + (bodies ? bodies->rows : 0);
    for (int64_t n = 0; n < s->nodes; n++)
        found->nodes += s->mark[n] != 0;
    field *of = mem_array(most, sizeof *of, "the distance fields", s->e);
    const int failed = !of || find_beside(s) || make_fields(s, of, found, warnings) ||
                       add_slides(s, of, found->fields, found->nodes) || add_fields(s, of, found->fields);
    for (int64_t f = 0; of && f < found->fields; f++) {
        free(of[f].is);
        free(of[f].value);
    }
    free(of);
    if (!failed)
        let_go(s);
    return failed ? -1 : 0;
}

static int begin(slider *s, lattice *grid)
{
    model *m = s->m;
    const model_array *position = model_need(m, "node.position", s->e), *held = model_need(m, "node.rigid", s->e);
    const model_array *anchor = model_need(m, "node.anchor", s->e), *body = model_find(m, "node.body");
    if (!position || !held || !anchor || lattice_of(m, grid, s->e))
        return -1;
    s->grid = grid;
    s->position = position->f64;
    s->rigid = held->u8;
    s->anchor = anchor->i32;
    s->body = body ? body->i32 : NULL;
    s->nodes = position->rows;
    s->mark = mem_array(s->nodes, 1, "the nodes", s->e);
    s->is_turned = mem_array(s->r->surfaces + 1, sizeof *s->is_turned, "the rigid surfaces", s->e);
    return s->mark && s->is_turned ? 0 : -1;
}

int slide_make(model *m, const rigid *r, const slide_options *o, pool *threads, slide_found *found, notes *warnings,
               err *e)
{
    lattice grid;
    slider s = {.m = m, .r = r, .threads = threads, .e = e};
    *found = (slide_found){.nodes = 0};
    model_axis_drop(m, "slide", warnings);
    model_axis_drop(m, "field", warnings);
    model_axis_drop(m, "distance", warnings);
    if (!o->keep->count && !o->off->count)
        return 0;
    int failed = begin(&s, &grid);
    for (int i = 0; i < o->keep->count && !failed; i++)
        failed = take_option(&s, "--slide", o->keep->value[i], KEEPS);
    for (int i = 0; i < o->off->count && !failed; i++)
        failed = take_option(&s, "--slide-off", o->off->value[i], LIFTS);
    failed = failed || make_all(&s, found, warnings);
    free(s.mark);
    free(s.beside);
    free(s.is_turned);
    return failed ? -1 : 0;
}
