/* The time loop of tled-run, for any executor: steps from check to check, where the monitor reads the state and the run
 * decides on the length of the steps, the damping and the end; frames, rows of the log and checkpoints on the way. The
 * caller gets them through the functions of run_setup. It owns all that it passes.
 *
 * Steps are counted, and times are counts over a rate. Where the caller does not fix the step, it may be cut in halves
 * while the tissue's stable step is small: the steps counted stay the same, each taken as 2, 4, ... That is decided
 * only at checks, whose places depend on the count alone, from the state there. Where the state at the next check shows
 * that the steps were too long, the run restores the check before and cuts once more. So what is written does not
 * change the result, and a run that goes on from a frame at a check takes the same steps as one that never stopped.
 * Of frames between two checks snapshots are taken on the way; they are written once the second check is known to be
 * sound, while the next steps are already under way. (Where the slots for snapshots do not suffice, those steps are
 * taken again for the frames.)
 *
 * A run to rest takes longer steps once the script is over (RUN_HASTE), unless the step is given. In single precision
 * it ends in double where rounding keeps it from its tolerance: the state goes over as it is.
 */
#ifndef SINEW_RUN_H
#define SINEW_RUN_H

#include "tled/loop/frame_writer.h"
#include "tled/loop/log.h"
#include "tled/loop/relax.h"
#include "tled/problem/tled_executor.h"

/* What a run has counted and decided so far, which a run that goes on takes over as it is. */
typedef struct run_course {
    int64_t from;              /* the step that the run began at */
    int64_t taken;             /* steps, each part of a cut one for itself, and those that were taken again */
    int cuts;                  /* each step is taken in 2^cuts */
    double finer;              /* 1: the executor is the setup's `finer` by now; else 0 */
    double damping;            /* 1/s */
    double remaining, closest; /* shares of the displacement: to rest, and the least so far */
    int64_t closest_at;        /* the step that came so close */
    double most_strain;        /* J: at a check, so far */
    relax relax;
} run_course;

/* Where a run stands at a check: with the state's fields, all that decides how it goes on. */
typedef struct run_point {
    double origin;     /* s: tled_plan's */
    double rate;       /* 1/s: likewise; 0: the setup's */
    int64_t first;     /* tled_plan's: steps counted by now */
    double moved_most; /* m: monitor_reading's */
    run_course course;
    log_point log;
} run_point;

/* Where a live run stands before a tick. */
typedef struct run_tick {
    double from, until; /* s: of the tick */
    /* Copies the displacements at `from`, nodes x 3, m. -1 with e filled. */
    int (*displacement)(void *run, double *to, err *e);
    void *run;
} run_tick;

/* What a live run (run_live_go) asks of its caller, with the setup's context. All in the thread that runs. */
typedef struct run_live {
    tled_problem *p; /* the setup's, to be changed */
    const model *m;  /* that it was made of */
    int64_t tick;    /* steps from frame to frame, each from check to check, in as many parts as its state needs */
    int64_t parts;   /* and never in fewer than these */
    /* Waits until a tick is due and takes what came, for its time. *anew: curves of the script came or went. 1; 0: the
     * run is over; -1 with e filled. */
    int (*take)(void *context, const run_tick *at, bool *anew, err *e);
    /* The state at the end of the tick is sound and goes out as a frame next. taken: parts of steps, also those that
     * were taken again; restored: how often it went back to a sound state within the tick. -1 with e filled. */
    int (*put)(void *context, double time, int64_t taken, int restored, err *e);
    /* The tissue broke, as `reading` has it: at `time` it goes on from a sound state at rest, that of
     * the last check or (anew) that it began from; what may have broken it
     * is the caller's to end. */
    void (*broke)(void *context, double time, double until, bool anew, const monitor_reading *reading);
} run_live;

/* A safe step is at most this share of the stable one: it changes a little between two checks. */
#define RUN_MARGIN .8

/* On the way to rest, once nothing acts anew, steps are as long as this share of the stable one: they need not follow a
 * motion, and the stable step hardly changes. They are cut, or made shorter, where they come to be more than the second
 * share of it. */
