/* The largest eigenvalue of a box's stiffness over its mass, by differences of its forces. For tests of stable steps:
 * shares no code with them. */
#ifndef SINEW_BOX_SQUARE_H
#define SINEW_BOX_SQUARE_H

#include "physics/element.h"

#include <math.h>

enum { BOX_FREEDOMS = 24 };

static inline double *box_component(element_field *f, int corner, int axis)
{
    return axis == 0 ? &f->x.at[corner] : axis == 1 ? &f->y.at[corner] : &f->z.at[corner];
}

/* Of a symmetric matrix, by Jacobi's rotations. */
static inline double box_largest(double a[BOX_FREEDOMS][BOX_FREEDOMS])
{
    for (int sweep = 0; sweep < 12; sweep++)
        for (int p = 0; p < BOX_FREEDOMS; p++)
            for (int q = p + 1; q < BOX_FREEDOMS; q++) {
                if (a[p][q] == 0)
                    continue;
                const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const double t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1));
                const double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < BOX_FREEDOMS; k++) {
                    const double x = a[k][p], y = a[k][q];
                    a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
                }
                for (int k = 0; k < BOX_FREEDOMS; k++) {
                    const double x = a[p][k], y = a[q][k];
                    a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
                }
            }
    double most = 0;
    for (int i = 0; i < BOX_FREEDOMS; i++)
        most = fmax(most, a[i][i]);
    return most;
}

/* At u, of corners that each have this mass (kg). step: of the differences, m. */
static inline double box_square(element_field (*forces)(const void *of, element_field u), const void *of,
                                element_field u, double step, double mass)
{
    static double k[BOX_FREEDOMS][BOX_FREEDOMS];
    for (int i = 0; i < BOX_FREEDOMS; i++) {
        element_field high = u, low = u;
        *box_component(&high, i / 3, i % 3) += step;
        *box_component(&low, i / 3, i % 3) -= step;
        element_field a = forces(of, high), b = forces(of, low);
        for (int j = 0; j < BOX_FREEDOMS; j++)
            k[j][i] = (*box_component(&a, j / 3, j % 3) - *box_component(&b, j / 3, j % 3)) / (2 * step * mass);
    }
    for (int i = 0; i < BOX_FREEDOMS; i++)
        for (int j = 0; j < i; j++)
            k[i][j] = k[j][i] = (k[i][j] + k[j][i]) / 2;
    return box_largest(k);
}

#endif
