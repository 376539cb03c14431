/* The maths of a box that a border parts into two materials: a laminate of these across the border's normal N. Owns
 * nothing.
 *
 * With s the share of the second part and H_1, H_2 the means over the parts of the gradient of the box's modes
 * (element_cut.h), the parts have
 *     F_1 = I + H_1 - s a (x) N,   F_2 = I + H_2 + (1 - s) a (x) N,
 * so along the border both stretch alike, and the mean of the two is F at the centre. The kink of the displacement, the
 * part of a (x) N that is across the border, also moves the corners: a k, with k = max(0, N.X - d), of which the slopes
 * are those of F and the hourglass modes, kappa, are no bending. So the energy is
 *     W = V ((1 - s) W_1(F_1) + s W_2(F_2)) + w(m - a kappa),   w of hourglass modes (hourglass.h) at the mean F,
 * and a is where it is least: N then has as good as the same traction on both sides,
 *     s (1 - s) V (P_2 - P_1) N - sum over modes of kappa_g f_g = 0.
 * As dW/da = 0, forces are those of F_1, F_2 and m - a kappa with a kept: no derivative of a is in them. In series
 * across and side by side along: a laminate's own moduli, whatever the two laws are.
 *
 * A surface may cut the box (element_cut.h): then s is the second part's share of what is tissue, V the volume of that,
 * and what is said of the mean F is of F's mean over it. As the parts' mean is that F whatever a is, the box still
 * passes the patch test of one stress; k at corners that are out of the tissue is as at the others.
 *
 * a is found by at most LAMINATE_TURNS of Newton's, from 0 on, until the next would change it by less than
 * LAMINATE_ENOUGH of it, by the matrix
 *     s (1 - s) V ((1 - s) A_2 + s A_1) + hourglass,   A_il = d2W/dF_ij dF_lm N_j N_m,
 * where A is that of a law of I1bar and J which has the law's bulk modulus and its stiffness in shear (form_shear.h):
 * exact of neo-Hookean laws and of those in form FIRST. With x = I1bar - 3, T = f'(x), g = cof F N, v = F N:
 *     A = 2 T J^-2/3 (I + 5/9 I1/J^2 g (x) g - 2/3 (v (x) g + g (x) v)/J) + K g (x) g + T' d (x) d,
 *     d = 2 J^-2/3 (v - I1/(3 J) g).
 * What is left of a is told (`left`). */
#ifndef SINEW_ELEMENT_LAMINATE_H
#define SINEW_ELEMENT_LAMINATE_H

#include "physics/element_cut.h"
#include "physics/laminate_numbers.h"

enum { LAMINATE_TURNS = 5 };
#ifdef ELEMENT_SINGLE
#define LAMINATE_ENOUGH 3e-6
#else
#define LAMINATE_ENOUGH 1e-11
#endif

/* kappa: of modes xy, yz, zx and xyz, m. */
typedef struct laminate_kink {
    real xy, yz, zx, xyz;
} laminate_kink;

typedef struct element_laminate {
    element_vector normal; /* N, at rest, of length 1, from the first part to the second */
    element_cut second;    /* moments of the second part, */
    element_cut whole;     /* and of both together: 0 of a box that no surface cuts */
    real share;            /* of the second in both, above 0 and below 1 */
    laminate_kink kink;
    real bulk[2]; /* of the parts: Pa */
} element_laminate;

/* What the parts do at given modes. p1 and p2 are by their shares. */
typedef struct laminate_state {
    element_tensor h, h1, h2, p1, p2;
    element_vector jump, left; /* a; what another turn would take off it */
    hourglass_modes modes;     /* m - a kappa */
    hourglass_force held;
} laminate_state;

ELEMENT_FUNCTION element_cut laminate_first(const element_laminate *l)
{
    const element_cut *a = &l->second, *b = &l->whole;
    const real k = -l->share / (1 - l->share), w = 1 / (1 - l->share);
    const element_cut c = {k * a->x + w * b->x,   k * a->y + w * b->y,   k * a->z + w * b->z,
                           k * a->xy + w * b->xy, k * a->yz + w * b->yz, k * a->zx + w * b->zx};
    return c;
}

