#include "base/pose.h"

#include <math.h>
#include <string.h>

pose pose_none(void)
{
    return (pose){.quaternion = {0, 0, 0, 1}};
}

pose pose_of_row(const double row[7])
{
    pose p;
    memcpy(p.position, row, sizeof p.position);
    memcpy(p.quaternion, row + 3, sizeof p.quaternion);
    return p;
}

void pose_to_row(const pose *p, double row[7])
{
    memcpy(row, p->position, sizeof p->position);
    memcpy(row + 3, p->quaternion, sizeof p->quaternion);
}

int pose_is_unit(double length)
{
    return fabs(length - 1) <= POSE_LENGTH;
}

double pose_unit(double quaternion[4])
{
    double square = 0;
    for (int i = 0; i < 4; i++)
        square += quaternion[i] * quaternion[i];
    const double length = sqrt(square);
    for (int i = 0; i < 4 && pose_is_unit(length); i++)
        quaternion[i] /= length;
    return length;
}

void pose_matrix(const double quaternion[4], double r[9])
{
    const double x = quaternion[0], y = quaternion[1], z = quaternion[2], w = quaternion[3];
    r[0] = 1 - 2 * (y * y + z * z), r[1] = 2 * (x * y - z * w), r[2] = 2 * (x * z + y * w);
    r[3] = 2 * (x * y + z * w), r[4] = 1 - 2 * (x * x + z * z), r[5] = 2 * (y * z - x * w);
    r[6] = 2 * (x * z - y * w), r[7] = 2 * (y * z + x * w), r[8] = 1 - 2 * (x * x + y * y);
}

static void turned(const double quaternion[4], const double v[3], double to[3])
{
    double r[9];
    pose_matrix(quaternion, r);
    for (int a = 0; a < 3; a++)
        to[a] = r[3 * a] * v[0] + r[3 * a + 1] * v[1] + r[3 * a + 2] * v[2];
}

/* From the quaternion's largest part, which is nowhere small. */
void pose_axes(double axis[3][3], double turn[4])
{
    double trace = axis[0][0] + axis[1][1] + axis[2][2], length = 0;
    int most = 0;
    for (int i = 1; i < 3; i++)
        most = axis[i][i] > axis[most][most] ? i : most;
    if (trace > axis[most][most]) {
        for (int i = 0; i < 3; i++)
            turn[i] = axis[(i + 1) % 3][(i + 2) % 3] - axis[(i + 2) % 3][(i + 1) % 3];
        turn[3] = 1 + trace;
    } else {
        int i = most, j = (i + 1) % 3, k = (i + 2) % 3;
        turn[i] = 1 + axis[i][i] - axis[j][j] - axis[k][k];
        turn[j] = axis[i][j] + axis[j][i];
        turn[k] = axis[i][k] + axis[k][i];
        turn[3] = axis[j][k] - axis[k][j];
    }
    for (int i = 0; i < 4; i++)
        length += turn[i] * turn[i];
    for (int i = 0; i < 4; i++)
        turn[i] /= sqrt(length);
}

void pose_apply(const pose *p, const double from[3], double to[3])
{
    double x[3];
    turned(p->quaternion, from, x);
    for (int a = 0; a < 3; a++)
        to[a] = x[a] + p->position[a];
}

static pose conjugate(const pose *p)
{
    const double *q = p->quaternion;
    return (pose){.quaternion = {-q[0], -q[1], -q[2], q[3]}};
}

void pose_apply_inverse(const pose *p, const double from[3], double to[3])
{
    const pose back = conjugate(p);
    double x[3];
    for (int a = 0; a < 3; a++)
        x[a] = from[a] - p->position[a];
    turned(back.quaternion, x, to);
}

static pose product(const pose *a, const pose *b)
{
    const double *p = a->quaternion, *q = b->quaternion;
    return (pose){.quaternion = {p[3] * q[0] + q[3] * p[0] + p[1] * q[2] - p[2] * q[1],
                                 p[3] * q[1] + q[3] * p[1] + p[2] * q[0] - p[0] * q[2],
                                 p[3] * q[2] + q[3] * p[2] + p[0] * q[1] - p[1] * q[0],
                                 p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2]}};
}

pose pose_compose(const pose *frame, const pose *in_frame)
{
    pose to = product(frame, in_frame);
    pose_apply(frame, in_frame->position, to.position);
    return to;
}

pose pose_relative(const pose *frame, const pose *at)
{
    const pose back = conjugate(frame);
    pose to = product(&back, at);
    pose_apply_inverse(frame, at->position, to.position);
    return to;
}

pose pose_between(const pose *a, const pose *b, double share)
{
    pose to;
    double dot = 0, length = 0;
    for (int i = 0; i < 4; i++)
        dot += a->quaternion[i] * b->quaternion[i];
    for (int i = 0; i < 4; i++) {
        to.quaternion[i] = (1 - share) * (dot < 0 ? -a->quaternion[i] : a->quaternion[i]) + share * b->quaternion[i];
        length += to.quaternion[i] * to.quaternion[i];
    }
    for (int i = 0; i < 4; i++)
        to.quaternion[i] = length > 1e-12 ? to.quaternion[i] / sqrt(length) : b->quaternion[i];
    for (int i = 0; i < 3; i++)
        to.position[i] = (1 - share) * a->position[i] + share * b->position[i];
    return to;
}

pose pose_slerp(const pose *a, const pose *b, double share)
{
    pose to;
    double dot = 0, length = 0;
    for (int i = 0; i < 4; i++)
        dot += a->quaternion[i] * b->quaternion[i];
    const double sign = dot < 0 ? -1 : 1;
    for (int i = 0; i < 4; i++) {
        const double gap = b->quaternion[i] - sign * a->quaternion[i];
        length += gap * gap;
    }
    /* By the chord, which keeps its digits where the angle is small. */
    const double half = asin(fmin(sqrt(length) / 2, 1)), sine = sin(2 * half);
    const double from = sine > 1e-9 ? sin(2 * half * (1 - share)) / sine : 1 - share;
    const double on = sine > 1e-9 ? sin(2 * half * share) / sine : share;
    for (int i = 0; i < 4; i++)
        to.quaternion[i] = from * sign * a->quaternion[i] + on * b->quaternion[i];
    pose_unit(to.quaternion);
    for (int i = 0; i < 3; i++)
        to.position[i] = (1 - share) * a->position[i] + share * b->position[i];
    return to;
}
