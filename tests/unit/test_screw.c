/* Screw motions against helices in closed form; constant twist; both ends; the bound on what points go. And how far a
 * probe is from triangles, against closed forms and against points of them. */
#include "probe/narrow.h"
#include "probe/screw.h"

#include "any_pose.h"
#include "tap.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static double apart(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* Where two poses have a point of the body, at most so far apart over some of them. */
static double poses_apart(const pose *a, const pose *b)
{
    double most = 0, x[3], y[3];
    for (int i = 0; i < 4; i++) {
        const double own[3] = {i == 1, i == 2, i == 3};
        pose_apply(a, own, x);
        pose_apply(b, own, y);
        most = fmax(most, apart(x, y));
    }
    return most;
}

/* About the line through (1, 2, .) along z, `angle` round and 3 up: x, y on a circle, z even. */
static void helix(double angle)
{
    const pose from = {{1.5, 2, -1}, {0, 0, 0, 1}};
    const pose to = {{1 + .5 * cos(angle), 2 + .5 * sin(angle), 2}, {0, 0, sin(angle / 2), cos(angle / 2)}};
    const screw s = screw_of(&from, &to);
    double worst = 0;
    for (int i = 0; i <= 20; i++) {
        const double share = i / 20., t = angle * share;
        const pose at = screw_at(&s, share);
        const pose want = {{1 + .5 * cos(t), 2 + .5 * sin(t), -1 + 3 * share}, {0, 0, sin(t / 2), cos(t / 2)}};
        worst = fmax(worst, poses_apart(&at, &want));
    }
    near_(worst, 0, 1e-12, "a helix of %g radians", angle);
    near_(screw_length(&s, 0), sqrt(9 + .25 * angle * angle), 1e-9, "and its length");
}

/* Equal shares of the motion are one and the same motion of space; the ends are those; the bound is one. */
static void twist(void)
{
    double worst = 0, over = 0, most = 0;
    int ends = 0;
    for (int k = 0; k < 500; k++) {
        const pose a = any_pose(), b = any_pose();
        const screw s = screw_of(&a, &b);
        pose at[9];
        double way = 0;
        const double r[3] = {any(), any(), any()}, radius = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
        for (int i = 0; i <= 8; i++)
            at[i] = screw_at(&s, i / 8.);
        ends += !memcmp(&at[0], &a, sizeof a) && !memcmp(&at[8], &b, sizeof b);
        for (int i = 0; i < 8; i++) { /* the motion of the first part takes each pose to the next */
            const pose none = pose_none();
            const pose back = pose_relative(&at[0], &none), step = pose_compose(&at[1], &back);
            const pose next = pose_compose(&step, &at[i]);
            double x[3], y[3];
            worst = fmax(worst, poses_apart(&next, &at[i + 1]));
            pose_apply(&at[i], r, x);
            pose_apply(&at[i + 1], r, y);
            way += apart(x, y);
        }
        over = fmax(over, way - screw_length(&s, radius));
        most = fmax(most, s.angle);
    }
    ok(ends == 500, "a motion's ends are the very poses");
    near_(worst, 0, 1e-12, "equal shares are equal motions of space");
    ok(over <= 1e-12, "no point goes farther than the bound");
    ok(most <= PI + 1e-12 && most > 3, "the shorter way round");
}

/* The velocity and the turn of a screw, seen in the body, lead along it. */
static void along(void)
{
    const double still[3] = {0, 0, 0};
    double worst = 0;
    for (int k = 0; k < 500; k++) {
        const pose a = any_pose(), b = any_pose();
        const screw s = screw_of(&a, &b);
        const pose turned = {.quaternion = {a.quaternion[0], a.quaternion[1], a.quaternion[2], a.quaternion[3]}};
        double way[3], axis[3];
        pose_apply_inverse(&turned, s.way, way);
        pose_apply_inverse(&turned, s.axis, axis);
        for (int i = 0; i < 3; i++)
            axis[i] *= s.angle;
        const pose got = screw_along(&a, way, axis);
        worst = fmax(worst, poses_apart(&got, &b));
    }
    near_(worst, 0, 1e-12, "along a screw to its end");
    const pose a = any_pose(), same = screw_along(&a, still, still);
    near_(poses_apart(&same, &a), 0, 1e-15, "and nowhere");
}

