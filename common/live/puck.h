/* A 3D mouse as a probe: how far its puck is deflected, event by event, becomes where the probe is. As a mouse, a
 * deflection is a velocity; as a joystick, it is the way from where the probe stands. No input and no output: who reads
 * the device gives events and times. Owns nothing but its plan's texts, which are the caller's.
 *
 * The puck has x to the right, y up and z away from the user, and its turns are about these axes, right-handed, as
 * spacenavd sends them (libspnav's spnav_posrot_moveobj has its z the other way round, toward the viewer). The probe
 * has x along the image's columns and z into the tissue, so that y is toward the user:
 *
 *     puck    x right   y up   z away          the probe is moved in its own frame, about the
 *     probe   x         -z     -y              middle of its face
 */
#ifndef SINEW_PUCK_H
#define SINEW_PUCK_H

#include "base/err.h"
#include "base/pose.h"

enum {
    PUCK_FULL = 350,   /* what spacenavd sends for a full deflection; some devices go to 500 */
    PUCK_MOST = 20000, /* more is no deflection, whatever the daemon's sensitivity */
    PUCK_WORD = 4096   /* bytes of a plan's text */
};

typedef struct puck_plan {
    bool joystick;        /* else a mouse */
    double way, turn;     /* at full deflection. Mouse: m/s and radians a second; joystick: m and radians */
    double hold;          /* s: for so long a mouse's deflection counts without a further event */
    char text[PUCK_WORD]; /* the words, cut */
    const char *start;    /* in text: the file whose first pose is where the probe begins; NULL: none was named */
} puck_plan;

/* Reads "[mouse|joystick][,speed=LENGTH][,reach=LENGTH][,turn=DEGREES][,hold=SECONDS][,start=FILE]"; start is the
 * last, as a file's name may have commas. -1 with e filled (usage). */
int puck_plan_read(const char *words, puck_plan *to, err *e);

typedef struct puck {
    const puck_plan *plan;
    bool placed;            /* where the probe is, is known */
    bool held;              /* by the second button */
    pose start;             /* where it was put last: the first button brings it back there */
    pose from;              /* joystick: what the deflection counts from */
    pose at;                /* now */
    double way[3], turn[3]; /* the deflection in the probe's frame, scaled as the plan says */
    double time;            /* s: `at` is of this time */
    double until;           /* s: when the deflection ends to count */
} puck;

puck puck_make(const puck_plan *plan);

/* Puts the probe there: it begins there, or something else than the puck has brought it there. */
void puck_place(puck *p, const pose *at, double now);

/* Moves on to `now` (s, of any clock that does not go back). */
void puck_advance(puck *p, double now);

typedef enum puck_type { PUCK_MOTION, PUCK_PRESS, PUCK_RELEASE, PUCK_TYPES } puck_type;

/* Moves on to `now` and takes an event: eight numbers, the first its type; of a motion x y z rx ry rz and the ms since
 * the last; of a button its number. Other types are let be. -1 with e filled where it is none. */
int puck_take(puck *p, const int32_t event[8], double now, err *e);

/* Whether the probe moves on by itself at that time. */
bool puck_moves(const puck *p, double now);

/* The puck is let go, as its daemon went away: the probe stays where it is. */
void puck_drop(puck *p, double now);

#endif
