/* The points and cells that an export writes: the elements of a model, or a surface that it carries, at rest or moved
 * by a frame. A shape borrows from its model and frame, and owns the displacement of its points.
 */
#ifndef SINEW_EXPORT_SHAPE_H
#define SINEW_EXPORT_SHAPE_H

#include "model/model.h"
#include "surface/surface.h"

typedef struct export_shape {
    const model *m;
    const frame *f; /* NULL: at rest */
    bool is_surface;
    surface s;               /* where is_surface */
    const model_array *node; /* element.node, else */
    int64_t points, cells, corners;
    const double *rest;   /* points x 3, m */
    double *displacement; /* points x 3, m; NULL at rest, and where the frame has none for these points */
    char point_axis[MODEL_NAME], cell_axis[MODEL_NAME];
} export_shape;

/* surface NULL: the elements. -1 with e filled where the model lacks what it takes. */
int export_shape_of(export_shape *x, const model *m, const char *name, err *e);

/* Moves the points by node.displacement of the frame (NULL: back to rest). A surface
 * that is not bound stays at rest. */
int export_shape_move(export_shape *x, const frame *f, err *e);

void export_shape_free(export_shape *x);

/* The points of a cell, in VTK order for elements. */
const int32_t *export_shape_cell(const export_shape *x, int64_t cell, int64_t *corners);

/* Where a point is: at rest, or moved. */
void export_shape_point(const export_shape *x, int64_t point, bool moved, double *at);

#endif
