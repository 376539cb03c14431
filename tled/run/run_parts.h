/* What run.c, which decides at checks, and run_advance.c, which goes from one check to the next, share: the run itself,
 * and what both do with its state. For these two alone.
 */
#ifndef SINEW_RUN_PARTS_H
#define SINEW_RUN_PARTS_H

#include "tled/run/run.h"

enum { CUTS_MAX = 10 }; /* a step cut 2^10 times is no step */

typedef struct run {
    const run_setup *r;
    tled_state *state;
    monitor *monitor;
    run_course course;
    frame_writer *writer;
    tled_plan plan;      /* plan.first: steps counted */
    int64_t last;        /* where it ends at the latest */
    bool is_last_short;  /* the step to there, which ends at r->end */
    bool rested;         /* at the last check: the run is over */
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

/* Where the state stands (s); and how long each part of a step is (s). */
double run_now(const run *n);
double run_part(const run *n);

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

/* Of a state that is sound, as all before it are: writes a frame; adds it to the log, with a row where one is due. */
int run_write_frame(run *n);
int run_log_sound(run *n);

/* The first step past `after` with a frame. */
int64_t run_next_frame(const run *n, int64_t after);

#endif
