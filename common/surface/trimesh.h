/* The polygons of an OBJ cut into triangles, in a unit of the caller's. Points and lines are left out. Owns all; begin
 * with a zeroed one.
 */
#ifndef SINEW_TRIMESH_H
#define SINEW_TRIMESH_H

#include "surface/obj.h"

typedef struct trimesh {
    double *position; /* vertices x 3: all of the OBJ's */
    int64_t vertices;
    int32_t *corner; /* triangles x 3: vertices */
    int32_t *group;  /* triangles: of the OBJ's groups */
    int64_t triangles;
    int64_t corner_capacity, group_capacity;
} trimesh;

/* scale: the OBJ's coordinates times this are positions. -1 with e filled on no memory. */
int trimesh_of(trimesh *t, const obj *o, double scale, err *e);
void trimesh_free(trimesh *t);

#endif
