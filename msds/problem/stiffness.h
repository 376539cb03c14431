/* The FEM's stiffness matrix in double, as 3 x 3 blocks: one a node, and one a spring, since both have the edges of the
 * tetrahedra; and the forces that elements pull with. The creator owns it.
 */
#ifndef SINEW_STIFFNESS_H
#define SINEW_STIFFNESS_H

#include "base/pool.h"
#include "msds/problem/problem.h"

typedef struct stiffness {
    const msds_problem *p;
    pool *threads;
    double *diagonal;        /* nodes x 9, row by row */
    double *block;           /* springs x 9: rows of the spring's first node, columns of its second */
    int32_t *element_spring; /* elements x 6, by SIMPLEX_EDGES */
    int64_t *start;          /* nodes + 1: corners of each node */
    int32_t *corner;         /* elements x 4: element * 4 + corner, ascending a node */
    double *turn;            /* elements x 4: the quaternion that warping takes out; NULL without */
    double *force;           /* elements x 12 */
    const double *u, *way;   /* what is being worked on */
    const double *turned;
    double *turning;
    double *sum;
} stiffness;

/* Allocates, and fills the blocks, at rest; warped: its elements' rotations are taken out. -1 with e filled; to be
 * freed in every case. */
int stiffness_make(stiffness *k, const msds_problem *p, bool warped, pool *threads, err *e);
void stiffness_free(stiffness *k);

/* Where warping is asked for: takes each element's rotation at u (nodes x 3) and, if
 * `again`, makes the blocks again. */
void stiffness_warp(stiffness *k, const double *u, bool again);

/* What the elements pull the nodes with at u: nodes x 3, N. */
void stiffness_force(stiffness *k, const double *u, double *force);

/* Where warping is asked for: the elements' rotations at u, from those before, to `turn` (elements x 4); k keeps its
 * own. */
void stiffness_turns(stiffness *k, const double *u, double *turn);

/* And what the pulls there change by along a way, N/m times its unit: turns as those. */
void stiffness_along(stiffness *k, const double *u, const double *turn, const double *way, double *force);

#endif
