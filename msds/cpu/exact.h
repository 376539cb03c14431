/* The FEM solved to a tolerance each frame, with one factor of the stiffness matrix at rest. A probe's contact does
 * not change that factor: with N the directions of contact and S = N^T K^-1 N (the Schur complement, whose parts are
 * products of path vectors, factor.h), the forces f >= 0 that keep each node out of the probe solve a small
 * complementarity problem; they come in between the two halves of a solve. What rounding (the factor is float), an
 * inexact S leaves over, the next solve takes out; where elements turn, whose factor it is not, mixing.h makes the
 * most of the solves. The creator owns it.
 */
#ifndef SINEW_EXACT_H
#define SINEW_EXACT_H

#include "msds/cpu/contacts.h"
#include "msds/cpu/factor.h"
#include "msds/cpu/mixing.h"

enum { EXACT_SOLVES = 300 };

typedef struct exact {
    const msds_problem *p;
    pool *threads;
    stiffness *k;
    factor factor;
    double *left, *inner, *step; /* nodes x 3 */
    int32_t *cached;             /* nodes: which of the paths are theirs, or -1 */
    int32_t *whose;              /* paths: the node */
    float *path;                 /* paths x 3 x factor.path */
    int64_t paths, room, whose_room;
    double *work;                 /* for paths being made */
    int64_t fresh;                /* the first of them */
    int64_t row;                  /* of schur: the first of those being made */
    float *normal;                /* contacts x factor.path: along each contact's way */
    double *schur, *want, *force; /* contacts squared; contacts */
    int64_t normal_room, schur_room, want_room, force_room;
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

/* Brings u (nodes x 3) into equilibrium with gravity and with the contacts listed, whose forces it fills; first:
 * of a frame. -1 with e filled where
 * it does not come to the tolerance. */
int exact_solve(exact *x, double *u, bool first, double tolerance, double reach, err *e);

#endif
