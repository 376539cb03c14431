/* Hourglass control: what holds the four modes of an element, xy, yz, zx and xyz, that its integration point does not
 * see. A mode of the displacement is a vector, m = sum over corners of sign u, so that over the element
 *     u = ... + m_xy/8 xi eta + ...,   xi = 2 x / h_x and so on, from -1 to 1.
 *
 * Physical: what these modes are in a beam. Read along the columns of F^-T, q = F^-1 m, they do not see the element
 * turn; with i, j, k the axes, h the sides and V the volume at rest the energies are those of
 *     bending about a plane, linear along j: strains a = q_ij^i/(4 h_i) and b = q_jk^k/(4 h_k), in plane stress,
 *         V/6 E/(1 - nu^2) (a^2 + b^2 + 2 nu a b),
 *     shear of the plane ij, linear along k (torsion is a sum of these): g = q_jk^i/(4 h_j) + q_ik^j/(4 h_i),
 *         V/6 mu g^2,
 *     xyz: strains e_i = q_xyz^i/(4 h_i),
 *         V/18 E e_i^2,
 * the means of xi^2, 1/3, and of xi^2 eta^2, 1/9, taken. E/(1 - nu^2) = 4 mu (lambda + mu)/(lambda + 2 mu) is finite at
 * nu = 1/2: nothing locks. See Belytschko & Bindeman (1993), Puso (2000), Krysl (2015) for physical stabilisation.
 * These are the moduli at rest, and this is the energy w0. Where a law stiffens, so do the modes: W = s(x) w0, with
 * x = I1bar - 3 at the centre and s(x) = T(x)/T(0), the slope of the law's stress in simple shear of the same x over
 * that at rest (form_shear.h). The law's tangent grows about as much along a stretch in one direction, and by less
 * across it. Of a neo-Hookean or a Mooney-Rivlin law s is 1. P has W s'/(s V) dx/dF besides, which element.h adds.
 * With s_g = dW/dq_g the forces on modes are f_g = F^-T s_g, and as q depends on F,
 *     P has -(1/V) sum over g of f_g (x) q_g.
 *
 * Isotropic: W = k/2 m.m for each mode, with no frame and no part in P (Joldes, Wittek & Miller 2008). Owns nothing.
 */
#ifndef SINEW_HOURGLASS_H
#define SINEW_HOURGLASS_H

#include "physics/hourglass_numbers.h"
#include "physics/strain.h"

/* A vector for each mode: displacements, or forces. */
typedef struct hourglass_modes {
    element_vector xy, yz, zx, xyz;
} hourglass_modes;

/* Forces on the modes (N), and what P gets (Pa). */
typedef struct hourglass_force {
    hourglass_modes f;
    element_tensor p;
} hourglass_force;

/* The box: 1/(4 h) (1/m) and V/(4 h) (m2) along each axis, 1/V (1/m3). */
typedef struct element_shape {
    element_vector slope, area;
    real density; /* of elements in space */
} element_shape;

ELEMENT_FUNCTION element_shape element_box(double hx, double hy, double hz)
{
    element_shape s = {{real_of(1 / (4 * hx)), real_of(1 / (4 * hy)), real_of(1 / (4 * hz))},
                       {real_of(hy * hz / 4), real_of(hz * hx / 4), real_of(hx * hy / 4)},
                       real_of(1 / (hx * hy * hz))};
    return s;
}

/* g^T m. */
ELEMENT_FUNCTION element_vector hourglass_by_columns(element_tensor g, element_vector m)
{
    element_vector w = {g.xx * m.x + g.yx * m.y + g.zx * m.z, g.xy * m.x + g.yy * m.y + g.zy * m.z,
                        g.xz * m.x + g.yz * m.y + g.zz * m.z};
    return w;
}

/* g t. */
ELEMENT_FUNCTION element_vector hourglass_by_rows(element_tensor g, element_vector t)
{
    element_vector f = {g.xx * t.x + g.xy * t.y + g.xz * t.z, g.yx * t.x + g.yy * t.y + g.yz * t.z,
                        g.zx * t.x + g.zy * t.y + g.zz * t.z};
    return f;
}

ELEMENT_FUNCTION hourglass_modes hourglass_all_by_columns(element_tensor g, hourglass_modes m)
{
    hourglass_modes w = {hourglass_by_columns(g, m.xy), hourglass_by_columns(g, m.yz), hourglass_by_columns(g, m.zx),
                         hourglass_by_columns(g, m.xyz)};
    return w;
}

ELEMENT_FUNCTION hourglass_modes hourglass_all_by_rows(element_tensor g, hourglass_modes t)
{
    hourglass_modes f = {hourglass_by_rows(g, t.xy), hourglass_by_rows(g, t.yz), hourglass_by_rows(g, t.zx),
                         hourglass_by_rows(g, t.xyz)};
    return f;
}

