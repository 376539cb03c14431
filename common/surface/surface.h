/* Surfaces carried with a model: arrays "S/vertex.position", "S/face.start", … seen as one struct. A view
 * borrows from the model and is valid until an array is added or removed.
 */
#ifndef SINEW_SURFACE_H
#define SINEW_SURFACE_H

#include "model/model.h"
#include "surface/obj.h"

enum { SURFACE_NAME_MOST = 200 }; /* bytes of a surface's name: its arrays' names are longer */

typedef struct surface {
    const char *name;
    const double *position; /* vertices x 3, m */
    int64_t vertices;
    const int64_t *start; /* faces; see surface_end */
    const int32_t *group; /* faces */
    int64_t faces;
    const int32_t *vertex; /* corners */
    int64_t corners;
    char *const *group_name; /* names between spaces */
    int64_t groups;
} surface;

static inline int64_t surface_end(const surface *s, int64_t face)
{
    return face + 1 < s->faces ? s->start[face + 1] : s->corners;
}

/* The array "NAME/what" of a surface, or NULL: "vertex.element". NULL for the user's names ("x-") too. */
model_array *surface_part(const model *m, const char *name, const char *what);

/* Whether the model carries the surface. */
bool surface_there(const model *m, const char *name);

/* The surface named `name` (borrowed by the view). */
int surface_of(const model *m, const char *name, surface *s, err *e);

/* Adds an OBJ to the model as the surface `name`, its coordinates times scale (to metres). */
int surface_add(model *m, const char *name, const obj *o, double scale, err *e);

/* A coordinate of an OBJ in metres: one product, the same wherever it is computed, so that equality can be asked. */
static inline double surface_metres(double coordinate, double scale)
{
    return coordinate * scale;
}

/* Whether the surface is this OBJ: as many vertices, at the same places. Returns 0, or -1 with e saying what differs
 * first. */
int surface_is(const surface *s, const obj *o, double scale, err *e);

/* A surface name from a path: base name without .obj, .obj.gz; what axis names may not hold becomes '_', and so
 * does the '-' of "x-" at its start, which is the user's; "stdin" for "-". */
void surface_name(const char *path, char *name, size_t size);

/* A name that says nothing of the file: that of the first surface that is this OBJ, else the first of surface_1,
 * surface_2, ... that is free. */
void surface_nameless(const model *m, const obj *o, double scale, char *name, size_t size);

/* Whether one of the names between spaces in `names` matches the pattern (any case; a '*' at its end matches any
 * rest). */
bool surface_in_group(const char *names, const char *pattern);

#endif
