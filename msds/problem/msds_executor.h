/* The contract of msds-run's executors: one state serves every method and carries displacement and velocity from one
 * to the next. A caller owns the state that create gives, until destroy; it borrows the problem and the threads. A
 * state is used by one thread at a time, except by fetch.
 *
 * step and snapshot may return before the device is done: what went wrong then comes out of a later call. get, monitor
 * and fetch wait.
 */
#ifndef SINEW_MSDS_EXECUTOR_H
#define SINEW_MSDS_EXECUTOR_H

#include "base/pool.h"
#include "msds/problem/problem.h"
#include "msds/problem/skin_step.h"
#include "solve/executor.h"

/* What get() gives, nodes x 3 doubles each: m, m/s. */
enum { MSDS_DISPLACEMENT, MSDS_VELOCITY };

/* Frames that may be on their way at once. */
enum { MSDS_SLOTS = 2 };

/* What the frames of a run take of its state. */
typedef struct msds_frames {
    bool displacement, velocity; /* of all nodes */
    const int32_t *node;         /* count: without `displacement`, the nodes whose displacement they take */
    int64_t count;
} msds_frames;

/* What a frame took, x 3, m and m/s, in the order of the model or of msds_frames.node; the state's, until its slot is
 * taken again. */
typedef struct msds_values {
    const float *displacement, *velocity; /* NULL: not taken */
    const double *precise;                /* in place of displacement, after exact frames */
} msds_values;

typedef struct msds_state msds_state; /* each executor's own */

typedef struct skin_state skin_state; /* each device's own */

struct msds_parts; /* msds/cpu/msds_cpu.h */

/* How a device steps a skin, beside the tissue. A caller owns the state that create gives, until destroy. All but
 * create: -1 with e filled. */
typedef struct skin_device {
    /* Takes over all of a skin as it stands. NULL with e filled. */
    skin_state *(*create)(const skin_view *s, err *e);
    void (*destroy)(skin_state *state);
    /* Takes over its options, inertia, anchor and held. */
    int (*change)(skin_state *state, const skin_view *s, err *e);
    /* Back to rest. */
    int (*reset)(skin_state *state, err *e);
    /* Takes `count` steps with the probe where it is (NULL: none); may return before they are done. */
    int (*step)(skin_state *state, const probe_placed *at, int64_t count, err *e);
    /* Waits, and copies the displacements out: vertices x 3, m. */
    int (*get)(skin_state *state, double *u, err *e);
} skin_device;

typedef struct msds_executor {
    executor is;
    const skin_device *skin; /* NULL: the processor steps skins */
    /* Allocates all that the springs take; what another method needs is made when it is first asked for. NULL with
     * e filled. */
    msds_state *(*create)(const msds_problem *p, pool *threads, err *e);
    void (*destroy)(msds_state *state); /* state may be NULL */
    /* Takes `count` steps of springs, or iterations of conjugate gradients. -1 with e filled, as for all below. */
    int (*step)(msds_state *state, const msds_plan *plan, int64_t count, err *e);
    /* Whether the plan's method can begin at once: 1; 0: not yet, what it needs is being made by threads that let
     * others go first; -1 with e filled where that failed. Who does not ask waits in step. */
    int (*ready)(msds_state *state, const msds_plan *plan, err *e);
    /* Takes over what the problem's options are now, of which the caller has changed some (problem.h), and its factor
     * of inertia. Displacements and velocities stay. */
    int (*change)(msds_state *state, err *e);
    /* Back to rest: no displacement, no velocity, nothing pressed, whatever they were, finite or not. */
    int (*reset)(msds_state *state, err *e);
    /* Copies one of the state's arrays out. */
    int (*get)(msds_state *state, int what, double *to, err *e);
    /* Gets ready for frames, once; from then on monitor counts inverted tetrahedra. `of` is only read here. NULL, as
     * are the next two: frames are made of what get gives. */
    int (*frames)(msds_state *state, const msds_frames *of, err *e);
    /* Puts what frames take of the state into a slot, to be fetched while the state goes on. */
    int (*snapshot)(msds_state *state, int slot, err *e);
    /* Waits for a slot, in any thread. */
    int (*fetch)(msds_state *state, int slot, msds_values *to, err *e);
    /* What the last step led to. */
    int (*monitor)(msds_state *state, msds_reading *reading, err *e);
    /* What the tangent at the probe is made of (msds/tangent), as the last step left it, until the next; NULL: a device
     * without EXECUTOR_TANGENT. -1 with e filled. */
    int (*parts)(msds_state *state, struct msds_parts *to, err *e);
    /* Bytes of the device's memory that the state has by now. */
    int64_t (*bytes)(const msds_state *state);
} msds_executor;

/* The executor that `is` is the first member of, as in the tables below; NULL for NULL. */
static inline const msds_executor *msds_executor_of(const executor *is)
{
    return (const msds_executor *)is;
}

/* The executors of this build, the preferred first; NULL-terminated. */
extern const executor *const msds_executors[];

#endif
