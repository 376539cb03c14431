/* The form of the first invariant, W = f(x) + K/2 (J - 1)^2, x = I1bar - 3 = J^-2/3 tr C - 3, f(x) = c1 x + c2 x^2 +
 * ... + c5 x^5. Coefficients: c1 to c5, K (Pa). At rest mu = 2 c1. It is the neo-Hookean form with 2 f'(x) in place of
 * mu, besides f'' in the tangent. Owns nothing.
 */
#ifndef SINEW_FORM_FIRST_H
#define SINEW_FORM_FIRST_H

#include "physics/form_neo_hookean.h"

enum { FORM_FIRST_POWERS = 5, FORM_FIRST_STIFFENS = 1 };

/* f'(x), by Horner's scheme. */
ELEMENT_FUNCTION real form_first_slope(real x, const real *c)
{
    return c[0] + x * (2 * c[1] + x * (3 * c[2] + x * (4 * c[3] + x * (5 * c[4]))));
}

ELEMENT_FUNCTION real form_first_x(element_tensor h)
{
    element_symmetric e = element_green(h);
    real dilation = element_dilation(h);
    return element_first_bar(dilation, element_cube_root_inverse(1 + dilation), e.xx + e.yy + e.zz);
}

/* P = cof F (2 f'(x) J^-5/3 dev(C - I) + K (J - 1) I); x without a difference of nearly equal numbers. */
ELEMENT_FUNCTION element_tensor form_first_stress(element_tensor h, const real *c)
{
    const real now[] = {2 * form_first_slope(form_first_x(h), c), c[5]};
    return form_neo_hookean_stress(h, now);
}

/* By volume at rest (J/m3). */
ELEMENT_FUNCTION real form_first_energy(element_tensor h, const real *c)
{
    real x = form_first_x(h), dilation = element_dilation(h);
    return x * (c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * c[4])))) + c[5] / 2 * dilation * dilation;
}

/* The stress is 2 f'(g^2) g, so T = f' + 2 x f'' = sum of k (2 k - 1) c_k x^(k - 1). */
ELEMENT_FUNCTION form_shear form_first_sheared(real x, const real *c)
{
    const form_shear s = {c[0], c[0] + x * (6 * c[1] + x * (15 * c[2] + x * (28 * c[3] + x * (45 * c[4])))),
                          6 * c[1] + x * (30 * c[2] + x * (84 * c[3] + x * (180 * c[4])))};
    return s;
}

/* Adds to f': to the coefficient of x. */
ELEMENT_FUNCTION void form_first_add(real *c, real slope)
{
    c[0] += slope;
}

#ifdef REAL_IS_DOUBLE
ELEMENT_FUNCTION double form_first_sheared_curve(double x, const double *c)
{
    return 30 * c[2] + x * (168 * c[3] + x * (540 * c[4]));
}

/* Adds to f' and f'' at x. */
ELEMENT_FUNCTION void form_first_add_at(double *c, double x, double slope, double curvature)
{
    c[0] += slope - curvature * x;
    c[1] += curvature / 2;
}

ELEMENT_FUNCTION double form_first_curvature(double x, const double *c)
{
    return 2 * c[1] + x * (6 * c[2] + x * (12 * c[3] + x * (20 * c[4])));
}

/* A = dP/dF: with n = dx/dF = 2 J^-2/3 (F - I1/(3 J) G),
 *     A = (the neo-Hookean form's A with mu = 2 f'(x)) + f''(x) n (x) n.
 * most: of (n:z)^2 across G. */
ELEMENT_FUNCTION element_tensor form_first_normal(element_tensor h, double *most)
{
    const element_tensor g = element_cofactor(h);
    const double volume = 1 + element_dilation(h), root = element_cube_root_inverse(volume);
    const double one = 3 + element_green_trace(h), twice = 2 * root * root;
    element_tensor n = {0, 0, 0, 0, 0, 0, 0, 0, 0};
    *most = twice * twice * tangent_across(one, tangent_dot(g, g), volume);
    tangent_add(&n, twice, tangent_moved(h));
    tangent_add(&n, -twice * one / (3 * volume), g);
    return n;
}

/* Adds curvature n (x) n to the lower triangle. */
ELEMENT_FUNCTION void form_first_bend(element_tensor h, double curvature, double a[9][9])
{
    double most;
    const element_tensor of = form_first_normal(h, &most);
    const double n[9] = {of.xx, of.xy, of.xz, of.yx, of.yy, of.yz, of.zx, of.zy, of.zz};
    for (int r = 0; r < 9; r++)
        for (int s = 0; s <= r; s++)
            a[r][s] += curvature * n[r] * n[s];
}

/* Adds curvature n (n:y) to *to. Returns no less than curvature (n:z)^2 of any z of length 1 with G:z = 0: above 0, as
 * n:z = 2 J^-2/3 F:z,
 *     curvature (n:z)^2 <= 4 curvature J^-4/3 (I1 - 9 J^2 / I2)
 * (tangent_across); below 0 it only takes. */
ELEMENT_FUNCTION double form_first_bend_along(element_tensor h, double curvature, element_tensor y, element_tensor *to)
{
    double most;
    const element_tensor n = form_first_normal(h, &most);
    tangent_add(to, curvature * tangent_dot(n, y), n);
    return fmax(curvature, 0.) * most;
}

/* The lower triangle of A. */
ELEMENT_FUNCTION void form_first_tangent(element_tensor h, const double *c, double a[9][9])
{
    const double x = form_first_x(h), now[] = {2 * form_first_slope(x, c), c[5]};
    form_neo_hookean_tangent(h, now, a);
    form_first_bend(h, form_first_curvature(x, c), a);
}

/* Adds A y to *to; square: G:y. Returns the sum of what the parts return: the neo-Hookean form's holds whatever the
 * sign of f'. */
ELEMENT_FUNCTION double form_first_along(element_tensor h, const double *c, element_tensor y, double square,
                                         element_tensor *to)
{
    const double x = form_first_x(h), now[] = {2 * form_first_slope(x, c), c[5]};
    const double plain = form_neo_hookean_along(h, now, y, square, to);
    return plain + form_first_bend_along(h, form_first_curvature(x, c), y, to);
}

/* Neo-Hookean. */
static inline int form_first_express(form from, const double *c, double *to)
{
    if (from != FORM_NEO_HOOKEAN)
        return 0;
    to[0] = c[0] / 2;
    to[FORM_FIRST_POWERS] = c[1];
    return 1;
}

/* Each f by its own mu goes by shares. */
static inline void form_first_between(double mu, double bulk, const double *a, const double *b, double share,
                                      double *to)
{
    for (int i = 0; i < FORM_FIRST_POWERS; i++)
        to[i] = mu * ((1 - share) * (a[i] / (2 * a[0])) + share * (b[i] / (2 * b[0])));
    to[FORM_FIRST_POWERS] = bulk;
}
#endif

#endif
