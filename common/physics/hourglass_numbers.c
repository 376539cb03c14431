#include "physics/hourglass_numbers.h"

#include "physics/hourglass.h"

#include <string.h>

/* The form of plane stress in the plane of two basis vectors, in strains e_ii, e_kk, 2 e_ik along them: with p, q, r
 * the inverse of their products, lambda tr^2 + 2 mu tr((A e)^2), A = (p r, r q), and lambda = nu E/(1 - nu^2). */
static void plane_form(const double i[3], const double k[3], double mu, double bulk, double by, double *to)
{
    const double ii = i[0] * i[0] + i[1] * i[1] + i[2] * i[2], kk = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
    const double ik = i[0] * k[0] + i[1] * k[1] + i[2] * k[2], area = ii * kk - ik * ik;
    const double p = kk / area, q = ii / area, r = -ik / area, lambda = hourglass_plate_coupling(mu, bulk);
    to[0] = by * (lambda + 2 * mu) * p * p;
    to[1] = by * (lambda * p * q + 2 * mu * r * r);
    to[2] = by * (lambda + 2 * mu) * q * q;
    to[3] = by * (lambda + 2 * mu) * p * r;
    to[4] = by * (lambda + 2 * mu) * q * r;
    to[5] = by * (lambda * r * r + mu * (r * r + p * q));
}

void hourglass_forms(double mu, double bulk, double volume, const double basis[9], double to[HOURGLASS_FORM])
{
    double g[3][3]; /* g[c]: column c */
    for (int i = 0; i < 9; i++)
        g[i % 3][i / 3] = basis[i];
    for (int a = 0; a < 3; a++) {
        const double square = g[a][0] * g[a][0] + g[a][1] * g[a][1] + g[a][2] * g[a][2];
        plane_form(g[(a + 1) % 3], g[(a + 2) % 3], mu, bulk, volume / 3 / 64, to + HOURGLASS_PLANE * a);
        to[3 * HOURGLASS_PLANE + a] = volume / 9 / 64 * hourglass_young(mu, bulk) / (square * square);
    }
}

/* The columns' lengths; returns the largest sum of a row of their cosines. */
static double lengths_of(const double basis[9], double length[3])
{
    double most = 0;
    for (int a = 0; a < 3; a++)
        length[a] = sqrt(basis[a] * basis[a] + basis[3 + a] * basis[3 + a] + basis[6 + a] * basis[6 + a]);
    for (int a = 0; a < 3; a++) {
        double sum = 0;
        for (int b = 0; b < 3; b++)
            sum += fabs(basis[a] * basis[b] + basis[3 + a] * basis[3 + b] + basis[6 + a] * basis[6 + b]) /
                   (length[a] * length[b]);
        most = fmax(most, sum);
    }
    return most;
}

/* With r = J^T q = S C q, S the columns' lengths, C their directions: |S D S| |C C^T|, both by sums of rows. */
double hourglass_forms_stiffest(const double hold[HOURGLASS_FORM], const double basis[9])
{
    double length[3], most = 0;
    const double cosines = lengths_of(basis, length);
    for (int i = 0; i < 12; i++) {
        hourglass_modes unit;
        double one[12] = {0}, column[12], sum = 0;
        one[i] = 1;
        memcpy(&unit, one, sizeof unit);
        const hourglass_modes t = hourglass_hexahedron(&unit, hold, 1);
        memcpy(column, &t, sizeof column);
        for (int k = 0; k < 12; k++)
            sum += fabs(column[k]) * length[k % 3] * length[i % 3];
        most = fmax(most, sum);
    }
    return most * cosines;
}
