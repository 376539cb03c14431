/* The neo-Hookean form, W = mu/2 (J^-2/3 tr C - 3) + K/2 (J - 1)^2. Coefficients: mu, K (Pa). Owns nothing. */
#ifndef SINEW_FORM_NEO_HOOKEAN_H
#define SINEW_FORM_NEO_HOOKEAN_H

#include "physics/form_shear.h"
#include "physics/forms.h"
#include "physics/tangent.h"

enum { FORM_NEO_HOOKEAN_STIFFENS = 0 }; /* whether T of form_shear.h is more than a constant */

/* P = F S. From S = mu J^-2/3 (I - tr C/3 C^-1) + K J (J - 1) C^-1, as I - tr C/3 C^-1 = C^-1 dev C and
 * dev C = dev(C - I):
 *     P = cof F (mu J^-5/3 dev(C - I) + K (J - 1) I),
 * which takes no difference of nearly equal numbers, so that float keeps small strains. */
ELEMENT_FUNCTION element_tensor form_neo_hookean_stress(element_tensor h, const real *c)
{
    element_symmetric e = element_green(h);
    real dilation = element_dilation(h);
    real root = element_cube_root_inverse(1 + dilation);
    real square = root * root;
    real scale = c[0] * (square * square * root);
    real pressure = c[1] * dilation - scale * ((e.xx + e.yy + e.zz) * R(1. / 3));
    element_symmetric s = {scale * e.xx + pressure,
                           scale * e.yy + pressure,
                           scale * e.zz + pressure,
                           scale * e.xy,
                           scale * e.yz,
                           scale * e.zx};
    return element_times(element_cofactor(h), s);
}

/* By volume at rest (J/m3). */
ELEMENT_FUNCTION real form_neo_hookean_energy(element_tensor h, const real *c)
{
    real dilation = element_dilation(h);
    real root = element_cube_root_inverse(1 + dilation);
    real trace = element_green_trace(h);
    return c[0] / 2 * (root * root * (3 + trace) - 3) + c[1] / 2 * dilation * dilation;
}

ELEMENT_FUNCTION form_shear form_neo_hookean_sheared(real x, const real *c)
{
    const form_shear s = {R(.5) * c[0], R(.5) * c[0], REAL_ZERO};
    (void)x;
    return s;
}

#ifdef REAL_IS_DOUBLE
/* d2T/dx2, Pa. */
ELEMENT_FUNCTION double form_neo_hookean_sheared_curve(double x, const double *c)
{
    (void)x, (void)c;
    return 0;
}

/* A = dP/dF. With G = cof F, J = det F, a = mu J^-2/3, I1 = F:F:
 *     P = a F + p G,   p = K (J - 1) - a I1 / (3 J),
 *     A = a I + (K + 5/9 a I1 / J^2) G (x) G - 2/3 (a/J) (F (x) G + G (x) F) + p dG/dF. */
typedef struct form_neo_hookean_terms {
    double shear, bulk, mixed, pressure; /* of A, in order; mixed is taken off */
} form_neo_hookean_terms;

ELEMENT_FUNCTION form_neo_hookean_terms form_neo_hookean_terms_at(element_tensor h, const double *c)
{
    const double dilation = element_dilation(h), volume = 1 + dilation;
    const double root = element_cube_root_inverse(volume), shear = c[0] * root * root, inverse = 1 / volume;
    const double trace = 3 + 2 * (h.xx + h.yy + h.zz) +
                         (h.xx * h.xx + h.xy * h.xy + h.xz * h.xz + h.yx * h.yx + h.yy * h.yy + h.yz * h.yz +
                          h.zx * h.zx + h.zy * h.zy + h.zz * h.zz);
    const form_neo_hookean_terms t = {shear, c[1] + 5. / 9 * shear * trace * inverse * inverse,
                                      2. / 3 * shear * inverse, c[1] * dilation - 1. / 3 * shear * trace * inverse};
    return t;
}

/* The lower triangle of A. */
ELEMENT_FUNCTION void form_neo_hookean_tangent(element_tensor h, const double *c, double a[9][9])
{
    const form_neo_hookean_terms t = form_neo_hookean_terms_at(h, c);
    element_tensor g = element_cofactor(h);
    const double f[3][3] = {{1 + h.xx, h.xy, h.xz}, {h.yx, 1 + h.yy, h.yz}, {h.zx, h.zy, 1 + h.zz}};
    const double fs[9] = {f[0][0], f[0][1], f[0][2], f[1][0], f[1][1], f[1][2], f[2][0], f[2][1], f[2][2]};
    const double gs[9] = {g.xx, g.xy, g.xz, g.yx, g.yy, g.yz, g.zx, g.zy, g.zz};
    for (int r = 0; r < 9; r++)
        for (int s = 0; s <= r; s++)
            a[r][s] = t.bulk * gs[r] * gs[s] - t.mixed * (fs[r] * gs[s] + gs[r] * fs[s]) +
                      t.pressure * tangent_cofactor_slope(f, r / 3, r % 3, s / 3, s % 3) + (r == s ? t.shear : 0);
}

/* Adds A y to *to; square: G:y. Returns no less than z:(A z) of any z of length 1 with G:z = 0: the terms of bulk and
 * mixed vanish there, and as z:(dG/dF z) = 2 F:cof z is at most 2 s |z|^2, s the largest stretch, what is left is at
 * most
 *     a + 2 |p| s. */
ELEMENT_FUNCTION double form_neo_hookean_along(element_tensor h, const double *c, element_tensor y, double square,
                                               element_tensor *to)
{
    const form_neo_hookean_terms t = form_neo_hookean_terms_at(h, c);
    const element_tensor g = element_cofactor(h), f = tangent_moved(h);
    tangent_add(to, t.shear, y);
    tangent_add(to, t.bulk * square - t.mixed * tangent_dot(f, y), g);
    tangent_add(to, -t.mixed * square, f);
    tangent_add(to, t.pressure, tangent_cofactor_along(h, y));
    return t.shear + 2 * fabs(t.pressure) * tangent_stretch(h);
}

/* This form expresses no other. */
/* NOLINTNEXTLINE(readability-non-const-parameter): the type is that of every form's */
static inline int form_neo_hookean_express(form from, const double *c, double *to)
{
    (void)from, (void)c, (void)to;
    return 0;
}

static inline void form_neo_hookean_between(double mu, double bulk, const double *a, const double *b, double share,
                                            double *to)
{
    (void)a, (void)b, (void)share;
    to[0] = mu;
    to[1] = bulk;
}
#endif

#endif
