/* The FEM as PST runs it: so many conjugate gradients a frame, from the frame before, in single precision. Contact by
 * prescribed displacement moves the nodes onto the probe first and then keeps the search out of the directions of
 * contact; by penalty it stiffens the nodes along them. The creator owns it.
 */
#ifndef SINEW_CG_H
#define SINEW_CG_H

#include "msds/cpu/pressed.h"
#include "msds/problem/stiffness.h"

typedef struct cg {
    const msds_problem *p;
    const lanes *loops;
    const sell *s;
    pool *threads;
    stiffness *k;
    pressed pressed;
    lanes_matrix matrix;
    lanes_field *u, *weight; /* the state's: m, N */
    lanes_field left, way, pulled;
    double *place, *force; /* the model's nodes x 3: m, N; where warping needs them */
    double *sum;           /* chunks */
    float alpha, beta;
    double pull;     /* N2: the square of the elements' pulls */
    double residual; /* what is left over the load or the pull, whichever is more */
} cg;

/* The stiffness as float, in the order of m's slices. Rows of Dirichlet nodes stay zero. */
void cg_fill(lanes_matrix *m, const msds_problem *p, const stiffness *k, pool *threads);

/* -1 with e filled, and to be freed all the same. */
int cg_make(cg *g, const msds_problem *p, const sell *s, stiffness *k, contacts *c, const lanes *loops, pool *threads,
            lanes_field *u, lanes_field *weight, err *e);
void cg_free(cg *g);

/* Some iterations with the contacts listed, whose forces it fills. */
void cg_solve(cg *g, int64_t iterations);

#endif
