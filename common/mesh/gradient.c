#include "mesh/gradient.h"

#include "mesh/lattice.h"

#include <math.h>

static double determinant(const double a[9])
{
    return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}

static void invert(const double a[9], double to[9])
{
    double d = determinant(a);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
            to[3 * i + j] = (a[3 * p + r] * a[3 * q + s] - a[3 * p + s] * a[3 * q + r]) / d;
        }
}

/* The slope of node n's shape function at the centre along each axis of the reference element. */
static void slopes(int n, int corners, double slope[3])
{
    for (int a = 0; a < 3; a++)
        if (corners == 8)
            slope[a] = lattice_vtk[n][a] - .5;
        else
            slope[a] = n == 0 ? -1 : n == a + 1;
}

int gradient_of(const int32_t *node, int corners, const double *rest, const double *u, double h[9])
{
    double place[9] = {0}, moved[9] = {0}, back[9];
    for (int n = 0; n < corners; n++) {
        double slope[3];
        slopes(n, corners, slope);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                place[3 * i + j] += rest[3 * (int64_t)node[n] + i] * slope[j] / (corners == 8 ? 4 : 1);
                moved[3 * i + j] += u[3 * (int64_t)node[n] + i] * slope[j] / (corners == 8 ? 4 : 1);
            }
    }
    int whole = determinant(place) != 0;
    if (whole)
        invert(place, back);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            h[3 * i + j] = whole ? 0 : (double)NAN;
            for (int k = 0; k < 3 && whole; k++)
                h[3 * i + j] += moved[3 * i + k] * back[3 * k + j];
        }
    return whole;
}

void gradient_strain(const double h[9], double strain[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double square = 0;
            for (int k = 0; k < 3; k++)
                square += h[3 * k + i] * h[3 * k + j];
            strain[3 * i + j] = (h[3 * i + j] + h[3 * j + i] + square) / 2;
        }
}

double gradient_mises(const double t[9])
{
    double x = t[0] - t[4], y = t[4] - t[8], z = t[8] - t[0];
    return sqrt((x * x + y * y + z * z) / 2 + 3 * (t[1] * t[1] + t[5] * t[5] + t[2] * t[2]));
}

/* By the angle of the deviator: m + 2 q cos(phi / 3), phi from its determinant; the others a third of a turn on. */
void gradient_principal(const double t[9], double to[3])
{
    const double third = acos(-.5);
    double m = (t[0] + t[4] + t[8]) / 3, q = gradient_mises(t) / 3, d[9];
    for (int i = 0; i < 3; i++)
        to[i] = m + q;
    if (!(q > 0))
        return;
    for (int i = 0; i < 9; i++)
        d[i] = (t[i] - (i % 4 ? 0 : m)) / q;
    double c = fmin(fmax(determinant(d) / 2, -1), 1);
    to[0] = m + 2 * q * cos(acos(c) / 3);
    to[2] = m + 2 * q * cos(acos(c) / 3 + third);
    to[1] = 3 * m - to[0] - to[2];
}

double gradient_largest(const double t[9])
{
    double principal[3];
    gradient_principal(t, principal);
    return principal[0];
}
