/* Frames on their way out: a thread of its own hands them on, in order, while the run goes on. Buffers belong to the
 * outbox, one at a time is the caller's to fill; the function that takes frames is called in that thread.
 */
#ifndef SINEW_OUTBOX_H
#define SINEW_OUTBOX_H

#include "tled/state.h"

typedef struct outbox outbox;

/* A state to write out; -1 with e filled. */
typedef int outbox_frame(void *context, double time, const double *displacement, const double *velocity, err *e);

/* NULL with e filled. */
outbox *outbox_create(int64_t nodes, outbox_frame *write, void *context, err *e);

/* The next buffer to fill, once one is free. -1 with e filled where a frame before could not be written. */
int outbox_next(outbox *o, tled_taken *to, err *e);

/* Sends what outbox_next gave, filled. */
void outbox_send(outbox *o, double time);

/* Waits until all is written and ends the thread; o may be NULL. -1 with e filled where a frame could not be written. */
int outbox_close(outbox *o, err *e);

#endif