/* by a (x) n. */
ELEMENT_FUNCTION element_tensor laminate_dyad(element_vector a, element_vector n, real by)
{
    const element_tensor t = {by * a.x * n.x, by * a.x * n.y, by * a.x * n.z, by * a.y * n.x, by * a.y * n.y,
                              by * a.y * n.z, by * a.z * n.x, by * a.z * n.y, by * a.z * n.z};
    return t;
}

/* m - a kappa. */
ELEMENT_FUNCTION hourglass_modes laminate_unkinked(hourglass_modes m, element_vector a, laminate_kink k)
{
    const hourglass_modes to = {{m.xy.x - a.x * k.xy, m.xy.y - a.y * k.xy, m.xy.z - a.z * k.xy},
                                {m.yz.x - a.x * k.yz, m.yz.y - a.y * k.yz, m.yz.z - a.z * k.yz},
                                {m.zx.x - a.x * k.zx, m.zx.y - a.y * k.zx, m.zx.z - a.z * k.zx},
                                {m.xyz.x - a.x * k.xyz, m.xyz.y - a.y * k.xyz, m.xyz.z - a.z * k.xyz}};
    return to;
}

/* The sum over modes of kappa_g f_g. */
ELEMENT_FUNCTION element_vector laminate_kinked(const hourglass_modes *f, laminate_kink k)
{
    const element_vector to = {k.xy * f->xy.x + k.yz * f->yz.x + k.zx * f->zx.x + k.xyz * f->xyz.x,
                               k.xy * f->xy.y + k.yz * f->yz.y + k.zx * f->zx.y + k.xyz * f->xyz.y,
                               k.xy * f->xy.z + k.yz * f->yz.z + k.zx * f->zx.z + k.xyz * f->xyz.z};
    return to;
}

/* What hourglass modes have of the matrix: its column for a along one axis. */
ELEMENT_FUNCTION element_vector laminate_column(hourglass_kind kind, element_vector a, const element_laminate *l,
                                                element_tensor h, element_shape shape, const real *hourglass)
{
    const hourglass_modes none = {{REAL_ZERO, REAL_ZERO, REAL_ZERO},
                                  {REAL_ZERO, REAL_ZERO, REAL_ZERO},
                                  {REAL_ZERO, REAL_ZERO, REAL_ZERO},
                                  {REAL_ZERO, REAL_ZERO, REAL_ZERO}};
    const element_vector back = {-a.x, -a.y, -a.z};
    const hourglass_force f = hourglass_of(kind, laminate_unkinked(none, back, l->kink), h, shape, hourglass);
    return laminate_kinked(&f.f, l->kink);
}

ELEMENT_FUNCTION element_symmetric laminate_hourglass(hourglass_kind kind, const element_laminate *l, element_tensor h,
                                                      element_shape shape, const real *hourglass)
{
    const real one = REAL_ZERO + 1;
    const element_vector ex = {one, REAL_ZERO, REAL_ZERO}, ey = {REAL_ZERO, one, REAL_ZERO},
                         ez = {REAL_ZERO, REAL_ZERO, one};
    const element_vector x = laminate_column(kind, ex, l, h, shape, hourglass),
                         y = laminate_column(kind, ey, l, h, shape, hourglass),
                         z = laminate_column(kind, ez, l, h, shape, hourglass);
    const element_symmetric q = {x.x, y.y, z.z, x.y, y.z, z.x};
    return q;
}

