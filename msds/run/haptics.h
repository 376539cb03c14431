/* What haptic devices are told of a live run: a line for each frame on a local socket, with the pose of the probe, the
 * force and the torque on it, and the contact stiffness there, in the frame that poses come in; with times, so that a
 * device's loop can extrapolate (HAPTICS in msds-run(1)). Where nobody listens, nothing is computed. The caller owns
 * the object, which borrows the session.
 */
#ifndef SINEW_HAPTICS_H
#define SINEW_HAPTICS_H

#include "live/broadcast.h"
#include "msds/run/session.h"

typedef struct haptics haptics;

/* On the session's socket; its state is made. NULL with e filled. */
haptics *haptics_create(session *s, err *e);
void haptics_destroy(haptics *h); /* h may be NULL */

/* The frame that was just made, of a pose that came at `came` (s, by clock_now); rested: the tissue was put back to
 * rest. -1 with e filled. */
int haptics_send(haptics *h, double came, bool rested, err *e);

/* Says how much was told, and what it took. */
void haptics_end(const haptics *h);

#endif
