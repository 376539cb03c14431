/* A place inside a hexahedron of any shape, by the same three weights as in a box (weights.h, W&M equation (1)): the shares of its nodes
 * that bring the place, found by Newton's method, as the map from weights to places is trilinear. Nothing here allocates.
 */
#ifndef SINEW_HEXAHEDRON_H
#define SINEW_HEXAHEDRON_H

#include <stdbool.h>
#include <stdint.h>

/* Whether all its corners stand where its first, its last and the axes say: then weights.h's formulas are exact. */
bool hexahedron_is_box(const int32_t *node, const double *position);

/* The weights of a place; where it is so far outside that the map does not reach it, those of the nearest place that was met, at most
 * half an element outside. node: the element's 8; position: of all nodes at rest, m. */
void hexahedron_weights(const int32_t *node, const double *position, const double *point, double *weight);

/* How far outside the place is, m: from the nearest place by weights, 0 inside. */
double hexahedron_outside(const int32_t *node, const double *position, const double *point);

/* The gradients of the nodes' shares, 1/m: 8 x 3. */
void hexahedron_gradients(const int32_t *node, const double *position, const double *weight, double *gradient);

#endif
