/* A 3D mouse's puck as a probe: its axes; a mouse's motion against straight lines, circles and helices in closed
 * form, however its time is cut; the time after which a deflection does not count any more; a joystick's displacement;
 * the buttons; wrong events; the words of the plan.
 */
#include "live/puck.h"

#include "tap.h"

#include <string.h>

static const double degree = 0.017453292519943295;

static puck_plan plan_of(const char *words)
{
    puck_plan plan;
    err e = {0};
    ok(!puck_plan_read(words, &plan, &e), "'%s' is read: %s", words, e.text);
    return plan;
}

static void send(puck *p, double now, int type, int x, int y, int z, int rx, int ry, int rz)
{
    const int32_t event[8] = {type, x, y, z, rx, ry, rz, 8};
    err e = {0};
    ok(!puck_take(p, event, now, &e), "event %d at %g: %s", type, now, e.text);
}

static void is_at(const puck *p, double x, double y, double z, const char *what)
{
    const double *at = p->at.position;
    const double apart = fabs(at[0] - x) + fabs(at[1] - y) + fabs(at[2] - z);
    near_(apart, 0, 1e-12, "%s: at %g %g %g", what, at[0], at[1], at[2]);
}

/* Turned by so many degrees about an axis. */
static void is_turned(const puck *p, double x, double y, double z, double degrees, const char *what)
{
    const double half = degrees * degree / 2, want[4] = {x * sin(half), y * sin(half), z * sin(half), cos(half)};
    double dot = 0;
    for (int i = 0; i < 4; i++)
        dot += want[i] * p->at.quaternion[i];
    near_(fabs(dot), 1, 1e-12, "%s: turned by %g degrees", what, degrees);
}

static puck placed(const puck_plan *plan)
{
    puck p = puck_make(plan);
    const pose none = pose_none();
    puck_place(&p, &none, 0);
    return p;
}

/* Right is x, down is z, and toward the user is y. */
static void axes(void)
{
    const puck_plan plan = plan_of("mouse,hold=10");
    static const struct {
        int event[6];
        double at[3], axis[3];
        const char *what;
    } list[] = {{{350, 0, 0, 0, 0, 0}, {.05, 0, 0}, {0}, "right"},
                {{0, -350, 0, 0, 0, 0}, {0, 0, .05}, {0}, "pressed down"},
                {{0, 350, 0, 0, 0, 0}, {0, 0, -.05}, {0}, "lifted"},
                {{0, 0, 350, 0, 0, 0}, {0, -.05, 0}, {0}, "pushed away"},
                {{0, 0, 0, 350, 0, 0}, {0}, {1, 0, 0}, "turned about x"},
                {{0, 0, 0, 0, 350, 0}, {0}, {0, 0, -1}, "turned about the puck's y, which is up"},
                {{0, 0, 0, 0, 0, 350}, {0}, {0, -1, 0}, "turned about the puck's z, which is away"}};
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        puck p = placed(&plan);
        const int *v = list[i].event;
        send(&p, 0, PUCK_MOTION, v[0], v[1], v[2], v[3], v[4], v[5]);
        puck_advance(&p, 1);
        is_at(&p, list[i].at[0], list[i].at[1], list[i].at[2], list[i].what);
        is_turned(&p, list[i].axis[0], list[i].axis[1], list[i].axis[2], i < 4 ? 0 : 45, list[i].what);
    }
}

/* x at v while it turns about its own y at w: a circle of radius v/w, whatever times the motion is cut at; with a
 * velocity along y too, a helix. */
static void helix(void)
{
    const puck_plan plan = plan_of("mouse,speed=7cm,turn=90,hold=10");
    for (int parts = 1; parts <= 1000; parts *= 10) {
        puck p = placed(&plan);
        const double v = .07, w = 90 * degree, t = 3;
        send(&p, 0, PUCK_MOTION, 350, 0, -175, 0, 0, -350);
        for (int i = 1; i <= parts; i++) {
            if (parts == 100)
                send(&p, t * i / parts, PUCK_MOTION, 350, 0, -175, 0, 0, -350); /* the same again and again */
            puck_advance(&p, t * i / parts);
        }
        is_at(&p, v / w * sin(w * t), v / 2 * t, -v / w * (1 - cos(w * t)), "a helix");
        is_turned(&p, 0, 1, 0, 270, "a helix");
    }
}

