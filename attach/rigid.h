/* The rigid surfaces of a model, which are known by the names of their groups, and the points, lines and polygons that
 * they consist of. A rigid owns its list; it borrows positions and corners from the models that it was collected from,
 * which must outlive it.
 */
#ifndef SINEW_RIGID_H
#define SINEW_RIGID_H

#include "cli/opt.h"
#include "model/model.h"
#include "surface/names.h"

typedef struct rigid_primitive {
    const double *position; /* vertices x 3 of its surface, m */
    const int32_t *vertex;  /* its corners */
    int64_t corners;        /* 1 point, 2 line, more: polygon */
    int32_t surface;        /* the rigid surface it belongs to: the first that its group names */
    const char *of;         /* the surface that it is a face of, by its name in the model; in the rigid's sources */
    int64_t face;           /* which */
    int64_t number;         /* in the order in which they were collected */
    bool idle;              /* it holds no node */
    bool apart;             /* of a file of its own: it may lie within tissue, and need not bound any */
} rigid_primitive;

typedef struct rigid_surface {
    const char *name; /* in the rigid's names */
    int64_t primitives;
    int64_t nodes; /* that it holds; a node may be held by several */
    int64_t idle;  /* primitives that hold no node */
} rigid_surface;

typedef struct rigid {
    rigid_surface *surface;     /* in order of the groups */
    rigid_primitive *primitive; /* by surface */
    int64_t surfaces, primitives, surface_capacity, primitive_capacity;
    names names;   /* of surfaces, by the same numbers */
    names sources; /* of the models' surfaces */
} rigid;

/* Adds all that m's surfaces hold in groups of which a name matches one of the patterns (a '*' at the end matches any
 * rest, any case; a value may hold several between commas). No patterns: skull*, bone* and rigid*. A pattern given that
 * matches nothing is an error that offers near names. */
int rigid_collect(rigid *r, const model *m, const opt_list *patterns, err *e);

/* Adds all of an OBJ file that was loaded as the only surface of `file`. What is in no group of its own is named as the
 * surface is. */
int rigid_collect_all(rigid *r, const model *file, err *e);

void rigid_free(rigid *r);

#endif
