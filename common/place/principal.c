#include "place/principal.h"

#include <math.h>

/* One Jacobi rotation: makes c[p][q] zero, and turns the columns of v along. */
static void rotate(double c[3][3], double v[3][3], int p, int q)
{
    if (c[p][q] == 0)
        return;
    double theta = (c[q][q] - c[p][p]) / (2 * c[p][q]);
    double t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1));
    double cosine = 1 / sqrt(t * t + 1), sine = t * cosine;
    for (int k = 0; k < 3; k++) {
        double cp = c[k][p], cq = c[k][q], vp = v[k][p], vq = v[k][q];
        c[k][p] = cosine * cp - sine * cq;
        c[k][q] = sine * cp + cosine * cq;
        v[k][p] = cosine * vp - sine * vq;
        v[k][q] = sine * vp + cosine * vq;
    }
    for (int k = 0; k < 3; k++) {
        double cp = c[p][k], cq = c[q][k];
        c[p][k] = cosine * cp - sine * cq;
        c[q][k] = sine * cp + cosine * cq;
    }
}

void principal_axes(double c[3][3], double v[3][3])
{
    for (int i = 0; i < 9; i++)
        v[i / 3][i % 3] = i / 3 == i % 3;
    for (int sweep = 0; sweep < 20; sweep++) { /* converges in 4 or 5 */
        rotate(c, v, 0, 1);
        rotate(c, v, 0, 2);
        rotate(c, v, 1, 2);
    }
}

int principal_largest(double c[3][3])
{
    int at = 0;
    for (int a = 1; a < 3; a++)
        if (c[a][a] > c[at][at])
            at = a;
    return at;
}

int principal_smallest(double c[3][3])
{
    int at = 0;
    for (int a = 1; a < 3; a++)
        if (c[a][a] < c[at][at])
            at = a;
    return at;
}
