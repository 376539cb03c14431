/* Whether all of a mesh is held: solvers that only come closer never find out that
 * there is nothing to come to. Owns nothing.
 */
#ifndef SINEW_PARTS_H
#define SINEW_PARTS_H

#include "msds/problem/problem.h"

/* -1 with e filled where a part of the mesh, its nodes connected by springs, has nodes that are free and fewer than
 * three that are fixed: it can turn, or go away. */
int parts_held(const msds_problem *p, err *e);

#endif
