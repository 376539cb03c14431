/* The Mooney-Rivlin form, W = c10 (I1bar - 3) + c01 (I2bar - 3) + K/2 (J - 1)^2, where I1bar = J^-2/3 I1 and
 * I2bar = J^-4/3 I2 are of C = F^T F. Coefficients: c10, c01, K (Pa); c01 >= 0. At rest mu = 2 (c10 + c01). (Rivlin &
 * Saunders 1951, with the volumetric energy of the neo-Hookean form.) Owns nothing.
 */
#ifndef SINEW_FORM_MOONEY_RIVLIN_H
#define SINEW_FORM_MOONEY_RIVLIN_H

#include "physics/form_shear.h"
#include "physics/forms.h"
#include "physics/tangent.h"

enum { FORM_MOONEY_RIVLIN_STIFFENS = 0 };

/* With E = C - I and r = J^-1/3, as I1 C - C^2 = (1 + tr E) E - E^2 + a multiple of I:
 *     P = cof F (dev M + K (J - 1) I),   M = 2 c10 r^5 E + 2 c01 r^7 ((1 + tr E) E - E^2),
 * which takes no difference of nearly equal numbers, so that float keeps small strains. */
ELEMENT_FUNCTION element_tensor form_mooney_rivlin_stress(element_tensor h, const real *c)
{
    element_symmetric e = element_green(h);
    real dilation = element_dilation(h);
    real root = element_cube_root_inverse(1 + dilation);
    real square = root * root, fifth = square * square * root;
    real second = 2 * c[1] * (fifth * square);
    real scale = 2 * c[0] * fifth + second * (1 + (e.xx + e.yy + e.zz));
    real mxx = scale * e.xx - second * (e.xx * e.xx + e.xy * e.xy + e.zx * e.zx);
    real myy = scale * e.yy - second * (e.xy * e.xy + e.yy * e.yy + e.yz * e.yz);
    real mzz = scale * e.zz - second * (e.zx * e.zx + e.yz * e.yz + e.zz * e.zz);
    real pressure = c[2] * dilation - (mxx + myy + mzz) * R(1. / 3);
    element_symmetric s = {mxx + pressure,
                           myy + pressure,
                           mzz + pressure,
                           scale * e.xy - second * (e.xx * e.xy + e.xy * e.yy + e.zx * e.yz),
                           scale * e.yz - second * (e.xy * e.zx + e.yy * e.yz + e.yz * e.zz),
                           scale * e.zx - second * (e.xx * e.zx + e.xy * e.yz + e.zx * e.zz)};
    return element_times(element_cofactor(h), s);
}

/* By volume at rest (J/m3). With r = J^-1/3:
 *     I2bar - 3 = 3 (r^4 - 1) + r^4 (2 tr E + II),   II = (tr^2 E - E:E) / 2. */
ELEMENT_FUNCTION real form_mooney_rivlin_energy(element_tensor h, const real *c)
{
    element_symmetric e = element_green(h);
    real dilation = element_dilation(h);
    real root = element_cube_root_inverse(1 + dilation);
    real square = root * root, trace = e.xx + e.yy + e.zz;
    real less = element_square_less(dilation, root);
    real second = (e.xx * e.yy - e.xy * e.xy) + (e.yy * e.zz - e.yz * e.yz) + (e.zz * e.xx - e.zx * e.zx);
    real first_bar = element_first_bar(dilation, root, trace);
    real second_bar = 3 * less * (square + 1) + square * square * (2 * trace + second);
    return c[0] * first_bar + c[1] * second_bar + c[2] / 2 * dilation * dilation;
}

/* In simple shear I2bar is I1bar. */
ELEMENT_FUNCTION form_shear form_mooney_rivlin_sheared(real x, const real *c)
{
    const form_shear s = {c[0] + c[1], c[0] + c[1], REAL_ZERO};
    (void)x;
    return s;
}

#ifdef REAL_IS_DOUBLE
ELEMENT_FUNCTION double form_mooney_rivlin_sheared_curve(double x, const double *c)
{
    (void)x, (void)c;
    return 0;
}

