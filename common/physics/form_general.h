/* The form of all isotropic laws together, and of what lies between any two of them:
 *     W = f(x) + c01 (I2bar - 3) + sum of e_j (exp(b_j x) - 1)
 *         + sum of m_i (L1^a_i + L2^a_i + L3^a_i - 3) + K/2 (J - 1)^2,
 * x = I1bar - 3, f(x) = c1 x + ... + c5 x^5, L1 to L3 the principal stretches times J^-1/3. Coefficients: c1 to c5,
 * c01, K, e1, e2, m1 to m6 (Pa); then exponents: b1, b2, a1 to a6. Terms without a modulus are left out. At rest
 *     mu = 2 (c1 + c01 + sum of e_j b_j) + sum of m_i a_i^2 / 2.
 * (The exponential: Veronda & Westmann 1970; stretches: Ogden 1972.) Owns nothing.
 */
#ifndef SINEW_FORM_GENERAL_H
#define SINEW_FORM_GENERAL_H

#include "physics/form_first.h"
#include "physics/form_mooney_rivlin.h"
#include "physics/powers.h"
#include "physics/spectral.h"

/* Twice as many terms as a law has: what lies between two has those of both. Where the coefficients lie. */
enum {
    FORM_GENERAL_EXPONENTIALS = 2,
    FORM_GENERAL_STRETCHES = 6,
    FORM_GENERAL_STIFFENS = 1,
    FORM_GENERAL_c01 = FORM_FIRST_POWERS,
    FORM_GENERAL_K,
    FORM_GENERAL_e,
    FORM_GENERAL_m = FORM_GENERAL_e + FORM_GENERAL_EXPONENTIALS,
    FORM_GENERAL_b = FORM_GENERAL_m + FORM_GENERAL_STRETCHES,
    FORM_GENERAL_a = FORM_GENERAL_b + FORM_GENERAL_EXPONENTIALS,
};

/* f' and what the exponentials add to it. */
ELEMENT_FUNCTION real form_general_slope(real x, const real *c)
{
    real slope = form_first_slope(x, c);
    for (int j = 0; j < FORM_GENERAL_EXPONENTIALS; j++)
        if (real_any(c[FORM_GENERAL_e + j] != 0))
            slope += c[FORM_GENERAL_e + j] * c[FORM_GENERAL_b + j] * real_exp(c[FORM_GENERAL_b + j] * x);
    return slope;
}

/* Whether there are terms of stretches. */
ELEMENT_FUNCTION real_mask form_general_stretched(const real *c)
{
    real_mask any = c[FORM_GENERAL_m] != 0;
    for (int i = 1; i < FORM_GENERAL_STRETCHES; i++)
        any = any | (c[FORM_GENERAL_m + i] != 0);
    return any;
}

/* ln L1 to ln L3, whose sum is 0, from the eigenvalues of C - I: no difference of nearly equal numbers. */
ELEMENT_FUNCTION element_vector form_general_logs(element_vector e)
{
    const element_vector l = {real_log_more(e.x) * R(.5), real_log_more(e.y) * R(.5), real_log_more(e.z) * R(.5)};
    const real mean = (l.x + l.y + l.z) * R(1. / 3);
    const element_vector bar = {l.x - mean, l.y - mean, l.z - mean};
    return bar;
}

/* dW/d(ln stretch) of the terms of stretches, along each principal axis: sum of m_i a_i L^a_i less its mean. The 1 that
 * is taken from each power goes with the mean. */
ELEMENT_FUNCTION element_vector form_general_pulls(element_vector log, const real *c)
{
    element_vector t = {REAL_ZERO, REAL_ZERO, REAL_ZERO};
    for (int i = 0; i < FORM_GENERAL_STRETCHES; i++)
        if (real_any(c[FORM_GENERAL_m + i] != 0)) {
            const real a = c[FORM_GENERAL_a + i], by = c[FORM_GENERAL_m + i] * a;
            t.x += by * real_exp_less(a * log.x);
            t.y += by * real_exp_less(a * log.y);
            t.z += by * real_exp_less(a * log.z);
        }
    const real mean = (t.x + t.y + t.z) * R(1. / 3);
    t.x -= mean, t.y -= mean, t.z -= mean;
    return t;
}

