#include "render/showing.h"

#include "base/mem.h"
#include "picture/image.h"
#include "render/showing_parts.h"
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const showing_things[SHOWING_THINGS] = {"surface", "voxels", "muscles", "rigid", "centres", "probe"};
const uint8_t showing_green[3] = {62, 158, 70}, showing_red[3] = {205, 32, 32}, showing_centre[3] = {12, 120, 30};

int showing_add(showing *b, scene_mesh *mesh, double *value, err *e)
{
    if (mem_grow(&b->value, &b->value_capacity, b->scene.meshes + 1, sizeof *b->value, "a scene", e)) {
        scene_mesh_free(mesh);
        free(value);
        return -1;
    }
    b->value[b->scene.meshes] = value;
    b->values = b->scene.meshes + 1;
    return scene_add_mesh(&b->scene, mesh, e);
}

bool showing_named(const char *const *pattern, int patterns, const char *name)
{
    for (int i = 0; i < patterns; i++)
        if (surface_in_group(name, pattern[i]))
            return true;
    return false;
}

uint64_t showing_cleared(const showing_want *want, const char *name)
{
    uint64_t by = 0;
    for (int k = 0; k < want->clears; k++)
        by |= (uint64_t)showing_named(&want->clear[k], 1, name) << k;
    return by;
}

int showing_moves(const showing_want *w, const char *what, const double **u, err *e)
{
    const model_array *a = w->moved ? frame_find(w->moved, "node.displacement") : NULL;
    *u = a ? a->f64 : NULL;
    if (a || !w->moved)
        return 0;
    return err_set(e, NULL, 0,
                   "frame %lld has no node.displacement, with which %s move; expected it, or the model at rest",
                   (long long)w->moved->index, what);
}

void showing_place(const double *rest, const double *u, int64_t node, float *to)
{
    for (int a = 0; a < 3; a++)
        to[a] = (float)(rest[3 * node + a] + (u ? u[3 * node + a] : 0));
}

void showing_linear(const uint8_t srgb[3], float to[3])
{
    image_linear(srgb, to);
}

static bool any(const model *m, const char *name)
{
    const model_array *a = model_find(m, name);
    for (int64_t i = 0; a && i < a->rows; i++)
        if (a->u8[i])
            return true;
    return false;
}

int showing_there(const model *m)
{
    const model_array *centre = model_find(m, "muscle.centre");
    int there = any(m, "node.rigid") ? SHOWING_RIGID : 0;
    if (any(m, "volume.muscle") && model_find(m, "element.volume"))
        there |= SHOWING_MUSCLES;
    for (int64_t i = 0; centre && i < centre->rows; i++)
        if (isfinite(centre->f64[3 * i]))
            there |= SHOWING_CENTRES;
    return there;
}

/* The field must be there to be seen somewhere: a picture all grey says nothing. */
static int check_values(const showing *b, const field *f, err *e)
{
    for (int64_t i = 0; f && i < b->values; i++)
        if (b->value[i])
            return 0;
    return f ? err_set(e, NULL, 0,
                       "nothing that is shown has %s: the surfaces are not bound; expected a model from sinew bind, or "
                       "--show voxels",
                       f->label)
             : 0;
}

/* Surfaces, where they are wanted; a field of elements shows at their vertices as the mean of a node's elements. */
static int show_surfaces(showing *b, const model *m, const showing_want *want, err *e)
{
    if (!(want->things & SHOWING_SURFACES) && !want->names)
        return 0;
    const bool has_field = want->field && !want->field->name;
    double *at_nodes = has_field ? field_at_nodes(want->field, m, e) : NULL;
    if (has_field && !at_nodes)
        return -1;
    const int result = showing_surfaces(b, m, want, at_nodes, e);
    free(at_nodes);
    return result;
}

static int check_seen(const showing *b, const showing_want *want, err *e)
{
    double low[3], high[3];
    if (scene_bounds(&b->scene, low, high))
        return 0;
    return err_set(e, NULL, 0,
                   want->cuts ? "nothing is left to be seen; expected --cut to leave some of it"
                              : "the model is empty: there is nothing to be seen");
}

int showing_make(showing *b, const model *m, const showing_want *want, err *e)
{
    *b = (showing){0};
    if (showing_check_names(m, want, e))
        return -1;
    if (show_surfaces(b, m, want, e) || showing_elements(b, m, want, e) || showing_spheres(b, m, want, e) ||
        showing_probe(b, m, want, e) || showing_slice(b, want, e) || showing_body(b, m, want, e) ||
        check_seen(b, want, e) || check_values(b, want->field, e)) {
        showing_free(b);
        return -1;
    }
    return 0;
}

void showing_free(showing *b)
{
    for (int64_t i = 0; i < b->values; i++)
        free(b->value[i]);
    free(b->value);
    scene_free(&b->scene);
    *b = (showing){0};
}

static int64_t value_count(const scene_mesh *mesh)
{
    return mesh->face_colour ? mesh->faces : mesh->vertices;
}

bool showing_range(const showing *b, double *low, double *high)
{
    *low = INFINITY, *high = -INFINITY;
    for (int64_t i = 0; i < b->values; i++)
        for (int64_t n = 0; b->value[i] && n < value_count(&b->scene.mesh[i]); n++)
            if (isfinite(b->value[i][n])) {
                *low = fmin(*low, b->value[i][n]);
                *high = fmax(*high, b->value[i][n]);
            }
    return *low <= *high;
}

void showing_colour(showing *b, const field *f, const colourmap *map, double low, double high)
{
    for (int64_t i = 0; i < b->values; i++) {
        scene_mesh *mesh = &b->scene.mesh[i];
        float *colour = mesh->face_colour ? mesh->face_colour : mesh->vertex_colour;
        for (int64_t n = 0; b->value[i] && n < value_count(mesh); n++) {
            double x = b->value[i][n];
            if (f->name && x >= 0)
                colourmap_name((int64_t)x, &colour[3 * n]);
            else if (f->folds && x <= 0)
                showing_linear(showing_red, &colour[3 * n]);
            else if (f->name)
                colourmap_at(map, (double)NAN, &colour[3 * n]);
            else
                colourmap_at(map, high > low ? (x - low) / (high - low) : 0 * x, &colour[3 * n]);
        }
    }
}
