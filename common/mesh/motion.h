/* How a bound surface moves with the nodes. A vertex is bound to one element (bound.h), and its weights in it give its
 * displacement by W&M equation (1). Where a vertex is blended (bound.h), the motion is smoother. Each node has an
 * affine map: of the elements around it, the mean displacement and the mean displacement gradient. A vertex gets the
 * maps of the eight nodes of its element, blended with the trilinear shares of the place in the element that is nearest
 * to the vertex:
 *
 *     u(x) = sum_n N_n(y) (a_n + G_n (x - X_n)),     y: x, or the place on its element that is nearest to x
 *     a_n = mean_e(u_e) + G_n (X_n - mean_e(c_e)),   G_n = mean_e(G_e)
 *
 * X_n: the node at rest; u_e, G_e, c_e: the mean displacement of an element's nodes, the displacement gradient at its
 * centre, and the centre at rest. Motions that are affine in space are exact, as each map is. Neighbouring elements
 * share nodes, so the motion is continuous from one to the next. At the end of a slit a node may have elements on both
 * sides: elements of which one has a node, and the other a further node at the same place, take no part in its map, so
 * no vertex moves with nodes across a slit. A node to which no element is left that way has in each element the map of
 * that element. This is ours. Owns its tables, borrows the bound surface and the model.
 */
#ifndef SINEW_MOTION_H
#define SINEW_MOTION_H

#include "base/pool.h"
#include "mesh/bound.h"

/* u and its gradient, u_i at i and du_i/dX_j at 3 i + j: of an element at its centre, of a node at the node. */
typedef struct motion_map {
    double u[3], gradient[9]; /* m; 1 */
} motion_map;

typedef struct motion {
    const bound *of;
    const double *u; /* nodes x 3, m: what motion_set gave */
    int32_t *place;  /* nodes: of the map, or -1; NULL: no vertex is blended, and there are no maps */
    int32_t *entry;  /* elements: of its map, or -1 */
    int32_t *node;   /* places: the node; in its order */
    int64_t *start;  /* places + 1: of its elements in around */
    int32_t *around; /* elements by their entries, ascending */
    int32_t *element;
    double *offset; /* places x 3: X_n - mean_e(c_e), m */
    motion_map *at_node, *at_element;
    int64_t places, entries;
} motion;

/* b must stay where it is. A surface without blended vertices costs nothing. -1 with e filled on no memory. */
int motion_open(motion *m, const bound *b, int64_t nodes, int64_t elements, err *e);
void motion_free(motion *m);

/* Takes the displacement of the nodes (x 3, m), which is borrowed. threads: may be NULL. */
void motion_set(motion *m, const double *u, pool *threads);

/* The displacement of a vertex, m. */
void motion_displacement(const motion *m, int64_t vertex, double *d);

/* The deformation gradient F = I + du/dX at a vertex: row i, column j at 3 i + j. */
void motion_gradient(const motion *m, int64_t vertex, double *f);

#endif