/* P of the terms of stretches: P = F S, and as cof F = J F^-T, and S and C have the same axes,
 *     P = cof F (1/J) sum over k of pull_k N_k (x) N_k,   N_k the eigenvectors of C - I. */
ELEMENT_APART element_tensor form_general_stretch_stress(element_tensor h, const real *c)
{
    const spectral s = spectral_of(element_green(h));
    const real root = element_cube_root_inverse(1 + element_dilation(h)), inverse = root * root * root;
    element_vector pull = form_general_pulls(form_general_logs(s.at), c);
    pull.x *= inverse, pull.y *= inverse, pull.z *= inverse;
    return element_times(element_cofactor(h), spectral_with(s.v, pull));
}

/* The Mooney-Rivlin form's with f' and the exponentials' in place of c10, and the stretches'. */
ELEMENT_FUNCTION element_tensor form_general_stress(element_tensor h, const real *c)
{
    const real now[] = {form_general_slope(form_first_x(h), c), c[FORM_GENERAL_c01], c[FORM_GENERAL_K]};
    const element_tensor p = form_mooney_rivlin_stress(h, now);
    const real_mask stretched = form_general_stretched(c);
    if (!real_any(stretched))
        return p;
    return element_selected(stretched, element_sum(p, form_general_stretch_stress(h, c)), p);
}

/* Of the terms of stretches. */
ELEMENT_FUNCTION real form_general_stretch_energy(element_tensor h, const real *c)
{
    const element_vector log = form_general_logs(spectral_of(element_green(h)).at);
    real w = REAL_ZERO;
    for (int i = 0; i < FORM_GENERAL_STRETCHES; i++)
        if (real_any(c[FORM_GENERAL_m + i] != 0)) {
            const real a = c[FORM_GENERAL_a + i];
            w += c[FORM_GENERAL_m + i] *
                 (real_exp_less(a * log.x) + real_exp_less(a * log.y) + real_exp_less(a * log.z));
        }
    return w;
}

/* By volume at rest (J/m3). */
ELEMENT_FUNCTION real form_general_energy(element_tensor h, const real *c)
{
    const real x = form_first_x(h), second[] = {REAL_ZERO, c[FORM_GENERAL_c01], c[FORM_GENERAL_K]};
    const real first[] = {c[0], c[1], c[2], c[3], c[4], REAL_ZERO};
    real w = form_first_energy(h, first) + form_mooney_rivlin_energy(h, second);
    for (int j = 0; j < FORM_GENERAL_EXPONENTIALS; j++)
        if (real_any(c[FORM_GENERAL_e + j] != 0))
            w += c[FORM_GENERAL_e + j] * real_exp_less(c[FORM_GENERAL_b + j] * x);
    const real_mask stretched = form_general_stretched(c);
    if (!real_any(stretched))
        return w;
    return REAL_SELECT(stretched, w + form_general_stretch_energy(h, c), w);
}

/* T of a term of stretches. These are e^l, 1 and e^-l in simple shear of the amount g = 2 sinh l, so the energy is
 * 2 m (cosh(a l) - 1), and with c = cosh l, U = a^2 cosh(a l) and V = a sinh(a l)/sinh l
 *     T = m/4 (U/c^2 - V/c + V/c^3),   dT/dx = m/4 ((a^2 + 2)/8 V/c^3 - 3/8 (U/c^4 + V/c^5)).
 * For a = 2 and -2 that is m, and 0. Only V divides by what is 0 at rest: no x is taken below 1e-30. */
typedef struct form_general_simple {
    real log, sine, inverse; /* l, sinh l, 1/c */
} form_general_simple;

