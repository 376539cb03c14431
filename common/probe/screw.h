/* The screw motion that takes a rigid body from one pose to another: it turns about an axis in space and slides along
 * it, both at a constant rate (Chasles), the shorter way round. Where it does not turn, that is a straight line. Owns
 * nothing.
 *
 * With the rotation vector t a (angle and unit axis) and the way d of the body's origin, the origin has gone s V(s t) w
 * at a share s, where V(t) = I + (1 - cos t)/t [a] + (1 - sin t / t) [a]^2, and V(t) w = d.
 */
#ifndef SINEW_SCREW_H
#define SINEW_SCREW_H

#include "base/pose.h"

typedef struct screw {
    pose from, to;
    double angle;   /* radians, 0 to pi */
    double axis[3]; /* unit */
    double way[3];  /* m: w, the velocity of the origin at `from`, over the whole motion */
} screw;

screw screw_of(const pose *from, const pose *to);

/* A share of the motion, 0 to 1: at its ends the very poses. */
pose screw_at(const screw *s, double share);

/* Where a body comes to from `from`, when in its own frame its origin moves at the velocity `way` and it turns by the
 * rotation vector `turn` (radians), both constant, for a unit of time: from exp(way, turn). */
pose screw_along(const pose *from, const double way[3], const double turn[3]);

/* m: no point within a radius about the body's origin goes a longer way, over the whole motion. */
double screw_length(const screw *s, double radius);

#endif