#define RUN_HASTE        .9
#define RUN_HASTE_MARGIN .95

typedef struct run_setup {
    const tled_problem *p;
    const tled_executor *device;
    pool *threads;
    double rate;                /* steps a second */
    bool rate_fixed;            /* never cut the step: fail instead */
    int64_t check;              /* steps between checks */
    int64_t steps;              /* how many to take; with rest: at most */
    double end;                 /* s: where it lies within the last of them, that step is shorter and ends there */
    double rest;                /* tolerance: end at rest; < 0: after `steps` */
    double frequency;           /* rad/s: relax_guess */
    double damping;             /* 1/s */
    bool adapt;                 /* find the damping on the way, from the end of the script on */
    bool single;                /* numbers of single precision, which may come no closer to rest: then it goes on by: */
    const tled_executor *finer; /* in double; NULL: none can, so that it fails */
    struct multigrid *coarser;  /* that correct it on the way to rest (multigrid.h), after their start; or NULL */
    int64_t smooth;             /* with them: steps between checks, which correct; 0: as without */
    double every;               /* s: a frame at each multiple; 0: the last state only */
    bool first;                 /* and a frame of the state that the run begins from */
    run_log *log;           /* opened, or NULL: a row a check, or at each multiple of its interval, and at the end */
    const run_point *point; /* of a checkpoint, whose state is p's start: the run goes on from there; NULL: it begins */
    double save_every;      /* s: save at the first check at or past each multiple; 0: each minute of the clock */
    void *context;
    /* Writes a state as a frame, in the order of time; called in a thread of the writer's. -1 with e filled ends the
     * run, at a frame soon after. */
    frame_writer_write *frame;
    frame_writer_last *last; /* of all frames that an executor gave; or NULL */
    /* The last state, as a step or create led to it. -1 with e filled. Or NULL. */
    int (*ended)(void *context, const tled_executor *device, tled_state *state, double time, err *e);
    /* After every check. remaining: see relax_share; cut: parts that each step is taken in from now on. */
    void (*checked)(void *context, int64_t step, const monitor_reading *reading, double remaining, int64_t cut,
                    double damping);
    /* Steps are cut in more parts than they were in this run so far: from the check on that `reading` is of; or those
     * to there, which it found not sound, were taken again. May be NULL. */
    void (*cut)(void *context, const monitor_reading *reading, int64_t parts);
    /* Single precision comes no closer to rest than `closest`: the run goes on in `finer`. May be NULL. */
    void (*refined)(void *context, double time, double closest);
    /* Every state before `at` is written; this one, of the fields that checkpoints have, is with `at` what a run can
     * go on from. First at the start. -1 with e filled ends the run. NULL: nothing is to be saved. */
    int (*save)(void *context, const run_point *at, double time, const field_values *state, err *e);
} run_setup;

typedef struct run_end {
    int64_t steps;   /* taken, cuts not counted */
    int64_t taken;   /* each part of a cut step for itself, and those taken again */
    int corrections; /* by coarser models */
    int64_t parts;   /* the most that a step was cut in, since the restart if there was one */
    bool rested;
    double remaining;        /* with rest: at the last check */
    monitor_reading reading; /* of the last state */
    /* However it ended: */
    double most_strain; /* J: at a check */
    int64_t bytes;      /* of the device's memory, in the end */
    int64_t crowded;    /* tled_executor's: the most of any state that it had */
} run_end;

/* Runs live, by ticks of the wall's clock, until the caller ends it or the last step is taken: a frame a tick, sent as
 * soon as its state is known to be sound; no log, no checkpoints. Where the tissue breaks, it goes back to the last
 * check, at rest; where it breaks again before the next one, to what it began from, at rest; and again, -1 with e
 * filled, status 3. */
int run_live_go(const run_setup *r, const run_live *live, run_end *end, err *e);

/* Runs. -1 with e filled; status 3 where the simulation diverged: e names step, time, element and volume. */
int run_go(const run_setup *r, run_end *end, err *e);

#endif