/* A row of the sum over modes of f (x) w. */
ELEMENT_FUNCTION element_vector hourglass_row(const hourglass_modes *w, real xy, real yz, real zx, real xyz)
{
    element_vector row = {xy * w->xy.x + yz * w->yz.x + zx * w->zx.x + xyz * w->xyz.x,
                          xy * w->xy.y + yz * w->yz.y + zx * w->zx.y + xyz * w->xyz.y,
                          xy * w->xy.z + yz * w->yz.z + zx * w->zx.z + xyz * w->xyz.z};
    return row;
}

/* by times the sum over modes of f (x) w. */
ELEMENT_FUNCTION element_tensor hourglass_products(const hourglass_modes *f, const hourglass_modes *w, real by)
{
    const element_vector x = hourglass_row(w, f->xy.x, f->yz.x, f->zx.x, f->xyz.x);
    const element_vector y = hourglass_row(w, f->xy.y, f->yz.y, f->zx.y, f->xyz.y);
    const element_vector z = hourglass_row(w, f->xy.z, f->yz.z, f->zx.z, f->xyz.z);
    element_tensor p = {by * x.x, by * x.y, by * x.z, by * y.x, by * y.y, by * y.z, by * z.x, by * z.y, by * z.z};
    return p;
}

/* dW/dw of a box, with law's four numbers times `by`: W(w) times `by` is half of this dotted with w. */
ELEMENT_FUNCTION hourglass_modes hourglass_box(const hourglass_modes *w, element_shape s, const real *law, real by)
{
    const real bending = by * law[HOURGLASS_BENDING], coupling = by * law[HOURGLASS_COUPLING];
    const real torsion = by * law[HOURGLASS_TORSION], corner = by * law[HOURGLASS_CORNER];
    const element_vector l = s.slope, a = s.area;
    /* strains: of i, linear along j */
    const real yx = l.y * w->xy.y, zx = l.z * w->zx.z, xy = l.x * w->xy.x, zy = l.z * w->yz.z, xz = l.x * w->zx.x,
               yz = l.y * w->yz.y;
    /* stresses of the planes xy, yz, zx, linear along the third axis */
    const real tz = torsion * (l.y * w->yz.x + l.x * w->zx.y), tx = torsion * (l.z * w->zx.y + l.y * w->xy.z),
               ty = torsion * (l.x * w->xy.z + l.z * w->yz.x);
    hourglass_modes t = {
        {a.x * (bending * xy + coupling * zy), a.y * (bending * yx + coupling * zx), a.y * tx + a.x * ty},
        {a.y * tz + a.z * ty, a.y * (bending * yz + coupling * xz), a.z * (bending * zy + coupling * xy)},
        {a.x * (bending * xz + coupling * yz), a.x * tz + a.z * tx, a.z * (bending * zx + coupling * yx)},
        {a.x * (corner * (l.x * w->xyz.x)), a.y * (corner * (l.y * w->xyz.y)), a.z * (corner * (l.z * w->xyz.z))}};
    return t;
}

ELEMENT_FUNCTION real hourglass_dot(const hourglass_modes *a, const hourglass_modes *b)
{
    return (a->xy.x * b->xy.x + a->xy.y * b->xy.y + a->xy.z * b->xy.z) +
           (a->yz.x * b->yz.x + a->yz.y * b->yz.y + a->yz.z * b->yz.z) +
           (a->zx.x * b->zx.x + a->zx.y * b->zx.y + a->zx.z * b->zx.z) +
           (a->xyz.x * b->xyz.x + a->xyz.y * b->xyz.y + a->xyz.z * b->xyz.z);
}

ELEMENT_FUNCTION element_vector hourglass_scaled(element_vector m, real k)
{
    element_vector f = {k * m.x, k * m.y, k * m.z};
    return f;
}

ELEMENT_FUNCTION hourglass_force hourglass_isotropic(hourglass_modes m, real k)
{
    hourglass_force h = {
        {hourglass_scaled(m.xy, k), hourglass_scaled(m.yz, k), hourglass_scaled(m.zx, k), hourglass_scaled(m.xyz, k)},
        {REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO}};
    return h;
}

/* Of a box. With G = cof F and w = G^T m: q = w/J, so t = dW/dw / J^2 gives f = G t, and P has -(1/(V J)) f (x) w. */
ELEMENT_FUNCTION hourglass_force hourglass_physical(hourglass_modes m, element_tensor h, element_shape s,
                                                    const real *law)
{
    const element_tensor g = element_cofactor(h);
    const real inverse = 1 / (1 + element_dilation(h));
    const hourglass_modes w = hourglass_all_by_columns(g, m);
    const hourglass_modes t = hourglass_box(&w, s, law, inverse * inverse);
    const hourglass_modes f = hourglass_all_by_rows(g, t);
    hourglass_force force = {f, hourglass_products(&f, &w, -(s.density * inverse))};
    return force;
}

/* f.m = t.w of it, twice the energy (J). */
ELEMENT_FUNCTION real hourglass_physical_work(hourglass_modes m, element_tensor h, element_shape s, const real *law)
{
    const real inverse = 1 / (1 + element_dilation(h));
    const hourglass_modes w = hourglass_all_by_columns(element_cofactor(h), m);
    const hourglass_modes t = hourglass_box(&w, s, law, inverse * inverse);
    return hourglass_dot(&t, &w);
}

