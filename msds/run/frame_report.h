/* What msds-run tells of its frames: on the way to them, a row for each, and at the end.
 */
#ifndef SINEW_FRAME_REPORT_H
#define SINEW_FRAME_REPORT_H

#include "msds/run/session.h"

/* Shows which frame is being made, and, where that takes long, what of it; context: the session. A msds_listener. */
void frame_report_work(void *context, const msds_progress *now);

/* A row of the table, for the frame that was made last. */
void frame_report_row(session *s);

/* Warns of what the first pose shows of the probe, and where it enters tissue at once; line: of the pose, or 0. */
void frame_report_pose(session *s, const pose *at, int64_t line, const press_moves *moves, bool first);

/* The largest values of all frames, in a line. */
enum { FRAME_REPORT_WORDS = 400 };
void frame_report_words(const session *s, char *to, size_t size);

/* Of all frames: what touched nothing, and the largest values. */
void frame_report_end(session *s);

#endif
