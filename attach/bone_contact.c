#include "bone_contact.h"

#include "base/mem.h"
#include "part.h"
#include "surface/scale.h"
#include "surface/surface_region.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char option[] = "--contact", file_option[] = "--contact-file";

typedef struct maker {
    const model *m;
    const rigid *r;
    const char *option;
    lattice grid;
    int64_t nodes;
    const uint8_t *rigid;
    const int32_t *anchor, *body; /* body: NULL without bodies */
    bool *touches;                /* rigid surfaces */
    int32_t *moves_with;          /* rigid surfaces: a body, or -1 */
    const opt_list *in;
    pool *threads;
    bone_fields *fields;
    notes *warnings;
    err *e;
} maker;

/* ---- which surfaces, and with which bodies they move */

/* The body of most of the nodes that a surface holds. */
static int find_body(maker *k, int32_t which, int32_t bodies)
{
    int64_t *count = mem_array((int64_t)bodies + 1, sizeof *count, "the bodies", k->e), all = 0;
    int32_t most = -1;
    for (int64_t n = 0; count && n < k->nodes; n++)
        if (k->rigid[n] && k->anchor[n] == which) {
            count[1 + (k->body ? k->body[n] : -1)]++;
            all++;
        }
    for (int32_t b = -1; count && b < bodies; b++)
        most = count[1 + b] > count[1 + most] ? b : most;
    if (count && count[1 + most] < all)
        notes_add(k->warnings,
                  "%s '%s' holds nodes of several bodies: what skin may not enter moves with most of them; expected a "
                  "surface for each body",
                  k->option, k->r->surface[which].name);
    k->moves_with[which] = most;
    const int failed = count ? 0 : -1;
    free(count);
    return failed;
}

static int find_bodies(maker *k, const opt_list *parts, bool is_loose)
{
    const model_array *bodies_of = k->body ? model_find(k->m, "body.name") : NULL;
    for (int32_t i = 0; i < (int32_t)k->r->surfaces; i++) {
        if (!k->touches[i])
            continue;
        if (is_loose)
            k->moves_with[i] = part_of_surface(parts, k->r->surface[i].name);
        else if (find_body(k, i, bodies_of ? (int32_t)bodies_of->rows : 0))
            return -1;
    }
    return 0;
}

/* ---- where */

/* The box of the triangles of which a corner is inside; inside: of corners, or NULL: all are. Returns how many there
 * are. */
static int64_t take_box(const maker *k, const distance_triangles *d, const uint8_t *inside, int32_t low[3],
                        int32_t high[3])
{
    int64_t count = 0;
    for (int64_t t = 0; t < d->triangles; t++) {
        if (inside && !inside[3 * t] && !inside[3 * t + 1] && !inside[3 * t + 2])
            continue;
        count++;
        for (int i = 0; i < 9; i++) {
            const int a = i % 3;
            const double at = (d->position[9 * t + i] - k->grid.origin[a]) / k->grid.spacing[a];
            const double most = INT32_MAX / 4., bound = fmin(fmax(at, -most), most);
            low[a] = (int32_t)fmin(low[a], floor(bound));
            high[a] = (int32_t)fmax(high[a], ceil(bound));
        }
    }
    return count;
}

/* Of the regions of all options. */
static int find_box(const maker *k, const distance_triangles *d, int32_t low[3], int32_t high[3])
{
    if (!k->in)
        return take_box(k, d, NULL, low, high) ? 0 : -1;
    uint8_t *inside = mem_array(3 * d->triangles, 1, "the triangles", k->e);
    int failed = !inside;
    int64_t count = 0;
    for (int i = 0; i < k->in->count && !failed; i++) {
        const char *text = k->in->value[i], *colon = strchr(text, ':');
        const num_unit unit = colon ? scale_unit(NULL, k->m, k->e) : num_unit_of("m");
        failed = !unit || surface_region_of_option(k->option, colon ? colon + 1 : NULL, unit, d->position,
                                                   3 * d->triangles, k->threads, inside, k->e);
        count += failed ? 0 : take_box(k, d, inside, low, high);
    }
    if (!failed && !count)
        failed = err_set(k->e, NULL, 0,
                         "%s '%.200s': the region has none of the %" PRId64
                         " triangles; expected one around some, in the model's place and unit",
                         k->option, k->in->value[0], d->triangles);
    free(inside);
    return failed ? -1 : 0;
}

