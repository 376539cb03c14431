/* A surface bound to the elements of a model, seen as one struct: how its vertices move where the nodes move, and what
 * values at the nodes are at its vertices. A view borrows from the model and is
 * valid until an array is added or removed.
 */
#ifndef SINEW_BOUND_H
#define SINEW_BOUND_H

#include "surface/surface.h"

typedef struct bound {
    surface shape;
    const int32_t *element; /* vertices */
    const double *weight;   /* vertices x 3 (hexahedra) or 4 (tetrahedra) */
    const uint8_t *blended; /* vertices: whether they move by motion.h; NULL: none does */
    const int32_t *node;    /* elements x corners */
    int corners;            /* of an element: 8 or 4 */
    const double *rest;     /* nodes x 3, m */
} bound;

/* The view of the surface named so. 1: it is bound; 0: it is carried, but not bound, and b
 * holds its shape only; -1: e is filled. */
int bound_of(bound *b, const model *m, const char *name, err *e);

/* The bound surface that this OBJ is: the one named, else any whose vertices are the same. -1 with e saying what
 * differs. */
int bound_find(bound *b, const model *m, const char *name, const obj *o, double scale, err *e);

/* The shares that the element's nodes have in a vertex: they sum to 1. Returns how many: b->corners. */
int bound_shares(const bound *b, int64_t vertex, double share[8]);

/* Below, u is the displacement of the nodes (x 3, m), and a vertex moves with its own element alone: motion.h has how
 * it moves where it is blended. */

/* The displacement of a vertex, m: trilinear (linear in a tetrahedron), extrapolated outside. */
void bound_displacement(const bound *b, int64_t vertex, const double *u, double *d);

/* The deformation gradient F = I + du/dX at a vertex: row i, column j at 3 i + j. */
void bound_gradient(const bound *b, int64_t vertex, const double *u, double *f);

/* How far the vertex lies outside its element at rest, m. */
double bound_outside(const bound *b, int64_t vertex);

#endif
