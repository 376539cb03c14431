/* Lines that come while a tool runs: poses, of which the newest counts, and controls, which are taken in their order.
 * Each source (a FIFO, or standard input) is read by a thread of its own, so that its writer never waits for a solver.
 *
 * A pose is a line of eight words, or one that begins with two that are no names; all else is a control. A pose that
 * was not taken when the next one comes is stale: it is dropped and counted. What is wrong is skipped, told once a kind
 * and counted: garbage, a number that is not finite, a quaternion that is not of length 1, a time before that of the
 * line before, a line that was cut. A FIFO whose writer goes away waits for the next one, whose times begin anew;
 * standard input, a pipe without a name, or any other file ends where it ends. Regular files are refused. The end of
 * standard input, where it is a source, is the end of all. A source may also be a 3D mouse (live/spnav.h), which never
 * ends; it goes on from the newest pose that another source has put the probe to.
 *
 * The functions are for the thread that called lines_open. The caller owns the object.
 */
#ifndef SINEW_LINES_H
#define SINEW_LINES_H

#include "probe/poses.h"

enum { LINES_SOURCES = 4 };

typedef struct lines lines;

typedef struct lines_pose {
    double time; /* s: as its line says */
    pose at;
    double came;      /* s, by clock_now: when it was read */
    const char *name; /* where its line stood: the source's name, which is the object's, and the line */
    int64_t line;
} lines_pose;

typedef struct lines_counts {
    int64_t poses;    /* that came and were sound */
    int64_t stale;    /* of these: dropped, as a newer one came */
    int64_t controls; /* lines taken */
    int64_t skipped;  /* lines that were wrong */
    int64_t writers;  /* that went away from a FIFO */
} lines_counts;

/* Opens the sources at `path` (count of them, at most LINES_SOURCES; "-": standard input, of which `before`, which may
 * be NULL, has read a part) and starts to read. A FIFO need not have a writer yet. NULL with e filled. */
lines *lines_open(const char *const *path, int count, in *before, err *e);

/* The same for a source of poses and one of controls. Each may be NULL; one that is named for both is read once. A 3D
 * mouse whose probe would be nowhere, without start= and without a second source, is refused. */
lines *lines_open_named(const char *poses_path, const char *control_path, in *before, err *e);

void lines_close(lines *l);

/* Waits until there is something to take, all sources have ended, or it is `until` (s, by clock_now); also ends
 * soon after stop_came(). */
void lines_wait(lines *l, double until);

/* A source that the caller reads by itself, as the frames of a model, counts as one that has not ended between join and
 * leave. Wake ends a wait, or the next one; any thread may call it. */
void lines_join(lines *l);
void lines_leave(lines *l);
void lines_wake(lines *l);

/* The newest pose, where one came since the last was taken. */
bool lines_take_pose(lines *l, lines_pose *to);

/* Says where the probe is, as a pose from a source does, to a 3D mouse alone. Any thread may call it. */
void lines_place(lines *l, const pose *at);

/* The oldest control that was not taken, cut into words that are valid until the next call; k->name and k->line say
 * where it stood. False where there is none, and once after 256 of them, so that a frame can be made. */
bool lines_take(lines *l, keyfile *k);

/* Counts a control that the caller could not take, for the reason in e; clears e. */
void lines_skip(lines *l, err *e);

/* The same of a pose that was taken; and one that the caller gave up for a newer one is stale. */
void lines_skip_pose(lines *l, err *e);
void lines_drop_pose(lines *l);

/* Warnings of the kinds of errors that are new since the last call. */
void lines_tell(lines *l, notes *warnings);

/* Whether every source has ended, or standard input, and all that came was taken. */
bool lines_ended(lines *l);

lines_counts lines_count(lines *l);

enum { LINES_TEXT = 200 };

/* "600 poses, 3 of them stale and dropped; 12 controls; 2 lines skipped; writers went away: 1". */
void lines_text(const lines_counts *c, char text[LINES_TEXT]);

#endif
