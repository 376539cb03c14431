/* The frames of a tool that runs live: its output is copied to the next tool as it comes, and read here, each by a
 * thread of its own; a third shows the newest frame. So neither of them waits for what a frame's picture takes, and
 * frames that came meanwhile are left out. The caller owns a feed.
 */
#ifndef SINEW_FEED_H
#define SINEW_FEED_H

#include "model/model.h"

typedef struct feed feed;

typedef struct feed_plan {
    int from;         /* the tool's output; the feed's from then on */
    const char *tool; /* borrowed */
    int copy_to;      /* the next tool's input, also the feed's; -1: none */
    void *context;
    /* The newest frame, and the body that it is of. */
    void (*show)(void *context, const model *body, const frame *f);
    /* What could not be read: once, and no frame follows. Silent where the stream ended with `fail`. */
    void (*failed)(void *context, const char *tool, const err *e);
    bool may_be_empty; /* a tool that ended at once has said why: nothing has failed */
    int stop;          /* a descriptor: once it can be read or is hung up, nothing more is read; -1: none */
    /* The next tool's input cannot be written (an errno value), and the rest goes on without it. NULL: never mind. */
    void (*cut)(void *context, int code);
} feed_plan;

/* NULL with e filled; both descriptors are closed in any case. */
feed *feed_open(const feed_plan *plan, err *e);

/* Whether the output has ended, and its last frame was shown. */
bool feed_ended(feed *f);

/* Frames that were read so far; those that were not shown are among them. */
int64_t feed_count(feed *f);

/* Waits for the output's end: the tool must have ended, or `stop` have come. f may be NULL. */
void feed_close(feed *f);

#endif