/* ---- a field */

static int fill_field(const maker *k, bone_field *f, const bone_view *from)
{
    int32_t low[3] = {INT32_MAX, INT32_MAX, INT32_MAX}, high[3] = {INT32_MIN, INT32_MIN, INT32_MIN};
    distance_triangles d = {.tree = NULL};
    int failed = bone_triangles(&d, k->r, f->is, from, k->option, k->e) || find_box(k, &d, low, high);
    if (!failed) {
        bone_field_box(f, &k->grid, low, high);
        failed = bone_field_sample(f, &d, k->threads, k->e);
    }
    distance_triangles_free(&d);
    return failed ? -1 : 0;
}

static int make_fields(maker *k, bool is_loose)
{
    const model_array *bodies_of = k->body ? model_find(k->m, "body.name") : NULL;
    const int32_t bodies = bodies_of ? (int32_t)bodies_of->rows : 0;
    uint8_t *chosen = mem_array(k->nodes, 1, "the nodes", k->e);
    double *beside = chosen ? bone_beside(k->m, k->e) : NULL;
    int failed = !beside;
    for (int32_t b = -1; b < bodies && !failed; b++) {
        bool any = false;
        for (int64_t i = 0; i < k->r->surfaces; i++)
            any |= k->touches[i] && k->moves_with[i] == b;
        bone_field *f = any ? bone_field_add(k->fields, k->r, b, k->e) : NULL;
        failed = any && !f;
        for (int64_t i = 0; f && i < k->r->surfaces; i++)
            f->is[i] = k->touches[i] && k->moves_with[i] == b;
        for (int64_t n = 0; f && n < k->nodes; n++)
            chosen[n] = !is_loose && k->rigid[n] && k->anchor[n] >= 0 && f->is[k->anchor[n]];
        if (f) {
            f->touches = true;
            failed = fill_field(k, f, &(bone_view){chosen, beside, k->nodes});
        }
    }
    free(chosen);
    free(beside);
    return failed ? -1 : 0;
}

/* ---- all */

static int begin(maker *k)
{
    const model *m = k->m;
    const model_array *position = model_need(m, "node.position", k->e), *held = model_need(m, "node.rigid", k->e);
    const model_array *anchor = model_need(m, "node.anchor", k->e), *body = model_find(m, "node.body");
    if (!position || !held || !anchor || lattice_of(m, &k->grid, k->e))
        return -1;
    k->nodes = position->rows;
    k->rigid = held->u8;
    k->anchor = anchor->i32;
    k->body = body ? body->i32 : NULL;
    k->touches = mem_array(k->r->surfaces + 1, sizeof *k->touches, "the rigid surfaces", k->e);
    k->moves_with =
        k->touches ? mem_array(k->r->surfaces + 1, sizeof *k->moves_with, "the rigid surfaces", k->e) : NULL;
    return k->moves_with ? 0 : -1;
}

static int take_option(maker *k, const char *text)
{
    const char *colon = strchr(text, ':');
    if (!*text || colon == text || (colon && !colon[1]))
        return err_usage(k->e, "%s '%.200s': expected SURFACE,...[:REGION], such as skull:mouth.obj", k->option, text);
    return bone_surfaces(k->r, k->option, text, k->touches, k->e);
}

static int make(maker *k, const opt_list *parts, bool is_loose)
{
    int failed = begin(k);
    for (int i = 0; k->in && i < k->in->count && !failed; i++)
        failed = take_option(k, k->in->value[i]);
    for (int64_t i = 0; is_loose && i < k->r->surfaces && !failed; i++)
        k->touches[i] = true;
    failed = failed || find_bodies(k, parts, is_loose) || make_fields(k, is_loose);
    free(k->touches);
    free(k->moves_with);
    return failed ? -1 : 0;
}

int bone_contact_make(const model *m, const bone_contact_options *o, pool *threads, bone_fields *fields,
                      notes *warnings, err *e)
{
    maker k = {.m = m, .threads = threads, .fields = fields, .warnings = warnings, .e = e};
    if (o->in->count) {
        k.r = o->held;
        k.option = option;
        k.in = o->in;
        if (make(&k, o->parts, false))
            return -1;
    }
    if (!o->loose->surfaces)
        return 0;
    k.r = o->loose;
    k.option = file_option;
    k.in = NULL;
    return make(&k, o->parts, true);
}
