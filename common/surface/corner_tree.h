/* Finds, among the corners that are left of a large polygon in its plane, whether one lies in a triangle, and which
 * corner's own triangle is the smallest, in a time that grows as the logarithm of their number. The tree is binary,
 * over the corners in Z-order of their ranks along u and v, so that neighbours in the plane are mostly neighbours
 * there, however their distances differ; a node knows the box of its corners, and a strip that lies as they do. The
 * creator owns it.
 */
#ifndef SINEW_CORNER_TREE_H
#define SINEW_CORNER_TREE_H

#include "base/err.h"

/* A corner of a polygon that is being cut: its place, and its neighbours among those that are left. */
typedef struct corner {
    double u, v;
    int32_t before, next;
} corner;

/* Twice the signed area of a triangle of corners. */
static inline double corner_area(const corner *a, const corner *b, const corner *c)
{
    return (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
}

static inline bool corner_same_place(const corner *a, const corner *b)
{
    return a->u == b->u && a->v == b->v;
}

/* Whether corner d lies in the closed triangle, but not on one of its corners (where a polygon touches itself). */
static inline bool corner_blocks(const corner *a, const corner *b, const corner *c, const corner *d)
{
    return corner_area(a, b, d) >= 0 && corner_area(b, c, d) >= 0 && corner_area(c, a, d) >= 0 &&
           !corner_same_place(a, d) && !corner_same_place(b, d) && !corner_same_place(c, d);
}

typedef struct corner_tree corner_tree;

/* corners: count of them, which are read whenever the tree is asked. NULL with e filled on no memory. */
corner_tree *corner_tree_create(const corner *corners, int32_t count, err *e);
void corner_tree_destroy(corner_tree *t);

/* Corner i was cut off: its neighbours know each other already. */
void corner_tree_cut(corner_tree *t, int32_t i);

/* Whether a corner that is left blocks the triangle of these three. */
bool corner_tree_blocks(const corner_tree *t, const corner *a, const corner *b, const corner *c);

/* The first of those whose triangle with their neighbours is the smallest; -1 where none has an area that is a
 * number. */
int32_t corner_tree_smallest(const corner_tree *t);

#endif
