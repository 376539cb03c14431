#include "muscle_surface.h"

#include "base/mem.h"
#include "surface/solid.h"
#include "surface/triangulate.h"

#include <stdlib.h>
#include <string.h>

/* The muscle that a group is of, or -1. */
static int32_t muscle_of(const char *group, const char *const *name, int64_t muscles)
{
    for (int64_t i = 0; i < muscles; i++)
        if (!strchr(name[i], '*') && surface_in_group(group, name[i]))
            return (int32_t)i;
    return -1;
}

/* to: the muscle of each group of a surface. A surface before this one keeps the muscles that it has. */
static void claim_groups(const muscle_surfaces *s, int view, const char *const *name, int32_t *to)
{
    const surface *v = &s->view[view];
    for (int64_t g = 0; g < v->groups; g++) {
        to[g] = muscle_of(v->group_name[g], name, s->muscles);
        if (to[g] < 0)
            continue;
        if (s->from[to[g]] < 0)
            s->from[to[g]] = view;
        to[g] = s->from[to[g]] == view ? to[g] : -1;
    }
}

/* Counts the faces of each muscle two places up, or, once they are counted, lists them. */
static void sort_faces(muscle_surfaces *s, int view, const int32_t *to)
{
    const surface *v = &s->view[view];
    for (int64_t f = 0; f < v->faces; f++) {
        const int32_t muscle = to[v->group[f]];
        if (muscle < 0 || surface_end(v, f) - v->start[f] < 3)
            continue;
        if (s->face)
            s->face[s->start[muscle + 1]++] = f;
        else
            s->start[muscle + 2]++;
    }
}

static int add_views(muscle_surfaces *s, const model *m, err *e)
{
    char name[MODEL_NAME];
    for (int at = 0; model_surface(m, &at, name, sizeof name); s->views++)
        if (mem_grow(&s->view, &s->view_capacity, s->views + 1, sizeof *s->view, "surfaces", e) ||
            surface_of(m, name, &s->view[s->views], e))
            return -1;
    return 0;
}

int muscle_surfaces_find(muscle_surfaces *s, const model *m, const char *const *name, int64_t muscles, err *e)
{
    *s = (muscle_surfaces){.muscles = muscles};
    if (add_views(s, m, e))
        return -1;
    int64_t groups = 0, at = 0;
    for (int i = 0; i < s->views; i++)
        groups += s->view[i].groups;
    s->from = mem_array(muscles, sizeof *s->from, "surfaces", e);
    s->start = s->from ? mem_array(muscles + 2, sizeof *s->start, "surfaces", e) : NULL;
    int32_t *to = s->start ? mem_array(groups, sizeof *to, "groups", e) : NULL;
    if (!to)
        return -1;
    for (int64_t i = 0; i < muscles; i++)
        s->from[i] = -1;
    for (int i = 0; i < s->views; at += s->view[i++].groups)
        claim_groups(s, i, name, to + at);
    for (int round = 0; round < 2; round++) {
        at = 0;
        for (int i = 0; i < s->views; at += s->view[i++].groups)
            sort_faces(s, i, to + at);
        for (int64_t i = 0; !round && i < muscles; i++)
            s->start[i + 2] += s->start[i + 1];
        if (!round && !(s->face = mem_array(s->start[muscles + 1], sizeof *s->face, "surfaces", e)))
            break;
    }
    free(to);
    return s->face ? 0 : -1;
}

void muscle_surfaces_free(muscle_surfaces *s)
{
    free(s->view);
    free(s->from);
    free(s->start);
    free(s->face);
    *s = (muscle_surfaces){0};
}

/* One polygon. */
static int cut(const surface *v, int64_t face, trimesh *t, int32_t *corner, err *e)
{
    const int32_t *vertex = &v->vertex[v->start[face]];
    const int64_t count = surface_end(v, face) - v->start[face];
    if (triangulate(v->position, vertex, count, corner, e))
        return -1;
    for (int64_t i = 0; i < 3 * (count - 2); i++)
        for (int a = 0; a < 3; a++)
            t->position[9 * t->triangles + 3 * i + a] = v->position[3 * (int64_t)vertex[corner[i]] + a];
    t->triangles += count - 2;
    return 0;
}

/* Leaves no triangles where they are not closed. */
static int keep_closed(trimesh *t, err *e)
{
    char open[SOLID_OPEN];
    const surface view = {.name = "", .position = t->position, .vertices = t->vertices};
    if (solid_open(&view, t->corner, NULL, t->triangles, open, e))
        return -1;
    if (open[0])
        t->triangles = 0;
    return 0;
}

int muscle_surface_take(const muscle_surfaces *s, int64_t muscle, trimesh *t, err *e)
{
    const int64_t first = s->start[muscle], last = s->start[muscle + 1];
    if (s->from[muscle] < 0 || first == last)
        return 0;
    const surface *v = &s->view[s->from[muscle]];
    int64_t triangles = 0;
    for (int64_t i = first; i < last; i++)
        triangles += surface_end(v, s->face[i]) - v->start[s->face[i]] - 2;
    t->vertices = 3 * triangles;
    t->position = mem_array(t->vertices, 3 * sizeof *t->position, "a muscle's surface", e);
    t->corner = t->position ? mem_array(t->vertices, sizeof *t->corner, "a muscle's surface", e) : NULL;
    if (!t->corner)
        return -1;
    for (int64_t i = first; i < last; i++)
        if (cut(v, s->face[i], t, t->corner + 3 * t->triangles, e))
            return -1;
    for (int64_t i = 0; i < t->vertices; i++)
        t->corner[i] = (int32_t)i;
    return keep_closed(t, e);
}