/* ---- a hexahedron of any shape
 *
 * With g_i = dX/dxi_i at the centre, the columns of J, and r = J^T q (m2), the strain of mode ij linear along j is
 * sym(q_ij/8 (x) g^i), so its components in the plane of g_i and g_k are
 *     e_ii = r_ij^i/8,   e_kk = r_jk^k/8,   2 e_ik = (r_ij^k + r_jk^i)/8,
 * and the plane-stress energy of these in the plane's metric is a quadratic form; that of xyz likewise by the sides'
 * lengths. Of a box it is the above. */
/* The stresses of the plane of two vectors, of products ii, kk and ik, from its strains e_ii, e_kk and 2 e_ik: with A
 * the inverse (p r, r q) of the matrix of products, of lambda tr(A e)^2 / 2 + mu tr((A e)^2). lambda: that of plane
 * stress; twice: 2 mu. */
ELEMENT_FUNCTION element_vector hourglass_plane(real ii, real kk, real ik, element_vector strain, real lambda,
                                                real twice)
{
    const real inverse = 1 / (ii * kk - ik * ik), p = kk * inverse, q = ii * inverse, r = -(ik * inverse);
    const real half = R(.5) * strain.z;
    const real a = p * strain.x + r * half, b = p * half + r * strain.y, c = r * strain.x + q * half,
               d = r * half + q * strain.y; /* A e */
    const real mean = lambda * (a + d);
    element_vector s = {mean * p + twice * (a * p + b * r), mean * q + twice * (c * r + d * q),
                        mean * r + twice * (a * r + b * q)};
    return s;
}

/* As hourglass_box, of w = J r. */
ELEMENT_FUNCTION hourglass_modes hourglass_hexahedron(const hourglass_modes *w, element_tensor j, const real *law,
                                                      real by)
{
    const real lambda = by * law[HOURGLASS_COUPLING], twice = 2 * by * law[HOURGLASS_TORSION];
    const real corner = by * law[HOURGLASS_CORNER];
    const real xx = j.xx * j.xx + j.yx * j.yx + j.zx * j.zx, yy = j.xy * j.xy + j.yy * j.yy + j.zy * j.zy;
    const real zz = j.xz * j.xz + j.yz * j.yz + j.zz * j.zz, xy = j.xx * j.xy + j.yx * j.yy + j.zx * j.zy;
    const real yz = j.xy * j.xz + j.yy * j.yz + j.zy * j.zz, zx = j.xz * j.xx + j.yz * j.yx + j.zz * j.zx;
    const element_vector along_x = {w->xy.y, w->zx.z, w->xy.z + w->zx.y};
    const element_vector along_y = {w->yz.z, w->xy.x, w->yz.x + w->xy.z};
    const element_vector along_z = {w->zx.x, w->yz.y, w->zx.y + w->yz.x};
    const element_vector x = hourglass_plane(yy, zz, yz, along_x, lambda, twice);
    const element_vector y = hourglass_plane(zz, xx, zx, along_y, lambda, twice);
    const element_vector z = hourglass_plane(xx, yy, xy, along_z, lambda, twice);
    hourglass_modes t = {{y.y, x.x, x.z + y.z},
                         {z.z + y.z, z.y, y.x},
                         {z.x, x.z + z.z, x.y},
                         {corner * w->xyz.x / (xx * xx), corner * w->xyz.y / (yy * yy), corner * w->xyz.z / (zz * zz)}};
    return t;
}

/* basis: J. With B = G J and w = B^T m: r = w/J, f = B dW/dw / J^2; as q = G^T m / J, P has -(1/(V J)) (f (x) m) G. */
ELEMENT_FUNCTION hourglass_force hourglass_physical_any(hourglass_modes m, element_tensor h, element_tensor basis,
                                                        real volume, const real *law)
{
    const element_tensor g = element_cofactor(h), b = element_product(g, basis);
    const real inverse = 1 / (1 + element_dilation(h));
    const hourglass_modes w = hourglass_all_by_columns(b, m);
    const hourglass_modes t =
        hourglass_hexahedron(&w, basis, law, R(.015625) * volume * (inverse * inverse)); /* V/64 */
    const hourglass_modes f = hourglass_all_by_rows(b, t);
    hourglass_force force = {f, element_product(hourglass_products(&f, &m, -inverse / volume), g)};
    return force;
}

/* Of the modes at H, by the kind: which is a constant in steppers. */
ELEMENT_FUNCTION hourglass_force hourglass_of(hourglass_kind kind, hourglass_modes m, element_tensor h, element_shape s,
                                              const real *law)
{
    if (kind == HOURGLASS_ISOTROPIC)
        return hourglass_isotropic(m, law[HOURGLASS_K]);
    return hourglass_physical(m, h, s, law);
}

#endif
