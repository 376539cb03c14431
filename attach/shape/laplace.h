/* A Laplace or Poisson potential on voxels, in trilinear finite elements: Dirichlet nodes have a given value, all other
 * boundaries have no flux. Solved by conjugate gradients without an assembled matrix. Sums are taken over chunks of a
 * fixed size, so that any number of threads gives the same bytes. The creator owns it.
 */
#ifndef SINEW_LAPLACE_H
#define SINEW_LAPLACE_H

#include "base/pool.h"

typedef struct laplace laplace;

/* node: elements x 8, VTK order, of 0 to nodes - 1, each of an element; it must outlive what is made. spacing: the
 * voxel's sides, m. share: of each element, how well it conducts (NULL: 1). threads: borrowed. NULL with e filled. */
laplace *laplace_create(pool *threads, const double *spacing, const int32_t *node, int64_t elements, int64_t nodes,
                        const float *share, err *e);
void laplace_free(laplace *l);

/* Solves -div grad u = source (1/m2). u is read at Dirichlet nodes, of which each connected component needs one, and is
 * the first guess at the others. -1 with e filled where it does not converge. */
int laplace_solve(laplace *l, const bool *held, double source, double *u, err *e);

/* grad u in the middle of an element, 1/m. */
void laplace_gradient(const laplace *l, int64_t element, const double *u, double *gradient);

#endif
