/* Records of msds-run's live runs, and their replay. A frame's line has its time and pose, its iterations, and as its
 * path the method that solved it, or `rest` where the tissue was put back to rest. The settings are at the beginning.
 */
#ifndef SINEW_MSDS_RECORD_H
#define SINEW_MSDS_RECORD_H

#include "live/record.h"
#include "msds/run/solve_frame.h"

/* Creates the file of --record. NULL with e filled. */
record *msds_record_create(const session *s, err *e);

/* Adds the frame that was made last; rested: it was put to rest. Adds a warning where that fails, once. */
void msds_record_add(record *r, session *s, const frame_input *from, bool rested);

/* Takes the probe that the record of --replay began with as that of the run, so that the model says it too. -1 with e
 * filled. */
int msds_record_probe(session *s, err *e);

/* Makes the frames of --replay again. -1 with e filled. */
int msds_record_replay(session *s, err *e);

#endif
