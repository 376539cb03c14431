/* What senders send: a row for each type of message and name, with how many came and how often; and which of its poses
 * is meant where nobody said. It owns nothing, and keeps the first rows where there are too many.
 */
#ifndef SINEW_TRACK_NAMES_H
#define SINEW_TRACK_NAMES_H

#include "link/track/track_pose.h"

enum { TRACK_ROWS = 200, TRACK_LIST = 700 };

typedef struct track_row {
    char type[IGTL_TYPE + 1];
    char name[TRACK_NAME];
    bool is_pose;
    int64_t count;
    double first, last; /* s, by clock_now */
} track_row;

typedef struct track_names {
    track_row row[TRACK_ROWS];
    int count;
    int poses; /* of the rows: names of poses, each once */
} track_names;

/* One came. Whether it is the first. */
bool track_names_add(track_names *n, const char *type, const char *name, bool is_pose, double now);

/* "ProbeToReference, StylusTip" of the poses, each once; "" where there are none. */
void track_names_list(const track_names *n, char to[TRACK_LIST]);

/* Messages a second of a row; 0: one alone. */
double track_names_rate(const track_row *row);

/* Which pose is meant: the only one, or of several ProbeToReference, or ProbeToTracker. NULL: that cannot be told. */
const char *track_names_choose(const track_names *n);

/* Whether it is ProbeToReference, so that nothing that comes later would be chosen. */
bool track_names_is_first(const char *name);

#endif
