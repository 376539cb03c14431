/* us-slice while it runs live, and the replay of what it recorded. An image is made at once when a frame, a pose or a
 * control came, of the newest of each, else at each tick; never more than twice as many as ticks.
 */
#ifndef SINEW_SLICE_LIVE_H
#define SINEW_SLICE_LIVE_H

#include "slice/image/slice_session.h"

/* Goes on until the model's stream ends, without a model until the lines end, or until a signal came. -1 with e
 * filled. */
int slice_live_run(slice_session *s, err *e);

/* Makes the images of the record that the options name, from the frames of the model's stream that it names. */
int slice_live_replay(slice_session *s, err *e);

#endif
