/* The maths of the stable step (step.h says how it is found), for every executor: the 9 x 9 matrix of one element,
 * whether its eigenvalues are below a limit, and, without the matrix, between which bounds the largest of them lies. In
 * double: `real` must not be float. Owns nothing.
 */
#ifndef SINEW_STABILITY_H
#define SINEW_STABILITY_H

#include "physics/element.h"
#include "physics/fibre.h"

#ifndef REAL_IS_DOUBLE
#error "stability.h is in double"
#endif

typedef struct step_matrix {
    double at[9][9]; /* symmetric; 1/s2; row 3 k + j: component k, axis j */
} step_matrix;

/* Of a muscle's stress: with m = F a0, l = |m| and t(l) = sigma(l)/l (muscle_curves.h), P = t m (x) a0, so
 *     A = t I (x) a0 a0 + (t'/l) (m (x) a0) (x) (m (x) a0).
 * The matrix of a muscle in series with a spring is no less than A, whatever part of the length its contractile element
 * has: along the fibre it has the spring's stiffness, even where the spring is slack, and across the fibre the largest
 * tension of the spring (muscle_series.h). */
typedef struct stability_muscle {
    element_vector now; /* m */
    double t, slope;    /* slope: t'/l */
} stability_muscle;

/* Whether a fibre pulls at all. */
ELEMENT_FUNCTION int stability_pulls(element_fibre fibre)
{
    return fibre.tension != 0 || fibre.curves.passive != 0 || fibre.series.stiffness != 0;
}

/* d sigma / d lambda, Pa, where nothing moves: what the muscle alone stiffens by along its fibre; below 0 where its
 * force falls. strain: lambda - 1. */
ELEMENT_FUNCTION double stability_fibre_slope(element_fibre fibre, double lambda, double strain)
{
    const muscle_curves c = fibre.curves;
    const double by_l = fibre.tension * muscle_force_length_slope(lambda + lambda * c.less) +
                        c.passive * muscle_passive_slope(c, muscle_beyond(c, strain));
    return by_l + by_l * c.less;
}

/* Whether the stress along the fibre falls as it is stretched, its sides free: the muscle's by more than that of
 * tissue of shear modulus mu rises (of a bar that keeps its volume, mu (lambda - lambda^-2), by mu (1 + 2 lambda^-3)).
 * A row of such elements does not stay even: some are stretched, until their passive stress holds them, and others
 * shorten. */
ELEMENT_FUNCTION int stability_falls(element_tensor h, element_fibre fibre, double mu)
{
    const double l = element_length(element_fibre_now(h, fibre.along));
    const double slope = stability_fibre_slope(fibre, l, element_fibre_strain(h, fibre.along, l));
    return l > 0 && slope + mu * (1 + 2 / (l * l * l)) < 0;
}

ELEMENT_FUNCTION stability_muscle stability_muscle_at(element_tensor h, element_fibre fibre)
{
    stability_muscle s = {element_fibre_now(h, fibre.along), 0, 0};
    const muscle_curves c = fibre.curves;
    const double l = element_length(s.now), strain = element_fibre_strain(h, fibre.along, l);
    const double spring = fibre.series.stiffness;
    if (!(l > 0))
        return s;
    if (spring > 0)
        fibre.tension *= MUSCLE_SERIES_MOST;
    s.t = (fibre.tension * muscle_force_length(l + l * c.less) +
           c.passive * muscle_passive(c, muscle_beyond(c, strain))) /
          l;
    if (spring > 0)
        fibre.tension = 0;
    s.slope = (stability_fibre_slope(fibre, l, strain) - s.t + spring) / (l * l);
    return s;
}

ELEMENT_FUNCTION void stability_add_muscle(element_tensor h, element_fibre fibre, double a[9][9])
{
    const stability_muscle s = stability_muscle_at(h, fibre);
    const double along[3] = {fibre.along.x, fibre.along.y, fibre.along.z}, m[3] = {s.now.x, s.now.y, s.now.z};
    for (int r = 0; r < 9; r++)
        for (int c = 0; c <= r; c++)
            a[r][c] += (r / 3 == c / 3 ? s.t * along[r % 3] * along[c % 3] : 0) +
                       s.slope * m[r / 3] * along[r % 3] * m[c / 3] * along[c % 3];
}

