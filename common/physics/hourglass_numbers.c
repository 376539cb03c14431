#include "physics/hourglass_numbers.h"

#include "physics/hourglass.h"

#include <stdbool.h>
#include <string.h>

enum { MODES = 12 }; /* by their components */

/* R m, or R^T m. */
static void by_root(const double root[16], bool transposed, const double m[MODES], double to[MODES])
{
    for (int i = 0; i < MODES; i++) {
        to[i] = 0;
        for (int g = 0; g < 4; g++)
            to[i] += root[transposed ? 4 * g + i / 3 : 4 * (i / 3) + g] * m[3 * g + i % 3];
    }
}

/* R^T D R, a column at a time. */
static void stiffness(const double law[HOURGLASS_NUMBERS], double volume, const double basis[9], const double root[16],
                      double to[MODES][MODES])
{
    const element_tensor j = element_tensor_of(basis);
    for (int i = 0; i < MODES; i++) {
        double one[MODES] = {0}, m[MODES];
        hourglass_modes q;
        one[i] = 1;
        by_root(root, false, one, m);
        memcpy(&q, m, sizeof q);
        const hourglass_modes w = hourglass_all_by_columns(j, q), t = hourglass_hexahedron(&w, j, law, volume / 64);
        const hourglass_modes f = hourglass_all_by_rows(j, t);
        memcpy(m, &f, sizeof m);
        by_root(root, true, m, to[i]);
    }
}

/* The largest sum of a row. */
static double row_norm(double a[MODES][MODES])
{
    double most = 0;
    for (int r = 0; r < MODES; r++) {
        double sum = 0;
        for (int c = 0; c < MODES; c++)
            sum += fabs(a[r][c]);
        most = fmax(most, sum);
    }
    return most;
}

/* (a/by)^2. */
static void square(double a[MODES][MODES], double by)
{
    double b[MODES][MODES] = {{0}};
    for (int i = 0; i < MODES * MODES; i++)
        a[i / MODES][i % MODES] /= by;
    for (int r = 0; r < MODES; r++)
        for (int k = 0; k < MODES; k++)
            for (int c = 0; c < MODES; c++)
                b[r][c] += a[r][k] * a[k][c];
    memcpy(a, b, sizeof b);
}

/* The largest eigenvalue l of a symmetric matrix A of n rows has l^p <= |A^p| <= sqrt(n) l^p, | | the largest sum of a
 * row: with p = 64 the root of this norm is at most 12^(1/128) = 1.0196 times l. Each square is of A by its norm, which
 * leaves room for rounding: l is at least .28 then. */
double hourglass_any_stiffest(const double law[HOURGLASS_NUMBERS], double volume, const double basis[9],
                              const double root[16])
{
    double a[MODES][MODES], power = 1;
    stiffness(law, volume, basis, root, a);
    double norm = row_norm(a), most = norm;
    for (int i = 0; i < 6 && norm > 0; i++) {
        square(a, norm);
        norm = row_norm(a);
        power /= 2;
        most *= pow(norm, power);
    }
    return most * (1 + 1e-12);
}
