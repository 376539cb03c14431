/* The rigid bodies that press on tissue, and the one question that a solver asks of them: how deep is a point inside,
 * and which way is out. A probe is its shape; a pose is where it is. Each question is answered by `static inline`
 * functions that nvcc compiles too. A probe owns its planes, corners and faces, if it has any (probe_free); a placed
 * one borrows them, is copied by value, and may be given a device's copy of the planes instead.
 *
 * A probe's frame: origin at the middle of its face, +z into the tissue, +x along an image's columns.
 *     sphere   radius R: it touches the origin with the pole that points along +z; its centre is at -R along z.
 *     linear a box, its face width W along x by thickness T along y, and max(W, T) tall; its edges and corners rounded.
 *     curved   a sector of a disc of radius R in the x-z plane that opens by an angle about +z, its tip at -R along z,
 *              extruded by thickness T along y; its edges and corners rounded.
 *     convex   a convex polyhedron of an OBJ file, in whose coordinates the frame is.
 * Rounded is: all that a ball of the edge's radius, which stays inside the sharp shape, gets to. Depths of all of them
 * are exact: inside, the distance to the surface; outside, minus that, but for the convex one, where minus the distance
 * to the plane that is farthest, which is never more.
 */
#ifndef SINEW_PROBE_H
#define SINEW_PROBE_H

#include "base/err.h"
#include "base/pose.h"

#include <math.h>
#include <stddef.h>

#ifdef __CUDACC__
#define PROBE_FUNCTION static __host__ __device__ inline
#else
#define PROBE_FUNCTION static inline
#endif

typedef enum probe_kind { PROBE_SPHERE, PROBE_LINEAR, PROBE_CURVED, PROBE_CONVEX } probe_kind;

/* Made by the functions below, which fill what is derived: the last two groups. */
typedef struct probe {
    probe_kind kind;
    double radius;    /* m: of a sphere, or of a curved array's face */
    double width;     /* m: of a linear array's face */
    double angle;     /* radians: a curved array's opening, at most pi */
    double thickness; /* m: of an array */
    double edge;      /* m: the radius of an array's edges */
    const char *file; /* of a convex one; borrowed from the text that it was read from */

    double middle[3], reach; /* m: of a ball that holds it; its middle in the probe's frame */
    double size;             /* m: the radius of a ball that goes in: what is small to this probe */
    double half[3];          /* m: an array's extent from the middle, less the edge; of a curved one only y */
    double sine, cosine;     /* of half the angle */
    double disc,
        tip; /* m: a curved array less the edge: the disc's radius, and where its sides meet, from the disc's centre */
    double side; /* m: how long these are */

    int32_t planes, corners; /* of a convex one */
    double *plane;           /* planes x 4: unit normal out, and how far from the frame's origin, m */
    double *corner;          /* corners x 3: m */
    int32_t faces;           /* of a convex one */
    int32_t *face;           /* faces x 3: corners of triangles that cover it, turned out */
} probe;

/* A probe at its pose, as the questions want it. */
typedef struct probe_placed {
    probe shape;
    double origin[3];  /* m: of its frame */
    double centre[3];  /* m: of a ball that holds it */
    double reach;      /* m: that ball's radius */
    double into[3];    /* unit: its +z */
    double axis[3][3]; /* unit: its x, y and z */
} probe_placed;

/* Where a point is. */
typedef struct probe_touch {
    double depth;  /* m: how far inside; below 0: outside */
    double way[3]; /* unit: the way out */
} probe_touch;

/* Reads "sphere:2cm", "linear:4cm,1cm", "curved:6cm,60,14mm" (degrees; both with an edge as a last length; by default a
 * quarter of the thickness, less where that would not go in) or "convex:FILE.obj", whose file probe_load reads; metres
 * without a suffix. -1 with e filled where it is none of these (status 2), or no such body can be (status 1). */
int probe_of(probe *p, const char *text, err *e);

/* Writes what probe_of reads, with all there is of it; of a file only its base name. */
void probe_text(const probe *p, char *to, size_t size);

/* Reads the file of a convex probe, its coordinates times scale (to metres); of the others there is nothing to do. -1
 * with e filled for what is not a closed convex surface. */
