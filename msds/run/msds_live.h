/* msds-run --live: a frame as soon as a pose or a control came, or else at the next tick; the newest pose counts, and a
 * frame takes no more than --iterations. Tissue that diverges is put back to rest, and the run goes on.
 */
#ifndef SINEW_MSDS_LIVE_H
#define SINEW_MSDS_LIVE_H

#include "msds/run/session.h"

/* Until the lines end, or a signal comes. -1 with e filled. */
int msds_live_run(session *s, err *e);

#endif
