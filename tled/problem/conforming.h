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
    double basis[9];                         /* m: dX/dxi at the centre, a row a component */
    double root[3][3];                       /* 1/m: L, lower */
    double gammas;                           /* the largest eigenvalue of gamma gamma^T: 8 of a box */
    double couple;                           /* c^2 */
    double hourglass[HOURGLASS_NUMBERS];     /* once joined, by its kind, as are: */
    double hold[HOURGLASS_FORM];             /* hourglass_any's */
    double stiffest;                         /* N/m: the largest eigenvalue of its modes' stiffness at rest */
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

/* Once the volumes have their laws: p->corner_start, p->corner and p->mass (allocated). -1 with e filled. */
int conforming_corners(tled_problem *p, err *e);

#endif
