/* Carried and bound surfaces as meshes of triangles. */
#include "base/mem.h"
#include "base/near.h"
#include "mesh/bone.h"
#include "model/check.h"
#include "render/showing_parts.h"
#include "surface/triangulate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const double crease = 40; /* degrees: edges sharper than this stay */

/* What a group is, by the beginning of one of its names, as voxelise and attach take it; the first that fits. */
static const struct {
    const char *pattern;
    uint8_t srgb[3];
} kinds[] = {{"skull*", {244, 237, 216}}, {"bone*", {244, 237, 216}}, {"rigid*", {244, 237, 216}},
             {"muscle*", {178, 66, 60}},  {"skin*", {246, 208, 184}}, {"*", {190, 198, 212}}};

enum { MUSCLE = 3, SKIN = 4 };

static int kind_of(const char *names)
{
    int i = 0;
    while (kinds[i].pattern[0] != '*' && !surface_in_group(names, kinds[i].pattern))
        i++;
    return i;
}

/* One surface on its way into the scene. */
typedef struct part {
    bound b;
    bool is_bound;
    bone bone;         /* who carries its vertices; filled where it moves */
    motion moves;      /* by u */
    motion shown;      /* by the field, where that displaces */
    const double *u;   /* displacement of the nodes, or NULL */
    const double *own; /* of its own vertices, which a skin has, or NULL */
    const double *at_nodes;
    const field *field;
    char *take; /* groups: 0 not seen, 1 seen, 2 seen through */
    float *group_colour;
    uint64_t cleared; /* as the showing's */
} part;

static bool has_skin(const surface *s)
{
    for (int64_t g = 0; g < s->groups; g++)
        if (kind_of(s->group_name[g]) == SKIN)
            return true;
    return false;
}

/* By the word that stands for all surfaces: bit k for clear[k]. */
static uint64_t all_cleared(const showing_want *w)
{
    uint64_t by = 0;
    for (int k = 0; k < w->clears; k++)
        by |= (uint64_t)!strcmp(w->clear[k], showing_things[0]) << k;
    return by;
}

/* Muscles lie within the skin, where there is one: they are seen only where they are named. */
static int choose_groups(part *p, const showing_want *w, err *e)
{
    const surface *s = &p->b.shape;
    int seen = 0;
    bool skin = has_skin(s);
    p->take = mem_array(s->groups, 1, "groups", e);
    p->group_colour = p->take ? mem_array(3 * s->groups, sizeof *p->group_colour, "groups", e) : NULL;
    if (!p->group_colour)
        return -1;
    for (int64_t g = 0; g < s->groups; g++) {
        const char *name = s->group_name[g];
        int kind = kind_of(name);
        bool outside = w->things & SHOWING_SURFACES && !(skin && kind == MUSCLE);
        if (outside || showing_named(w->name, w->names, s->name) || showing_named(w->name, w->names, name)) {
            uint64_t cleared = showing_cleared(w, s->name) | showing_cleared(w, name) | all_cleared(w);
            p->take[g] = cleared ? 2 : 1;
            p->cleared |= cleared;
        }
        seen |= p->take[g];
        showing_linear(kinds[kind].srgb, &p->group_colour[3 * g]);
    }
    return seen;
}

/* The triangles of the faces whose groups are taken so: corners and colours. */
static int cut_faces(const part *p, int take, scene_mesh *to, err *e)
{
    const surface *s = &p->b.shape;
    int64_t most = 0, most_corners = 0, capacity = 0;
    int32_t *triangle = NULL;
    for (int64_t f = 0; f < s->faces; f++) {
        int64_t corners = surface_end(s, f) - s->start[f];
        most += corners > 2 && p->take[s->group[f]] == take ? corners - 2 : 0;
        most_corners = corners > most_corners ? corners : most_corners;
    }
    to->corner = mem_array(3 * most, sizeof *to->corner, "triangles", e);
    to->face_colour = to->corner ? mem_array(3 * most, sizeof *to->face_colour, "triangles", e) : NULL;
    if (!to->face_colour || mem_grow(&triangle, &capacity, 3 * most_corners + 1, sizeof *triangle, "triangles", e))
        return -1;
    int bad = 0;
    for (int64_t f = 0; f < s->faces && !bad; f++) {
        const int32_t *vertex = &s->vertex[s->start[f]];
        int64_t corners = surface_end(s, f) - s->start[f];
        if (corners < 3 || p->take[s->group[f]] != take)
            continue;
        bad = triangulate(s->position, vertex, corners, triangle, e);
        for (int64_t t = 0; t < corners - 2 && !bad; t++, to->faces++) {
            for (int c = 0; c < 3; c++)
                to->corner[3 * to->faces + c] = (uint32_t)vertex[triangle[3 * t + c]];
            memcpy(&to->face_colour[3 * to->faces], &p->group_colour[3 * (int64_t)s->group[f]], 3 * sizeof(float));
        }
    }
    free(triangle);
    return bad;
}

