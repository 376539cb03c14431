/* Whether every connected component of a mesh is held. An iterative solver does not notice that a component that is not
 * held has no equilibrium. Owns nothing.
 */
#ifndef SINEW_PARTS_H
#define SINEW_PARTS_H

#include "msds/problem/problem.h"

/* -1 with e filled where a connected component (of nodes joined by springs) has free nodes and fewer than three
 * Dirichlet nodes: it can turn or move away. */
int parts_held(const msds_problem *p, err *e);

#endif
