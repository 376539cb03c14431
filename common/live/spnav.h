/* A 3D mouse as a source of poses, through spacenavd's socket: $SPNAV_SOCKET, else /var/run/spnav.sock. The daemon
 * sends eight 32-bit integers of this machine's byte order an event (protocol 0) to who has connected, without a word
 * from us; one of version 1 does so too, as long as it is not asked for more. No X11. A daemon that goes away is
 * waited for. The caller owns the object.
 */
#ifndef SINEW_SPNAV_H
#define SINEW_SPNAV_H

#include "live/puck.h"

#define SPNAV_PREFIX "spnav:"

typedef struct spnav spnav;

/* Whether a source is a 3D mouse: "spnav:" and the words of puck_plan_read(). May be NULL. */
bool spnav_is(const char *name);

/* For runs that are not live: refuses a name that is a 3D mouse. -1 with e filled (usage). */
int spnav_refuse(const char *source, err *e);

/* For runs that are live: refuses controls from a 3D mouse, and a 3D mouse whose probe would be nowhere: without
 * start=, and without a second source, which may put it somewhere. Both may be NULL. -1 with e filled (usage). */
int spnav_check(const char *source, const char *control, err *e);

/* Whether a 3D mouse's words have start=, which says where the probe begins. */
bool spnav_has_start(const char *name);

/* Connects to the daemon, and reads the pose of start=. NULL with e filled. */
spnav *spnav_open(const char *name, err *e);
void spnav_close(spnav *s);

/* What comes of it; by the thread that calls spnav_run. */
typedef struct spnav_to {
    void *context;
    void (*pose)(void *context, double time, const pose *at, int64_t event); /* s since spnav_open */
    void (*wrong)(void *context, const err *e);                              /* an event was skipped */
    void (*say)(void *context, const char *text, bool went);                 /* a warning; the daemon went away */
    /* Whether something else has put the probe somewhere since the last call; where. */
    bool (*placed)(void *context, pose *at);
} spnav_to;

/* Reads events until the descriptor `stop` has something to read, or its other end is closed. */
void spnav_run(spnav *s, int stop, const spnav_to *to);

#endif