static int place(const part *p, scene_mesh *to, err *e)
{
    const surface *s = &p->b.shape;
    to->vertices = s->vertices;
    to->position = mem_array(3 * s->vertices, sizeof *to->position, "vertices", e);
    if (!to->position)
        return -1;
    for (int64_t v = 0; v < s->vertices; v++) {
        double d[3] = {0};
        if (p->own)
            memcpy(d, p->own + 3 * v, sizeof d);
        else if (p->u && p->is_bound)
            bone_displacement(&p->bone, &p->moves, v, d);
        for (int a = 0; a < 3; a++)
            to->position[3 * v + a] = (float)(s->position[3 * v + a] + d[a]);
    }
    return 0;
}

/* A vector is blended before its norm is taken. */
static double value_of_vector(const part *p, int64_t v)
{
    double at[3];
    if (p->field->displaces && p->own)
        memcpy(at, p->own + 3 * v, sizeof at);
    else if (p->field->displaces && p->bone.node)
        bone_displacement(&p->bone, &p->shown, v, at);
    else
        bound_displacement(&p->b, v, p->field->vector, at);
    return field_of_vector(p->field, at);
}

/* A vertex has the value that its element's nodes give it, and none beyond theirs where it lies outside; a name is
 * its element's. */
static double value_at(const part *p, int64_t v)
{
    const bound *b = &p->b;
    double share[8], sum = 0, low = INFINITY, high = -INFINITY;
    if (p->field->vector)
        return value_of_vector(p, v);
    if (!p->at_nodes)
        return p->field->value[b->element[v]];
    int corners = bound_shares(b, v, share);
    for (int n = 0; n < corners; n++) {
        double at = p->at_nodes[b->node[b->corners * (int64_t)b->element[v] + n]];
        sum += share[n] * at;
        low = fmin(low, at);
        high = fmax(high, at);
    }
    return isnan(sum) ? sum : fmin(fmax(sum, low), high);
}

/* Values take the place of the groups' colours. Names do not blend: they are the faces'. */
static double *values(const part *p, scene_mesh *to, err *e)
{
    int64_t count = p->at_nodes ? to->vertices : to->faces;
    double *value = mem_array(count, sizeof *value, "values", e);
    if (value && p->at_nodes) {
        free(to->face_colour);
        to->face_colour = NULL;
        to->vertex_colour = mem_array(3 * count, sizeof *to->vertex_colour, "values", e);
    }
    if (!value || (p->at_nodes && !to->vertex_colour)) {
        free(value);
        return NULL;
    }
    /* Vertices of no face here are not seen: they have no part in the scale. */
    for (int64_t n = 0; n < count; n++)
        value[n] = (double)NAN;
    for (int64_t c = 0; c < 3 * to->faces; c += p->at_nodes ? 1 : 3)
        value[p->at_nodes ? to->corner[c] : c / 3] = value_at(p, to->corner[c]);
    return value;
}

/* The faces that are in it are placed, and get values where the field has some. */
static int finish_part(const part *p, scene_mesh *mesh, double **value, err *e)
{
    if (place(p, mesh, e))
        return -1;
    if (p->field && (p->is_bound || (p->own && p->field->displaces))) {
        *value = values(p, mesh, e);
        if (!*value)
            return -1;
    }
    return scene_smooth(mesh, crease, e);
}

static int add_part(showing *b, const part *p, int take, err *e)
{
    scene_mesh mesh = {.corners = 3, .transparency = take == 2 ? .75f : 0};
    double *value = NULL;
    mesh.label = mem_text(p->b.shape.name, e);
    int failed = mesh.label ? cut_faces(p, take, &mesh, e) : -1;
    const bool is_empty = !failed && !mesh.faces;
    if (!failed && !is_empty)
        failed = finish_part(p, &mesh, &value, e);
    if (!failed && !is_empty) {
        b->seen |= SHOWING_SURFACES;
        return showing_add(b, &mesh, value, e);
    }
    free(value);
    scene_mesh_free(&mesh);
    return failed;
}

