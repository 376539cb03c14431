/* The contacts of a frame that push, as its tangent takes them (probe_tangent.h): where they are, how the surface of
 * the probe lies and bends there, and how stiff that makes their nodes. The creator owns the list.
 */
#ifndef SINEW_TANGENT_TOUCHES_H
#define SINEW_TANGENT_TOUCHES_H

#include "msds/cpu/cg.h"
#include "msds/cpu/msds_cpu.h"

typedef struct tangent_touch {
    int32_t own;        /* the node, in the solver's order */
    double way[3];      /* unit: out of the probe */
    double arm[3];      /* m: from the origin of the probe's frame */
    double force;       /* N: along way */
    double stiff[3][3]; /* N/m: S of probe_tangent.h */
} tangent_touch;

typedef struct tangent_touches {
    tangent_touch *list;
    int64_t count, room;
    bool held; /* nodes go along their ways as the probe does */
} tangent_touches;

/* Lists them; flat: as if the probe's surface had no curvature, which takes from the stiffness. -1 with e filled. */
int tangent_touches_find(tangent_touches *to, const msds_parts *from, bool flat, err *e);
void tangent_touches_free(tangent_touches *t);

/* How far column j moves the probe at a contact, m (a turn: m/rad). */
void tangent_touches_rigid(const tangent_touch *c, int j, double d[3]);

/* The force on a contact's node that column j changes by the turn of its way alone: lambda theta x n. */
void tangent_touches_turned(const tangent_touch *c, int j, double f[3]);

/* What contacts add to the stiffness of columns i and j, where they move by w less than the probe does. */
double tangent_touches_energy(const tangent_touch *c, int i, const double wi[3], int j, const double wj[3]);

/* The torque of all on the probe. */
void tangent_touches_torque(const tangent_touches *t, double torque[3]);

#endif
