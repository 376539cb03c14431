/* One of the two surfaces of sinew distance: its OBJ and triangles in mm and, once it is measured to, what finds the
 * nearest point and its side. And the distances from the vertices of one to the other. The caller owns both; begin with
 * zeroed ones.
 */
#ifndef SINEW_DISTANCE_SURFACE_H
#define SINEW_DISTANCE_SURFACE_H

#include "base/pool.h"
#include "surface/pseudonormal.h"
#include "surface/trimesh.h"

typedef struct distance_surface {
    obj file;
    trimesh mesh;  /* mm */
    uint8_t *used; /* vertices: whether a polygon has it */
    int64_t used_count;
    triangle_tree *tree; /* NULL: it is not measured to */
    pseudonormal normal;
} distance_surface;

/* Where a surface comes from. */
typedef struct distance_source {
    const char *path;         /* "-": standard input */
    double mm;                /* of the OBJ's unit */
    const char *group;        /* of polygons that are taken, with * at the end for any rest; NULL: all */
    const char *group_option; /* what asks for it, for messages */
} distance_source;

/* -1 with e filled where there is no polygon too. */
int distance_surface_read(distance_surface *s, const distance_source *from, notes *warnings, err *e);

/* Words that the OBJ has no such group. Returns -1. */
int distance_unknown_group(const obj *o, const char *option, const char *group, err *e);

/* Makes what is needed to measure to it; notes where its outside is in doubt. */
int distance_surface_index(distance_surface *s, notes *warnings, err *e);
void distance_surface_free(distance_surface *s);

/* Of each vertex; of those that no polygon has, 0. */
typedef struct distance_field {
    double *distance; /* vertices: mm, to the nearest point of the other surface */
    double *side;     /* vertices: 1 outside, -1 inside, 0 where the nearest point is on the border */
    double *nearest;  /* vertices x 3: that point, mm */
    int64_t border;   /* vertices whose nearest point is on the border */
} distance_field;

/* The same bytes for any number of threads. */
int distance_measure(distance_field *f, const distance_surface *from, const distance_surface *to, pool *threads,
                     err *e);
void distance_field_free(distance_field *f);

#endif
