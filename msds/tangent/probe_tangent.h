/* The contact stiffness of a probe in tissue: how the force and the torque on it change when it moves as a rigid body,
 * once the tissue is in equilibrium again; for devices that extrapolate between frames (msds/run/haptics.h). It is the
 * Hessian of what the elements store, by the probe's six displacements, with the contacts kept that push now: nodes
 * slide on the probe, whose surface turns and bends under them. A column is the tissue's displacement for a unit of one
 * of the six. It solves
 *
 *     (K + S) u = S d - lambda n x theta,      S = -lambda H (+ k n n^T: penalty, springs) (+ g (I - n n^T): friction)
 *
 * where K is the tangent of the elements at the frame's state; at a contact, n is the way out of the probe, H the
 * curvature of its surface there, lambda the force, and d = t + theta x (x - origin) the probe's own displacement. With
 * prescribed contact, n . u = n . d besides. Conjugate gradients go on from the columns of the frame before, so that a
 * probe at rest costs a product a column; and since the stiffness is an energy of columns, its error is of the order of
 * theirs squared, and never makes a diagonal element too small. The creator owns it; the state stays as it is.
 */
#ifndef SINEW_PROBE_TANGENT_H
#define SINEW_PROBE_TANGENT_H

#include "msds/problem/msds_executor.h"

enum { PROBE_TANGENT_COLUMNS = 6 };

typedef struct probe_tangent probe_tangent;

typedef struct probe_tangent_reading {
    /* Row i: minus what force (i < 3) or torque (about the frame's origin of the probe, where that is then) changes by;
     * column j: with the translation (j < 3) or turn (about that origin) of the probe; along the axes of the model.
     * N/m, N, N m/m, N m. */
    double stiffness[PROBE_TANGENT_COLUMNS][PROBE_TANGENT_COLUMNS];
    int64_t products; /* with the elements' tangent that it took */
    double left;      /* what is left of the worst column, as an energy over that of the column */
} probe_tangent_reading;

/* Of a state, whose executor has parts. NULL with e filled. */
probe_tangent *probe_tangent_create(const msds_executor *device, msds_state *state, err *e);
void probe_tangent_destroy(probe_tangent *t); /* t may be NULL */

/* Of where the last step led, by so many iterations a column at most; `first` ones where the frame before had no
 * columns. -1 with e filled. */
int probe_tangent_find(probe_tangent *t, int64_t most, int64_t first, probe_tangent_reading *to, err *e);

/* The next frame has no columns before it: the tissue is somewhere else. */
void probe_tangent_forget(probe_tangent *t);

#endif
