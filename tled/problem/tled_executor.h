/* The contract of tled-run's executors, each in one precision: they make a state of a problem, take it on by steps,
 * and give what is in it. A caller owns the state that create gives, until destroy; it borrows the problem and the
 * threads. A state is used by one thread at a time, except by fetch.
 *
 * step, save, restore and snapshot may return before the device is done: what went wrong then comes out of a later
 * call. get, monitor and fetch wait.
 */
#ifndef SINEW_TLED_EXECUTOR_H
#define SINEW_TLED_EXECUTOR_H

#include "base/pool.h"
#include "solve/executor.h"
#include "tled/problem/state.h"

/* Slots for snapshots. */
enum { TLED_SLOTS = 24 };

/* What monitor() is asked. */
typedef struct tled_question {
    double time;      /* s: where the state stands */
    double rest;      /* 1/s2: frequencies up to this one are not told */
    double raise;     /* by what factor the frequency told may be too high: 1.01, or 1 for exactly */
    bool differences; /* against what was saved */
} tled_question;

/* And its answer: sums over all, in a fixed order. */
typedef struct tled_sums {
    double kinetic, strain;                  /* J; strain with hourglass energy, without what muscles do */
    double acceleration, speed, moved, mass; /* squares times masses, kg m2/s4, kg m2/s2, kg m2; and kg */
    double stiffness, inertia; /* with du, df since what was saved: du df (J), m du du (kg m2), where free */
    double largest;            /* m2: the square of the largest displacement */
    double frequency;          /* 1/s2: the square of the highest of any element, if past question.rest */
    int64_t frequency_element; /* whose it is, or -1 */
    int64_t broken;            /* an element that is inverted (J <= 0) or not a number, or -1 */
} tled_sums;

typedef struct tled_state tled_state; /* each executor's own */

typedef struct tled_executor {
    executor is;
    /* Allocates all that the steps take. NULL with e filled. */
    tled_state *(*create)(const tled_problem *p, pool *threads, err *e);
    void (*destroy)(tled_state *state); /* state may be NULL */
    /* Takes `count` steps. -1 with e filled, as for all below. */
    int (*step)(tled_state *state, const tled_plan *plan, int64_t count, err *e);
    /* Copies a field of the state out, or its internal forces (state.h). */
    int (*get)(tled_state *state, int what, double *to, err *e);
    /* Saves a copy of the state in place of the one before; and restores it. From either on, steps are those of a state
     * that is made there. */
    int (*save)(tled_state *state, err *e);
    int (*restore)(tled_state *state, err *e);
    /* Puts a state's fields to these values, at a time (s), as if it were made there. NULL: it has to be made anew. */
    int (*put)(tled_state *state, const field_values *values, double time, err *e);
    /* Takes over what tled_problem_reload changed. 0; 1: it has no room for it, so the state has to be made again, as
     * it has where this is NULL. */
    int (*reload)(tled_state *state, err *e);
    /* Copies the results as they are now into a slot, to be fetched later. */
    int (*snapshot)(tled_state *state, int slot, err *e);
    /* Fetches the fields of a snapshot, in any thread, while the state goes on. */
    int (*fetch)(tled_state *state, int slot, const field_values *to, err *e);
    /* Computes what a monitor asks, on the device; NULL: the monitor does it from what get gives. */
    int (*monitor)(tled_state *state, const tled_question *question, tled_sums *answer, err *e);
    /* Bytes of the device's memory that the state has by now. */
    int64_t (*bytes)(const tled_state *state);
    /* How many elements of skin had more beside them, in any step so far, than contact keeps (self_contact_crowded). -1
     * with e filled. NULL: no skin touches itself there. */
    int (*crowded)(tled_state *state, int64_t *count, err *e);
    /* How many elements a pass computes, those that are computed twice counted twice, for benchmarks. */
    int64_t (*computed)(const tled_state *state);
} tled_executor;

/* The executor that `is` is the first member of, as in the tables below; NULL for NULL. */
static inline const tled_executor *tled_executor_of(const executor *is)
{
    return (const tled_executor *)is;
}

/* The executors of this build by the precision of their numbers, the preferred first; NULL-terminated. */
extern const executor *const tled_executors_double[];
extern const executor *const tled_executors_single[];

/* What a problem needs of its executor: of the elements, of contact and pressures, of the form. Its names are the
 * problem's. */
executor_need tled_need(const tled_problem *p);

#endif
