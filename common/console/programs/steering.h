/* What moves the console's probe beside a hand on a page, and who is told where it is: a source of poses (a FIFO, a 3D
 * mouse, or a tracker through `sinew igtl-in`), which a thread of its own reads, and `sinew igtl-out`, which serves the
 * newest pose. Poses are in the frame that those of msds-run --body are in. Both programs end with it. All functions
 * are for the thread that opened it, which owns it.
 */
#ifndef SINEW_STEERING_H
#define SINEW_STEERING_H

#include "base/pose.h"
#include "console/programs/child.h"

typedef struct steering_plan {
    const char *poses; /* a FIFO, "-", "spnav:...", or "igtl:HOST:PORT[,TRANSFORM]"; NULL: none */
    const char *out;   /* [ADDRESS:]PORT of igtl-out; NULL: none */
    void *context;
    /* A pose came; and a line was said, by a program or of the poses: by threads of its own. */
    void (*came)(void *context, const pose *at);
    void (*said)(void *context, const char *name, const char *line);
} steering_plan;

typedef struct steering steering;

/* Opens the source and starts the programs. plan's texts are borrowed. NULL with e filled. */
steering *steering_open(const steering_plan *plan, err *e);

/* Nothing comes any more. s may be NULL. */
void steering_close(steering *s);

/* In a word what the poses come from: "3D mouse", "tracker", "lines"; NULL: there is no source. s may be NULL. */
const char *steering_word(const steering *s);

/* Whether the source has places of its own; a 3D mouse goes on from where the probe is put. */
bool steering_has_places(const steering *s);

/* A hand has put the probe there. s may be NULL. */
void steering_place(steering *s, const pose *at);

/* Where the probe is, as a line of poses, for igtl-out. -1 with e filled: see child_tell. s may be NULL. */
int steering_tell(steering *s, const char *line, err *e);

/* Whether a program has ended since the last call; why, in words. s may be NULL. */
bool steering_has_lost(steering *s, char *why, size_t size);

enum { STEERING_PROGRAMS = 2 };

/* igtl-in and igtl-out, for i from 0 on; NULL: it was not started. s may be NULL. */
const child *steering_program(const steering *s, int i);

#endif
