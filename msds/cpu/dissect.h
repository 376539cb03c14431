/* In what order to eliminate the free nodes: nested dissection by planes (George 1973). The nodes are cut in two by
 * the plane of the axis that leaves the fewest nodes between; the halves come first, each cut in turn, then what lies
 * between. What comes of it is a tree of fronts, each some nodes that are eliminated together (its columns) and the
 * later nodes that this touches (its rows). The creator owns it.
 */
#ifndef SINEW_DISSECT_H
#define SINEW_DISSECT_H

#include "msds/problem/problem.h"

typedef struct front {
    int64_t first, columns, rows; /* nodes, by their place in the order */
    int64_t parent;               /* or -1 */
    int64_t depth;                /* 0: the root */
    int32_t *row;                 /* rows: places, ascending */
    int32_t *above;               /* rows: where each stands among the parent's columns and rows */
} front;

typedef struct dissection {
    int64_t nodes;  /* free ones */
    int32_t *order; /* nodes: the model's */
    int32_t *place; /* the model's nodes: in the order, or -1 for a fixed one */
    front *front;   /* children before parents; the last is the root */
    int64_t fronts, room;
    int64_t *start; /* the model's nodes + 1: neighbours of each */
    int32_t *link;  /* of each: the spring */
} dissection;

/* Makes d (zeroed); -1 with e filled, and to be freed all the same. */
int dissect(dissection *d, const msds_problem *p, err *e);
void dissect_free(dissection *d);

#endif
