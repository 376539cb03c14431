/* What run.c, which decides at checks, and run_advance.c, which goes from one check to the next, share: the run itself,
 * and what both do with its state. For these two alone.
 */
#ifndef SINEW_RUN_PARTS_H
#define SINEW_RUN_PARTS_H

#include "tled/loop/run.h"

enum { CUTS_MAX = 10 }; /* a step cut 2^10 times is no step */

typedef struct run_corrector run_corrector;

typedef struct run {
    const run_setup *r;
    const run_live *live;        /* or NULL */
    const tled_executor *device; /* whose state is below: the setup's, or its `finer` */
    tled_problem moved;          /* the setup's, to go on from elsewhere: run_go_on_from */
    run_corrector *corrector;    /* by coarser models; NULL: there are none */
    int64_t parts;               /* live: that each step is taken in */
    int went_back;               /* live: since the last sound check: to the one before, then to the beginning */
    field_values began;          /* live: the state that it began from; at rest when it is gone back to */
    int restored;                /* live: in this tick */
    int64_t crowded;             /* run_end's, of the states so far */
    tled_state *state;
    monitor *monitor;
    run_course course;
    frame_writer *writer;
    tled_plan plan;      /* plan.first: steps counted; plan.rate: the setup's, until it hastens to rest */
    int64_t last;        /* where it ends at the latest */
    bool is_last_short;  /* the step to there, which ends at r->end */
    bool rested;         /* at the last check: the run is over */
    int64_t check;       /* steps between checks */
    int64_t saved_first; /* plan.first of the state that the device has saved: that at the last check */
    /* Frames are numbered, and a snapshot of each is in the slot of its number modulo `slots`: `sent` of them were
     * sent to the writer, then come those not yet known to be sound. */
    int slots;
    double frame_time[TLED_SLOTS];
    int64_t sent;
    int unsure;
    int64_t written; /* plan.first of the last frame that was taken of a state known to be sound; INT64_MIN: none yet */
    int cuts_told;
    double dt, damped;       /* s, 1/s: of the last steps */
    field_values checkpoint; /* what is saved; to be filled */
    double next_checkpoint;  /* s: of the model's time, or of the clock */
    err *e;
} run;

/* Of run.c: the first check, with its frame; a run from its beginning to its end, by a loop of its own. */
int run_begin(run *n);
int run_by(const run_setup *r, const run_live *live, int (*by)(run *n), run_end *end, err *e);

/* Where the state stands (s); and how long each part of a step is (s). */
double run_now(const run *n);
double run_part(const run *n);

/* A safe step, as a share of the stable one: RUN_MARGIN, or RUN_HASTE_MARGIN. */
double run_margin(const run *n);

/* All below that return an int: -1 with n->e filled. */

/* Reads the state into n->monitor->reading. */
int run_monitor(run *n);

/* Whether the state that was monitored last is sound: no element is broken, and steps as long as now are stable there.
 * */
bool run_is_sound(const run *n);

/* Fills e with status 3, and the element and time of the last reading. Returns -1. */
int run_diverged(run *n);

/* Tells the caller where steps are cut into more parts than ever before in this run, and the reading that is why. */
void run_tell_cut(run *n, const monitor_reading *why);

/* Goes from the last check, whose state is sound, to the next one, or to the end, with the frames and the rows of the
 * log before it. That state is sound, or it has diverged. */
int run_advance(run *n, int64_t to);

/* What is due of the state as it is now. To be asked before a check decides on other steps: seen from those, a multiple
 * of an interval that an earlier frame or row was of may lie in the step to here. */
typedef struct run_due {
    bool frame, row;
} run_due;
run_due run_due_now(const run *n);

/* Of a state that is sound, as all before it are: writes a frame; adds it to the log, with a row if it is shown. */
int run_write_frame(run *n);
int run_log_sound(run *n, bool shown);

/* Saves the state that was monitored last, to go back to; and goes back. */
int run_save(run *n);
int run_restore(run *n);

/* Counts what the state has of crowded elements (run_end). -1 with e filled. */
int run_count_crowded(run *n, err *e);

/* Goes on from a state of these values, of all fields, where it stands, on this device, at a check: all frames before
 * are written by then. */
int run_go_on_from(run *n, const tled_executor *device, const field_values *values);

/* Goes on in the setup's `finer`, at a check. */
int run_refine(run *n);

/* Corrections by coarser models (run_correct.c): whether more are to come; reads, at a check, the way since the last
 * one into the monitor's reading; makes one, at a check that is not at rest, or gives up; and how many there were. */
int run_corrector_make(run *n);
void run_corrector_free(run_corrector *c);
bool run_corrects(const run *n);
int run_read_way(run *n);
int run_correct(run *n);
int run_corrections(const run *n);

/* Live: as few parts as a step may safely be taken in, from the state that was monitored last. */
void run_choose_parts(run *n);

/* Takes steps to `to`, as they are cut now, and reads the state there. */
int run_try(run *n, int64_t to);

/* The first step past `after` with a frame. */
int64_t run_next_frame(const run *n, int64_t after);

#endif
