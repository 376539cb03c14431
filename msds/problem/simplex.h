/* The maths of one tetrahedron of linear shape functions (PST section III; Zienkiewicz and Taylor), for gcc and nvcc,
 * in double: gradients, stiffness, forces, and the rotation that warping takes out.
 */
#ifndef SINEW_SIMPLEX_H
#define SINEW_SIMPLEX_H

#include <math.h>

#ifdef __CUDACC__
#define SIMPLEX_FUNCTION static __host__ __device__ inline
#else
#define SIMPLEX_FUNCTION static inline
#endif

typedef struct simplex {
    double volume;         /* m3, above 0 */
    double gradient[4][3]; /* 1/m: of the shape functions */
    double lambda, mu;     /* Pa */
} simplex;

/* The six edges by their corners. */
#define SIMPLEX_EDGES                                                                                                  \
    {                                                                                                                  \
        {0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3},                                                                        \
        {                                                                                                              \
            2, 3                                                                                                       \
        }                                                                                                              \
    }

SIMPLEX_FUNCTION void simplex_cross(const double a[3], const double b[3], double to[3])
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

/* Of corners x0 to x3, without the material. volume is below 0 for one that is inverted. */
SIMPLEX_FUNCTION void simplex_shape(const double *x0, const double *x1, const double *x2, const double *x3, simplex *s)
{
    double a[3], b[3], c[3], bc[3], ca[3], ab[3], six = 0;
    for (int i = 0; i < 3; i++) {
        a[i] = x1[i] - x0[i];
        b[i] = x2[i] - x0[i];
        c[i] = x3[i] - x0[i];
    }
    simplex_cross(b, c, bc);
    simplex_cross(c, a, ca);
    simplex_cross(a, b, ab);
    for (int i = 0; i < 3; i++)
        six += a[i] * bc[i];
    s->volume = six / 6;
    for (int i = 0; i < 3; i++) {
        s->gradient[1][i] = bc[i] / six;
        s->gradient[2][i] = ca[i] / six;
        s->gradient[3][i] = ab[i] / six;
        s->gradient[0][i] = -s->gradient[1][i] - s->gradient[2][i] - s->gradient[3][i];
    }
}

/* The volume of corners x0 to x3, m3; below 0 for one that is inverted. */
SIMPLEX_FUNCTION double simplex_volume(const double *x0, const double *x1, const double *x2, const double *x3)
{
    double a[3], b[3], c[3], bc[3];
    for (int i = 0; i < 3; i++) {
        a[i] = x1[i] - x0[i];
        b[i] = x2[i] - x0[i];
        c[i] = x3[i] - x0[i];
    }
    simplex_cross(b, c, bc);
    return (a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2]) / 6;
}

SIMPLEX_FUNCTION void simplex_material(double young, double poisson, simplex *s)
{
    s->lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    s->mu = young / (2 * (1 + poisson));
}

/* The 3 x 3 block, row by row, of corners i and j: V (lambda gi gj^T + mu gj gi^T + mu (gi . gj) I). */
SIMPLEX_FUNCTION void simplex_block(const simplex *s, int i, int j, double k[9])
{
    const double *p = s->gradient[i], *q = s->gradient[j];
    double dot = s->mu * (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            k[3 * a + b] = s->volume * (s->lambda * p[a] * q[b] + s->mu * q[a] * p[b] + (a == b ? dot : 0));
}

/* G = sum of u_c (x) gradient_c: the displacement's derivatives. u: of the corners. */
SIMPLEX_FUNCTION void simplex_derivative(const simplex *s, double u[4][3], double g[3][3])
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            g[a][b] = u[0][a] * s->gradient[0][b] + u[1][a] * s->gradient[1][b] + u[2][a] * s->gradient[2][b] +
                      u[3][a] * s->gradient[3][b];
}

/* What the corners pull with: V sigma gradient_c, sigma of Cauchy's strain sym(g). */
SIMPLEX_FUNCTION void simplex_force(const simplex *s, double g[3][3], double f[4][3])
{
    double sigma[3][3], trace = s->lambda * (g[0][0] + g[1][1] + g[2][2]);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            sigma[a][b] = s->volume * (s->mu * (g[a][b] + g[b][a]) + (a == b ? trace : 0));
    for (int c = 0; c < 4; c++)
        for (int a = 0; a < 3; a++)
            f[c][a] =
                sigma[a][0] * s->gradient[c][0] + sigma[a][1] * s->gradient[c][1] + sigma[a][2] * s->gradient[c][2];
}

/* Solves a x = b, a symmetric. Returns whether a is positive definite, without which x is left as it was. */
SIMPLEX_FUNCTION int simplex_solve(double a[3][3], const double b[3], double x[3])
{
    double c[3] = {a[1][1] * a[2][2] - a[1][2] * a[1][2], a[0][2] * a[1][2] - a[0][1] * a[2][2],
                   a[0][1] * a[1][2] - a[0][2] * a[1][1]};
    double det = a[0][0] * c[0] + a[0][1] * c[1] + a[0][2] * c[2], minor = a[0][0] * a[1][1] - a[0][1] * a[0][1];
    if (!(a[0][0] > 0 && minor > 0 && det > 0))
        return 0;
    double d = a[0][0] * a[2][2] - a[0][2] * a[0][2], e = a[0][1] * a[0][2] - a[0][0] * a[1][2];
    x[0] = (c[0] * b[0] + c[1] * b[1] + c[2] * b[2]) / det;
    x[1] = (c[1] * b[0] + d * b[1] + e * b[2]) / det;
    x[2] = (c[2] * b[0] + e * b[1] + minor * b[2]) / det;
    return 1;
}

