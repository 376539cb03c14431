#include "base/space.h"

#include <math.h>
#include <string.h>

/* LPS and RAS differ by half a turn about z. */
static double sign(space s, int axis)
{
    return s == SPACE_RAS && axis < 2 ? -1 : 1;
}

/* ---- matrices */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double volume_of(double axis[3][3])
{
    const double *x = axis[0], *y = axis[1], *z = axis[2];
    return x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
}

int space_axes(const double m[16], double axis[3][3], double length[3])
{
    int bad = 0;
    for (int j = 0; j < 3; j++) {
        double square = 0;
        for (int i = 0; i < 3; i++)
            square += m[4 * i + j] * m[4 * i + j];
        length[j] = sqrt(square);
        bad |= !(length[j] > 0) || !isfinite(length[j]);
        for (int i = 0; i < 3; i++)
            axis[j][i] = m[4 * i + j] / length[j];
    }
    for (int j = 0; j < 3; j++)
        bad |= !(fabs(dot(axis[j], axis[(j + 1) % 3])) <= SPACE_COSINE);
    return bad || !(volume_of(axis) > 0) ? -1 : 0;
}

void space_product(const double a[16], const double b[16], double to[16])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            to[4 * i + j] = 0;
            for (int k = 0; k < 4; k++)
                to[4 * i + j] += a[4 * i + k] * b[4 * k + j];
        }
}

int space_inverse(const double m[16], double to[16])
{
    double c[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (i + 1) % 3, b = (i + 2) % 3, x = (j + 1) % 3, y = (j + 2) % 3;
            c[3 * j + i] = m[4 * a + x] * m[4 * b + y] - m[4 * a + y] * m[4 * b + x];
        }
    double d = m[0] * c[0] + m[1] * c[3] + m[2] * c[6];
    if (!(fabs(d) > 0) || !isfinite(d))
        return -1;
    for (int i = 0; i < 3; i++) {
        to[4 * i + 3] = 0;
        for (int j = 0; j < 3; j++) {
            to[4 * i + j] = c[3 * i + j] / d;
            to[4 * i + 3] -= to[4 * i + j] * m[4 * j + 3];
        }
        to[12 + i] = 0;
    }
    to[15] = 1;
    return 0;
}

/* ---- a matrix as a pose */

static int check_last_row(const double m[16], err *e)
{
    for (int i = 0; i < 4; i++)
        if (!(fabs(m[12 + i] - (i == 3)) <= 0))
            return err_set(e, NULL, 0, "a matrix whose last row is %g %g %g %g; expected 0 0 0 1", m[12], m[13], m[14],
                           m[15]);
    return 0;
}

static int check_lengths(const double length[3], err *e)
{
    for (int i = 0; i < 3; i++)
        if (!(fabs(length[i] - 1) <= SPACE_SCALE))
            return err_set(e, NULL, 0,
                           "a matrix with scale: its columns have the lengths %.6g, %.6g and %.6g; expected a rotation "
                           "and a translation, with lengths of 1 to within %g",
                           length[0], length[1], length[2], SPACE_SCALE);
    return 0;
}

static int refuse_axes(double axis[3][3], err *e)
{
    double most = 0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(dot(axis[i], axis[(i + 1) % 3])));
    if (most > SPACE_COSINE)
        return err_set(e, NULL, 0,
                       "a matrix with shear: the cosine between two of its columns is %.6g; expected a rotation and a "
                       "translation, with cosines of 0 to within %g",
                       most, SPACE_COSINE);
    return err_set(e, NULL, 0,
                   "a matrix that mirrors: its columns are left-handed; expected a rotation and a "
                   "translation");
}

int space_pose_of_matrix(const double m[16], space s, pose *p, err *e)
{
    double axis[3][3], length[3];
    pose to;
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return err_set(e, NULL, 0, "a matrix with a number that is not finite; expected 16 finite numbers");
    const int bad = space_axes(m, axis, length);
    if (check_last_row(m, e) || check_lengths(length, e))
        return -1;
    if (bad)
        return refuse_axes(axis, e);
    for (int i = 0; i < 3; i++) {
        to.position[i] = sign(s, i) * m[4 * i + 3] / 1e3;
        for (int j = 0; j < 3; j++)
            axis[j][i] *= sign(s, i);
    }
    pose_axes(axis, to.quaternion);
    *p = to;
    return 0;
}

void space_matrix_of_pose(const pose *p, space s, double m[16])
{
    double r[9];
    pose_matrix(p->quaternion, r);
    memset(m, 0, 16 * sizeof *m);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            m[4 * i + j] = sign(s, i) * r[3 * i + j] + 0.0; /* never -0 */
        m[4 * i + 3] = sign(s, i) * 1e3 * p->position[i] + 0.0;
    }
    m[15] = 1;
}

pose space_motion(const pose *p)
{
    pose to = *p;
    for (int i = 0; i < 2; i++) {
        to.position[i] = -to.position[i];
        to.quaternion[i] = -to.quaternion[i];
    }
    return to;
}

/* ---- points */

void space_point_of_mm(const double from[3], space s, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = sign(s, i) * from[i] / 1e3;
}

void space_point_to_mm(const double from[3], space s, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = sign(s, i) * from[i] * 1e3;
}
