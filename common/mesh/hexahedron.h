/* A place inside a hexahedron of any shape, by the same three weights as in a box (weights.h, W&M equation (1)): the
 * shares of its nodes that bring the place, found by Newton's method, as the map from weights to places is trilinear.
 * And its mean derivatives, by which elements with one integration point go. Nothing here allocates.
 */
#ifndef SINEW_HEXAHEDRON_H
#define SINEW_HEXAHEDRON_H

#include <stdbool.h>
#include <stdint.h>

/* Whether all its corners stand where its first, its last and the axes say: then weights.h's formulas are exact. */
bool hexahedron_is_box(const int32_t *node, const double *position);

/* The weights of a place; where it is so far outside that the map does not reach it, those of the nearest place that
 * was met, at most half an element outside. node: the element's 8; position: of all nodes at rest, m. */
void hexahedron_weights(const int32_t *node, const double *position, const double *point, double *weight);

/* How far outside the place is, m: from the nearest place by weights, 0 inside. */
double hexahedron_outside(const int32_t *node, const double *position, const double *point);

/* The gradients of the nodes' shares, 1/m: 8 x 3. */
void hexahedron_gradients(const int32_t *node, const double *position, const double *weight, double *gradient);

/* The mean over an element of its shape functions' derivatives, B (8 x 3, 1/m), which is exact; returns its volume V,
 * m3. at: its corners, 8 x 3, m. B is no number where V is 0. */
double hexahedron_mean(const double *at, double *b);

/* The sign of a mode (x, y, z, xy, yz, zx, xyz) at a corner. */
double hexahedron_sign(int mode, int corner);

/* dX/dxi at the centre, m: a row a component, a column an axis, xi from -1 to 1. */
void hexahedron_basis(const double *at, double basis[9]);

/* What element_any.h takes of them: the slopes of the modes (7 x 3, 1/m) and the twists of the last four (4 x 3, m). */
void hexahedron_modes(const double *at, const double *b, double *slope, double *twist);

#endif
