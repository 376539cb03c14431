/* The shares of the script's forces and tractions that nodes have, into the problem's table of forces. They do not
 * change: a force is divided equally among its nodes; of a traction, a node has an area, m2: of each triangle at rest
 * a third for each vertex, and of that what the vertex's binding gives the node.
 */
#ifndef SINEW_LOADS_H
#define SINEW_LOADS_H

#include "tled/problem/state.h"

/* Makes force_start, force_curve and force_share: by node, then in the order of the curves. -1 with e filled. */
int loads_make(tled_problem *p, const model *m, err *e);

/* Warns of surfaces under tractions and pressures whose triangles are too large: loads act at vertices alone. */
void loads_check(const tled_problem *p, const model *m, notes *warnings);

#endif