int probe_load(probe *p, double scale, err *e);

/* A probe is freed so, whether or not it was loaded. */
void probe_free(probe *p);

/* The same from numbers that are right (see probe_of). */
probe probe_sphere(double radius);
probe probe_linear(double width, double thickness, double edge);
probe probe_curved(double radius, double angle, double thickness, double edge);

/* The point of it that is farthest along d (any length), both in its own frame. */
void probe_farthest(const probe *p, const double d[3], double to[3]);

/* m: no point of it is farther from its frame's origin. */
double probe_lever(const probe *p);

/* Whether it is thinner than cells of this side, m: nodes are so far apart that it may go in between them. */
bool probe_is_thin(const probe *p, double side);

/* Whether the probe's face is wider than what these points (x 3, m) span, both of
 * its sides: it presses like a plate. */
bool probe_is_plate(const probe_placed *at, const double *position, int64_t nodes);

PROBE_FUNCTION probe_placed probe_place(const probe *p, const pose *at)
{
    probe_placed placed;
    placed.shape = *p;
    placed.reach = p->reach;
    for (int i = 0; i < 3; i++) {
        const double unit[3] = {i == 0 ? 1. : 0., i == 1 ? 1. : 0., i == 2 ? 1. : 0.};
        pose_turn(at->quaternion, unit, placed.axis[i]);
    }
    for (int a = 0; a < 3; a++) {
        placed.origin[a] = at->position[a];
        placed.into[a] = placed.axis[2][a];
        placed.centre[a] = at->position[a] + p->middle[2] * placed.axis[2][a];
        if (p->kind == PROBE_CONVEX)
            placed.centre[a] += p->middle[0] * placed.axis[0][a] + p->middle[1] * placed.axis[1][a];
    }
    return placed;
}

/* The signed distance to what is in front of (below 0) or behind a flat shape's outline, and in front of or behind its
 * thickness, put together and rounded by `edge`: `flat` with its unit way (x, z), and y with its half-thickness. */
PROBE_FUNCTION probe_touch probe_extruded(double flat, const double flat_way[2], double y, double half, double edge)
{
    probe_touch t;
    const double over = fabs(y) - half, sign = y < 0 ? -1 : 1;
    const double f = flat > 0 ? flat : 0, o = over > 0 ? over : 0;
    const double away = sqrt(f * f + o * o);
    if (away > 0) {
        t.depth = edge - away;
        t.way[0] = flat_way[0] * (f / away);
        t.way[1] = sign * (o / away);
        t.way[2] = flat_way[1] * (f / away);
        return t;
    }
    const int thin = over > flat;
    t.depth = edge - (thin ? over : flat);
    t.way[0] = thin ? 0 : flat_way[0];
    t.way[1] = thin ? sign : 0;
    t.way[2] = thin ? 0 : flat_way[1];
    return t;
}

/* A rectangle in the x-z plane about (0, -half z): the signed distance and the way, of the probe's face where two are
 * as near. Conditional expressions, not branches: on a card they are selections. */
PROBE_FUNCTION double probe_rectangle(const probe *p, double x, double z, double way[2])
{
    const double over[2] = {fabs(x) - p->half[0], fabs(z) - p->half[2]};
    const double sign[2] = {x < 0 ? -1. : 1., z < 0 ? -1. : 1.};
    const double a = over[0] > 0 ? over[0] : 0, b = over[1] > 0 ? over[1] : 0, away = sqrt(a * a + b * b);
    const int side = over[0] > over[1];
    way[0] = away > 0 ? sign[0] * (a / away) : side ? sign[0] : 0;
    way[1] = away > 0 ? sign[1] * (b / away) : side ? 0 : sign[1];
    return away > 0 ? away : over[side ? 0 : 1];
}

/* The wedge of a sector within its disc, whose centre is at 0, 0: the signed distance and the way. The sides meet in
 * the tip, at `tip` along z, and end in corners on the circle. */
