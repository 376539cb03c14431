/* Elements that are their lattice's boxes: that they are, and which of them meet at each node. On the problem's threads;
 * the result is the same for any number of them. Owns nothing.
 */
#ifndef SINEW_BOXES_H
#define SINEW_BOXES_H

#include "tled/problem/state.h"

/* Every element must be a box with the lattice's spacing for sides, its corners in VTK order. -1 with e filled for the
 * first that is not. */
int boxes_check(const tled_problem *p, err *e);

/* Fills p->corner (nodes x 8) and p->mass (nodes, zeroed): the corners of elements at each node, and its mass,
 * rho V / 8 from each, of what is tissue. -1 with e filled where a node is in no element, or in more than 8. */
int boxes_corners(tled_problem *p, err *e);

#endif
