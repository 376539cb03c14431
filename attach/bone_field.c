#include "bone_field.h"

#include "base/mem.h"
#include "base/near.h"
#include "surface/closest.h"
#include "surface/surface.h"
#include "surface/surface_region.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

bone_field *bone_field_add(bone_fields *to, const rigid *r, int32_t body, err *e)
{
    if (mem_grow(&to->of, &to->room, to->count + 1, sizeof *to->of, "the distance fields", e))
        return NULL;
    bone_field *f = &to->of[to->count];
    *f = (bone_field){.body = body, .is = mem_array(r->surfaces + 1, sizeof *f->is, "the rigid surfaces", e)};
    to->count += f->is != NULL;
    return f->is ? f : NULL;
}

void bone_field_drop(bone_fields *to)
{
    const bone_field *last = &to->of[--to->count];
    free(last->is);
    free(last->value);
}

void bone_fields_free(bone_fields *f)
{
    while (f->count)
        bone_field_drop(f);
    free(f->of);
    *f = (bone_fields){.of = NULL};
}

/* ---- surfaces */

static int find_surface(const rigid *r, const char *option, const char *name, bool *is, err *e)
{
    bool any = false;
    for (int64_t i = 0; i < r->surfaces; i++) {
        const bool mine = surface_in_group(r->surface[i].name, name);
        is[i] |= mine;
        any |= mine;
    }
    return any ? 0 : near_option(e, option, "rigid surface", name, (const char *const *)r->names.name, r->names.count);
}

int bone_surfaces(const rigid *r, const char *option, const char *text, bool *is, err *e)
{
    char name[MODEL_NAME];
    int found;
    for (const char *p = text; (found = surface_region_name(&p, name, sizeof name)) > 0;)
        if (find_surface(r, option, name, is, e))
            return -1;
    return found ? err_usage(e, "%s '%.200s': expected names of rigid surfaces between commas", option, text) : 0;
}

static int collect(distance_triangles *d, const rigid *r, const bool *is, const bool *is_turned, err *e)
{
    closest_shape shape = {0};
    int failed = 0;
    for (int64_t i = 0; i < r->primitives && !failed; i++) {
        const rigid_primitive *p = &r->primitive[i];
        if (!is[p->surface] || p->corners < 3)
            continue;
        failed = closest_shape_of(&shape, p->position, p->vertex, p->corners, e);
        for (int64_t k = 0; k < shape.parts && !failed && shape.corners == 3; k++)
            failed = distance_triangles_add(d, shape.point + 9 * k, p->surface, is_turned[p->surface], e);
    }
    closest_shape_free(&shape);
    return failed;
}

/* turned: of rigid surfaces. */
static int make_triangles(distance_triangles *d, const rigid *r, const bool *is, const bool *is_turned,
                          const char *option, err *e)
{
    if (collect(d, r, is, is_turned, e))
        return -1;
    if (!d->triangles)
        return err_set(e, NULL, 0, "%s: surfaces of points and lines alone; expected polygons", option);
    if (distance_triangles_ready(d, e))
        return -1;
    if (d->side.turned)
        return err_set(e, NULL, 0,
                       "%s: at %" PRId64 " edges of %s and what is beside it, two faces face different sides; "
                       "expected surfaces, and all that touch, whose faces all face the tissue, or all the bone",
                       option, d->side.turned, r->surface[d->of[0]].name);
    return 0;
}

/* ---- sides */

double *bone_beside(const model *m, err *e)
{
    const model_array *of = model_need(m, "element.node", e), *at = model_need(m, "node.position", e);
    int32_t *count = of && at ? mem_array(at->rows, sizeof *count, "the nodes", e) : NULL;
    double *beside = count ? mem_array(at->rows, 3 * sizeof *beside, "the nodes", e) : NULL;
    for (int64_t i = 0; beside && i < of->rows; i++) {
        const int32_t *node = of->i32 + of->columns * i;
        double middle[3] = {0, 0, 0};
        for (int c = 0; c < of->columns; c++)
            for (int a = 0; a < 3; a++)
                middle[a] += at->f64[3 * (int64_t)node[c] + a] / of->columns;
        for (int c = 0; c < of->columns; c++) {
            count[node[c]]++;
            for (int a = 0; a < 3; a++)
                beside[3 * (int64_t)node[c] + a] += middle[a];
        }
    }
    for (int64_t i = 0; beside && i < 3 * at->rows; i++)
        beside[i] /= count[i / 3] ? count[i / 3] : 1;
    free(count);
    return beside;
}

