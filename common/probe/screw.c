#include "probe/screw.h"

#include <math.h>

/* Below it, the first term of a series has all digits. */
static const double slight = 1e-4;

/* V(t) w = w + along a x w + twice a x (a x w). */
static void carry(const double axis[3], const double w[3], double along, double twice, double to[3])
{
    double once[3], again[3];
    for (int a = 0; a < 3; a++)
        once[a] = axis[(a + 1) % 3] * w[(a + 2) % 3] - axis[(a + 2) % 3] * w[(a + 1) % 3];
    for (int a = 0; a < 3; a++)
        again[a] = axis[(a + 1) % 3] * once[(a + 2) % 3] - axis[(a + 2) % 3] * once[(a + 1) % 3];
    for (int a = 0; a < 3; a++)
        to[a] = w[a] + along * once[a] + twice * again[a];
}

/* Takes the rotation from one quaternion to the other apart; in the frame that both are in. */
static void find_turn(screw *s)
{
    const pose back = {
        .quaternion = {-s->from.quaternion[0], -s->from.quaternion[1], -s->from.quaternion[2], s->from.quaternion[3]}};
    const pose turn = pose_compose(&s->to, &back);
    const double *q = turn.quaternion, sign = q[3] < 0 ? -1 : 1;
    const double sine = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    s->angle = 2 * atan2(sine, sign * q[3]);
    for (int a = 0; a < 3; a++)
        s->axis[a] = sine > 0 ? sign * q[a] / sine : a == 2;
    if (!(sine > 0))
        s->angle = 0;
}

screw screw_of(const pose *from, const pose *to)
{
    screw s = {.from = *from, .to = *to};
    double d[3];
    find_turn(&s);
    for (int a = 0; a < 3; a++)
        d[a] = to->position[a] - from->position[a];
    const double half = s.angle / 2;
    const double twice = s.angle > slight ? 1 - half * cos(half) / sin(half) : s.angle * s.angle / 12;
    carry(s.axis, d, -half, twice, s.way); /* the inverse of V */
    return s;
}

/* A share of the motion; `to` is not looked at. */
static pose go(const screw *s, double share)
{
    const double t = share * s->angle, half = t / 2;
    const double along = t > 0 ? sin(half) * sin(half) / half : 0;
    const double twice = t > slight ? 1 - sin(t) / t : t * t / 6;
    pose turn = {.quaternion = {s->axis[0] * sin(half), s->axis[1] * sin(half), s->axis[2] * sin(half), cos(half)}};
    pose at = pose_compose(&turn, &s->from);
    double gone[3];
    carry(s->axis, s->way, along, twice, gone);
    pose_unit(at.quaternion);
    for (int a = 0; a < 3; a++)
        at.position[a] = s->from.position[a] + share * gone[a];
    return at;
}

pose screw_at(const screw *s, double share)
{
    if (share <= 0 || share >= 1)
        return share >= 1 ? s->to : s->from;
    return go(s, share);
}

pose screw_along(const pose *from, const double way[3], const double turn[3])
{
    screw s = {.from = pose_none(), .way = {way[0], way[1], way[2]}};
    s.angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    for (int a = 0; a < 3; a++)
        s.axis[a] = s.angle > 0 ? turn[a] / s.angle : a == 2;
    const pose gone = go(&s, 1);
    pose to = pose_compose(from, &gone);
    pose_unit(to.quaternion);
    return to;
}

double screw_length(const screw *s, double radius)
{
    const double *w = s->way;
    return sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) + s->angle * radius;
}
