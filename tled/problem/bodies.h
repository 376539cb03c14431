/* The rigid bodies of a problem, as the model's node.body says: which nodes and elements each has, how it has moved,
 * and what the tissue pulls it with. The force on a body is the sum over its nodes of
 *     m g + f_ext - f_int,
 * f_int being the elements' pulls and f_ext the script's loads: at rest it is what holds the body up, the other way
 * round. The inertia of its own nodes is left out, and so is what a probe pushes these with (probe.force has none of
 * that either). All is computed from displacements in double, by chunks in a fixed order: the same bytes for any number
 * of threads and on any device. The problem owns its bodies.
 */
#ifndef SINEW_BODIES_H
#define SINEW_BODIES_H

#include "base/pool.h"
#include "tled/problem/state.h"

typedef struct bodies {
    int32_t count;
    const int32_t *of; /* nodes: the body, or -1; borrowed from the model */
    int64_t *start;    /* count + 1: the nodes of body b are node[start[b]] and on; owned, as is all below */
    int32_t *node;
    int32_t *element; /* those with a node of a body, ascending */
    int64_t elements;
} bodies;

typedef struct body_load {
    double force[3];  /* N: of the tissue on the body */
    double torque[3]; /* N m: about the mean of the body's nodes as they are */
} body_load;

/* Makes p->bodies, NULL where the model has none. -1 with e filled. */
int bodies_make(tled_problem *p, const model *m, err *e);
void bodies_free(bodies *b);

/* How many there are; 0 without any. */
static inline int32_t bodies_count(const tled_problem *p)
{
    return p->bodies ? p->bodies->count : 0;
}

/* What bodies are pulled by, borrowed: the curves' values; displacements, nodes x 3, m; of muscles in series with a
 * spring, fields TLED_CONTRACTILE and TLED_MIXCONTRACTILE, elements, or NULL where the problem has none. */
typedef struct bodies_state {
    const double *value, *displacement, *contractile[2];
} bodies_state;

/* What an element pulls its corners with, N. */
void bodies_pull(const tled_problem *p, int64_t element, const bodies_state *now, double pull[8][3]);

/* The mean of a body's nodes as they are; false, and 0, where it has none, as all that it holds slides on it. */
bool bodies_middle(const tled_problem *p, int32_t body, const double *displacement, double middle[3]);

/* Fills `to`, one for each body. -1 with e filled. */
int bodies_loads(const tled_problem *p, pool *threads, const bodies_state *now, body_load *to, err *e);

/* Adds to a frame of m where the bodies are (as pose_fit finds it), and their loads, if there are bodies. -1 with e
 * filled. */
int bodies_add(const tled_problem *p, pool *threads, const bodies_state *now, frame *f, const model *m, err *e);

#endif