static void straight(void)
{
    const pose a = any_pose();
    pose b = a;
    for (int i = 0; i < 3; i++)
        b.position[i] += 1 + i;
    const screw s = screw_of(&a, &b);
    const pose at = screw_at(&s, .25);
    const double want[3] = {a.position[0] + .25, a.position[1] + .5, a.position[2] + .75};
    near_(apart(at.position, want), 0, 1e-14, "a straight line where nothing turns");
    for (int i = 0; i < 4; i++)
        b.quaternion[i] = -a.quaternion[i];
    near_(screw_of(&a, &b).angle, 0, 1e-14, "a quaternion and its negative are one rotation");
}

/* ---- distances from triangles */

static const probe_placed *place(probe shape, const pose *at)
{
    static probe_placed placed;
    static probe kept;
    kept = shape;
    placed = probe_place(&kept, at);
    return &placed;
}

static void gaps(void)
{
    const pose at = {{0, 0, 0}, {0, 0, 0, 1}}; /* its face looks up along z */
    const double flat[9] = {-1, -1, .003, 1, -1, .003, 0, 1, .003}, aside[9] = {-1, -1, .003, -1, 1, .003, -2, 0, .003};
    const probe linear = probe_linear(.04, .01, .0025), sphere = probe_sphere(.01);
    const double fine = 1e-7;
    near_(narrow_gap(place(linear, &at), flat, 1, fine), .003, fine, "a flat face under a large triangle");
    near_(narrow_gap(place(sphere, &at), flat, 1, fine), .003, fine, "a sphere under it");
    near_(narrow_gap(place(probe_curved(.06, 1, .014, .003), &at), flat, 1, fine), .003, fine, "a curved array");
    near_(narrow_gap(place(sphere, &at), aside, 2, fine), sqrt(1 + .013 * .013) - .01, fine, "a sphere and an edge");
    near_(narrow_gap(place(linear, &at), flat, .002, fine), .002, 0, "no more than what is asked for");
    const double through[9] = {-1, -1, -.003, 1, -1, -.003, 0, 1, -.003};
    near_(narrow_gap(place(linear, &at), through, 1, fine), 0, 0, "0 where they meet");
}

/* Against many points of the triangle, each by the closed form: none is nearer, and one is nearly as near. */
static void samples(const char *name, probe shape, double off)
{
    double under = 0, over = 0;
    int apart_ones = 0;
    for (int k = 0; k < 60; k++) {
        const pose at = any_pose();
        const probe_placed *p = place(shape, &at);
        double t[9], x[3], least = INFINITY;
        for (int i = 0; i < 9; i++)
            t[i] = p->centre[i % 3] + 3 * p->reach * any();
        for (int i = 0; i <= 80; i++)
            for (int j = 0; i + j <= 80; j++) {
                for (int a = 0; a < 3; a++)
                    x[a] = t[a] + (i * (t[3 + a] - t[a]) + j * (t[6 + a] - t[a])) / 80;
                least = fmin(least, fmax(0, -probe_at(p, x).depth));
            }
        const double gap = narrow_gap(p, t, 10, 1e-6 * shape.size);
        apart_ones += gap > 0;
        over = fmax(over, (gap - least) / shape.size);
        under = fmax(under, (least - gap) / shape.size);
    }
    ok(over <= 1e-5 && under < off && apart_ones > 20,
       "%s: no point of a triangle is nearer, by %g, nor all farther, by %g", name, over, under);
}

int main(void)
{
    helix(2.5);
    helix(1e-3);
    helix(2e-5);
    helix(1e-9);
    twist();
    along();
    straight();
    gaps();
    samples("sphere", probe_sphere(.02), .1);
    samples("linear", probe_linear(.04, .02, .004), .1);
    samples("curved", probe_curved(.05, 1, .02, .004), .1);
    return done_testing();
}
