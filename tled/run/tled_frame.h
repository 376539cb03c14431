/* The frames that tled-run writes: the fields of a state, and what is told beside them: the probe, the bodies, the
 * results that were asked for. All is the session's.
 */
#ifndef SINEW_TLED_FRAME_H
#define SINEW_TLED_FRAME_H

#include "tled/run/options.h"
#include "tled/run/tled_session.h"

/* Makes what --results asks for, once the session has its problem and its folds, whose threads it takes. -1 with e
 * filled. */
int tled_frame_results(session *s, const struct options *o, err *e);

/* Offers what frames can have, and reads --frames, once there is the collider too. -1 with e filled. */
int tled_frame_choose(session *s, const struct options *o, err *e);

/* Whether frames have more than the fields of a state, for which the curves of their time are needed. */
bool tled_frame_takes_curves(const session *s);

/* run_setup's, with a session: writes a state as a frame. */
int tled_frame_write(void *context, double time, const field_values *state, err *e);

/* run_setup's: what is told of the last frame alone. */
void tled_frame_last(void *context, const field_values *state);

/* The same as tled_frame_write of a frame that a checkpoint has as it was written. */
int tled_frame_replay(void *context, const frame *f, err *e);

#endif
