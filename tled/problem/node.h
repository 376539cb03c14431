/* The maths of one component of a node's step, which every executor's loop over nodes does: central differences with
 * mass damping alpha (Miller et al. 2007), as kick, drift, kick. From u, v, a at t
 *     v' = (v + dt/2 a) / (1 + alpha dt/2),  u += dt v',                (begin)
 * then with a at t + dt
 *     v = v' (1 - alpha dt/2) + dt/2 a.                                 (finish)
 * The state at the end of a step is u and v alone: a run goes on from them to the same bytes. The end of one step and
 * the beginning of the next are one loop over nodes. `real` is element.h's.
 */
#ifndef SINEW_NODE_H
#define SINEW_NODE_H

#include "physics/element.h"

/* dt, dt/2, 1 - alpha dt/2, 1 / (1 + alpha dt/2). */
typedef struct node_factors {
    real_one dt, half, keep, slow;
} node_factors;

ELEMENT_FUNCTION node_factors node_factors_of(double dt, double damping)
{
    const double drag = damping * dt / 2;
    node_factors k = {(real_one)dt, (real_one)(dt / 2), (real_one)(1 - drag), (real_one)(1 / (1 + drag))};
    return k;
}

ELEMENT_FUNCTION real node_finish(real velocity, real acceleration, node_factors k)
{
    return velocity * k.keep + k.half * acceleration;
}

/* The velocity at the middle of the step; the displacement moves on by dt times it. */
ELEMENT_FUNCTION real node_begin(real velocity, real acceleration, node_factors k)
{
    return (velocity + k.half * acceleration) * k.slow;
}

#endif
