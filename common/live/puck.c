#include "live/puck.h"

#include "base/num.h"
#include "probe/screw.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295 /* radians */

/* ---- The words */

static int take_length(const char *key, const char *text, double *to, err *e)
{
    num_length length;
    if (!num_length_of(text, &length)) {
        *to = num_length_in(length, num_unit_of("m"), num_unit_of("m"));
        if (*to >= 1e-5 && *to <= 10)
            return 0;
    }
    return err_usage(e, "spnav: %s=%.60s; expected a length at full deflection, 0.01mm to 10m", key, text);
}

static int take_number(const char *key, const char *text, double low, double high, double *to, err *e)
{
    if (!num_double(text, to) && *to >= low && *to <= high)
        return 0;
    return err_usage(e, "spnav: %s=%.60s; expected a number from %g to %g", key, text, low, high);
}

static int take_key(const char *key, char *value, puck_plan *to, err *e)
{
    if (!strcmp(key, to->joystick ? "reach" : "speed"))
        return take_length(key, value, &to->way, e);
    if (!strcmp(key, "turn")) {
        const int failed = take_number(key, value, .1, 3600, &to->turn, e);
        to->turn *= DEGREE;
        return failed;
    }
    if (!strcmp(key, "hold") && !to->joystick)
        return take_number(key, value, .02, 10, &to->hold, e);
    return err_usage(e, "spnav: unknown '%.60s=' of a %s; expected %sstart=FILE at the end", key,
                     to->joystick ? "joystick" : "mouse",
                     to->joystick ? "reach=LENGTH, turn=DEGREES, and "
                                  : "speed=LENGTH, turn=DEGREES, hold=SECONDS, and ");
}

/* One word; the first may be what the puck is. */
static int take_word(char *word, bool first, puck_plan *to, err *e)
{
    char *equals = strchr(word, '=');
    if (first && (!*word || !strcmp(word, "mouse") || !strcmp(word, "joystick")))
        return 0;
    if (!equals)
        return err_usage(e, "spnav: '%.60s'; expected mouse or joystick, then KEY=VALUE between commas", word);
    *equals = '\0';
    return take_key(word, equals + 1, to, e);
}

int puck_plan_read(const char *words, puck_plan *to, err *e)
{
    *to = (puck_plan){.joystick = !strncmp(words, "joystick", strlen("joystick")), .hold = .3};
    to->way = to->joystick ? .02 : .05;
    to->turn = (to->joystick ? 30 : 45) * DEGREE;
    if (snprintf(to->text, sizeof to->text, "%s", words) >= (int)sizeof to->text)
        return err_usage(e, "spnav: more than %d bytes", PUCK_WORD);
    bool first = true;
    for (char *at = to->text; at; first = false) {
        if (!strncmp(at, "start=", strlen("start="))) {
            to->start = at + strlen("start=");
            return *to->start ? 0 : err_usage(e, "spnav: start= without a file; expected one with a pose");
        }
        char *comma = strchr(at, ',');
        if (comma)
            *comma = '\0';
        if (take_word(at, first, to, e))
            return -1;
        at = comma ? comma + 1 : NULL;
    }
    return 0;
}

/* ---- The motion */

puck puck_make(const puck_plan *plan)
{
    return (puck){.plan = plan, .start = pose_none(), .from = pose_none(), .at = pose_none()};
}

void puck_place(puck *p, const pose *at, double now)
{
    puck_advance(p, now);
    p->placed = true;
    p->start = p->from = p->at = *at;
}

bool puck_moves(const puck *p, double now)
{
    if (!p->placed || p->held || p->plan->joystick || now >= p->until)
        return false;
    for (int a = 0; a < 3; a++)
        if (p->way[a] != 0 || p->turn[a] != 0)
            return true;
    return false;
}

/* A mouse's velocity is constant between two events, so the motion is a screw's, whatever times it is cut at. */
void puck_advance(puck *p, double now)
{
    const double seconds = fmin(now, p->until) - p->time;
    if (seconds > 0 && puck_moves(p, p->time)) {
        double way[3], turn[3];
        for (int a = 0; a < 3; a++) {
            way[a] = p->way[a] * seconds;
            turn[a] = p->turn[a] * seconds;
        }
        p->at = screw_along(&p->at, way, turn);
    }
    p->time = fmax(p->time, now);
}

static int take_motion(puck *p, const int32_t event[8], err *e)
{
    for (int i = 1; i <= 6; i++)
        if (event[i] < -PUCK_MOST || event[i] > PUCK_MOST)
            return err_set(e, NULL, 0, "a deflection of %ld; expected at most %d", (long)event[i], PUCK_MOST);
    const double moved[3] = {event[1], -event[3], -event[2]}, turned[3] = {event[4], -event[6], -event[5]};
    for (int a = 0; a < 3; a++) {
        p->way[a] = moved[a] * p->plan->way / PUCK_FULL;
        p->turn[a] = turned[a] * p->plan->turn / PUCK_FULL;
    }
    p->until = p->time + p->plan->hold;
    if (p->plan->joystick && p->placed && !p->held)
        p->at = screw_along(&p->from, p->way, p->turn);
    return 0;
}

/* A joystick goes on from where the probe is, without a jump, whatever the deflection is. */
static void go_on_from_here(puck *p)
{
    double back[3], turned_back[3];
    for (int a = 0; a < 3; a++) {
        back[a] = -p->way[a];
        turned_back[a] = -p->turn[a];
    }
    p->from = screw_along(&p->at, back, turned_back);
}

/* The first button brings the probe back to where it was put, and the second holds it where it is, and lets it go. */
static void press(puck *p, int32_t button)
{
    if (button == 0)
        p->from = p->at = p->start;
    if (button != 1)
        return;
    p->held = !p->held;
    if (!p->held)
        go_on_from_here(p);
}

int puck_take(puck *p, const int32_t event[8], double now, err *e)
{
    enum { TYPES_MOST = 1000 }; /* newer daemons than we know have a dozen */
    if (event[0] < 0 || event[0] > TYPES_MOST)
        return err_set(e, NULL, 0, "an event of type %ld; expected 0 to %d", (long)event[0], TYPES_MOST);
    puck_advance(p, now);
    if (event[0] == PUCK_MOTION)
        return take_motion(p, event, e);
    if (event[0] == PUCK_PRESS && p->placed)
        press(p, event[1]);
    return 0;
}

void puck_drop(puck *p, double now)
{
    puck_advance(p, now);
    for (int a = 0; a < 3; a++)
        p->way[a] = p->turn[a] = 0;
    p->until = now;
    p->held = false;
    p->from = p->at;
}
