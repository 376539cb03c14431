/* The maths of one element: a box of eight corners, one integration point at its centre, in total Lagrangian form
 * (Miller, Joldes, Lance & Wittek 2007), with hourglass control in the same form (Joldes, Wittek & Miller 2008).
 * Compiled by gcc, clang and nvcc alike; in the numbers of strain.h and the forms of form_maths.h.
 *
 * Corners are in VTK order. Over a box, a field u with values at the corners is a sum of eight modes: its mean, three
 * slopes (x, y, z) and four hourglass modes (xy, yz, zx, xyz), each a product of signs at the corners. The slopes give
 * the displacement gradient at the centre: the derivatives of the shape functions there are B_ai = +-1/(4 h_i). The
 * hourglass modes are Flanagan & Belytschko's gamma vectors, exact for a box.
 */
#ifndef SINEW_ELEMENT_H
#define SINEW_ELEMENT_H

#include "physics/form_maths.h"
#include "physics/hourglass.h"
#include "physics/muscle_curves.h"
#include "physics/muscle_series.h"

#ifdef ELEMENT_FORCES_ALONE /* numbers without bits have no powers, so no fibres that take them */
typedef struct fibre_set fibre_set;
#else
#include "physics/fibre.h"
#endif

/* One component of a vector field at the eight corners, and all three. */
typedef struct element_corners {
    real at[8];
} element_corners;

typedef struct element_field {
    element_corners x, y, z;
} element_field;

typedef struct element_modes {
    real x, y, z, xy, yz, zx, xyz;
} element_modes;

/* The coefficients of a form (Pa); what holds the hourglass modes, by its kind (hourglass.h). */
typedef struct element_law {
    real c[FORM_NUMBERS], hourglass[HOURGLASS_NUMBERS];
} element_law;

/* Unit direction at rest; the active stress (Pa): activation times peak, over the optimum; the muscle's curves; what it
 * is in series with, if anything. */
typedef struct element_fibre {
    element_vector along;
    real tension;
    muscle_curves curves;
    muscle_series series;
} element_fibre;

/* How much of a muscle a function computes: nothing; its active stress, with the curves at 0; the curves too; the
 * spring in series too. For steppers this is mostly a constant. */
enum { ELEMENT_NO_MUSCLE, ELEMENT_MUSCLE, ELEMENT_CURVED_MUSCLE, ELEMENT_SERIAL_MUSCLE };

/* The modes of one component: sums and differences along x, then y, then z. */
ELEMENT_FUNCTION element_modes element_modes_of(element_corners u)
{
    real s01 = u.at[0] + u.at[1], d01 = u.at[1] - u.at[0];
    real s32 = u.at[3] + u.at[2], d32 = u.at[2] - u.at[3];
    real s45 = u.at[4] + u.at[5], d45 = u.at[5] - u.at[4];
    real s76 = u.at[7] + u.at[6], d76 = u.at[6] - u.at[7];
    real x0 = d01 + d32, xy0 = d32 - d01, y0 = s32 - s01, sum0 = s01 + s32;
    real x1 = d45 + d76, xy1 = d76 - d45, y1 = s76 - s45, sum1 = s45 + s76;
    element_modes m = {x0 + x1, y0 + y1, sum1 - sum0, xy0 + xy1, y1 - y0, x1 - x0, xy1 - xy0};
    return m;
}

/* The way back: the sum of the modes at each corner (no mean: forces of an element have none). */
ELEMENT_FUNCTION element_corners element_corners_of(element_modes m)
{
    real x0 = m.x - m.zx, x1 = m.x + m.zx, y0 = m.y - m.yz, y1 = m.y + m.yz;
    real xy0 = m.xy - m.xyz, xy1 = m.xy + m.xyz;
    real s01 = -m.z - y0, s32 = y0 - m.z, s45 = m.z - y1, s76 = m.z + y1;
    real d01 = x0 - xy0, d32 = x0 + xy0, d45 = x1 - xy1, d76 = x1 + xy1;
    element_corners f = {{s01 - d01, s01 + d01, s32 + d32, s32 - d32, s45 - d45, s45 + d45, s76 + d76, s76 - d76}};
    return f;
}

/* H = grad u at the centre. */
ELEMENT_FUNCTION element_tensor element_gradient(element_modes x, element_modes y, element_modes z,
                                                 element_vector slope)
{
    element_tensor h = {x.x * slope.x, x.y * slope.y, x.z * slope.z, y.x * slope.x, y.y * slope.y,
                        y.z * slope.z, z.x * slope.x, z.y * slope.y, z.z * slope.z};
    return h;
}

