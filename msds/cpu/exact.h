/* The FEM solved to a tolerance each frame, with one factor of the stiffness matrix at rest. A probe's contact does
 * not change that factor: the forces f >= 0 that keep each node out of the probe are the minimum of a quadratic
 * function, whose matrix is the compliance between contacts (compliance.h), and which takes products with it alone
 * (mprgp.h), so that thousands of nodes may touch. What rounding leaves over (the factor is float), the next solve
 * takes out; where elements turn, whose factor it is not, mixing.h makes the most of the solves. The creator owns it.
 */
#ifndef SINEW_EXACT_H
#define SINEW_EXACT_H

#include "msds/cpu/compliance.h"
#include "msds/cpu/mixing.h"
#include "msds/cpu/mprgp.h"

enum { EXACT_SOLVES = 300 };

typedef struct exact {
    const msds_problem *p;
    pool *threads;
    stiffness *k;
    factor factor;
    double *left, *inner, *step; /* nodes x 3 */
    compliance compliance;
    mprgp forces;
    contacts *c;
    double slight; /* N2: the problem's where elements turn; else 0 */
    double load;   /* N2: the square of the load or the pull where the frame began */
    double residual;
    int solves;
    const msds_listener *listener; /* set before exact_make; NULL: nobody */
    mixing mixing;                 /* where elements turn: of displacements, which lead, and contact forces */
    double *state, *by;            /* nodes x 4: those, as mixing wants them */
} exact;

/* Factors. -1 with e filled, and to be freed all the same. */
int exact_make(exact *x, const msds_problem *p, stiffness *k, contacts *c, const lanes *loops, pool *threads, err *e);
void exact_free(exact *x);

/* Tells x that it, its k and its pool are somewhere else now. */
void exact_moved(exact *x, stiffness *k, pool *threads);

/* Brings u (nodes x 3) into equilibrium with gravity and with the contacts listed, whose forces it fills; first:
 * of a frame. -1 with e filled where
 * it does not come to the tolerance. */
int exact_solve(exact *x, double *u, bool first, double tolerance, double reach, err *e);

#endif