/* Which surfaces have the tissue beside the chosen nodes behind them, by more than half of these. */
static int find_turned(const rigid *r, const distance_triangles *d, const bone_view *from, bool *is_turned, err *e)
{
    int64_t *votes = mem_array(r->surfaces + 1, sizeof *votes, "the rigid surfaces", e), guess = -1;
    for (int64_t n = 0; votes && n < from->nodes; n++) {
        if (!from->chosen[n])
            continue;
        const double *x = from->beside + 3 * n;
        const triangle_hit hit = triangle_tree_nearest(d->tree, x, guess);
        guess = hit.triangle;
        votes[d->of[hit.triangle]] += pseudonormal_outside(&d->side, &hit, x) ? 1 : -1;
    }
    for (int64_t i = 0; votes && i < r->surfaces; i++)
        is_turned[i] = votes[i] < 0;
    const int failed = votes ? 0 : -1;
    free(votes);
    return failed;
}

int bone_triangles(distance_triangles *d, const rigid *r, const bool *is, const bone_view *from, const char *option,
                   err *e)
{
    bool *is_turned = mem_array(r->surfaces + 1, sizeof *is_turned, "the rigid surfaces", e);
    int failed = !is_turned || make_triangles(d, r, is, is_turned, option, e) || find_turned(r, d, from, is_turned, e);
    if (!failed) {
        distance_triangles_free(d);
        failed = make_triangles(d, r, is, is_turned, option, e);
    }
    free(is_turned);
    return failed ? -1 : 0;
}

/* ---- samples */

void bone_field_box(bone_field *f, const lattice *l, const int32_t low[3], const int32_t high[3])
{
    for (int a = 0; a < 3; a++) {
        f->box.origin[a] = l->origin[a];
        f->box.spacing[a] = l->spacing[a];
        f->box.first[a] = low[a] - BONE_BEYOND;
        f->box.samples[a] = high[a] + BONE_BEYOND + 1 - f->box.first[a];
    }
}

int bone_field_sample(bone_field *f, const distance_triangles *d, pool *threads, err *e)
{
    f->value = mem_array(distance_box_samples(&f->box), sizeof *f->value, "the distance field", e);
    if (f->value)
        distance_sample(d, &f->box, threads, f->value);
    return f->value ? 0 : -1;
}

static bool any_touches(const bone_fields *f)
{
    for (int64_t i = 0; i < f->count; i++)
        if (f->of[i].touches)
            return true;
    return false;
}

int bone_fields_write(model *m, const bone_fields *f, bool with_bodies, err *e)
{
    const bool touches = any_touches(f);
    int64_t samples = 0, at = 0;
    for (int64_t i = 0; i < f->count; i++)
        samples += distance_box_samples(&f->of[i].box);
    if (model_axis_add(m, "field", f->count, e) || model_axis_add(m, "distance", samples, e) ||
        (with_bodies && !model_add(m, "field.body", e)) || (touches && !model_add(m, "field.contact", e)) ||
        !model_add(m, "field.first", e) || !model_add(m, "field.samples", e) || !model_add(m, "distance.value", e))
        return -1;
    for (int64_t i = 0; i < f->count; i++) {
        const bone_field *one = &f->of[i];
        const int64_t count = distance_box_samples(&one->box);
        if (with_bodies)
            model_find(m, "field.body")->i32[i] = one->body;
        if (touches)
            model_find(m, "field.contact")->u8[i] = one->touches;
        memcpy(model_find(m, "field.first")->i32 + 3 * i, one->box.first, sizeof one->box.first);
        memcpy(model_find(m, "field.samples")->i32 + 3 * i, one->box.samples, sizeof one->box.samples);
        memcpy(model_find(m, "distance.value")->f32 + at, one->value, (size_t)count * sizeof *one->value);
        at += count;
    }
    return 0;
}
