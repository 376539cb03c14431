/* A live run of tled-run, and the replay of its record: waits for ticks, takes the controls and poses that came, or
 * those that the record has, records them, and knows where the probe is in each frame on its way. main owns it.
 */
#ifndef SINEW_TLED_LIVE_H
#define SINEW_TLED_LIVE_H

#include "tled/run/options.h"
#include "tled/run/tled_session.h"

typedef struct live live;

/* Whether the options of live runs and replays fit together. -1 with e filled, status 2. */
int live_check(const struct options *o, err *e);

/* Makes s->live of the options; NULL in other runs. -1 with e filled. */
int live_create(session *s, const struct options *o, err *e);
void live_destroy(live *l);

/* The parts that a step is taken in, at rest; l may be NULL: 1. */
int64_t live_parts(const live *l);

/* s: during which the force of contact rises, where the probe comes in or the tissue broke. */
double live_ramp(const live *l);

/* Before the problem is there: what the probe's motion needs; poses come relative to `place`. -1 with e filled. */
int live_collider(session *s, const placing *of, err *e);

/* Once it is there: curves for what may come, and steps of which a whole number is a tick. -1 with e filled. */
int live_prepare(session *s, const struct options *o, err *e);

/* Once all is known of the run, and the model's frames are read: opens the sources and the record. -1 with e filled. */
int live_open(session *s, const struct options *o, err *e);

/* Runs, as run_go. */
int live_go(session *s, run_end *end, err *e);

/* Of the frame that is being written: where the probe is, or NULL before it is anywhere; where there are bodies, the
 * curves' values; and that it has been written. In the frames' thread. */
const collider_moment *live_moment(const live *l);
const double *live_values(const live *l);
void live_written(live *l);

/* Ends the record, and says how it went. */
void live_end(session *s);

#endif