ELEMENT_FUNCTION form_general_simple form_general_simple_by(real x)
{
    const real least = real_of(1e-30), quarter = R(.25) * REAL_SELECT(x > least, x, least);
    const real sine = real_sqrt(quarter), cosine = real_sqrt(1 + quarter);
    const form_general_simple at = {real_log_more(sine + quarter / (1 + cosine)), sine, 1 / cosine};
    return at;
}

/* U and V, which are the same for -a: with e = e^(a l) - 1, cosh(a l) = 1 + e^2/(2 + 2 e) and sinh(a l) = (e + e/(1 +
 * e))/2. */
ELEMENT_FUNCTION void form_general_pair(form_general_simple at, real exponent, real *u, real *v)
{
    const real a = REAL_SELECT(exponent < 0, -exponent, exponent);
    const real more = real_exp_less(a * at.log), part = more / (1 + more);
    *u = a * a * (1 + R(.5) * (more * part));
    *v = a * (more + part) / (2 * at.sine);
}

ELEMENT_FUNCTION void form_general_add_stretches(real x, const real *c, form_shear *to)
{
    const form_general_simple at = form_general_simple_by(x);
    const real k = at.inverse;
    for (int i = 0; i < FORM_GENERAL_STRETCHES; i++)
        if (real_any(c[FORM_GENERAL_m + i] != 0)) {
            const real a = c[FORM_GENERAL_a + i], by = R(.25) * c[FORM_GENERAL_m + i];
            real u, v;
            form_general_pair(at, a, &u, &v);
            to->rest += by * a * a;
            to->now += by * (k * (u * k - v + v * k * k));
            to->slope += by * (k * k * k * ((a * a + 2) * R(.125) * v - R(.375) * k * (u + v * k)));
        }
}

/* That of f and c01; of an exponential, e b exp(b x) (1 + 2 b x); of stretches. */
ELEMENT_FUNCTION form_shear form_general_sheared(real x, const real *c)
{
    form_shear s = form_first_sheared(x, c);
    s.rest += c[FORM_GENERAL_c01];
    s.now += c[FORM_GENERAL_c01];
    for (int j = 0; j < FORM_GENERAL_EXPONENTIALS; j++)
        if (real_any(c[FORM_GENERAL_e + j] != 0)) {
            const real b = c[FORM_GENERAL_b + j], rest = c[FORM_GENERAL_e + j] * b, now = rest * real_exp(b * x);
            s.rest += rest;
            s.now += now * (1 + 2 * (b * x));
            s.slope += now * b * (3 + 2 * (b * x));
        }
    if (real_any(form_general_stretched(c)))
        form_general_add_stretches(x, c, &s);
    return s;
}

#ifdef REAL_IS_DOUBLE
/* As dV/dx = (U - V c)/(2 x c), which is a^2 (a^2 - 1)/24 at rest, and dU/dx = a^2 V/(8 c), d2T/dx2 of stretches is
 *     m/4 ((a^2 + 2)/8 (V'/c^3 - 3/8 V/c^5) - 3/8 (U'/c^4 - U/(2 c^6) + V'/c^5 - 5/8 V/c^7)). */
ELEMENT_FUNCTION double form_general_stretch_curve(double x, double m, double a)
{
    const form_general_simple at = form_general_simple_by(x);
    const double k = at.inverse, cube = k * k * k, square = a * a;
    double u, v;
    form_general_pair(at, a, &u, &v);
    const double dv = x > 1e-6 ? (u * k - v) / (2 * x) : square * (square - 1) / 24, du = square * v * k / 8;
    return m / 4 * cube *
           ((square + 2) / 8 * (dv - 3. / 8 * v * k * k) -
            3. / 8 * (du * k - u * cube / 2 + dv * k * k - 5. / 8 * v * k * cube));
}

