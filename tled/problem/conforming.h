/* The part of a problem whose elements are hexahedra of any shape, not a lattice's boxes: what each of them is at
 * rest, and its stable step. Derivatives are the element's mean ones and hourglass vectors Flanagan & Belytschko's
 * (element_any.h); hourglass control has the element's own V, B and basis (hourglass.h); a corner has an eighth of the
 * element's mass. The problem owns it.
 */
#ifndef SINEW_CONFORMING_H
#define SINEW_CONFORMING_H

#include "tled/problem/state.h"

typedef struct conforming_element {
    double slope[7][3], twist[4][3], volume; /* element_any's */
    double squares;                          /* 1/m2: sum of B^2 over corners and axes */
    double root[3][3];                       /* 1/m: L, lower */
    double gammas, least;                    /* eigenvalues of R R^T, the largest and the smallest: 8 of a box */
    double steepest;                         /* 1/m: l of conforming_step.h; the largest 1/(4 h) of a box */
    double couple;                           /* c^2 */
    double stiffest;                         /* N/m, once joined: no less than the largest eigenvalue of R^T D R */
} conforming_element;

typedef struct conforming {
    conforming_element *element; /* elements */
    double square;               /* 1/s2: of the highest frequency at rest, once joined */
    int64_t stiffest;            /* whose it is */
} conforming;

/* Makes p->conforming, and p->side, a cube's of the mean volume, once p's mesh is there. -1 with e filled where an
 * element has no inside. */
int conforming_create(tled_problem *p, err *e);
void conforming_free(conforming *c);

/* R of an element, 4 x 4, a row a mode, lower: R R^T is gamma gamma^T, or, where that has nearly no inverse, its
 * largest eigenvalue times 1, which is no less. */
void conforming_root(const conforming_element *c, double root[16]);

/* Once the volumes have their laws: p->corner_start, p->corner and p->mass (allocated). -1 with e filled. */
int conforming_corners(tled_problem *p, err *e);

/* What holds the modes of an element, made anew at each call: its basis (m: dX/dxi at its centre, a row a component),
 * and what its law has by the control. */
typedef struct conforming_hold {
    double basis[9], law[HOURGLASS_NUMBERS];
} conforming_hold;

conforming_hold conforming_hold_of(const tled_problem *p, int64_t element);

/* Elements that are their lattice's boxes, on the problem's threads: the result is the same for any number of them. */

/* Every element must be a box with the lattice's spacing for sides, its corners in VTK order. -1 with e filled for the
 * first that is not. */
int boxes_check(const tled_problem *p, err *e);

/* Fills p->corner (nodes x 8) and p->mass (nodes, zeroed): the corners of elements at each node, and its mass,
 * rho V / 8 from each, of what is tissue. -1 with e filled where a node is in no element, or in more than 8. */
int boxes_corners(tled_problem *p, err *e);

#endif
