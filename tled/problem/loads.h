/* The shares of the script's forces, tractions and pulls that nodes have, into the problem's table of forces. They do
 * not change: a force is divided equally among its nodes; of a traction, a node has an area, m2: of each triangle at
 * rest a third for each vertex, and of that what the vertex's binding gives the node. The spring of a pull is divided
 * equally too: with K N/m on n nodes around X, and its end at T, each of them is pulled with
 *     f = K/n (s (T - X) - s u),
 * where s, 1 while it pulls and else 0, is the value of a curve of its own, and s (T - X) that of the pull's.
 */
#ifndef SINEW_LOADS_H
#define SINEW_LOADS_H

#include "tled/problem/state.h"

/* What an entry of the table adds to component a (N) of the force on its node; u: its displacement (m). */
static inline double loads_entry(const tled_problem *p, int32_t i, const double *value, int a, double u)
{
    const int32_t spring = p->force_spring[i];
    const double less = spring < 0 ? 0 : value[3 * (int64_t)spring + a] * u;
    return p->force_share[i] * (value[3 * (int64_t)p->force_curve[i] + a] - less);
}

/* 1/s2: by how much springs raise the square of the highest frequency: the largest sum of K/n over a node's mass.
 * value: the curves'; NULL: all springs pull. */
double loads_square(const tled_problem *p, const double *value);

/* Makes force_start, force_curve, force_spring and force_share: by node, then in the order of the curves. -1 with e
 * filled. */
int loads_make(tled_problem *p, const model *m, err *e);

/* Warns of surfaces under tractions and pressures whose triangles are too large: loads act at vertices alone. */
void loads_check(const tled_problem *p, const model *m, notes *warnings);

#endif
