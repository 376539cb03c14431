#include "place/pose_fit.h"

#include <math.h>

static void mean_of(const double *x, const int32_t *point, int64_t count, double to[3])
{
    for (int a = 0; a < 3; a++) {
        to[a] = 0;
        for (int64_t i = 0; i < count; i++)
            to[a] += x[3 * (int64_t)point[i] + a] / (double)count;
    }
}

/* One rotation of Jacobi's in the plane p, q, which makes m[p][q] 0. */
static void rotate(double m[4][4], double v[4][4], int p, int q)
{
    if (m[p][q] == 0)
        return;
    const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
    const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < 4; k++) {
        const double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b;
        m[k][q] = s * a + c * b;
    }
    for (int k = 0; k < 4; k++) {
        const double a = m[p][k], b = m[q][k], x = v[k][p], y = v[k][q];
        m[p][k] = c * a - s * b;
        m[q][k] = s * a + c * b;
        v[k][p] = c * x - s * y;
        v[k][q] = s * x + c * y;
    }
}

/* The eigenvector of the largest eigenvalue; of several as large, the sum of what they have of 0 0 0 1, the turn by
 * nothing. */
static void largest(double m[4][4], double to[4])
{
    double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, most = -INFINITY, scale = 0;
    for (int sweep = 0; sweep < 20; sweep++)
        for (int p = 0; p < 3; p++)
            for (int q = p + 1; q < 4; q++)
                rotate(m, v, p, q);
    for (int i = 0; i < 4; i++) {
        most = fmax(most, m[i][i]);
        scale = fmax(scale, fabs(m[i][i]));
        to[i] = 0;
    }
    double own = 0; /* how much of 0 0 0 1 they have */
    int one = 0;
    for (int i = 0; i < 4; i++) {
        if (m[i][i] < most - 1e-9 * scale)
            continue;
        one = i;
        own += v[3][i] * v[3][i];
        for (int k = 0; k < 4; k++)
            to[k] += v[3][i] * v[k][i];
    }
    for (int k = 0; k < 4; k++)
        to[k] = own > 1e-20 ? to[k] / sqrt(own) : v[k][one];
}

/* Horn's matrix, in the order x y z w, of the sums s of products of what places were and what they are, from their
 * means. */
static void matrix_of(double s[3][3], double m[4][4])
{
    const double trace = s[0][0] + s[1][1] + s[2][2];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        m[i][i] = 2 * s[i][i] - trace;
        m[i][j] = m[j][i] = s[i][j] + s[j][i];
        m[i][3] = m[3][i] = s[j][k] - s[k][j];
    }
    m[3][3] = trace;
}

pose pose_fit(const double *rest, const double *displacement, const int32_t *point, int64_t count)
{
    double was[3], way[3], s[3][3] = {{0}}, m[4][4], turned[3];
    pose to = pose_none();
    if (count < 1)
        return to;
    mean_of(rest, point, count, was);
    mean_of(displacement, point, count, way);
    for (int64_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                const double *x = rest + 3 * (int64_t)point[i], *u = displacement + 3 * (int64_t)point[i];
                s[a][b] += (x[a] - was[a]) * (x[b] - was[b] + (u[b] - way[b]));
            }
    matrix_of(s, m);
    largest(m, to.quaternion);
    pose_unit(to.quaternion);
    pose_apply(&to, was, turned);
    for (int a = 0; a < 3; a++)
        to.position[a] = was[a] + way[a] - turned[a];
    return to;
}