/* Adds `by` A of a part at H to the matrix. c, bulk: by the part's share. */
ELEMENT_FUNCTION element_symmetric laminate_add(element_symmetric q, form f, element_tensor h, const real *c, real bulk,
                                                element_vector n, real by)
{
    const real dilation = element_dilation(h), inverse = 1 / (1 + dilation);
    const real root = element_cube_root_inverse(1 + dilation), square = root * root;
    const real first = (3 + element_green_trace(h)) * inverse;
    const form_shear t = form_sheared(f, form_first_x(h), c);
    const element_vector g = hourglass_by_rows(element_cofactor(h), n), u = hourglass_by_rows(h, n),
                         v = {u.x + n.x, u.y + n.y, u.z + n.z};
    const real shear = by * 2 * t.now * square, mixed = R(2. / 3) * shear * inverse, third = R(1. / 3) * first;
    const real wave = by * bulk + R(5. / 9) * shear * first * inverse, slope = by * 4 * t.slope * square * square;
    const element_vector d = {v.x - third * g.x, v.y - third * g.y, v.z - third * g.z};
    const element_symmetric to = {q.xx + shear + wave * g.x * g.x - mixed * (2 * v.x * g.x) + slope * d.x * d.x,
                                  q.yy + shear + wave * g.y * g.y - mixed * (2 * v.y * g.y) + slope * d.y * d.y,
                                  q.zz + shear + wave * g.z * g.z - mixed * (2 * v.z * g.z) + slope * d.z * d.z,
                                  q.xy + wave * g.x * g.y - mixed * (v.x * g.y + v.y * g.x) + slope * d.x * d.y,
                                  q.yz + wave * g.y * g.z - mixed * (v.y * g.z + v.z * g.y) + slope * d.y * d.z,
                                  q.zx + wave * g.z * g.x - mixed * (v.z * g.x + v.x * g.z) + slope * d.z * d.x};
    return to;
}

/* q^-1 r, of a positive definite q. */
ELEMENT_FUNCTION element_vector laminate_solved(element_symmetric q, element_vector r)
{
    const real xx = q.yy * q.zz - q.yz * q.yz, yy = q.zz * q.xx - q.zx * q.zx, zz = q.xx * q.yy - q.xy * q.xy;
    const real xy = q.yz * q.zx - q.xy * q.zz, yz = q.zx * q.xy - q.yz * q.xx, zx = q.xy * q.yz - q.zx * q.yy;
    const real inverse = 1 / (q.xx * xx + q.xy * xy + q.zx * zx);
    const element_vector d = {inverse * (xx * r.x + xy * r.y + zx * r.z), inverse * (xy * r.x + yy * r.y + yz * r.z),
                              inverse * (zx * r.x + yz * r.y + zz * r.z)};
    return d;
}

/* Tells which elements take another turn; each decides for itself, whichever are computed beside it. */
ELEMENT_FUNCTION real_mask laminate_goes_on(element_vector jump, element_vector left)
{
    const real a = jump.x * jump.x + jump.y * jump.y + jump.z * jump.z;
    const real d = left.x * left.x + left.y * left.y + left.z * left.z;
    return d > R(LAMINATE_ENOUGH * LAMINATE_ENOUGH) * a;
}

/* hourglass: what holds the modes, as it is at the mean F. first, second: the parts' coefficients, by their shares. */
ELEMENT_FUNCTION laminate_state laminate_of(form f, hourglass_kind kind, element_modes x, element_modes y,
                                            element_modes z, element_shape shape, const real *hourglass,
                                            const real *first, const real *second, const element_laminate *l)
{
    const hourglass_modes m = element_hourglass_modes(x, y, z);
    const element_tensor h1 = element_cut_gradient(x, y, z, shape.slope, laminate_first(l)),
                         h2 = element_cut_gradient(x, y, z, shape.slope, l->second);
    laminate_state to = {.h = element_cut_gradient(x, y, z, shape.slope, l->whole),
                         .jump = {REAL_ZERO, REAL_ZERO, REAL_ZERO}};
    const element_symmetric held = laminate_hourglass(kind, l, to.h, shape, hourglass);
    const real share = l->share, volume = 1 / shape.density, one = volume * (1 - share), other = volume * share;
    for (int turn = 0; turn <= LAMINATE_TURNS; turn++) {
        to.h1 = element_sum(h1, laminate_dyad(to.jump, l->normal, -share));
        to.h2 = element_sum(h2, laminate_dyad(to.jump, l->normal, 1 - share));
        to.p1 = form_stress(f, to.h1, first);
        to.p2 = form_stress(f, to.h2, second);
        to.modes = laminate_unkinked(m, to.jump, l->kink);
        to.held = hourglass_of(kind, to.modes, to.h, shape, hourglass);
        const element_vector t1 = hourglass_by_rows(to.p1, l->normal), t2 = hourglass_by_rows(to.p2, l->normal),
                             k = laminate_kinked(&to.held.f, l->kink);
        const element_vector r = {one * t2.x - other * t1.x - k.x, one * t2.y - other * t1.y - k.y,
                                  one * t2.z - other * t1.z - k.z};
        const element_symmetric q =
            laminate_add(held, f, to.h1, first, (1 - share) * l->bulk[0], l->normal, other * share);
        to.left =
            laminate_solved(laminate_add(q, f, to.h2, second, share * l->bulk[1], l->normal, one * (1 - share)), r);
        const real_mask on = laminate_goes_on(to.jump, to.left);
        if (turn == LAMINATE_TURNS || !real_any(on))
            break;
        to.jump = (element_vector){REAL_SELECT(on, to.jump.x - to.left.x, to.jump.x),
                                   REAL_SELECT(on, to.jump.y - to.left.y, to.jump.y),
                                   REAL_SELECT(on, to.jump.z - to.left.z, to.jump.z)};
    }
    return to;
}