/* (4/rho) A_kjlm / (h_j h_m) of an element at H, with its fibre and that of a second volume in it, and what fibres
 * these volumes have beside; density: kg/m3; side: m; sets: `count`, none to two. */
ELEMENT_FUNCTION void stability_matrix_fibred(form f, const double *c, double density, const double side[3],
                                              element_tensor h, element_fibre fibre, element_fibre second,
                                              const fibre_set *sets, int count, step_matrix *a)
{
    form_tangent(f, h, c, a->at);
    if (stability_pulls(fibre))
        stability_add_muscle(h, fibre, a->at);
    if (stability_pulls(second))
        stability_add_muscle(h, second, a->at);
    fibre_add_tangent(h, sets, count, a->at);
    for (int r = 0; r < 9; r++)
        for (int s = 0; s <= r; s++)
            a->at[s][r] = a->at[r][s] *= 4 / (density * side[r % 3] * side[s % 3]);
}

/* The same, of no more fibres. */
ELEMENT_FUNCTION void stability_matrix(form f, const double *c, double density, const double side[3], element_tensor h,
                                       element_fibre fibre, element_fibre second, step_matrix *a)
{
    stability_matrix_fibred(f, c, density, side, h, fibre, second, 0, 0, a);
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

/* ---- bounds */

/* Between which the largest eigenvalue of stability_matrix lies. Where bulk is well above shear, as in tissue, that is
 * narrow. */
typedef struct stability_range {
    double low, high;
} stability_range;

/* a D, D the diagonal d: what belongs to axis j is scaled by d_j. */
ELEMENT_FUNCTION element_tensor stability_scaled(element_tensor a, element_vector d)
{
    element_tensor b = {a.xx * d.x, a.xy * d.y, a.xz * d.z, a.yx * d.x, a.yy * d.y,
                        a.yz * d.z, a.zx * d.x, a.zy * d.y, a.zz * d.z};
    return b;
}

/* Adds a muscle's part of A y to *to. Returns no less than what it does to any z of length 1: z:(A z). */
ELEMENT_FUNCTION double stability_muscle_along(element_tensor h, element_fibre fibre, element_tensor y,
                                               element_tensor *to)
{
    if (!stability_pulls(fibre))
        return 0;
    const stability_muscle s = stability_muscle_at(h, fibre);
    const element_vector a = fibre.along, m = s.now;
    const element_vector v = {y.xx * a.x + y.xy * a.y + y.xz * a.z, y.yx * a.x + y.yy * a.y + y.yz * a.z,
                              y.zx * a.x + y.zy * a.y + y.zz * a.z};
    const double turn = s.slope * (m.x * v.x + m.y * v.y + m.z * v.z), l = element_length(m);
    const element_vector w = {s.t * v.x + turn * m.x, s.t * v.y + turn * m.y, s.t * v.z + turn * m.z};
    const element_tensor part = {w.x * a.x, w.x * a.y, w.x * a.z, w.y * a.x, w.y * a.y,
                                 w.y * a.z, w.z * a.x, w.z * a.y, w.z * a.z};
    const double length = element_length(a);
    tangent_add(to, 1, part);
    return (fmax(s.t, 0.) + fmax(s.slope, 0.) * l * l) * length * length;
}

/* Of stability_matrix, B = D A D with D_j = 2/(sqrt(rho) h_j), by the direction x = D G, which the bulk's term makes
 * nearly that of its largest eigenvalue. The Rayleigh quotient q of x is the lower bound. Across it, for z:x = 0, |z| =
 * 1 and y = D z, is G:y = 0, where the form bounds y:(A y) / |y|^2 (form_along), as fibres do, so that z:(B z) is at
 * most
 *     m = max(D_j)^2 (that bound + the muscles' + the fibres').
 * So with r, the length of what B x/|x| has across x, the largest eigenvalue is at most that of the 2 x 2 matrix (q r,
 * r m). Both bounds leave room for rounding. Where F's cofactors all vanish they are no numbers. d: D's diagonal. */
ELEMENT_FUNCTION stability_range stability_range_fibred(form f, const double *c, element_vector d, element_tensor h,
                                                        element_fibre fibre, element_fibre second,
                                                        const fibre_set *sets, int count)
{
    const double slack = 1e-12;
    const element_tensor g = element_cofactor(h), x = stability_scaled(g, d), y = stability_scaled(x, d);
    const double square = tangent_dot(x, x), most = fmax(d.x, fmax(d.y, d.z));
    const double inverse = 1 / square;
    element_tensor z = {0, 0, 0, 0, 0, 0, 0, 0, 0};
    const double bound = form_along(f, h, c, y, square, &z);
    const double muscles = stability_muscle_along(h, fibre, y, &z) + stability_muscle_along(h, second, y, &z);
    const double stretched = fibre_along(h, sets, count, y, &z);
    const double across = most * most * (bound + muscles + stretched);
    const double quotient = tangent_dot(y, z) * inverse; /* x:(z D) */
    z = stability_scaled(z, d);
    const double rest = fmax(tangent_dot(z, z) * inverse - quotient * quotient, 0.) + slack * quotient * quotient;
    const double half = (quotient - across) / 2;
    const stability_range range = {quotient - slack * fabs(quotient),
                                   ((quotient + across) / 2 + sqrt(half * half + rest)) * (1 + slack)};
    return range;
}

/* The same, of no more fibres. */
ELEMENT_FUNCTION stability_range stability_range_scaled(form f, const double *c, element_vector d, element_tensor h,
                                                        element_fibre fibre, element_fibre second)
{
    return stability_range_fibred(f, c, d, h, fibre, second, 0, 0);
}

/* ---- hourglass modes
 *
 * Their energy w = q:D q / 2, q = F^-1 m, moves with F as well as with m: dq = F^-1 (dm - dF q), so along (dm, dF)
 *     d2w = dq:D dq - 2 sum over g of f_g.(dF dq_g),   |f| <= |F^-1| |D| |q|,   |dq| <= |F^-1| (|dm| + |dF| |q|),
 *     d2w <= |D| |F^-1|^2 (|dm|^2 + 4 |q| |dm| |dF| + 3 |q|^2 |dF|^2).
 * Where it follows the law, W = s(x) w, with n = dx/dF and dw = q:D dq,
 *     d2W = s d2w + 2 s' (n:dF) dw + w d2s,   (n:dF) dw <= |n| |D| |F^-1| |q| |dF| (|dm| + |dF| |q|),
 *     d2s = s' d2x + s'' (n:dF)^2,
 * of which w d2s is that of a law with w s'/V more of f' and w s''/V more of f'': it is counted there, as it is.
 * Over the mass of mode g, and of the slopes m of dF = m/(4 h), with l the largest 1/(4 h), b = l |q|, w0 the square of
 * the highest frequency at rest, and 2 b x y <= b (x^2 + y^2), the modes and F then have as squares at most
 *     own = w0 (s |F^-1|^2 (1 + 2 b) + |s'| |n| |F^-1| b)   and
 *     more = w0 (s |F^-1|^2 (2 b + 3 b^2) + |s'| |n| |F^-1| (b + 2 b^2)) besides the law's,
 * and as they share no displacement, the element has the larger of own and (law's + more). */

/* x, s and its derivatives by x; of control that does not follow, 0, 1, 0, 0. */
typedef struct stability_stiffening {
    double x, now, slope, curve;
} stability_stiffening;

ELEMENT_FUNCTION stability_stiffening stability_stiffening_of(form f, hourglass_kind kind, element_tensor h,
                                                              const double *c)
{
    stability_stiffening s = {0, 1, 0, 0};
    if (!element_follows(f, kind))
        return s;
    s.x = form_first_x(h);
    const form_shear t = form_sheared(f, s.x, c);
    s.now = t.now / t.rest;
    s.slope = t.slope / t.rest;
    s.curve = form_sheared_curve(f, s.x, c) / t.rest;
    return s;
}

/* Adds w d2s to the law whose tangent is asked for; density: w/V, J/m3. */
ELEMENT_FUNCTION void stability_stiffen(stability_stiffening s, double density, double *c)
{
    if (s.slope != 0 || s.curve != 0)
        form_first_add_at(c, s.x, density * s.slope, density * s.curve);
}

typedef struct stability_twists {
    double own, more;
} stability_twists;

/* No less than the largest singular value of a, as tangent_stretch. */
ELEMENT_FUNCTION double stability_norm(element_tensor a)
{
    const double row = fmax(fmax(fabs(a.xx) + fabs(a.xy) + fabs(a.xz), fabs(a.yx) + fabs(a.yy) + fabs(a.yz)),
                            fabs(a.zx) + fabs(a.zy) + fabs(a.zz));
    const double column = fmax(fmax(fabs(a.xx) + fabs(a.yx) + fabs(a.zx), fabs(a.xy) + fabs(a.yy) + fabs(a.zy)),
                               fabs(a.xz) + fabs(a.yz) + fabs(a.zz));
    return sqrt(row * column);
}

/* |n|, n = dx/dF. */
ELEMENT_FUNCTION double stability_normal(element_tensor h)
{
    double most;
    const element_tensor n = form_first_normal(h, &most);
    return sqrt(tangent_dot(n, n));
}

/* At H, of modes m with G^T m of such a length, G = cof F. square: at rest; slope: 1/m, the largest 1/(4 h). */
ELEMENT_FUNCTION stability_twists stability_twists_by(hourglass_kind kind, double square, double slope,
                                                      element_tensor h, double length, stability_stiffening s)
{
    const double inverse = 1 / (1 + element_dilation(h)), norm = stability_norm(element_cofactor(h)) * inverse;
    const double b = slope * length * fabs(inverse), now = square * norm * norm * s.now;
    stability_twists t = {now * (1 + 2 * b), now * (2 * b + 3 * b * b)};
    if (kind == HOURGLASS_ISOTROPIC)
        t = (stability_twists){square, 0};
    if (s.slope != 0) {
        const double across = square * fabs(norm * s.slope) * stability_normal(h) * b;
        t.own += across;
        t.more += across * (1 + 2 * b);
    }
    return t;
}

ELEMENT_FUNCTION stability_twists stability_twists_of(hourglass_kind kind, double square, double slope,
                                                      element_tensor h, const hourglass_modes *m,
                                                      stability_stiffening s)
{
    const hourglass_modes w = hourglass_all_by_columns(element_cofactor(h), *m);
    return stability_twists_by(kind, square, slope, h, sqrt(hourglass_dot(&w, &w)), s);
}

/* The square of the element's highest frequency, from the largest eigenvalue of stability_matrix. */
ELEMENT_FUNCTION double stability_square(stability_twists t, double eigenvalue)
{
    const double law = eigenvalue + t.more; /* no number stays none, which fmax would lose */
    return t.own > law ? t.own : law;
}

/* What that eigenvalue may be, so that the square is at most limit; no eigenvalue is below what it gives where the
 * modes alone are past it. */
ELEMENT_FUNCTION double stability_room(stability_twists t, double limit)
{
    return limit > t.own ? limit - t.more : 0;
}

ELEMENT_FUNCTION stability_range stability_range_with(stability_range r, stability_twists t)
{
    const stability_range range = {r.low, stability_square(t, r.high)};
    return range;
}

/* D of an element of these sides. */
ELEMENT_FUNCTION element_vector stability_diagonal(double density, const double side[3])
{
    const double unit = 2 / sqrt(density);
    const element_vector d = {unit / side[0], unit / side[1], unit / side[2]};
    return d;
}

/* Of an element of these sides. */
ELEMENT_FUNCTION stability_range stability_range_of(form f, const double *c, double density, const double side[3],
                                                    element_tensor h, element_fibre fibre, element_fibre second)
{
    return stability_range_scaled(f, c, stability_diagonal(density, side), h, fibre, second);
}

#endif
