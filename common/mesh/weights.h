/* A place inside a hexahedron of a lattice, as three weights, and what follows from them: the shares of the eight
 * nodes, their gradients, the distance outside. Source: W&M section 3.3, equation (1). The same of tetrahedra, by
 * barycentric weights. Nothing here allocates.
 */
#ifndef SINEW_WEIGHTS_H
#define SINEW_WEIGHTS_H

#include <stdint.h>

/* An element at rest: its first node (VTK node 0) and its sides, m. */
typedef struct weights_box {
    double first[3], side[3];
} weights_box;

/* node: the element's 8; position: of all nodes at rest, m. */
weights_box weights_box_of(const int32_t *node, const double *position);

/* Equation (1): w_i = 1 - (p_i - x_i) / v_i, x the first node, v the sides. Below 0 or above 1: outside. */
void weights_of(const weights_box *box, const double *point, double *weight);

/* The shares of the 8 nodes, trilinear: they sum to 1. Node 0's is w_0 w_1 w_2. */
void weights_shares(const double *weight, double *share);

/* The displacement of a place in an element, m, by equation (1) in a hexahedron (columns 8, three weights; extrapolated
 * outside) and by barycentric weights in a tetrahedron (columns 4, four weights).
 * node: the element's; u: of all nodes, x 3. */
void weights_displacement(const int32_t *node, int32_t columns, const double *weight, const double *u, double *d);

/* A tetrahedron: the four weights of a place, which sum to 1, and the gradients of its nodes' shares, 1/m (4 x 3). It
 * must have a volume. node: its 4; position: of all nodes at rest. */
void weights_tetrahedron(const int32_t *node, const double *position, const double *point, double *weight);
void weights_tetrahedron_gradients(const int32_t *node, const double *position, double *gradient);

/* Its volume, m3, either way round; 0 where it is less than a billionth of a cube over its longest side. */
double weights_tetrahedron_volume(const int32_t *node, const double *position);

/* How far outside the tetrahedron the place is, m; 0: it is inside. */
double weights_tetrahedron_outside(const int32_t *node, const double *position, const double *point);

/* The gradients of the shares at rest, 1/m: 8 x 3. */
void weights_gradients(const weights_box *box, const double *weight, double *gradient);

/* How far outside the box the place is, m; 0: it is inside. */
double weights_outside(const weights_box *box, const double *weight);

#endif
