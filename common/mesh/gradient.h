/* The displacement gradient at an element's centre, from the displacements of its nodes, and the strain
 * there: for hexahedra of any shape and for tetrahedra. Tensors are 3 x 3, row i column j at 3 i + j. Nothing here
 * allocates.
 */
#ifndef SINEW_GRADIENT_H
#define SINEW_GRADIENT_H

#include <stdint.h>

/* H = du/dX at the centre. node: the element's 8 or 4; rest, u: of all nodes, x 3, m. False,
 * and all nan: the element has no volume. */
int gradient_of(const int32_t *node, int corners, const double *rest, const double *u, double h[9]);

/* Green-Lagrange's E = (H + H^T + H^T H) / 2. */
void gradient_strain(const double h[9], double strain[9]);

/* The principal values of a symmetric tensor, the largest first. */
void gradient_principal(const double t[9], double to[3]);

/* Of a symmetric tensor: the largest principal value, and sqrt(3/2 dev : dev), von Mises' equivalent of a stress (that
 * of a strain is 2/3 of it). */
double gradient_largest(const double t[9]);
double gradient_mises(const double t[9]);

#endif
