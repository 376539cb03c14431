/* What a record of a live run of tled-run is of: all that decides its frames besides its lines. Owns nothing.
 */
#ifndef SINEW_TLED_RECORD_H
#define SINEW_TLED_RECORD_H

#include "live/record.h"
#include "tled/run/tled_session.h"

/* Creates the record `path`, if not NULL, or opens the one to be replayed, and compares what it is of. rate: frames a
 * second. -1 with e filled. */
int record_begin(const session *s, double rate, const char *path, bool force, const char *replayed, record **to,
                 replay **from, err *e);

#endif
