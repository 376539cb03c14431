/* Frames on their way out: a thread of its own fetches them from the device, in the order in which they
 * are sent, and another hands them on, while the next is fetched and the run goes on. The function that
 * takes frames is called in that other one.
 */
#ifndef SINEW_OUTBOX_H
#define SINEW_OUTBOX_H

#include "tled/problem/tled_executor.h"

typedef struct outbox outbox;

/* A state to write out: the fields that frames have; -1 with e filled. */
typedef int outbox_frame(void *context, double time, const field_values *state, err *e);

/* Frames are fetched from the state of a device. NULL with e filled. */
outbox *outbox_create(const tled_problem *p, const tled_executor *device, tled_state *state, outbox_frame *write,
                      void *context, err *e);

/* Sends what was taken into a slot. */
void outbox_send(outbox *o, int slot, double time);

/* Waits until frame number `index` (from 0, as they are sent) is fetched, so that its slot may be taken again; until it
 * is written. -1 with e filled where one could not be. */
int outbox_wait_fetched(outbox *o, int64_t index, err *e);
int outbox_wait(outbox *o, int64_t index, err *e);

/* Waits until all is written and ends the threads; o may be NULL. -1 with e filled
 * where a frame could not be written. */
int outbox_close(outbox *o, err *e);

#endif