/* A = dP/dF. With G = cof F, N = I1 F - F C, a = 2 c10 J^-2/3, b = 2 c01 J^-4/3:
 *     P = a F + b N + p G,   p = K (J - 1) - (a I1 + 2 b I2) / (3 J),
 *     A = a I + b dN/dF + (K + (5 a I1 + 14 b I2) / (9 J^2)) G (x) G - 2/3 (a/J) (F (x) G + G (x) F)
 *         - 4/3 (b/J) (N (x) G + G (x) N) + p dG/dF,
 *     dN/dF along y: 2 (F:y) F + I1 y - y C - F y^T F - F F^T y. */
typedef struct form_mooney_rivlin_terms {
    double shear, second, bulk, mixed, mixed_second, pressure; /* of A, in order; those mixed are taken off */
    double first_invariant, second_invariant;                  /* I1, I2 */
} form_mooney_rivlin_terms;

ELEMENT_FUNCTION form_mooney_rivlin_terms form_mooney_rivlin_terms_at(element_tensor h, const double *c)
{
    const element_tensor g = element_cofactor(h);
    const double dilation = element_dilation(h), volume = 1 + dilation, inverse = 1 / volume;
    const double root = element_cube_root_inverse(volume), square = root * root;
    const double a = 2 * c[0] * square, b = 2 * c[1] * square * square;
    const double one = 3 + element_green_trace(h), two = tangent_dot(g, g);
    const form_mooney_rivlin_terms t = {a,
                                        b,
                                        c[2] + (5 * a * one + 14 * b * two) / 9 * inverse * inverse,
                                        2. / 3 * a * inverse,
                                        4. / 3 * b * inverse,
                                        c[2] * dilation - (a * one + 2 * b * two) / 3 * inverse,
                                        one,
                                        two};
    return t;
}

/* What dN/dF takes off I1 I along y, but for its multiple of F:
 *     y C + F y^T F + F F^T y = (y F^T + F y^T) F + F (F^T y). */
ELEMENT_FUNCTION element_tensor form_mooney_rivlin_less(element_tensor f, element_tensor y)
{
    const element_tensor turned = tangent_transposed(f);
    const element_tensor both = element_product(y, turned), across = tangent_transposed(both);
    const element_tensor sum = element_sum(both, across);
    return element_sum(element_product(sum, f), element_product(f, element_product(turned, y)));
}

/* The lower triangle of A. */
ELEMENT_FUNCTION void form_mooney_rivlin_tangent(element_tensor h, const double *c, double a[9][9])
{
    const form_mooney_rivlin_terms t = form_mooney_rivlin_terms_at(h, c);
    const element_tensor g = element_cofactor(h), moved = tangent_moved(h), turned = tangent_transposed(moved);
    const element_tensor right = element_product(turned, moved), left = element_product(moved, turned);
    element_tensor n = {0, 0, 0, 0, 0, 0, 0, 0, 0};
    tangent_add(&n, t.first_invariant, moved);
    tangent_add(&n, -1, element_product(moved, right));
    const double f[3][3] = {
        {moved.xx, moved.xy, moved.xz}, {moved.yx, moved.yy, moved.yz}, {moved.zx, moved.zy, moved.zz}};
    const double cs[3][3] = {
        {right.xx, right.xy, right.xz}, {right.yx, right.yy, right.yz}, {right.zx, right.zy, right.zz}};
    const double bs[3][3] = {{left.xx, left.xy, left.xz}, {left.yx, left.yy, left.yz}, {left.zx, left.zy, left.zz}};
    const double gs[9] = {g.xx, g.xy, g.xz, g.yx, g.yy, g.yz, g.zx, g.zy, g.zz};
    const double ns[9] = {n.xx, n.xy, n.xz, n.yx, n.yy, n.yz, n.zx, n.zy, n.zz};
    for (int r = 0; r < 9; r++)
        for (int s = 0; s <= r; s++) {
            const int k = r / 3, j = r % 3, l = s / 3, m = s % 3;
            const double slope = 2 * f[k][j] * f[l][m] + (r == s ? t.first_invariant : 0) - (k == l ? cs[m][j] : 0) -
                                 f[k][m] * f[l][j] - (j == m ? bs[k][l] : 0);
            a[r][s] = t.bulk * gs[r] * gs[s] - t.mixed * (f[k][j] * gs[s] + gs[r] * f[l][m]) -
                      t.mixed_second * (ns[r] * gs[s] + gs[r] * ns[s]) + t.second * slope +
                      t.pressure * tangent_cofactor_slope(f, k, j, l, m) + (r == s ? t.shear : 0);
        }
}

