/* The asynchronous writer of frames: one thread fetches snapshots from the executor, in the order in which they are
 * sent, and another writes each as a frame, by the caller's function, while the next is fetched and the run goes on.
 * The creator owns it.
 */
#ifndef SINEW_FRAME_WRITER_H
#define SINEW_FRAME_WRITER_H

#include "tled/problem/tled_executor.h"

typedef struct frame_writer frame_writer;

/* A state to write out: the fields that frames have; -1 with e filled. */
typedef int frame_writer_write(void *context, double time, const field_values *state, err *e);

/* The last state that was written out: once, when all were, none of them badly. */
typedef void frame_writer_last(void *context, const field_values *state);

/* Frames are fetched from the state of a device. last: or NULL. NULL with e filled. */
frame_writer *frame_writer_create(const tled_problem *p, const tled_executor *device, tled_state *state,
                                  frame_writer_write *write, frame_writer_last *last, void *context, err *e);

/* Sends the snapshot in a slot, of a state at `time`, s. */
void frame_writer_send(frame_writer *w, int slot, double time);

/* Waits until frame number `index` (from 0, as they are sent) is fetched, so that its slot may be taken again; until it
 * is written. -1 with e filled where one could not be. */
int frame_writer_wait_fetched(frame_writer *w, int64_t index, err *e);
int frame_writer_wait(frame_writer *w, int64_t index, err *e);

/* Waits until all is written and ends the threads; w may be NULL. -1 with e filled
 * where a frame could not be written. */
int frame_writer_close(frame_writer *w, err *e);

#endif
