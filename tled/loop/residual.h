/* What is out of balance in a state, node by node, whatever computes it. Owns nothing.
 */
#ifndef SINEW_RESIDUAL_H
#define SINEW_RESIDUAL_H

#include "tled/problem/tled_executor.h"

/* Of a state that stands at `time` (s), to which a step or create led: its displacements (m, nodes x 3), and the forces
 * from outside less internal ones (N, nodes x 3), 0 where nodes are held. Not of problems with nodes that slide or skin
 * that touches itself. -1 with e filled. */
int residual_read(const tled_problem *p, const tled_executor *device, tled_state *state, double time,
                  double *displacement, double *residual, err *e);

#endif
