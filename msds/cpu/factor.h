/* A Cholesky factor of the FEM's stiffness matrix over its free nodes: multifrontal (Duff and Reid 1983), made in
 * double, kept as float, since what solves with it refines. Solving is in halves, so that contact can step in
 * between: K^-1 = L^-T L^-1. The tree of fronts is worked level by level; each front sums its children's shares in
 * their order, so the result is the same for any number of threads. The creator owns it.
 *
 * The path of a node is its own front and all above: where L^-1 of a load on that node is not zero. A path vector
 * holds those values, the root's first, so that two paths share the beginnings of their vectors.
 */
#ifndef SINEW_FACTOR_H
#define SINEW_FACTOR_H

#include "msds/cpu/dissect.h"
#include "msds/cpu/lanes.h"
#include "msds/problem/stiffness.h"

#include <stdatomic.h>

typedef struct factor_front {
    float *panel;     /* (rows + columns) x columns, by columns */
    double *value;    /* rows + columns: of the solve under way */
    double *left;     /* 3 rows squared, by columns, while the factor is made: what the front leaves to its parent */
    int64_t child[2]; /* or -1 */
    int64_t above;    /* columns of all fronts above it */
} factor_front;

typedef struct factor {
    const msds_problem *p;
    const stiffness *k;
    const lanes *loops;
    pool *threads;
    dissection tree;
    factor_front *of; /* tree.fronts */
    int64_t *level;   /* tree.fronts: the deepest first */
    int64_t *begin;   /* levels + 1: of each in `level` */
    int64_t levels;
    int64_t at;                    /* the level that is being worked on */
    int64_t numbers;               /* in all panels */
    int64_t path;                  /* the longest path's values */
    int64_t largest;               /* rows and columns of the largest front, as numbers */
    const msds_listener *listener; /* set before factor_make; NULL: nobody */
    const double *load;
    double *result;
    const atomic_bool
        *stop;       /* set by another thread: to end early, as if it had failed; set before factor_make; NULL */
    int32_t *failed; /* fronts: the model's node whose pivot was not above 0, or -1; -2: no memory */
} factor;

/* Orders, allocates and factors k's matrix. -1 with e filled, and to be freed all the same: where memory is short
 * (said before it is taken), or the matrix is not positive definite (a part that nothing holds). */
int factor_make(factor *f, const msds_problem *p, const stiffness *k, const lanes *loops, pool *threads, err *e);
void factor_free(factor *f);

/* Factors again, when k's matrix has changed. -1 with e filled. */
int factor_again(factor *f, err *e);

/* L^-1 of a load (the model's nodes x 3), into the fronts' values. */
void factor_forward(factor *f, const double *load);
/* L^-T of the fronts' values, into result (the model's nodes x 3; fixed ones get 0). */
void factor_backward(factor *f, double *result);

/* How many values a free node's path has. */
int64_t factor_path_length(const factor *f, int64_t node);

/* L^-1 of unit loads on a free node along x, y and z: three path vectors, `stride` apart. work: 3 f->largest. */
void factor_path(const factor *f, int64_t node, double *work, float *to, int64_t stride);

/* How many values the paths of two free nodes share. */
int64_t factor_shared(const factor *f, int64_t a, int64_t b);

/* The product of a path vector with the fronts' values; and those plus scale times it. */
double factor_dot(const factor *f, int64_t node, const float *path);
void factor_add(factor *f, int64_t node, const float *path, double scale);

#endif
