/* Muscles that are rings, as sphincters: fibres run round the opening. A ring is points in all twelve sectors about one
 * of its principal axes, and none near this axis. Its line is fitted to the points: radius and height over the angle
 * about the axis, in Fourier series of four harmonics, so that an oval or bent ring is followed too, and a round one is
 * a circle. Keeps nothing.
 */
#ifndef SINEW_RING_H
#define SINEW_RING_H

#include <stdbool.h>
#include <stdint.h>

enum { RING_TERMS = 9 }; /* 1, cos, sin, cos 2, ... sin 4 */

/* A cloud of weighted points, as elements' centres or triangles' middles. */
typedef struct ring_points {
    const double *place;  /* count x 3, m */
    const double *weight; /* count; 0 or more */
    int64_t count;
} ring_points;

typedef struct ring {
    double centre[3], axis[3][3]; /* m; unit: two in its plane, and the one that it goes round */
    double radius[RING_TERMS], height[RING_TERMS];
} ring;

/* Tells whether the points are a ring, and finds its line if they are. */
bool ring_find(ring *r, const ring_points *p);

/* The unit direction of its line at the angle of a place. */
void ring_along(const ring *r, const double *x, double *along);

#endif
