#include "surface/trimesh.h"

#include "base/mem.h"
#include "surface/surface.h"
#include "surface/triangulate.h"

#include <stdlib.h>

static int cut_face(trimesh *t, const obj *o, int64_t face, err *e)
{
    const int64_t first = o->face_start[face], count = o->face_start[face + 1] - first;
    const int32_t *vertex = o->corner_vertex + first;
    if (count < 3)
        return 0;
    const int64_t need = t->triangles + count - 2;
    if ((3 * need > t->corner_capacity &&
         mem_grow(&t->corner, &t->corner_capacity, 3 * need, sizeof *t->corner, "a surface's triangles", e)) ||
        MEM_ROOM(&t->group, &t->group_capacity, need, "a surface's triangles", e))
        return -1;
    int32_t *cut = t->corner + 3 * t->triangles;
    if (triangulate(t->position, vertex, count, cut, e))
        return -1;
    for (int64_t i = 0; i < 3 * (count - 2); i++)
        cut[i] = vertex[cut[i]];
    for (int64_t i = t->triangles; i < need; i++)
        t->group[i] = o->face_group[face];
    t->triangles = need;
    return 0;
}

int trimesh_of(trimesh *t, const obj *o, double scale, err *e)
{
    t->vertices = o->vertices;
    t->position = mem_array(o->vertices, 3 * sizeof *t->position, "a surface's vertices", e);
    if (!t->position)
        return -1;
    for (int64_t i = 0; i < 3 * o->vertices; i++)
        t->position[i] = surface_metres(o->position[i], scale);
    for (int64_t f = 0; f < o->faces; f++)
        if (cut_face(t, o, f, e))
            return -1;
    return 0;
}

void trimesh_free(trimesh *t)
{
    free(t->position);
    free(t->corner);
    free(t->group);
    *t = (trimesh){0};
}
