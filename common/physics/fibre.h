/* Fibres that resist being stretched, beside any law: families of fibres, and the law fung, which has a direction. With
 * C = F^T F and a0 a family's direction at rest, of length 1,
 *     Ebar = kappa (tr C - 3) + (1 - 3 kappa) (a0.C a0 - 1),
 *     W = k1/(2 k2) (exp(k2 Ebar^2) - 1) where Ebar > 0, else 0
 * (Gasser, Ogden & Holzapfel 2006, but of full C: see below; quadratic: k2 and kappa 0, W = k1/2 Ebar^2), and with
 * E = (C - I)/2 in axes whose first is the fibre
 *     Q = bf E11^2 + bt (E22^2 + E33^2 + 2 E23^2) + 2 bfs (E12^2 + E13^2),   W = c/2 (exp Q - 1)
 * (Guccione, McCulloch & Waldman 1991). Invariants are full, not of C without its change of volume: with these, fibres
 * that are pulled swell the tissue (Vergori et al. 2013). Exponents are capped at FIBRE_CAP: there the energy goes on
 * in a straight line of k2 Ebar^2 or Q, so that stress goes on in one of Ebar or E.
 *
 * P = F S, S = dW/dE: no difference of nearly equal numbers is taken, so float keeps small strains. Compiled by gcc,
 * clang and nvcc alike, in the numbers of strain.h. Owns nothing.
 */
#ifndef SINEW_FIBRE_H
#define SINEW_FIBRE_H

#include "physics/fibre_numbers.h"
#include "physics/powers.h"
#include "physics/tangent.h"

enum { FIBRE_CAP = 30 };

/* The law of a family; the law fung, as the coefficients of its Q (fibre_numbers_fung).
 * Energies are linear in k1 and c. */
typedef struct fibre_law {
    real k1, k2, kappa;
} fibre_law;

typedef struct fibre_fung {
    real c, all, along, both;
} fibre_fung;

/* The fibres of one volume in an element. Of families and is_fung steppers decide by volumes, not by elements. */
typedef struct fibre_set {
    fibre_law law;
    fibre_fung fung;
    element_vector along, family[FIBRE_FAMILIES];
    int families, is_fung;
} fibre_set;

/* What is made of y in exp y - 1: its value, its slope and the slope of that. */
typedef struct fibre_growth {
    real value, slope, curve;
} fibre_growth;

ELEMENT_FUNCTION fibre_growth fibre_growth_at(real y)
{
    const real cap = real_of(FIBRE_CAP), within = REAL_SELECT(y < cap, y, cap);
    const real less = real_exp_less(within), slope = 1 + less;
    const fibre_growth g = {less + slope * (y - within), slope, REAL_SELECT(y < cap, slope, REAL_ZERO)};
    return g;
}