/* A skin's own displacement in a frame, or NULL. */
static const double *own_displacement(const frame *f, const char *name)
{
    char array[MODEL_NAME + 20];
    snprintf(array, sizeof array, "%s/vertex.displacement", name);
    const model_array *u = f ? frame_find(f, array) : NULL;
    return u ? u->f64 : NULL;
}

/* Who carries the vertices, and how the others move. */
static int find_motion(part *p, const model *m, const frame *moved, err *e)
{
    const int64_t nodes = model_count(m, "node"), elements = model_count(m, "element");
    if (bone_find(&p->bone, &p->b, m, e) || motion_open(&p->moves, &p->b, nodes, elements, e))
        return -1;
    motion_set(&p->moves, p->u, NULL);
    bone_set(&p->bone, moved);
    if (!p->field || !p->field->displaces || !p->field->vector)
        return 0;
    if (motion_open(&p->shown, &p->b, nodes, elements, e))
        return -1;
    motion_set(&p->shown, p->field->vector, NULL);
    return 0;
}

/* 1: some of it is seen; 0: none; -1: e is filled. */
static int add_surface(showing *b, const model *m, const showing_want *w, const double *at_nodes, const char *name,
                       err *e)
{
    part p = {.at_nodes = at_nodes, .field = w->field};
    int is_bound = bound_of(&p.b, m, name, e), seen = is_bound < 0 ? -1 : choose_groups(&p, w, e);
    p.is_bound = is_bound > 0;
    p.own = own_displacement(w->moved, name);
    if (seen > 0 && p.is_bound && !p.own && showing_moves(w, "bound surfaces", &p.u, e))
        seen = -1;
    if (seen > 0 && p.u && p.is_bound && find_motion(&p, m, w->moved, e))
        seen = -1;
    b->cleared |= p.cleared;
    for (int take = 1; take <= 2 && seen > 0; take++)
        if (seen & take && add_part(b, &p, take, e))
            seen = -1;
    bone_free(&p.bone);
    motion_free(&p.moves);
    motion_free(&p.shown);
    free(p.take);
    free(p.group_colour);
    return seen < 0 ? -1 : seen > 0;
}

/* The names of the things among `things`, and of all surfaces and groups. */
static int note_names(const model *m, int things, notes *there, err *e)
{
    char name[MODEL_NAME];
    for (int i = 0; i < SHOWING_THINGS; i++)
        if (things >> i & 1)
            notes_add(there, "%s", showing_things[i]);
    for (int at = 0; model_surface(m, &at, name, sizeof name);) {
        surface s;
        if (surface_of(m, name, &s, e))
            return -1;
        notes_add(there, "%s", name);
        for (int64_t g = 0; g < s.groups; g++)
            notes_add(there, "%s", s.group_name[g]);
    }
    return 0;
}

static bool is_thing(const char *name)
{
    int i = 0;
    while (i < SHOWING_THINGS && strcmp(name, showing_things[i]) != 0)
        i++;
    return i < SHOWING_THINGS;
}

/* Names of one option that takes the things among `things`; what else of them it is given is not for here. */
static int check_names(const model *m, const char *option, int things, const char *const *names, int count, err *e)
{
    notes there = {0};
    int bad = note_names(m, things, &there, e);
    for (int n = 0; n < count && !bad; n++) {
        int i = 0;
        while (i < there.count && !surface_in_group(there.line[i], names[n]))
            i++;
        if (i == there.count && !is_thing(names[n]))
            bad = near_option(e, option, "thing", names[n], (const char *const *)there.line, there.count);
    }
    notes_free(&there);
    return bad;
}

int showing_check_names(const model *m, const showing_want *w, err *e)
{
    const int all = (1 << SHOWING_THINGS) - 1, whole = SHOWING_RIGID | SHOWING_CENTRES;
    return check_names(m, "--show", all, w->name, w->names, e) ||
                   check_names(m, "--clear", all & ~whole, w->clear, w->clears, e)
               ? -1
               : 0;
}

int showing_surfaces(showing *b, const model *m, const showing_want *want, const double *at_nodes, err *e)
{
    char name[MODEL_NAME];
    if (!model_surface(m, &(int){0}, name, sizeof name))
        return err_set(e, NULL, 0,
                       "the model carries no surface; expected a model from voxelise or sinew bind, or "
                       "--show voxels");
    for (int at = 0; model_surface(m, &at, name, sizeof name);)
        if (add_surface(b, m, want, at_nodes, name, e) < 0)
            return -1;
    return 0;
}