static void silence(void)
{
    const puck_plan plan = plan_of("");
    puck p = placed(&plan);
    near_(plan.hold, .3, 0, "for .3 s, if nothing is said");
    send(&p, 1, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    ok(puck_moves(&p, 1.2) && !puck_moves(&p, 1.31), "a deflection counts for a while");
    puck_advance(&p, 100);
    is_at(&p, .05 * .3, 0, 0, "and no longer");
    send(&p, 100, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    puck_advance(&p, 100.1);
    send(&p, 100.2, PUCK_MOTION, 0, 0, 0, 0, 0, 0);
    puck_advance(&p, 200);
    is_at(&p, .05 * .5, 0, 0, "a puck that is released stops");
    send(&p, 200, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    puck_drop(&p, 200.1);
    puck_advance(&p, 201);
    is_at(&p, .05 * .6, 0, 0, "and so it does where the daemon goes away");
    puck nowhere = puck_make(&plan);
    send(&nowhere, 1, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    puck_advance(&nowhere, 2);
    is_at(&nowhere, 0, 0, 0, "without a place nothing moves");
    ok(!nowhere.placed && !puck_moves(&nowhere, 1.1), "and it has none");
}

static void joystick(void)
{
    const puck_plan plan = plan_of("joystick,reach=14mm,turn=10");
    puck p = placed(&plan);
    const pose there = {{.1, .2, .3}, {1, 0, 0, 0}}; /* half round about x: its z is down */
    send(&p, 1, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    is_at(&p, .014, 0, 0, "a deflection is a displacement");
    puck_advance(&p, 50);
    is_at(&p, .014, 0, 0, "which stays");
    ok(!puck_moves(&p, 50), "and does not go on");
    send(&p, 51, PUCK_MOTION, 0, 0, 0, 0, 0, 0);
    is_at(&p, 0, 0, 0, "and which goes with it");
    puck_place(&p, &there, 52);
    send(&p, 52, PUCK_MOTION, 0, -175, 0, 0, 0, 0);
    is_at(&p, .1, .2, .3 - .007, "in the probe's own frame");
    send(&p, 53, PUCK_MOTION, 0, 0, 0, 350, 0, 0);
    is_turned(&p, 1, 0, 0, 190, "a turn too");
}

static void buttons(void)
{
    const puck_plan stick = plan_of("hold=10"), plan = plan_of("joystick");
    puck p = placed(&stick), m = placed(&plan);
    const pose there = {{1, 0, 0}, {0, 0, 0, 1}};
    send(&p, 0, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    send(&p, 1, PUCK_PRESS, 1, 1, 0, 0, 0, 0);
    send(&p, 2, PUCK_RELEASE, 1, 0, 0, 0, 0, 0);
    puck_advance(&p, 3);
    is_at(&p, .05, 0, 0, "the second button holds the probe");
    send(&p, 4, PUCK_PRESS, 1, 1, 0, 0, 0, 0);
    puck_advance(&p, 5);
    is_at(&p, .1, 0, 0, "and lets it go");
    send(&p, 6, PUCK_MOTION, 0, 0, 0, 0, 0, 0);
    send(&p, 6, PUCK_PRESS, 0, 1, 0, 0, 0, 0);
    is_at(&p, 0, 0, 0, "the first brings it back to where it was put");
    puck_place(&p, &there, 7);
    send(&p, 8, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    send(&p, 9, PUCK_PRESS, 7, 1, 0, 0, 0, 0);
    send(&p, 9, 6, 1, 1, 0, 0, 0, 0);
    is_at(&p, 1.05, 0, 0, "other buttons and newer types of events do nothing");
    send(&p, 9, PUCK_PRESS, 0, 1, 0, 0, 0, 0);
    is_at(&p, 1, 0, 0, "back to where it was put last");

    send(&m, 1, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    send(&m, 2, PUCK_PRESS, 1, 1, 0, 0, 0, 0);
    send(&m, 3, PUCK_MOTION, 0, 0, 0, 0, 0, 0);
    is_at(&m, .02, 0, 0, "a joystick that is held stays where it is as the puck comes back");
    send(&m, 4, PUCK_PRESS, 1, 1, 0, 0, 0, 0);
    send(&m, 5, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    is_at(&m, .04, 0, 0, "and goes on from there");
    send(&m, 6, PUCK_PRESS, 1, 1, 0, 0, 0, 0);
    send(&m, 7, PUCK_PRESS, 1, 1, 0, 0, 0, 0);
    send(&m, 8, PUCK_MOTION, 350, 0, 0, 0, 0, 0);
    is_at(&m, .04, 0, 0, "without a jump where it is deflected");
}

static void wrong(void)
{
    static const int32_t list[][8] = {
        {-1}, {1 << 30}, {0x7faa5501}, {0, 20001}, {0, 0, 0, INT32_MIN}, {0, 0, 0, 0, 0, 0, INT32_MAX}};
    const puck_plan plan = plan_of("");
    puck p = placed(&plan);
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        err e = {0};
        ok(puck_take(&p, list[i], 1, &e) && strstr(e.text, "expected"), "%s", e.text);
    }
    puck_advance(&p, 2);
    is_at(&p, 0, 0, 0, "and nothing has moved");
    static const char *const words[] = {
        "stick",           "mouse,joystick", "speed=0",   "speed=x", "speed=11m", "reach=1cm", "joystick,speed=1cm",
        "joystick,hold=1", "turn=nan",       "turn=4000", "hold=0",  "start=",    "mouse,",    "mouse,,turn=1",
        "speed",           "colour=1",       "mousetrap"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        err e = {0};
        puck_plan refused;
        ok(puck_plan_read(words[i], &refused, &e) && e.status == STATUS_USAGE && strstr(e.text, "expected"), "'%s': %s",
           words[i], e.text);
    }
    const puck_plan named = plan_of("joystick,turn=5,start=a,b=c.tum");
    ok(named.joystick && named.start && !strcmp(named.start, "a,b=c.tum"), "a file's name may have commas");
    near_(named.turn, 5 * degree, 1e-15, "a turn in degrees");
}

int main(void)
{
    axes();
    helix();
    silence();
    joystick();
    buttons();
    wrong();
    return done_testing();
}
