/* The rigid bodies that press on tissue, and the one question that a solver asks of them: how deep is a point inside, and
 * which way is out. A probe is its shape; a pose is where it is. Each question is answered by `static inline` functions that
 * nvcc compiles too. Nothing is owned.
 *
 * A probe's frame: origin at the middle of its face, +z into the tissue, +x along an image's columns. So a sphere of radius
 * R touches its frame's origin with the pole that points along +z, and its centre is at -R along z.
 */
#ifndef SINEW_PROBE_H
#define SINEW_PROBE_H

#include "base/err.h"

#include <math.h>

#ifdef __CUDACC__
#define PROBE_FUNCTION static __host__ __device__ inline
#else
#define PROBE_FUNCTION static inline
#endif

typedef enum probe_kind { PROBE_SPHERE } probe_kind;

typedef struct probe {
    probe_kind kind;
    double radius; /* m */
} probe;

typedef struct probe_pose {
    double position[3];   /* m */
    double quaternion[4]; /* unit; x y z w */
} probe_pose;

/* A probe at its pose, as the questions want it. */
typedef struct probe_placed {
    probe shape;
    double centre[3]; /* m: of a ball that holds it */
    double reach;     /* m: that ball's radius */
    double into[3];   /* unit: its +z */
} probe_placed;

/* Where a point is. */
typedef struct probe_touch {
    double depth;  /* m: how far inside; below 0: outside */
    double way[3]; /* unit: the way out */
} probe_touch;

/* Reads "sphere:2cm" (metres without a suffix). -1 with e filled (status 2) where it is none, or its radius is not above 0. */
int probe_of(probe *p, const char *text, err *e);

/* v turned by a unit quaternion. */
PROBE_FUNCTION void probe_turn(const double q[4], const double v[3], double to[3])
{
    double a[3] = {2 * (q[1] * v[2] - q[2] * v[1]), 2 * (q[2] * v[0] - q[0] * v[2]), 2 * (q[0] * v[1] - q[1] * v[0])};
    to[0] = v[0] + q[3] * a[0] + (q[1] * a[2] - q[2] * a[1]);
    to[1] = v[1] + q[3] * a[1] + (q[2] * a[0] - q[0] * a[2]);
    to[2] = v[2] + q[3] * a[2] + (q[0] * a[1] - q[1] * a[0]);
}

PROBE_FUNCTION probe_placed probe_place(const probe *p, const probe_pose *at)
{
    const double z[3] = {0, 0, 1};
    probe_placed placed = {*p, {0, 0, 0}, p->radius, {0, 0, 0}};
    probe_turn(at->quaternion, z, placed.into);
    for (int a = 0; a < 3; a++)
        placed.centre[a] = at->position[a] - p->radius * placed.into[a];
    return placed;
}

/* A point at the very centre of a sphere is pushed along +z. */
PROBE_FUNCTION probe_touch probe_at(const probe_placed *p, const double x[3])
{
    probe_touch t = {0, {p->into[0], p->into[1], p->into[2]}};
    double d[3] = {x[0] - p->centre[0], x[1] - p->centre[1], x[2] - p->centre[2]};
    double away = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    t.depth = p->shape.radius - away;
    for (int a = 0; a < 3 && away > 0; a++)
        t.way[a] = d[a] / away;
    return t;
}

#endif