/* F a0. */
ELEMENT_FUNCTION element_vector element_fibre_now(element_tensor h, element_vector a)
{
    element_vector m = {a.x + (h.xx * a.x + h.xy * a.y + h.xz * a.z), a.y + (h.yx * a.x + h.yy * a.y + h.yz * a.z),
                        a.z + (h.zx * a.x + h.zy * a.y + h.zz * a.z)};
    return m;
}

ELEMENT_FUNCTION real element_length(element_vector a)
{
    return real_sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

/* t m (x) a0. */
ELEMENT_FUNCTION element_tensor element_along(real t, element_vector m, element_vector a)
{
    element_tensor p = {t * m.x * a.x, t * m.x * a.y, t * m.x * a.z, t * m.y * a.x, t * m.y * a.y,
                        t * m.y * a.z, t * m.z * a.x, t * m.z * a.y, t * m.z * a.z};
    return p;
}

/* P of the muscle's active stress S = a s f(l)/l a0 (x) a0: a s f(l)/l (F a0) (x) a0. No fibre (a0 = 0): none. */
ELEMENT_FUNCTION element_tensor element_active(element_tensor h, element_fibre fibre)
{
    element_vector a = fibre.along, m = element_fibre_now(h, a);
    real l = element_length(m);
    real t = fibre.tension * muscle_force_length(l) / REAL_SELECT(l > 0, l, REAL_ZERO + 1);
    return element_along(t, m, a);
}

#ifndef ELEMENT_FORCES_ALONE

/* lambda - 1 of lambda = |F a0|, |a0| = 1, from the displacement gradient, so that float keeps small strains. */
ELEMENT_FUNCTION real element_fibre_strain(element_tensor h, element_vector a, real lambda)
{
    const element_vector d = {h.xx * a.x + h.xy * a.y + h.xz * a.z, h.yx * a.x + h.yy * a.y + h.yz * a.z,
                              h.zx * a.x + h.zy * a.y + h.zz * a.z};
    return (2 * (a.x * d.x + a.y * d.y + a.z * d.z) + (d.x * d.x + d.y * d.y + d.z * d.z)) / (1 + lambda);
}

/* P of a muscle with curves of its own: sigma/lambda (F a0) (x) a0, sigma as in muscle_curves.h. With curves of 0 the
 * bits of element_active. */
ELEMENT_FUNCTION element_tensor element_curved(element_tensor h, element_fibre fibre)
{
    const element_vector a = fibre.along, m = element_fibre_now(h, a);
    const real lambda = element_length(m);
    const real beyond = muscle_beyond(fibre.curves, element_fibre_strain(h, a, lambda));
    const real sigma = fibre.tension * muscle_force_length(lambda + lambda * fibre.curves.less) +
                       fibre.curves.passive * muscle_passive(fibre.curves, beyond);
    return element_along(sigma / REAL_SELECT(lambda > 0, lambda, REAL_ZERO + 1), m, a);
}

/* Likewise of a muscle in series with a spring, which then pulls in place of the active stress. */
ELEMENT_FUNCTION element_tensor element_serial(element_tensor h, element_fibre fibre)
{
    const element_vector a = fibre.along, m = element_fibre_now(h, a);
    const real lambda = element_length(m), strain = element_fibre_strain(h, a, lambda);
    const real beyond = muscle_beyond(fibre.curves, strain);
    const real active = REAL_SELECT(fibre.series.stiffness > 0, muscle_spring(fibre.series, strain),
                                    fibre.tension * muscle_force_length(lambda + lambda * fibre.curves.less));
    const real sigma = active + fibre.curves.passive * muscle_passive(fibre.curves, beyond);
    return element_along(sigma / REAL_SELECT(lambda > 0, lambda, REAL_ZERO + 1), m, a);
}

/* Its contractile element at the end of a step, at H (muscle_contract). */
ELEMENT_FUNCTION real element_contract(element_tensor h, element_fibre fibre, real most)
{
    const real lambda = element_length(element_fibre_now(h, fibre.along));
    const real tension = fibre.tension * muscle_force_length(lambda + lambda * fibre.curves.less);
    return muscle_contract(fibre.series, element_fibre_strain(h, fibre.along, lambda), tension, most);
}

#ifdef REAL_IS_DOUBLE
/* From numbers of a model: a0; its muscle's curves; what of the element is the muscle's. Without active stress, and of
 * a contractile element as at rest. */
ELEMENT_FUNCTION element_fibre element_fibre_of(const float *along, double share, const double *curve)
{
    const element_fibre fibre = {
        {along[0], along[1], along[2]},
        0,
        {curve[MUSCLE_LESS], share * curve[MUSCLE_PASSIVE], curve[MUSCLE_STIFFENING], curve[MUSCLE_STRAIGHT]},
        {share * curve[MUSCLE_SPRING], 0}};
    return fibre;
}

/* What of such a fibre is to be looked at: ELEMENT_MUSCLE and so on. */
ELEMENT_FUNCTION int element_fibre_which(element_fibre of)
{
    if (of.series.stiffness != 0)
        return ELEMENT_SERIAL_MUSCLE;
    if (of.curves.passive != 0 || of.curves.less != 0)
        return ELEMENT_CURVED_MUSCLE;
    return of.tension != 0 ? ELEMENT_MUSCLE : ELEMENT_NO_MUSCLE;
}

/* What a fibre's passive curve holds, J/m3 by volume at rest: d lambda = optimum dl. No fibre holds nothing, whatever
 * the optimum. */
ELEMENT_FUNCTION double element_fibre_energy(element_tensor h, element_fibre fibre)
{
    const element_vector a = fibre.along;
    const muscle_curves c = fibre.curves;
    if (c.passive == 0 || (a.x == 0 && a.y == 0 && a.z == 0))
        return 0;
    const double strain = element_fibre_strain(h, a, element_length(element_fibre_now(h, a)));
    return c.passive / (1 + c.less) * muscle_passive_sum(c, muscle_beyond(c, strain));
}
#endif

#endif

ELEMENT_FUNCTION element_tensor element_muscle(element_tensor h, element_fibre fibre, int which)
{
#ifndef ELEMENT_FORCES_ALONE
    if (which == ELEMENT_SERIAL_MUSCLE)
        return element_serial(h, fibre);
    if (which == ELEMENT_CURVED_MUSCLE)
        return element_curved(h, fibre);
#endif
    (void)which;
    return element_active(h, fibre);
}

/* P (Pa) of all that an element's tissue does at H: of its law; of the muscles along its fibres, of each of which is
 * looked at what `which` tells, ELEMENT_MUSCLE and so on; and of what of fibres resists being stretched, of `count`
 * volumes, none to two. Steppers, monitors and results take the stress from here. */
ELEMENT_FUNCTION element_tensor element_stress(form f, element_tensor h, const real *c, element_fibre fibre, int which,
                                               element_fibre second, int which_second, const fibre_set *sets, int count)
{
    element_tensor p = form_stress(f, h, c);
    if (which)
        p = element_sum(p, element_muscle(h, fibre, which));
    if (which_second)
        p = element_sum(p, element_muscle(h, second, which_second));
#ifndef ELEMENT_FORCES_ALONE
    if (count)
        p = element_sum(p, fibre_stress(h, sets, count));
#endif
    (void)sets, (void)count;
    return p;
}

ELEMENT_FUNCTION hourglass_modes element_hourglass_modes(element_modes x, element_modes y, element_modes z)
{
    hourglass_modes m = {{x.xy, y.xy, z.xy}, {x.yz, y.yz, z.yz}, {x.zx, y.zx, z.zx}, {x.xyz, y.xyz, z.xyz}};
    return m;
}

/* ---- hourglass control that follows the law (hourglass.h): physical, of a form that stiffens */

ELEMENT_FUNCTION int element_follows(form f, hourglass_kind kind)
{
    return kind == HOURGLASS_PHYSICAL && form_stiffens(f);
}

/* The numbers that hold modes become those at H, s times those at rest. Returns s'/s. */
ELEMENT_FUNCTION real element_follow_numbers(form f, element_tensor h, element_law *law)
{
    const form_shear t = form_sheared(f, form_first_x(h), law->c);
    const real by = 1 / (t.now * t.rest), s = t.now * t.now * by;
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        law->hourglass[i] = law->hourglass[i] * s;
    return t.slope * t.rest * by;
}

/* P has W s'/(s V) dx/dF besides: f' becomes so much more. work: 2 W (J); by: s'/(s V), 1/m3. */
ELEMENT_FUNCTION void element_followed(real work, real by, element_law *law)
{
    form_first_add(law->c, R(.5) * work * by);
}

/* The law of an element that control follows becomes that at H: P, and what holds the modes, are to be found by it.
 * Other laws stay. */
ELEMENT_FUNCTION void element_follow(form f, hourglass_kind kind, hourglass_modes modes, element_tensor h,
                                     element_shape shape, element_law *law)
{
    if (!element_follows(f, kind))
        return;
    const real slope = element_follow_numbers(f, h, law);
    element_followed(hourglass_physical_work(modes, h, shape, law->hourglass), slope * shape.density, law);
}

/* One component of f_a = V P B_a + sum_g gamma_g f_g; px, py, pz: its row of P; the others: of its hourglass forces. */
ELEMENT_FUNCTION element_corners element_gather(real px, real py, real pz, element_vector area, real xy, real yz,
                                                real zx, real xyz)
{
    element_modes f = {px * area.x, py * area.y, pz * area.z, xy, yz, zx, xyz};
    return element_corners_of(f);
}

/* The forces at the corners from P of the tissue and from what holds the modes. */
ELEMENT_FUNCTION element_field element_force_of(hourglass_kind kind, element_tensor p, const hourglass_force *held,
                                                element_shape shape)
{
    const hourglass_modes *m = &held->f;
    if (kind == HOURGLASS_PHYSICAL)
        p = element_sum(p, held->p);
    element_field force = {element_gather(p.xx, p.xy, p.xz, shape.area, m->xy.x, m->yz.x, m->zx.x, m->xyz.x),
                           element_gather(p.yx, p.yy, p.yz, shape.area, m->xy.y, m->yz.y, m->zx.y, m->xyz.y),
                           element_gather(p.zx, p.zy, p.zz, shape.area, m->xy.z, m->yz.z, m->zx.z, m->xyz.z)};
    return force;
}

/* H of displacements u. */
ELEMENT_FUNCTION element_tensor element_gradient_to(element_field u, element_vector slope)
{
    return element_gradient(element_modes_of(u.x), element_modes_of(u.y), element_modes_of(u.z), slope);
}

/* As element_follow, of displacements u. */
ELEMENT_FUNCTION void element_follow_to(form f, hourglass_kind kind, element_field u, element_shape shape,
                                        element_law *law)
{
    const element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    element_follow(f, kind, element_hourglass_modes(x, y, z), element_gradient(x, y, z, shape.slope), shape, law);
}

/* The forces at the corners, of displacements u, from P of the tissue and the numbers that hold the modes. */
ELEMENT_FUNCTION element_field element_force_from(hourglass_kind kind, element_field u, element_tensor p,
                                                  element_shape shape, const real *hourglass)
{
    const element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    const element_tensor h = element_gradient(x, y, z, shape.slope);
    const hourglass_force held = hourglass_of(kind, element_hourglass_modes(x, y, z), h, shape, hourglass);
    return element_force_of(kind, p, &held, shape);
}

/* As element_force, with a second fibre, and what resists being stretched of `count` volumes, none to two. */
ELEMENT_FUNCTION element_field element_force_fibred(form f, hourglass_kind kind, element_field u, element_shape shape,
                                                    element_law law, element_fibre fibre, int which,
                                                    element_fibre second, int which_second, const fibre_set *sets,
                                                    int count)
{
    const element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    const element_tensor h = element_gradient(x, y, z, shape.slope);
    const hourglass_modes modes = element_hourglass_modes(x, y, z);
    element_tensor p = h;
    if (!element_follows(f, kind))
        p = element_stress(f, h, law.c, fibre, which, second, which_second, sets, count);
    element_follow(f, kind, modes, h, shape, &law);
    const hourglass_force held = hourglass_of(kind, modes, h, shape, law.hourglass);
    if (element_follows(f, kind)) /* what it holds is at hand: faster on a processor */
        p = element_stress(f, h, law.c, fibre, which, second, which_second, sets, count);
    return element_force_of(kind, p, &held, shape);
}

/* As element_force, with a second fibre. */
ELEMENT_FUNCTION element_field element_force_of_two(form f, hourglass_kind kind, element_field u, element_shape shape,
                                                    element_law law, element_fibre fibre, int which,
                                                    element_fibre second, int which_second)
{
    return element_force_fibred(f, kind, u, shape, law, fibre, which, second, which_second, 0, 0);
}

/* The internal forces at the corners (N): what the element pulls with, for displacements u (m). which: ELEMENT_MUSCLE
 * and so on. */
ELEMENT_FUNCTION element_field element_force(form f, hourglass_kind kind, element_field u, element_shape shape,
                                             element_law law, element_fibre fibre, int which)
{
    return element_force_of_two(f, kind, u, shape, law, fibre, which, fibre, ELEMENT_NO_MUSCLE);
}

#endif