ELEMENT_FUNCTION real fibre_dot(element_vector a, element_vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* e a. */
ELEMENT_FUNCTION element_vector fibre_row(element_symmetric e, element_vector a)
{
    const element_vector v = {e.xx * a.x + e.xy * a.y + e.zx * a.z, e.xy * a.x + e.yy * a.y + e.yz * a.z,
                              e.zx * a.x + e.yz * a.y + e.zz * a.z};
    return v;
}

ELEMENT_FUNCTION real fibre_square(element_symmetric e)
{
    return (e.xx * e.xx + e.yy * e.yy + e.zz * e.zz) + 2 * (e.xy * e.xy + e.yz * e.yz + e.zx * e.zx);
}

/* Adds k (v (x) a + a (x) v)/2. */
ELEMENT_FUNCTION void fibre_add(element_symmetric *s, real k, element_vector v, element_vector a)
{
    const real half = R(.5) * k;
    s->xx += k * v.x * a.x;
    s->yy += k * v.y * a.y;
    s->zz += k * v.z * a.z;
    s->xy += half * (v.x * a.y + v.y * a.x);
    s->yz += half * (v.y * a.z + v.z * a.y);
    s->zx += half * (v.z * a.x + v.x * a.z);
}

/* Ebar, e = C - I. */
ELEMENT_FUNCTION real fibre_strain_of(element_symmetric e, element_vector a, real kappa)
{
    return kappa * (e.xx + e.yy + e.zz) + (1 - 3 * kappa) * fibre_dot(a, fibre_row(e, a));
}

/* The same; 0 where it is below, or where there is no direction. */
ELEMENT_FUNCTION real fibre_strain(element_symmetric e, element_vector a, real kappa)
{
    const real strain = fibre_strain_of(e, a, kappa);
    return REAL_SELECT(fibre_dot(a, a) > 0, REAL_SELECT(strain > 0, strain, REAL_ZERO), REAL_ZERO);
}

/* Adds a family's S = 2 W' (kappa I + (1 - 3 kappa) a0 (x) a0), W' = k1 Ebar exp(k2 Ebar^2). */
ELEMENT_FUNCTION void fibre_add_family(element_symmetric e, fibre_law law, element_vector a, element_symmetric *s)
{
    const real strain = fibre_strain(e, a, law.kappa);
    real twice = 2 * law.k1 * strain;
    if (real_any(law.k2 != 0)) /* else times 1 */
        twice = twice * fibre_growth_at(law.k2 * strain * strain).slope;
    const real around = twice * law.kappa;
    s->xx += around;
    s->yy += around;
    s->zz += around;
    fibre_add(s, twice * (1 - 3 * law.kappa), a, a);
}

/* B = 2 dQ/de of e = C - I = 2 E: linear in e, and Q = e:B/4. */
ELEMENT_FUNCTION element_symmetric fibre_fung_slope(element_symmetric e, fibre_fung f, element_vector a)
{
    const element_vector v = fibre_row(e, a);
    element_symmetric b = {f.all * e.xx, f.all * e.yy, f.all * e.zz, f.all * e.xy, f.all * e.yz, f.all * e.zx};
    fibre_add(&b, 2 * f.along, v, a);
    fibre_add(&b, f.both * fibre_dot(a, v), a, a);
    return b;
}

ELEMENT_FUNCTION real fibre_fung_exponent(element_symmetric e, fibre_fung f, element_vector a)
{
    const element_vector v = fibre_row(e, a);
    const real first = fibre_dot(a, v);
    return R(.25) * (f.all * fibre_square(e) + 2 * f.along * fibre_dot(v, v) + f.both * first * first);
}

/* Adds S = c/2 exp(Q) B. */
ELEMENT_FUNCTION void fibre_add_fung(element_symmetric e, fibre_fung f, element_vector a, element_symmetric *s)
{
    const element_symmetric b = fibre_fung_slope(e, f, a);
    const real scale = R(.5) * f.c * fibre_growth_at(fibre_fung_exponent(e, f, a)).slope;
    s->xx += scale * b.xx;
    s->yy += scale * b.yy;
    s->zz += scale * b.zz;
    s->xy += scale * b.xy;
    s->yz += scale * b.yz;
    s->zx += scale * b.zx;
}

/* Adds the S of one volume's fibres. */
ELEMENT_FUNCTION void fibre_add_set(element_symmetric e, const fibre_set *of, element_symmetric *s)
{
    if (of->families > 0)
        fibre_add_family(e, of->law, of->family[0], s);
    if (of->families > 1)
        fibre_add_family(e, of->law, of->family[1], s);
    if (of->is_fung)
        fibre_add_fung(e, of->fung, of->along, s);
}

/* F S, F = I + H. */
ELEMENT_FUNCTION element_tensor fibre_moved(element_tensor h, element_symmetric s)
{
    const element_tensor f = {1 + h.xx, h.xy, h.xz, h.yx, 1 + h.yy, h.yz, h.zx, h.zy, 1 + h.zz};
    return element_times(f, s);
}

/* P (Pa) of one or two volumes' fibres. */
ELEMENT_APART element_tensor fibre_stress(element_tensor h, const fibre_set *sets, int count)
{
    const element_symmetric e = element_green(h);
    element_symmetric s = {REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO};
    fibre_add_set(e, &sets[0], &s);
    if (count > 1)
        fibre_add_set(e, &sets[1], &s);
    return fibre_moved(h, s);
}

/* W of a family, J/m3 at rest. */
ELEMENT_FUNCTION real fibre_family_energy(element_symmetric e, fibre_law law, element_vector a)
{
    const real strain = fibre_strain(e, a, law.kappa), y = law.k2 * strain * strain;
    const real ratio =
        REAL_SELECT(y > 0, fibre_growth_at(y).value / REAL_SELECT(y > 0, y, REAL_ZERO + 1), REAL_ZERO + 1);
    return R(.5) * law.k1 * strain * strain * ratio;
}

/* W of one volume's fibres, J/m3 at rest. */
ELEMENT_FUNCTION real fibre_energy(element_tensor h, const fibre_set *of)
{
    const element_symmetric e = element_green(h);
    real w = REAL_ZERO;
    for (int i = 0; i < of->families; i++)
        w += fibre_family_energy(e, of->law, of->family[i]);
    if (of->is_fung)
        w += R(.5) * of->fung.c * fibre_growth_at(fibre_fung_exponent(e, of->fung, of->along)).value;
    return w;
}

#ifdef REAL_IS_DOUBLE
ELEMENT_FUNCTION element_vector fibre_vector(const double a[3])
{
    const element_vector v = {a[0], a[1], a[2]};
    return v;
}

/* On the host. times: what the volume's energies are to be multiplied by. */
static inline fibre_set fibre_set_of(const fibre_local *l, double times)
{
    const fibre_numbers *n = &l->of;
    const fibre_invariants q = fibre_numbers_fung(n);
    const fibre_set s = {{times * n->k1, n->k2, n->kappa}, {times * n->c, q.all, q.along, q.both},
                         fibre_vector(l->along),           {fibre_vector(l->family[0]), fibre_vector(l->family[1])},
                         fibre_numbers_families(n),        n->c > 0};
    return s;
}

/* W' and W'' of a family at its Ebar; at 0 W'' is that of the fibre that is pulled. */
typedef struct fibre_slopes {
    double first, second;
} fibre_slopes;

ELEMENT_FUNCTION fibre_slopes fibre_slopes_at(element_symmetric e, fibre_law law, element_vector a)
{
    const double strain = fibre_strain_of(e, a, law.kappa), y = law.k2 * strain * strain;
    const fibre_growth g = fibre_growth_at(y);
    fibre_slopes s = {0, 0};
    if (!(strain >= 0 && fibre_dot(a, a) > 0))
        return s;
    s.first = law.k1 * strain * g.slope;
    s.second = law.k1 * (g.slope + 2 * y * g.curve);
    return s;
}

/* No less than z:(A z) of any z of length 1 with G:z = 0, G = cof F, of a part of A that is c N (x) N, c >= 0: as z may
 * be taken across G, it is at most c (|N|^2 - (N:G)^2 / |G|^2). */
ELEMENT_FUNCTION double fibre_across(double c, element_tensor n, element_tensor g)
{
    const double along = tangent_dot(n, g);
    return c * fmax(tangent_dot(n, n) - along * along / tangent_dot(g, g), 0.);
}

/* Adds A y, A = dP/dF of a family. With m = F a0 and N = dEbar/dF = 2 (kappa F + (1 - 3 kappa) m (x) a0):
 *     A = W'' N (x) N + 2 W' (kappa I + (1 - 3 kappa) I (x) a0 a0).
 * Returns no less than z:(A z) of any z of length 1 with G:z = 0: of the first term as above (without kappa that is at
 * most 4 W'' I4, I4 = m.m); of the second, as |z a0| <= |a0| and kappa <= 1/3, 2 W' (kappa + (1 - 3 kappa) |a0|^2). */
ELEMENT_FUNCTION double fibre_family_along(element_tensor h, fibre_law law, element_vector a, element_tensor y,
                                           element_tensor *to)
{
    const fibre_slopes w = fibre_slopes_at(element_green(h), law, a);
    const element_tensor f = tangent_moved(h);
    const double part = 1 - 3 * law.kappa;
    element_symmetric s = {law.kappa, law.kappa, law.kappa, 0, 0, 0};
    fibre_add(&s, part, a, a);
    element_tensor n = element_times(f, s);
    const double turn = 4 * w.second * tangent_dot(n, y);
    tangent_add(to, 2 * w.first, element_times(y, s));
    tangent_add(to, turn, n);
    return fibre_across(4 * w.second, n, element_cofactor(h)) + 2 * w.first * (law.kappa + part * fibre_dot(a, a));
}

/* F^T y + y^T F. */
ELEMENT_FUNCTION element_symmetric fibre_green_along(element_tensor f, element_tensor y)
{
    const element_tensor t = element_product(tangent_transposed(f), y);
    const element_symmetric e = {2 * t.xx, 2 * t.yy, 2 * t.zz, t.xy + t.yx, t.yz + t.zy, t.zx + t.xz};
    return e;
}

/* Adds A y, A = dP/dF of the law fung. With N = dQ/dF = F B and w = (c/2) exp(Q):
 *     A y = w (N:y) N + w (y B + F B[F^T y + y^T F]).
 * Returns no less than z:(A z) of any z of length 1 with G:z = 0: of the first term as fibre_across says; of the second
 * at most w times B's length; and as z:(F B[e]) = e:B[e]/2 = 2 Q(e) <= b |e|^2 / 2 for e = F^T z + z^T F, b the largest
 * of bf, bt, bfs, and |e| <= 2 s, s the largest stretch, of the third at most 2 w b s^2. */
ELEMENT_FUNCTION double fibre_fung_along(element_tensor h, fibre_fung q, element_vector a, element_tensor y,
                                         element_tensor *to)
{
    const element_symmetric e = element_green(h), b = fibre_fung_slope(e, q, a);
    const fibre_growth g = fibre_growth_at(fibre_fung_exponent(e, q, a));
    const element_tensor f = tangent_moved(h), n = element_times(f, b);
    const double slope = q.c / 2 * g.slope, curve = q.c / 2 * g.curve, stretch = tangent_stretch(h);
    const double shear = q.all + q.along, fibre = q.all + 2 * q.along + q.both;
    tangent_add(to, curve * tangent_dot(n, y), n);
    tangent_add(to, slope, element_times(y, b));
    tangent_add(to, slope, element_times(f, fibre_fung_slope(fibre_green_along(f, y), q, a)));
    return fibre_across(curve, n, element_cofactor(h)) +
           slope * (sqrt(fibre_square(b)) + 2 * fmax(q.all, fmax(shear, fibre)) * stretch * stretch);
}

/* Adds A y of one or two volumes' fibres; returns no less than z:(A z) of any z of length 1 with G:z = 0. */
ELEMENT_FUNCTION double fibre_along(element_tensor h, const fibre_set *sets, int count, element_tensor y,
                                    element_tensor *to)
{
    double most = 0;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < sets[i].families; k++)
            most += fibre_family_along(h, sets[i].law, sets[i].family[k], y, to);
        if (sets[i].is_fung)
            most += fibre_fung_along(h, sets[i].fung, sets[i].along, y, to);
    }
    return most;
}

/* Adds to the lower triangle of A as a 9 x 9 matrix. */
ELEMENT_FUNCTION void fibre_add_tangent(element_tensor h, const fibre_set *sets, int count, double a[9][9])
{
    for (int s = 0; s < 9 && count; s++) {
        double unit[9] = {0}, column[9];
        element_tensor y, product = {0, 0, 0, 0, 0, 0, 0, 0, 0};
        unit[s] = 1;
        memcpy(&y, unit, sizeof y);
        fibre_along(h, sets, count, y, &product);
        memcpy(column, &product, sizeof column);
        for (int r = s; r < 9; r++)
            a[r][s] += column[r];
    }
}
#endif

#endif
