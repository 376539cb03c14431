/* What nodes that slide on rigid bodies push these with, which is what the bone bears of their forces (sliding.h); and
 * where bodies are that hold no node. All in double, node by node and added in their order: the same bytes for any
 * number of threads. Friction of a node that slips is told as if it were against the other forces on it, not against
 * its way. Keeps nothing.
 */
#ifndef SINEW_SLIDING_LOADS_H
#define SINEW_SLIDING_LOADS_H

#include "tled/problem/bodies.h"

/* Adds to the loads of the bodies (bodies_loads): torques about the mean of a body's nodes, or, where it holds none,
 * about the mean of those that slide on it. -1 with e filled. */
int sliding_loads(const tled_problem *p, pool *threads, const bodies_state *now, body_load *to, err *e);

/* The same to a frame's body.force and body.torque; fills body.pose of those that hold no node. -1 with e filled. */
int sliding_add(const tled_problem *p, pool *threads, const bodies_state *now, frame *f, err *e);

#endif
