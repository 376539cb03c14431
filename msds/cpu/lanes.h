/* The loops that take the time, over eight nodes side by side (sell.h) and over dense columns, as a table of
 * functions: the same source, lanes_loops.c, compiled for each set of solve/vectors.h, chosen when a state is made.
 * No multiply and add is fused in any, and no sum changes its order: all give the same bytes. All memory is the
 * caller's.
 */
#ifndef SINEW_LANES_H
#define SINEW_LANES_H

#include "msds/cpu/tissue_mesh.h"
#include "msds/problem/sell.h"
#include "solve/vectors.h"

/* A value for each component of each of our nodes: three arrays, with LANES zeros before and after each. */
typedef struct lanes_field {
    float *x[3];
    float *memory; /* owned: what holds them */
} lanes_field;

typedef struct lanes_springs {
    const sell *s;
    const float *stiffness, *damper, *rest; /* slots x LANES */
    lanes_field place;                      /* m: at rest */
    lanes_field u, v, next_u, next_v;       /* m, m/s */
    const float *inverse;                   /* nodes: dt / inertia, 0 where fixed */
    lanes_field weight;                     /* N: gravity on each node */
    float dt;
    bool touched;
    float centre[3], reach; /* m: of a ball that holds the probe */
    const float *repulsion; /* nodes: N/m */
    double damping;         /* s: of the repulsion, over its stiffness */
    const probe_placed *probe;
    bool *met; /* set where the probe pushes a node that is free; by any thread, atomically */
} lanes_springs;

/* A sparse matrix of 3 x 3 blocks, with the graph of the springs (sell.h). Rows of Dirichlet nodes are zero. */
typedef struct lanes_matrix {
    const sell *s;
    float *diagonal; /* count x 9 x LANES */
    float *block;    /* slots x 9 x LANES */
} lanes_matrix;

typedef struct lanes {
    const char *name; /* as solve/vectors.h has it */
    /* A step of springs for slices [from, to): next_u, next_v from u, v. */
    void (*step)(const lanes_springs *w, int64_t from, int64_t to);
    /* y = a p for slices [from, to); returns p . y. */
    double (*multiply)(const lanes_matrix *a, const lanes_field *p, lanes_field *y, int64_t from, int64_t to);
    /* u += alpha p; r -= alpha y; returns r . r. */
    double (*advance)(lanes_field *u, lanes_field *r, const lanes_field *p, const lanes_field *y, float alpha,
                      int64_t from, int64_t to);
    /* p = r + beta p. */
    void (*turn)(lanes_field *p, const lanes_field *r, float beta, int64_t from, int64_t to);
    /* Nodes of slices [from, to) in the ball: their numbers to `list`; returns how many. */
    int64_t (*inside)(const lanes_springs *w, int64_t from, int64_t to, int32_t *list);
    /* c (rows x columns, at most 4, `stride` apart) -= l (rows x count) times the transpose of top (columns x
     * count), all of one stride. */
    void (*update)(double *c, int64_t stride, const double *l, const double *top, int64_t rows, int64_t columns,
                   int64_t count);
    /* y (rows) -= sum over columns of l (by columns, `stride` apart) times x (columns). */
    void (*forward)(double *y, const float *l, int64_t stride, int64_t rows, int64_t columns, const double *x);
    /* x (columns) -= the transpose of l times y (rows). */
    void (*backward)(double *x, const float *l, int64_t stride, int64_t rows, int64_t columns, const double *y);
    /* Groups [from, to): m->g, m->counted and m->swollen at u. */
    void (*tissue_measure)(const tissue_mesh *m, const lanes_field *u, int64_t from, int64_t to);
    /* Groups: m->force and m->law, of m->g and m->pressure. */
    void (*tissue_stress)(const tissue_mesh *m, int64_t from, int64_t to);
    /* Groups: what m->swollen changes by along a way from m->g. */
    void (*tissue_swell)(const tissue_mesh *m, const lanes_field *way, int64_t from, int64_t to);
    /* Groups: what m->force changes by, where m->pressure changes by m->pressed. */
    void (*tissue_tangent)(const tissue_mesh *m, const lanes_field *way, int64_t from, int64_t to);
    /* Groups: m->prestress, as linear elasticity has stress at this displacement. */
    void (*tissue_prestress)(const tissue_mesh *m, const lanes_field *of, int64_t from, int64_t to);
    /* Slices of points: m->bulk times the sums of m->swollen, to value; to m->pressure with m->held. */
    void (*tissue_points)(const tissue_mesh *m, float *value, int64_t from, int64_t to);
    /* Slices of nodes: the sums of m->force to y, 0 at Dirichlet nodes; returns way . y; way NULL: 0. */
    double (*tissue_gather)(const tissue_mesh *m, const lanes_field *way, lanes_field *y, int64_t from, int64_t to);
    /* d += alpha way; r -= alpha y; returns r . r m->inverse. */
    double (*tissue_advance)(const tissue_mesh *m, lanes_field *d, lanes_field *r, const lanes_field *way,
                             const lanes_field *y, float alpha, int64_t from, int64_t to);
    /* way = m->inverse r + beta way. */
    void (*tissue_turn)(const tissue_mesh *m, lanes_field *way, const lanes_field *r, float beta, int64_t from,
                        int64_t to);
} lanes;

#define LANES_DECLARE(set, name, bytes, has) extern const lanes lanes_##set;
VECTORS_SETS(LANES_DECLARE)

/* One for each set of solve/vectors.h. */
extern const lanes *const lanes_all[VECTORS_COUNT];

/* The first that this processor can do, or what SINEW_VECTORS names (solve/vectors.h). NULL with e filled. */
const lanes *lanes_choose(err *e);

int lanes_field_make(lanes_field *f, int64_t nodes, err *e);
void lanes_field_free(lanes_field *f);

#endif
