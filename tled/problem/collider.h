/* A probe that presses on a voxel model, moved by a file of poses: between two of them it goes in a
 * straight line, before the first and after the last it stays. What it pushes a node with is a penalty
 * of its own that goes by the node's mass,
 *     f = m c depth,    c = repulsion times the square of the highest frequency at rest,
 * so that the highest frequency with contact is known: that at rest and c together. The push joins the elements' forces
 * in the sum that a node's step takes; so the internal forces that a monitor reads have it too. A probe that begins
 * inside the tissue comes up slowly. The creator owns it; once read it does not change.
 */
#ifndef SINEW_COLLIDER_H
#define SINEW_COLLIDER_H

#include "probe/probe.h"
#include "tled/problem/state.h"
#include "volume/placing.h"

typedef struct collider {
    probe shape;
    double *time; /* poses: s, not decreasing; owned, as is pose */
    pose *list;
    int64_t poses, pose_room, time_room;
    double stiffness;    /* 1/s2: c */
    double start, rises; /* s: from when, and how long it takes to come up; 0: it is there at once */
    bool is_away;        /* live: no pose has come yet, so it presses on nothing */
} collider;

/* Reads all poses of a file, placed as `of` says, if not NULL; c->shape is the caller's to read (probe_read). -1 with e
 * filled, c to be freed all the same. */
int collider_read_poses(collider *c, const char *path, const placing *of, err *e);
void collider_free(collider *c);

/* Makes it part of the problem, which says how stiff it is. */
void collider_join(collider *c, tled_problem *p, double repulsion);

/* From the problem's start; ramp, s: how long it takes to come up if it is inside of the tissue then. Warns where it
 * is, never comes near the tissue, or is of a size that these elements are not for. */
void collider_begin(collider *c, const tled_problem *p, double ramp, notes *warnings);

/* Where it is at a moment, and which share of its push it has come up to. */
typedef struct collider_moment {
    pose at;
    double up;
} collider_moment;
collider_moment collider_moment_at(const collider *c, double time);

/* Live, once: for a motion that collider_move gives. From then on, it goes in a straight line from where it was at
 * `from` to a pose at `until` (s); the first pose is there at once. */
int collider_begin_live(collider *c, err *e);
void collider_move(collider *c, double from, double until, const pose *to);

/* It comes up anew from a time on, in so many s. */
void collider_rise(collider *c, double from, double ramp);

/* Where it is. */
pose collider_pose(const collider *c, double time);
probe_placed collider_at(const collider *c, double time);

/* The time of its last pose. */
double collider_end(const collider *c);

/* The share of its push that it has come up to. */
double collider_up(const collider *c, double time);

/* The push on a node of this mass at x, N; up: collider_up of now. False: none. */
bool collider_push(const collider *c, const probe_placed *at, double up, const double x[3], double mass,
                   double push[3]);

/* The force on the probe and its torque about its origin at these displacements (nodes x 3). Returns how many
 * nodes push. */
int64_t collider_sum(const tled_problem *p, const collider_moment *now, const double *displacement, double force[3],
                     double torque[3]);

/* Adds to a frame where the probe is, and what the tissue at these displacements pushes it with. -1 with e filled. */
int collider_add(const tled_problem *p, const collider_moment *now, frame *f, const model *m,
                 const double *displacement, err *e);

/* A stable step, s, of the elements, with contact. p->collider may be NULL. */
double collider_step(const tled_problem *p, double step);

/* When all that is planned has happened, s: the script's end and the last pose. */
double collider_events_end(const tled_problem *p);

#endif
