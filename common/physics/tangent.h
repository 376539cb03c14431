/* Tensors as 9 x 9 matrices, row 3 k + j for component k and axis j, and products of them, of which the forms make
 * their tangents A = dP/dF for the stable step. In double, and nothing where `real` is anything else. Owns nothing.
 */
#ifndef SINEW_TANGENT_H
#define SINEW_TANGENT_H

#include "physics/strain.h"

#ifdef REAL_IS_DOUBLE

/* d^2 det F / dF dF: cof(F)' along dF, as a 9 x 9 matrix: eps_kln eps_jmo F_no. */
ELEMENT_FUNCTION double tangent_cofactor_slope(const double f[3][3], int k, int j, int l, int m)
{
    if (k == l || j == m)
        return 0;
    int n = 3 - k - l, o = 3 - j - m;
    int sign_row = (l - k + 3) % 3 == 1 ? 1 : -1, sign_column = (m - j + 3) % 3 == 1 ? 1 : -1;
    return sign_row * sign_column * f[n][o];
}

ELEMENT_FUNCTION double tangent_dot(element_tensor a, element_tensor b)
{
    return (a.xx * b.xx + a.xy * b.xy + a.xz * b.xz) + (a.yx * b.yx + a.yy * b.yy + a.yz * b.yz) +
           (a.zx * b.zx + a.zy * b.zy + a.zz * b.zz);
}

ELEMENT_FUNCTION void tangent_add(element_tensor *a, double s, element_tensor b)
{
    a->xx += s * b.xx, a->xy += s * b.xy, a->xz += s * b.xz;
    a->yx += s * b.yx, a->yy += s * b.yy, a->yz += s * b.yz;
    a->zx += s * b.zx, a->zy += s * b.zy, a->zz += s * b.zz;
}

/* dG/dF along y, at F = I + H. */
ELEMENT_FUNCTION element_tensor tangent_cofactor_along(element_tensor h, element_tensor y)
{
    const double xx = 1 + h.xx, yy = 1 + h.yy, zz = 1 + h.zz;
    element_tensor s = {
        yy * y.zz + zz * y.yy - h.yz * y.zy - h.zy * y.yz,   h.yz * y.zx + h.zx * y.yz - h.yx * y.zz - zz * y.yx,
        h.yx * y.zy + h.zy * y.yx - yy * y.zx - h.zx * y.yy, h.xz * y.zy + h.zy * y.xz - h.xy * y.zz - zz * y.xy,
        xx * y.zz + zz * y.xx - h.xz * y.zx - h.zx * y.xz,   h.xy * y.zx + h.zx * y.xy - xx * y.zy - h.zy * y.xx,
        h.xy * y.yz + h.yz * y.xy - h.xz * y.yy - yy * y.xz, h.xz * y.yx + h.yx * y.xz - xx * y.yz - h.yz * y.xx,
        xx * y.yy + yy * y.xx - h.xy * y.yx - h.yx * y.xy};
    return s;
}

/* No less than the largest singular value of F = I + H: of the largest sums of a row and of a column the geometric
 * mean. */
ELEMENT_FUNCTION double tangent_stretch(element_tensor h)
{
    const double xx = fabs(1 + h.xx), yy = fabs(1 + h.yy), zz = fabs(1 + h.zz);
    const double row =
        fmax(fmax(xx + fabs(h.xy) + fabs(h.xz), yy + fabs(h.yx) + fabs(h.yz)), zz + fabs(h.zx) + fabs(h.zy));
    const double column =
        fmax(fmax(xx + fabs(h.yx) + fabs(h.zx), yy + fabs(h.xy) + fabs(h.zy)), zz + fabs(h.xz) + fabs(h.yz));
    return sqrt(row * column);
}

/* F = I + H. */
ELEMENT_FUNCTION element_tensor tangent_moved(element_tensor h)
{
    const element_tensor f = {1 + h.xx, h.xy, h.xz, h.yx, 1 + h.yy, h.yz, h.zx, h.zy, 1 + h.zz};
    return f;
}

ELEMENT_FUNCTION element_tensor tangent_transposed(element_tensor a)
{
    const element_tensor b = {a.xx, a.yx, a.zx, a.xy, a.yy, a.zy, a.xz, a.yz, a.zz};
    return b;
}

/* No less than (F:z)^2 for any z of length 1 with G:z = 0, G = cof F; nothing at rest: F may be cut down to what it has
 * across G, so that
 *     (F:z)^2 <= |F|^2 - (F:G)^2 / |G|^2 = I1 - 9 J^2 / I2. */
ELEMENT_FUNCTION double tangent_across(double first_invariant, double second_invariant, double volume)
{
    return fmax(first_invariant - 9 * volume * volume / second_invariant, 0.);
}

#endif

#endif
