/* A surface bound to the elements of a model, seen as one struct: how its vertices move where the nodes move. A view
 * borrows from the model and is valid until an array is added or removed.
 */
#ifndef SINEW_BOUND_H
#define SINEW_BOUND_H

#include "mesh/surface.h"

typedef struct bound {
    surface shape;
    const int32_t *element; /* vertices */
    const double *weight;   /* vertices x 3 */
    const int32_t *node;    /* elements x 8 */
    const double *rest;     /* nodes x 3, m */
} bound;

/* The bound surface that this OBJ is: the one named, else any whose vertices are the same. -1 with e saying what
 * differs. */
int bound_find(bound *b, const model *m, const char *name, const obj *o, double scale, err *e);

/* Below, u is the displacement of the nodes (x 3, m). */

/* The displacement of a vertex, m: trilinear, extrapolated outside. */
void bound_displacement(const bound *b, int64_t vertex, const double *u, double *d);

/* The deformation gradient F = I + du/dX at a vertex: row i, column j at 3 i + j. */
void bound_gradient(const bound *b, int64_t vertex, const double *u, double *f);

/* How far the vertex lies outside its element at rest, m. */
double bound_outside(const bound *b, int64_t vertex);

#endif