/* The same, where hourglass control follows the law (element_follow): law's c is what that adds to f' at the mean F,
 * alone. law: between the two, of the whole. */
ELEMENT_FUNCTION laminate_state laminate_held(form f, hourglass_kind kind, element_modes x, element_modes y,
                                              element_modes z, element_shape shape, element_law *law, const real *first,
                                              const real *second, const element_laminate *l)
{
    const int follows = element_follows(f, kind);
    const element_tensor h = element_cut_gradient(x, y, z, shape.slope, l->whole);
    const real slope = follows ? element_follow_numbers(f, h, law) : REAL_ZERO;
    const laminate_state to = laminate_of(f, kind, x, y, z, shape, law->hourglass, first, second, l);
    for (int i = 0; i < form_moduli(f); i++)
        law->c[i] = REAL_ZERO;
    if (follows)
        element_followed(hourglass_dot(&to.held.f, &to.modes), slope * shape.density, law);
    return to;
}

/* As element_force_cut. */
ELEMENT_FUNCTION element_field element_force_laminate(form f, hourglass_kind kind, element_field u, element_shape shape,
                                                      element_law law, const real *first, const real *second_law,
                                                      element_fibre fibre, int which, element_fibre second,
                                                      int which_second, const fibre_set *sets, int count,
                                                      const element_laminate *l)
{
    const element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    laminate_state is = laminate_held(f, kind, x, y, z, shape, &law, first, second_law, l);
    const element_tensor mean = element_stress(f, is.h, law.c, fibre, which, second, which_second, sets, count),
                         held = kind == HOURGLASS_PHYSICAL ? element_sum(mean, is.held.p) : mean;
    is.held.f = element_cut_pull(is.held.f, is.p1, shape.area, laminate_first(l));
    is.held.f = element_cut_pull(is.held.f, is.p2, shape.area, l->second);
    is.held.f = element_cut_pull(is.held.f, held, shape.area, l->whole);
    return element_force_of(kind, element_sum(element_sum(is.p1, is.p2), mean), &is.held, shape);
}

#ifdef REAL_IS_DOUBLE
/* n: LAMINATE_NUMBERS; bulk: of the parts, Pa. */
ELEMENT_FUNCTION element_laminate laminate_by(const double *n, double share, double bulk, double other)
{
    const double *c = n + LAMINATE_SECOND, *w = n + LAMINATE_WHOLE, *k = n + LAMINATE_KINK;
    const element_laminate l = {{n[0], n[1], n[2]},
                                {c[0], c[1], c[2], c[3], c[4], c[5]},
                                {w[0], w[1], w[2], w[3], w[4], w[5]},
                                share,
                                {k[0], k[1], k[2], k[3]},
                                {bulk, other}};
    return l;
}

/* J/m3, by the volume of the whole at rest: of the two laws, whose coefficients are by their shares. */
ELEMENT_FUNCTION double laminate_energy(form f, const laminate_state *is, const double *first, const double *second)
{
    return form_energy(f, is->h1, first) + form_energy(f, is->h2, second);
}
#endif

#endif