ELEMENT_FUNCTION double form_general_sheared_curve(double x, const double *c)
{
    double curve = form_first_sheared_curve(x, c);
    for (int j = 0; j < FORM_GENERAL_EXPONENTIALS; j++) {
        const double b = c[FORM_GENERAL_b + j];
        if (c[FORM_GENERAL_e + j] != 0)
            curve += c[FORM_GENERAL_e + j] * b * b * b * real_exp(b * x) * (5 + 2 * b * x);
    }
    for (int i = 0; i < FORM_GENERAL_STRETCHES; i++)
        if (c[FORM_GENERAL_m + i] != 0)
            curve += form_general_stretch_curve(x, c[FORM_GENERAL_m + i], c[FORM_GENERAL_a + i]);
    return curve;
}

/* A = dP/dF of the terms of stretches, in principal axes: with F = sum of l_k n_k (x) N_k, W of the stretches l_k
 * alone, and y = sum of y_kj n_k (x) N_j, the components of A y are
 *     sum over j of W_kj y_jj at kk;   and of two axes, at kj and jk,
 *     (even (y_kj + y_jk) +- odd (y_kj - y_jk)) / 2,
 *     even = (W_k - W_j)/(l_k - l_j),   odd = (W_k + W_j)/(l_k + l_j).
 * (Ogden, Non-Linear Elastic Deformations, 6.1.) */
typedef struct form_general_axes {
    double n[3][3], rest[3][3]; /* n_k, N_k */
    double slope[3][3];         /* W_kj */
    double even[3], odd[3];     /* of axes 1 2, 2 0, 0 1 */
} form_general_axes;

/* (L_k^a - L_j^a) / (L_k - L_j) L_j^(1 - a), of the difference of logarithms; a where that is 0. */
ELEMENT_FUNCTION double form_general_quotient(double a, double difference)
{
    return difference == 0 ? a : real_exp_less(a * difference) / real_exp_less(difference);
}

/* The axes, and l_k. */
ELEMENT_FUNCTION form_general_axes form_general_principal(element_tensor h, spectral s, double l[3])
{
    const element_tensor moved = element_product(tangent_moved(h), s.v);
    const double now[3][3] = {
        {moved.xx, moved.yx, moved.zx}, {moved.xy, moved.yy, moved.zy}, {moved.xz, moved.yz, moved.zz}};
    const double rest[3][3] = {{s.v.xx, s.v.yx, s.v.zx}, {s.v.xy, s.v.yy, s.v.zy}, {s.v.xz, s.v.yz, s.v.zz}};
    form_general_axes t;
    for (int k = 0; k < 3; k++) {
        l[k] = sqrt(now[k][0] * now[k][0] + now[k][1] * now[k][1] + now[k][2] * now[k][2]);
        for (int i = 0; i < 3; i++) {
            t.n[k][i] = now[k][i] / l[k];
            t.rest[k][i] = rest[k][i];
        }
    }
    return t;
}

/* With u_k = sum of m_i a_i^2 L_k^a_i, d pull_k / d ln l_j = u_k [k = j] - (u_k + u_j)/3 + (u_1 + u_2 + u_3)/9, and
 * W_k = pull_k / l_k. */
