/* Coarser lattices over a mesh, for solvers that go through them (geometric multigrid): each has half the nodes a side,
 * and the stiffness that the finer one has between fields that are trilinear on it (Galerkin). The mesh itself may be
 * of any tetrahedra: a node takes part with its place among the eight nodes around it; where the mesh is a lattice of
 * five tetrahedra a cell the coarser ones fit it. Fixed nodes take no part, so labels that hold nodes fast are held on
 * every lattice. The creator owns it; the matrix of level 0 is the mesh's and borrowed.
 */
#ifndef SINEW_LEVELS_H
#define SINEW_LEVELS_H

#include "base/pool.h"
#include "msds/cpu/lanes.h"

enum { LEVELS_MOST = 12, LEVELS_COARSEST = 100 /* nodes: so few are solved for directly */ };

/* A sparse matrix of one number a pair of nodes; rows in slices of LANES, as sell.h has them. A lane without one: its
 * first column with weight 0. */
typedef struct levels_weights {
    int64_t count, slots; /* sell */
    int32_t *start;       /* count + 1 */
    int32_t *column;      /* slots x LANES */
    float *weight;
} levels_weights;

typedef struct level {
    sell graph; /* of level 0: the mesh's, borrowed; else count, nodes, slots, start, first and neighbour alone */
    lanes_matrix matrix;
    float *inverse;          /* count x 9 x LANES: of the diagonal's blocks, row by row; zero where nothing moves */
    double largest;          /* the largest eigenvalue of inverse times matrix, from above */
    levels_weights up, down; /* from the next coarser level to this one, and back */
    double *place;           /* nodes x 3: on this level's lattice */
    bool *moves;             /* nodes */
} level;

typedef struct levels {
    level at[LEVELS_MOST];
    int count;
    float *coarsest; /* order squared: the inverse of the last level's matrix */
    int64_t order;   /* 3 x its nodes */
} levels;

/* Makes l (zeroed) of the stiffness of p's mesh, as cg_fill() gives it, which stays borrowed. -1
 * with e filled; to be freed in every case. */
int levels_make(levels *l, const msds_problem *p, const sell *s, const lanes_matrix *m, pool *threads, err *e);
void levels_free(levels *l);

#endif
