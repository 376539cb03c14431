/* The graph of nodes and springs, stored as the rows of a sparse matrix in SELL-C-sigma (Kreutzer et al., SIAM J. Sci.
 * Comput. 36, 2014), with C = LANES = 8 and sigma = all nodes. A slice is eight consecutive nodes in the solver's own
 * order; a slot is one neighbour of each of the eight. In a lattice, the eight neighbours of a slot are nearly always
 * consecutive too; such a slot stores only the first of them. Nodes are sorted by their number of springs, many or
 * few, so that no slot of a lattice is wasted. The creator owns the graph.
 */
#ifndef SINEW_SELL_H
#define SINEW_SELL_H

#include "msds/problem/problem.h"

enum {
    LANES = 8,
    SELL_CHUNK = 16 /* slices that a thread takes at a time; sums are made by chunks, so results depend on it */
};

typedef struct sell {
    int64_t count, nodes, slots; /* nodes: LANES * count, with those that only fill up */
    int32_t *model_node;         /* nodes: the model's, -1 where it only fills up */
    int32_t *own_node;           /* the model's nodes: ours */
    int64_t *start;              /* count + 1: slots of slice s are start[s] to start[s + 1] - 1 */
    int32_t *first;     /* slots: where lane 0's neighbour stands (may be below 0 or past the end, by less than LANES,
                                    where that lane has none), or SELL_SCATTERED */
    int32_t *neighbour; /* slots x LANES: ours; the node itself where the lane has none */
    int32_t *spring;    /* slots x LANES: or -1 */
} sell;

enum { SELL_SCATTERED = INT32_MIN };

/* Makes s (zeroed); -1 with e filled, and to be freed all the same. */
int sell_make(sell *s, const msds_problem *p, err *e);
void sell_free(sell *s);

/* The springs' numbers in single precision, slots x LANES each. A length is that of the ends as float, so that rest is
 * without force. A lane without a spring: length 1, no stiffness. */
void sell_springs(const sell *s, const msds_problem *p, float *stiffness, float *damper, float *rest);

#endif
