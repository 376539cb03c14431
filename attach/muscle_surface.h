/* The closed surfaces that muscles were voxelised from, as a model carries them: the polygons of the groups that have a
 * muscle's name. They know a muscle's shape better than its voxels do, as these are few, stepped, and cut off where
 * bone or skin is. The creator owns what is found; the model's arrays are borrowed.
 */
#ifndef SINEW_MUSCLE_SURFACE_H
#define SINEW_MUSCLE_SURFACE_H

#include "model/model.h"
#include "surface/surface.h"
#include "surface/trimesh.h"

typedef struct muscle_surfaces {
    surface *view; /* the model's surfaces */
    int views;
    int64_t view_capacity;
    int32_t *from;  /* muscles: which surface has it, -1 = none */
    int64_t *start; /* muscles + 1: a muscle's first place in face */
    int64_t *face;  /* of that surface, rising */
    int64_t muscles;
} muscle_surfaces;

/* name: of each muscle, its volume's. A muscle in several surfaces is in the first. -1 with e filled; s is to be freed
 * all the same. */
int muscle_surfaces_find(muscle_surfaces *s, const model *m, const char *const *name, int64_t muscles, err *e);
void muscle_surfaces_free(muscle_surfaces *s);

/* The triangles of one, m; none where the model has no surface of it, or where its surface is open. t: zeroed, owned by
 * the caller. Each triangle has corners of its own. */
int muscle_surface_take(const muscle_surfaces *s, int64_t muscle, trimesh *t, err *e);

#endif
