/* The maths of the stable step (step.h says how it is found), for any back end: the 9 x 9 matrix of one element, and whether
 * its eigenvalues are below a limit. In double: `real` must not be float. Owns nothing.
 */
#ifndef SINEW_STABILITY_H
#define SINEW_STABILITY_H

#include "mesh/element.h"

#ifdef ELEMENT_SINGLE
#error "stability.h is in double"
#endif

typedef struct step_matrix {
    double at[9][9]; /* symmetric; 1/s2; row 3 k + j: component k, axis j */
} step_matrix;

/* d^2 det F / dF dF: cof(F)' along dF, as a 9 x 9 matrix: eps_kln eps_jmo F_no. */
ELEMENT_FUNCTION double stability_cofactor_slope(const double f[3][3], int k, int j, int l, int m)
{
    if (k == l || j == m)
        return 0;
    int n = 3 - k - l, o = 3 - j - m;
    int sign_row = (l - k + 3) % 3 == 1 ? 1 : -1, sign_column = (m - j + 3) % 3 == 1 ? 1 : -1;
    return sign_row * sign_column * f[n][o];
}

/* A = dP/dF of the neo-Hookean law. With G = cof F, J = det F, a = mu J^-2/3, I1 = F:F:
 *     P = a F + p G,   p = K (J - 1) - a I1 / (3 J),
 *     A = a I + (K + 5/9 a I1 / J^2) G (x) G - 2/3 (a/J) (F (x) G + G (x) F) + p dG/dF. */
ELEMENT_FUNCTION void stability_add_law(double mu, double k, element_tensor h, double a[9][9])
{
    element_tensor g = element_cofactor(h);
    const double f[3][3] = {{1 + h.xx, h.xy, h.xz}, {h.yx, 1 + h.yy, h.yz}, {h.zx, h.zy, 1 + h.zz}};
    const double fs[9] = {f[0][0], f[0][1], f[0][2], f[1][0], f[1][1], f[1][2], f[2][0], f[2][1], f[2][2]};
    const double gs[9] = {g.xx, g.xy, g.xz, g.yx, g.yy, g.yz, g.zx, g.zy, g.zz};
    double dilation = element_dilation(h), volume = 1 + dilation;
    double root = element_cube_root_inverse(volume), shear = mu * root * root, trace = 0;
    for (int i = 0; i < 9; i++)
        trace += fs[i] * fs[i];
    double pressure = k * dilation - shear * trace / (3 * volume);
    double bulk = k + 5. / 9 * shear * trace / (volume * volume), mixed = 2. / 3 * shear / volume;
    for (int r = 0; r < 9; r++)
        for (int c = 0; c <= r; c++)
            a[r][c] = bulk * gs[r] * gs[c] - mixed * (fs[r] * gs[c] + gs[r] * fs[c]) +
                      pressure * stability_cofactor_slope(f, r / 3, r % 3, c / 3, c % 3) + (r == c ? shear : 0);
}

/* Of the active stress: with m = F a0, l = |m| and t(l) = a s f(l)/l, P = t m (x) a0, so
 *     A = t I (x) a0 a0 + (t'/l) (m (x) a0) (x) (m (x) a0). */
ELEMENT_FUNCTION void stability_add_active(element_tensor h, element_fibre fibre, double a[9][9])
{
    element_vector now = element_fibre_now(h, fibre.along);
    const double along[3] = {fibre.along.x, fibre.along.y, fibre.along.z}, m[3] = {now.x, now.y, now.z};
    double l = element_length(now);
    if (!(l > 0))
        return;
    double t = fibre.tension * element_force_length(l) / l;
    double slope = (fibre.tension * element_force_length_slope(l) - t) / (l * l);
    for (int r = 0; r < 9; r++)
        for (int c = 0; c <= r; c++)
            a[r][c] += (r / 3 == c / 3 ? t * along[r % 3] * along[c % 3] : 0) +
                       slope * m[r / 3] * along[r % 3] * m[c / 3] * along[c % 3];
}

/* (4/rho) A_kjlm / (h_j h_m) of an element at H, with its fibre and that of a second volume in it; density: kg/m3; side: m. */
ELEMENT_FUNCTION void stability_matrix(double mu, double k, double density, const double side[3], element_tensor h,
                                       element_fibre fibre, element_fibre second, step_matrix *a)
{
    stability_add_law(mu, k, h, a->at);
    if (fibre.tension != 0)
        stability_add_active(h, fibre, a->at);
    if (second.tension != 0)
        stability_add_active(h, second, a->at);
    for (int r = 0; r < 9; r++)
        for (int c = 0; c <= r; c++)
            a->at[c][r] = a->at[r][c] *= 4 / (density * side[r % 3] * side[c % 3]);
}

/* limit I - A = L D L^T: it is positive definite exactly where all of D is positive. */
ELEMENT_FUNCTION int stability_below(const step_matrix *a, double limit)
{
    double l[9][9], inverse[9] = {0}, scaled[9]; /* scaled: a row of L D */
    for (int j = 0; j < 9; j++) {
        double d = limit - a->at[j][j];
        for (int i = 0; i < j; i++) {
            scaled[i] = -a->at[j][i];
            for (int k = 0; k < i; k++)
                scaled[i] -= scaled[k] * l[i][k];
            l[j][i] = scaled[i] * inverse[i];
            d -= scaled[i] * l[j][i];
        }
        if (!(d > 0))
            return 0;
        inverse[j] = 1 / d;
    }
    return 1;
}

/* No eigenvalue is past the largest sum of a row. */
ELEMENT_FUNCTION double stability_bound(const step_matrix *a)
{
    double high = 0;
    for (int r = 0; r < 9; r++) {
        double sum = 0;
        for (int c = 0; c < 9; c++)
            sum += fabs(a->at[r][c]);
        high = fmax(high, sum);
    }
    return high;
}

/* The largest eigenvalue to 1e-13, if that is positive; else 0. */
ELEMENT_FUNCTION double stability_largest(const step_matrix *a)
{
    double low = 0, high = stability_bound(a);
    for (int i = 0; i < 100 && high - low > 1e-13 * high; i++) {
        double middle = low + (high - low) / 2;
        if (stability_below(a, middle))
            high = middle;
        else
            low = middle;
    }
    return high;
}

#endif