PROBE_FUNCTION double probe_sector(const probe *p, double x, double z, double way[2])
{
    const double mirror = x < 0 ? -1. : 1., radius = sqrt(x * x + z * z);
    const double u = fabs(x), v = z - p->tip;
    const double beyond = p->cosine * u - p->sine * v; /* the side: out of it */
    const double along = p->sine * u + p->cosine * v;  /* and along it, from the tip */
    const double round = radius - p->disc;
    const double corner[2] = {p->side * p->sine, p->side * p->cosine + p->tip};
    double d[2] = {u, v}, away;
    const int within = beyond <= 0 && round <= 0, above = u * corner[1] <= z * corner[0];
    if (within ? round >= beyond : above && round > 0) { /* the arc */
        way[0] = radius > 0 ? x / radius : 0;
        way[1] = radius > 0 ? z / radius : 1;
        return round;
    }
    way[0] = mirror * p->cosine;
    way[1] = -p->sine;
    if (within || (along > 0 && along < p->side))
        return beyond;
    if (along > 0) {
        d[0] = u - corner[0];
        d[1] = z - corner[1];
    }
    away = sqrt(d[0] * d[0] + d[1] * d[1]);
    for (int a = 0; a < 2 && away > 0; a++)
        way[a] = (a ? 1 : mirror) * d[a] / away;
    return away;
}

/* In the probe's own frame. The farthest plane of a convex one is the first of those that are. */
PROBE_FUNCTION probe_touch probe_at_own(const probe *p, const double x[3])
{
    probe_touch t = {0, {0, 0, 1}};
    double flat, way[2];
    if (p->kind == PROBE_LINEAR) {
        flat = probe_rectangle(p, x[0], x[2] - p->middle[2], way);
        return probe_extruded(flat, way, x[1], p->half[1], p->edge);
    }
    if (p->kind == PROBE_CURVED) {
        flat = probe_sector(p, x[0], x[2] + p->radius, way);
        return probe_extruded(flat, way, x[1], p->half[1], p->edge);
    }
    int32_t farthest = 0;
    double most = -INFINITY;
    for (int32_t i = 0; i < p->planes; i++) {
        const double *n = p->plane + 4 * i;
        double over = n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - n[3];
        if (over > most) {
            most = over;
            farthest = i;
        }
    }
    t.depth = -most;
    for (int a = 0; a < 3 && p->planes; a++)
        t.way[a] = p->plane[4 * farthest + a];
    return t;
}

/* A point at the very centre of a sphere is pushed along +z. */
PROBE_FUNCTION probe_touch probe_at_sphere(const probe_placed *p, const double x[3])
{
    probe_touch t = {0, {p->into[0], p->into[1], p->into[2]}};
    double d[3] = {x[0] - p->centre[0], x[1] - p->centre[1], x[2] - p->centre[2]};
    double away = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    t.depth = p->shape.radius - away;
    for (int a = 0; a < 3 && away > 0; a++)
        t.way[a] = d[a] / away;
    return t;
}

PROBE_FUNCTION probe_touch probe_at(const probe_placed *p, const double x[3])
{
    if (p->shape.kind == PROBE_SPHERE)
        return probe_at_sphere(p, x);
    double own[3];
    for (int i = 0; i < 3; i++)
        own[i] = p->axis[i][0] * (x[0] - p->origin[0]) + p->axis[i][1] * (x[1] - p->origin[1]) +
                 p->axis[i][2] * (x[2] - p->origin[2]);
    probe_touch found = probe_at_own(&p->shape, own), t = found;
    for (int a = 0; a < 3; a++)
        t.way[a] = p->axis[0][a] * found.way[0] + p->axis[1][a] * found.way[1] + p->axis[2][a] * found.way[2];
    return t;
}

/* Adds to the torque about the probe's origin, N m, that of a force, N, at a point. */
PROBE_FUNCTION void probe_torque(const probe_placed *p, const double x[3], const double force[3], double torque[3])
{
    const double d[3] = {x[0] - p->origin[0], x[1] - p->origin[1], x[2] - p->origin[2]};
    for (int a = 0; a < 3; a++)
        torque[a] += d[(a + 1) % 3] * force[(a + 2) % 3] - d[(a + 2) % 3] * force[(a + 1) % 3];
}

#endif
