/* The kinds of hourglass control, and what they take of a law: numbers that follow from mu and K at rest, in double.
 * hourglass.h has the energies. Owns nothing.
 */
#ifndef SINEW_HOURGLASS_NUMBERS_H
#define SINEW_HOURGLASS_NUMBERS_H

#include <math.h>

typedef enum hourglass_kind { HOURGLASS_PHYSICAL, HOURGLASS_ISOTROPIC, HOURGLASS_KINDS } hourglass_kind;

/* What a run takes: of isotropic control kappa, of physical control nothing. */
typedef struct hourglass_control {
    hourglass_kind kind;
    double kappa;
} hourglass_control;

/* Of a law, by kind: E/(1 - nu^2)/3, nu times that, mu/3, E/9 (Pa); or k (N/m), and nothing else. */
enum { HOURGLASS_BENDING, HOURGLASS_COUPLING, HOURGLASS_TORSION, HOURGLASS_CORNER, HOURGLASS_NUMBERS };
enum { HOURGLASS_K = HOURGLASS_BENDING };

/* kappa 11 mu V sum(B^2) / 8, N/m: the sum over all corners and axes. 11 mu is lambda + 2 mu at nu = .45. */
static inline double hourglass_stiffness(double kappa, double mu, double volume, double squares)
{
    return kappa * 11 * mu * volume * squares / 8;
}

/* sum(B^2) of a box, 1/m2. */
static inline double hourglass_squares(const double side[3])
{
    return (1 / (side[0] * side[0]) + 1 / (side[1] * side[1]) + 1 / (side[2] * side[2])) / 2;
}

/* E/(1 - nu^2) and nu times that, Pa, from mu and K: plane stress. */
static inline double hourglass_plate(double mu, double bulk)
{
    return 4 * mu * (bulk + mu / 3) / (bulk + 4 * mu / 3);
}

static inline double hourglass_plate_coupling(double mu, double bulk)
{
    return hourglass_plate(mu, bulk) - 2 * mu;
}

static inline double hourglass_young(double mu, double bulk)
{
    return 9 * bulk * mu / (3 * bulk + mu);
}

/* The four numbers of physical control. */
static inline void hourglass_moduli(double mu, double bulk, double to[HOURGLASS_NUMBERS])
{
    to[HOURGLASS_BENDING] = hourglass_plate(mu, bulk) / 3;
    to[HOURGLASS_COUPLING] = hourglass_plate_coupling(mu, bulk) / 3;
    to[HOURGLASS_TORSION] = mu / 3;
    to[HOURGLASS_CORNER] = hourglass_young(mu, bulk) / 9;
}

/* Of a box, by the control. */
static inline void hourglass_numbers(hourglass_control control, double mu, double bulk, const double side[3],
                                     double to[HOURGLASS_NUMBERS])
{
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        to[i] = 0;
    if (control.kind == HOURGLASS_PHYSICAL)
        hourglass_moduli(mu, bulk, to);
    else
        to[HOURGLASS_K] = hourglass_stiffness(control.kappa, mu, side[0] * side[1] * side[2], hourglass_squares(side));
}

/* The largest eigenvalue of (p r, r q). */
static inline double hourglass_larger(double p, double q, double r)
{
    return (p + q) / 2 + sqrt((p - q) * (p - q) / 4 + r * r);
}

/* No less than the largest eigenvalue of d2W/dq dq of a box, N/m, exact for a cube: of the pairs that bend, of the
 * three that shear by the sums of their rows, of xyz. */
static inline double hourglass_stiffest(hourglass_kind kind, const double to[HOURGLASS_NUMBERS], const double side[3])
{
    const double volume = side[0] * side[1] * side[2];
    double most = 0, l[3];
    if (kind == HOURGLASS_ISOTROPIC)
        return to[HOURGLASS_K];
    for (int a = 0; a < 3; a++)
        l[a] = 1 / (4 * side[a]);
    for (int a = 0; a < 3; a++) {
        const double i = l[(a + 1) % 3], k = l[(a + 2) % 3];
        const double bends = hourglass_larger(to[HOURGLASS_BENDING] * i * i, to[HOURGLASS_BENDING] * k * k,
                                              to[HOURGLASS_COUPLING] * i * k);
        const double turns = to[HOURGLASS_TORSION] * (i * i + k * k + l[a] * i + l[a] * k);
        const double corner = to[HOURGLASS_CORNER] * l[a] * l[a];
        most = fmax(most, fmax(bends, fmax(turns, corner)));
    }
    return volume * most;
}

/* ---- of hexahedra of any shape */

/* No less than the largest eigenvalue of R^T D R, N/m, and at most 2 % more; of a box it is that. D: d2W/dq dq, of
 * physical control's four numbers; basis: dX/dxi at the centre, m, a column an axis; root: R, 4 x 4, a row a mode,
 * lower. */
double hourglass_any_stiffest(const double law[HOURGLASS_NUMBERS], double volume, const double basis[9],
                              const double root[16]);

#endif
