/* Frames on their way out: while one is written on a thread of its own, the caller fills the next. There are two
 * frames and no more, so that a slow reader makes the caller wait and takes no memory. The creator owns the queue; a
 * frame belongs to the caller from frame_queue_next until frame_queue_send, else to the queue.
 */
#ifndef SINEW_FRAME_QUEUE_H
#define SINEW_FRAME_QUEUE_H

#include "model/model.h"

typedef struct frame_queue frame_queue;

/* Writes a frame, whose arrays it may first make; -1 with e filled. It is called for one frame at a time, in the order
 * in which they are sent. */
typedef int frame_queue_write(void *context, frame *f, err *e);

/* at_once: without a thread, so that a frame is out when it has been sent (live runs). NULL with e filled. */
frame_queue *frame_queue_open(frame_queue_write *write, void *context, bool at_once, err *e);

/* The frame to fill, once there is one that is not being written. It has the arrays of an earlier frame, which
 * frame_queue_array gives again. NULL with e filled where an earlier frame could not be written. */
frame *frame_queue_next(frame_queue *q, err *e);

/* The array of that name in a frame from frame_queue_next: a new one as by frame_add, or that of an earlier frame,
 * whose numbers the caller writes over. NULL with e filled. */
model_array *frame_queue_array(frame *f, const model *m, const char *name, err *e);

/* Sends the frame that frame_queue_next gave. -1 with e filled: it (at once), or an earlier one, could not be
 * written. */
int frame_queue_send(frame_queue *q, err *e);

/* Waits until all that was sent is written, and frees the queue, which may be NULL. Where a frame could not be written,
 * e becomes that error, whatever it was: without the queue nothing would have come after that frame. Then -1. */
int frame_queue_close(frame_queue *q, err *e);

#endif
