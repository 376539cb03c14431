/* Times of lines out of time stamps: seconds since the first pose, that never decrease, whatever the sender's clock
 * does. Owns nothing.
 */
#ifndef SINEW_TRACK_TIME_H
#define SINEW_TRACK_TIME_H

#include <stdbool.h>
#include <stdint.h>

typedef struct track_time {
    bool begun;
    double origin;      /* s: the stamp that is time 0 */
    double stamp, came; /* s: of the pose before, and when that came */
    double last;        /* s: its time */
} track_time;

typedef enum track_when {
    TRACK_ON_TIME,
    TRACK_LATE, /* its stamp is before the last one's, by at most TRACK_TIME_LATE: an old pose, that is to be skipped */
    TRACK_JUMP  /* the sender's clock was set: the time goes on by how long the pose was under way */
} track_when;

#define TRACK_TIME_LATE  1.0  /* s */
#define TRACK_TIME_AHEAD 10.0 /* s: more than this ahead of the clock here is a jump too */

/* The time of a pose that came at `came` (s, by clock_now) with this stamp (igtl.h; 0: when it came counts). *jump: s
 * by which the stamp went back, or ahead of the clock here. */
track_when track_time_of(track_time *t, uint64_t stamp, double came, double *time, double *jump);

#endif
