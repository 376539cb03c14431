/* The graph of nodes and springs as eight nodes side by side: a slice is eight nodes in a row of the solver's own
 * order, a slot one neighbour of each. Where the neighbours of a slot stand in a row too, as in a lattice nearly all
 * do, a slot says only where the first stands. Nodes with many springs come before those with few, so that slices of a
 * lattice waste no slots. The creator owns it.
 */
#ifndef SINEW_SLICES_H
#define SINEW_SLICES_H

#include "msds/problem/problem.h"

enum {
    LANES = 8,
    SLICES_CHUNK = 16 /* slices that a thread takes at a time; sums are made over chunks, so it is part of the result */
};

typedef struct slices {
    int64_t count, nodes, slots; /* nodes: LANES * count, with those that only fill up */
    int32_t *model_node;         /* nodes: the model's, -1 where it only fills up */
    int32_t *own_node;           /* the model's nodes: ours */
    int64_t *start;              /* count + 1: slots of slice s are start[s] to start[s + 1] - 1 */
    int32_t *first;     /* slots: where lane 0's neighbour stands (may be below 0 or past the end, by less than LANES,
                                    where that lane has none), or SLICES_SCATTERED */
    int32_t *neighbour; /* slots x LANES: ours; the node itself where the lane has none */
    int32_t *spring;    /* slots x LANES: or -1 */
} slices;

enum { SLICES_SCATTERED = INT32_MIN };

/* Makes s (zeroed); -1 with e filled, and to be freed all the same. */
int slices_make(slices *s, const msds_problem *p, err *e);
void slices_free(slices *s);

/* The springs' numbers in single precision, slots x LANES each. A length is that of the ends as float, so that rest is
 * without force. A lane without a spring: length 1, no stiffness. */
void slices_springs(const slices *s, const msds_problem *p, float *stiffness, float *damper, float *rest);

#endif
