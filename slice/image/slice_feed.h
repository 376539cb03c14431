/* The frames of a model as they come: a thread reads them, so that their writer never waits, and keeps the newest. One
 * that was not taken when the next comes is dropped and counted. The functions are for one other thread. The source is
 * the feed's until it is closed, but its body and name may be looked at. The caller owns the feed.
 */
#ifndef SINEW_SLICE_FEED_H
#define SINEW_SLICE_FEED_H

#include "live/lines.h"
#include "model/source.h"

typedef struct slice_feed slice_feed;

typedef struct slice_feed_counts {
    int64_t came, dropped;
} slice_feed_counts;

/* Reads on in a source whose body was read; what comes wakes `wakes`. NULL with e filled. */
slice_feed *slice_feed_open(source *s, lines *wakes, err *e);

/* Ends the thread, and with it reading. f may be NULL. */
void slice_feed_close(slice_feed *f);

/* The newest frame into *to (freed and filled), where one came since the last was taken, and when it came (s, by
 * clock_now). */
bool slice_feed_take(slice_feed *f, frame *to, double *came);

/* Whether no more will come; what came last may still be taken. */
bool slice_feed_ended(slice_feed *f);

/* Waits until no more will come, at most so many seconds. */
void slice_feed_finish(slice_feed *f, double seconds);

/* How the stream ended, once it has: -1 with e filled where it was broken, or said that it failed. */
int slice_feed_error(slice_feed *f, err *e);

slice_feed_counts slice_feed_count(slice_feed *f);

#endif
