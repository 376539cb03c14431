/* The nodes that anchors hold, each anchor's in a k-d tree of its own, to find the one nearest to a place. Positions
 * are borrowed for as long as it is used; the caller owns the trees.
 */
#ifndef SINEW_HELD_H
#define SINEW_HELD_H

#include "base/err.h"

#include <stdint.h>

typedef struct held {
    const double *position; /* nodes x 3 */
    int64_t *start;         /* anchors + 1: an anchor's first place in node */
    int32_t *node;          /* a range's middle one divides the others by x, y or z, in turn from half to half */
    int32_t anchors;
} held;

/* anchor: of each node, -1 = none. -1 with e filled. */
int held_build(held *h, const double *position, const int32_t *anchor, int64_t nodes, int32_t anchors, err *e);
void held_free(held *h);

/* The node of that anchor nearest to p, of equally near ones the first; -1 where it holds none. */
int32_t held_nearest(const held *h, int32_t anchor, const double *p);

#endif
