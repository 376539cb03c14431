/* PST's Algorithm 1: from tetrahedra to springs, one an edge, with the sums of stiffness and damping over the
 * tetrahedra that share it. The caller owns what is made.
 */
#ifndef SINEW_SPRINGS_H
#define SINEW_SPRINGS_H

#include "msds/problem/problem.h"

/* Fills p->springs and p->spring, ascending by nodes, with k = scale * young and
 * gamma = damping * k for each tetrahedron. */
int springs_make(msds_problem *p, double scale, double damping, err *e);

/* Fills the springs that there are, in their places, with the stiffness and damping of other constants: what
 * springs_make would give. */
void springs_change(msds_problem *p, double scale, double damping);

/* The spring of an edge between two nodes, in any order. */
int springs_find(const msds_problem *p, int32_t a, int32_t b);

#endif