ELEMENT_FUNCTION form_general_axes form_general_axes_at(element_tensor h, const double *c)
{
    const spectral s = spectral_of(element_green(h));
    const element_vector log = form_general_logs(s.at), pulls = form_general_pulls(log, c);
    const double logs[3] = {log.x, log.y, log.z}, pull[3] = {pulls.x, pulls.y, pulls.z};
    double l[3], u[3] = {0}, apart[3] = {0}; /* apart: (pull_k - pull_j)/(l_k - l_j) l_j */
    form_general_axes t = form_general_principal(h, s, l);
    for (int i = 0; i < FORM_GENERAL_STRETCHES; i++) {
        const double a = c[FORM_GENERAL_a + i], by = c[FORM_GENERAL_m + i] * a;
        for (int k = 0; k < 3 && by != 0; k++) {
            const int j = (k + 1) % 3;
            const double power = by * real_exp(a * logs[k]);
            u[k] += power * a;
            apart[(k + 2) % 3] += power * form_general_quotient(a, logs[j] - logs[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        const int j = (k + 1) % 3, pair = (k + 2) % 3;
        t.even[pair] = (apart[pair] - pull[k]) / (l[k] * l[j]);
        t.odd[pair] = (pull[k] / l[k] + pull[j] / l[j]) / (l[k] + l[j]);
        for (int m = 0; m < 3; m++)
            t.slope[k][m] =
                ((k == m ? u[k] - pull[k] : 0) - (u[k] + u[m]) / 3 + (u[0] + u[1] + u[2]) / 9) / (l[k] * l[m]);
    }
    return t;
}

/* Adds A y to *to. */
ELEMENT_FUNCTION void form_general_axes_along(const form_general_axes *t, element_tensor y, element_tensor *to)
{
    const double ys[3][3] = {{y.xx, y.xy, y.xz}, {y.yx, y.yy, y.yz}, {y.zx, y.zy, y.zz}};
    double across[3][3] = {{0}}, made[3][3], sum[9] = {0};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            for (int p = 0; p < 9; p++)
                across[k][j] += t->n[k][p / 3] * ys[p / 3][p % 3] * t->rest[j][p % 3];
    for (int k = 0; k < 3; k++) {
        const int j = (k + 1) % 3, pair = (k + 2) % 3;
        const double even = t->even[pair] * (across[k][j] + across[j][k]) / 2,
                     odd = t->odd[pair] * (across[k][j] - across[j][k]) / 2;
        made[k][k] = t->slope[k][0] * across[0][0] + t->slope[k][1] * across[1][1] + t->slope[k][2] * across[2][2];
        made[k][j] = even + odd;
        made[j][k] = even - odd;
    }
    for (int p = 0; p < 9; p++)
        for (int q = 0; q < 9; q++)
            sum[p] += made[q / 3][q % 3] * t->n[q / 3][p / 3] * t->rest[q % 3][p % 3];
    const element_tensor part = {sum[0], sum[1], sum[2], sum[3], sum[4], sum[5], sum[6], sum[7], sum[8]};
    tangent_add(to, 1, part);
}

/* The most of z:(A z) of any z of length 1. */
ELEMENT_FUNCTION double form_general_axes_most(const form_general_axes *t)
{
    const element_symmetric slope = {t->slope[0][0], t->slope[1][1], t->slope[2][2],
                                     t->slope[0][1], t->slope[1][2], t->slope[2][0]};
    const element_vector of = spectral_of(slope).at;
    double most = fmax(of.x, fmax(of.y, of.z));
    for (int k = 0; k < 3; k++)
        most = fmax(most, fmax(t->even[k], t->odd[k]));
    return most;
}

/* The Mooney-Rivlin form with the slope of now, and the curvature, f'' and the exponentials'. */
typedef struct form_general_terms {
    double now[3], curvature;
} form_general_terms;

ELEMENT_FUNCTION form_general_terms form_general_terms_at(element_tensor h, const double *c)
{
    const double x = form_first_x(h);
    form_general_terms t = {{form_general_slope(x, c), c[FORM_GENERAL_c01], c[FORM_GENERAL_K]},
                            form_first_curvature(x, c)};
    for (int j = 0; j < FORM_GENERAL_EXPONENTIALS; j++) {
        const double b = c[FORM_GENERAL_b + j];
        if (c[FORM_GENERAL_e + j] != 0)
            t.curvature += c[FORM_GENERAL_e + j] * b * b * real_exp(b * x);
    }
    return t;
}

/* The lower triangle of A. */
ELEMENT_FUNCTION void form_general_tangent(element_tensor h, const double *c, double a[9][9])
{
    const form_general_terms t = form_general_terms_at(h, c);
    form_mooney_rivlin_tangent(h, t.now, a);
    form_first_bend(h, t.curvature, a);
    if (!form_general_stretched(c))
        return;
    const form_general_axes axes = form_general_axes_at(h, c);
    for (int s = 0; s < 9; s++) {
        element_tensor y, to = {0, 0, 0, 0, 0, 0, 0, 0, 0};
        double column[9] = {0};
        column[s] = 1;
        memcpy(&y, column, sizeof y);
        form_general_axes_along(&axes, y, &to);
        memcpy(column, &to, sizeof to);
        for (int r = s; r < 9; r++)
            a[r][s] += column[r];
    }
}

/* Adds A y to *to; square: G:y. Returns the sum of what the parts return. */
ELEMENT_FUNCTION double form_general_along(element_tensor h, const double *c, element_tensor y, double square,
                                           element_tensor *to)
{
    const form_general_terms t = form_general_terms_at(h, c);
    const double plain =
        form_mooney_rivlin_along(h, t.now, y, square, to) + form_first_bend_along(h, t.curvature, y, to);
    if (!form_general_stretched(c))
        return plain;
    const form_general_axes axes = form_general_axes_at(h, c);
    form_general_axes_along(&axes, y, to);
    return plain + form_general_axes_most(&axes);
}

/* Any. */
static inline int form_general_express(form from, const double *c, double *to)
{
    switch (from) {
    case FORM_NEO_HOOKEAN:
        to[0] = c[0] / 2;
        to[FORM_GENERAL_K] = c[1];
        return 1;
    case FORM_MOONEY_RIVLIN:
        to[0] = c[0];
        to[FORM_GENERAL_c01] = c[1];
        to[FORM_GENERAL_K] = c[2];
        return 1;
    case FORM_FIRST:
        for (int i = 0; i < FORM_FIRST_POWERS; i++)
            to[i] = c[i];
        to[FORM_GENERAL_K] = c[FORM_FIRST_POWERS];
        return 1;
    default:
        return 0;
    }
}

/* mu at rest. */
static inline double form_general_shear(const double *c)
{
    double mu = 2 * (c[0] + c[FORM_GENERAL_c01]);
    for (int j = 0; j < FORM_GENERAL_EXPONENTIALS; j++)
        mu += 2 * c[FORM_GENERAL_e + j] * c[FORM_GENERAL_b + j];
    for (int i = 0; i < FORM_GENERAL_STRETCHES; i++)
        mu += c[FORM_GENERAL_m + i] * c[FORM_GENERAL_a + i] * c[FORM_GENERAL_a + i] / 2;
    return mu;
}

/* Adds to terms of a modulus and an exponent; those of the same exponent are one. There is room (see the enum). */
static inline void form_general_join(const double *moduli, const double *exponents, int count, double by,
                                     double *to_moduli, double *to_exponents)
{
    for (int i = 0; i < count; i++) {
        int at = 0;
        if (moduli[i] == 0)
            continue;
        while (at < count - 1 && to_moduli[at] != 0 && to_exponents[at] != exponents[i])
            at++;
        to_moduli[at] += by * moduli[i];
        to_exponents[at] = exponents[i];
    }
}

/* Each energy by its own mu goes by shares: a sum that is exact, with the terms of both. */
static inline void form_general_between(double mu, double bulk, const double *a, const double *b, double share,
                                        double *to)
{
    const double *both[] = {a, b}, shares[] = {1 - share, share};
    for (int k = 0; k < 2; k++) {
        const double *c = both[k], by = mu * (shares[k] / form_general_shear(c));
        for (int i = 0; i <= FORM_GENERAL_c01; i++)
            to[i] += by * c[i];
        if (by == 0)
            continue;
        form_general_join(c + FORM_GENERAL_e, c + FORM_GENERAL_b, FORM_GENERAL_EXPONENTIALS, by, to + FORM_GENERAL_e,
                          to + FORM_GENERAL_b);
        form_general_join(c + FORM_GENERAL_m, c + FORM_GENERAL_a, FORM_GENERAL_STRETCHES, by, to + FORM_GENERAL_m,
                          to + FORM_GENERAL_a);
    }
    to[FORM_GENERAL_K] = bulk;
}
#endif

#endif