/* Adds A y to *to; square: G:y. Returns no less than z:(A z) of any z of length 1 with G:z = 0. There the
 * terms that have G vanish. Of the others, with s the largest stretch,
 *     z:(dG/dF z) = 2 F:cof z <= 2 s,
 *     z:(dN/dF z) = 2 (F:z)^2 + I1 - |F z^T|^2 - |F^T z + z^T F|^2 / 2 <= 2 (F:z)^2 + min(I1, 2 s^2),
 * as |F z^T|^2 is at least the square of the least stretch, which leaves two of the three in I1; and as G:z = 0,
 * (F:z)^2 <= I1 - 9 J^2 / I2 (tangent_across). So what is left is at most
 *     a + b (2 (I1 - 9 J^2 / I2) + min(I1, 2 s^2)) + 2 |p| s.
 * Of b below 0, which the general form may have, dN/dF counts from below: |F z^T| is at most s, |F^T z + z^T F| 2 s, so
 *     a + |b| (3 s^2 - I1) + 2 |p| s. */
ELEMENT_FUNCTION double form_mooney_rivlin_along(element_tensor h, const double *c, element_tensor y, double square,
                                                 element_tensor *to)
{
    const form_mooney_rivlin_terms t = form_mooney_rivlin_terms_at(h, c);
    const element_tensor g = element_cofactor(h), f = tangent_moved(h);
    const double along = tangent_dot(f, y), stretch = tangent_stretch(h), volume = 1 + element_dilation(h);
    element_tensor n = {0, 0, 0, 0, 0, 0, 0, 0, 0};
    tangent_add(&n, t.first_invariant, f);
    tangent_add(&n, -1, element_product(f, element_product(tangent_transposed(f), f)));
    tangent_add(to, t.shear + t.second * t.first_invariant, y);
    tangent_add(to, -t.second, form_mooney_rivlin_less(f, y));
    tangent_add(to, t.bulk * square - t.mixed * along - t.mixed_second * tangent_dot(n, y), g);
    tangent_add(to, 2 * t.second * along - t.mixed * square, f);
    tangent_add(to, -t.mixed_second * square, n);
    tangent_add(to, t.pressure, tangent_cofactor_along(h, y));
    const double apart = tangent_across(t.first_invariant, t.second_invariant, volume);
    const double twice = fmin(t.first_invariant, 2 * stretch * stretch);
    const double slope = t.second < 0 ? t.first_invariant - 3 * stretch * stretch : 2 * apart + twice;
    return fmax(t.shear, 0.) + t.second * slope + 2 * fabs(t.pressure) * stretch;
}

/* Neo-Hookean: c01 is 0. */
static inline int form_mooney_rivlin_express(form from, const double *c, double *to)
{
    if (from != FORM_NEO_HOOKEAN)
        return 0;
    to[0] = c[0] / 2;
    to[1] = 0;
    to[2] = c[1];
    return 1;
}

/* The part that c01 has of mu goes by shares. */
static inline void form_mooney_rivlin_between(double mu, double bulk, const double *a, const double *b, double share,
                                              double *to)
{
    const double part = (1 - share) * (a[1] / (a[0] + a[1])) + share * (b[1] / (b[0] + b[1]));
    to[0] = (1 - part) * (mu / 2);
    to[1] = part * (mu / 2);
    to[2] = bulk;
}
#endif

#endif
