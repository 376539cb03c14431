/* What holds, displaces and pushes the nodes of a coarser problem. Owns nothing.
 */
#ifndef SINEW_COARSE_LOADS_H
#define SINEW_COARSE_LOADS_H

#include "tled/coarse/coarse.h"

/* Holds the nodes that lie where a finer one is held; and those that lie where no finer one is, by one beside them. -1
 * with e filled. */
int coarse_holds(coarse *c, err *e);

/* Gives each node its eighths of the forces on finer ones: the same force, and the same work in a motion that both
 * have. -1 with e filled. */
int coarse_loads(coarse *c, err *e);

/* Adds to what pushes its nodes besides (N, nodes x 3), which is nothing to begin with. States that are made from then
 * on have it. */
void coarse_push(coarse *c, const double *force);

#endif