/* One turn of the quaternion q (x y z w) toward the rotation of the polar decomposition of f. With B = f R^T, w the
 * axis of B - B^T: Newton's step solves (tr B - sym B) turn = w; where that is no way up, or a long one, it is that of
 * Muller et al. 2016, w over |tr B|. Returns an estimate of the angle that is left. */
SIMPLEX_FUNCTION double simplex_turn(double f[3][3], double r[3][3], double q[4])
{
    double b[3][3], a[3][3], turn[3] = {2, 0, 0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            b[i][j] = f[i][0] * r[j][0] + f[i][1] * r[j][1] + f[i][2] * r[j][2];
    const double w[3] = {b[2][1] - b[1][2], b[0][2] - b[2][0], b[1][0] - b[0][1]}, trace = b[0][0] + b[1][1] + b[2][2];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            a[i][j] = (i == j ? trace : 0) - (b[i][j] + b[j][i]) / 2;
    int newton = simplex_solve(a, w, turn);
    double square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    if (!newton || !(square < 1)) {
        newton = 0;
        for (int i = 0; i < 3; i++)
            turn[i] = w[i] / (fabs(trace) + 1e-9);
        square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    }
    const double p[3] = {turn[0] / 2, turn[1] / 2, turn[2] / 2}; /* and 1 */
    double t[4] = {q[0] + q[3] * p[0] + p[1] * q[2] - p[2] * q[1], q[1] + q[3] * p[1] + p[2] * q[0] - p[0] * q[2],
                   q[2] + q[3] * p[2] + p[0] * q[1] - p[1] * q[0], q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2]};
    double length = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] + t[3] * t[3]);
    for (int i = 0; i < 4; i++)
        q[i] = t[i] / length;
    return newton ? square : sqrt(square);
}

SIMPLEX_FUNCTION void simplex_matrix(const double q[4], double r[3][3])
{
    double x = q[0], y = q[1], z = q[2], w = q[3];
    r[0][0] = 1 - 2 * (y * y + z * z), r[0][1] = 2 * (x * y - w * z), r[0][2] = 2 * (x * z + w * y);
    r[1][0] = 2 * (x * y + w * z), r[1][1] = 1 - 2 * (x * x + z * z), r[1][2] = 2 * (y * z - w * x);
    r[2][0] = 2 * (x * z - w * y), r[2][1] = 2 * (y * z + w * x), r[2][2] = 1 - 2 * (x * x + y * y);
}

/* The rotation of the polar decomposition of I + g, from the one before, q, which is so kept where an
 * element is inverted; its matrix in r. */
SIMPLEX_FUNCTION void simplex_rotation(double g[3][3], double q[4], double r[3][3])
{
    double f[3][3];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            f[a][b] = g[a][b] + (a == b);
    simplex_matrix(q, r);
    for (int i = 0; i < 30; i++) {
        double left = simplex_turn(f, r, q);
        simplex_matrix(q, r);
        if (left < 1e-12)
            break;
    }
}

/* The corners' pulls of a warped element: R K (R^T (X + u) - X), which is V R sigma(R^T (I + g) - I) gradient. */
SIMPLEX_FUNCTION void simplex_warped(const simplex *s, double g[3][3], double r[3][3], double f[4][3])
{
    double h[3][3], t[4][3];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            h[a][b] = r[0][a] * (g[0][b] + (b == 0)) + r[1][a] * (g[1][b] + (b == 1)) + r[2][a] * (g[2][b] + (b == 2)) -
                      (a == b);
    simplex_force(s, h, t);
    for (int c = 0; c < 4; c++)
        for (int a = 0; a < 3; a++)
            f[c][a] = r[a][0] * t[c][0] + r[a][1] * t[c][1] + r[a][2] * t[c][2];
}

/* What those change by along d, the derivatives of a displacement. With U = R^T (I + g), R turns on by R [w], where
 * (tr U - U) w is the axis of R^T d - d^T R; the stress R sigma(U - I) changes by R (sigma(dU) + [w] sigma(U - I)),
 * dU = R^T d - [w] U. An element that is inverted does not turn. */
SIMPLEX_FUNCTION void simplex_warped_along(const simplex *s, double g[3][3], double r[3][3], double d[3][3],
                                           double f[4][3])
{
    double u[3][3], v[3][3], a[3][3], w[3] = {0, 0, 0}, t[4][3], more[4][3], back[3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            u[i][j] = r[0][i] * (g[0][j] + (j == 0)) + r[1][i] * (g[1][j] + (j == 1)) + r[2][i] * (g[2][j] + (j == 2));
            v[i][j] = r[0][i] * d[0][j] + r[1][i] * d[1][j] + r[2][i] * d[2][j];
        }
    const double axis[3] = {v[2][1] - v[1][2], v[0][2] - v[2][0], v[1][0] - v[0][1]};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            a[i][j] = (i == j ? u[0][0] + u[1][1] + u[2][2] : 0) - (u[i][j] + u[j][i]) / 2;
    simplex_solve(a, axis, w);
    for (int j = 0; j < 3; j++) {
        const double column[3] = {u[0][j], u[1][j], u[2][j]};
        simplex_cross(w, column, back);
        for (int i = 0; i < 3; i++) {
            v[i][j] -= back[i];
            u[i][j] -= i == j;
        }
    }
    simplex_force(s, v, t);
    simplex_force(s, u, more);
    for (int c = 0; c < 4; c++) {
        simplex_cross(w, more[c], back);
        for (int i = 0; i < 3; i++)
            t[c][i] += back[i];
        for (int i = 0; i < 3; i++)
            f[c][i] = r[i][0] * t[c][0] + r[i][1] * t[c][1] + r[i][2] * t[c][2];
    }
}

#endif
