/* The maths of one element that is any hexahedron, one integration point, hourglass control as in element.h, whose
 * stress, modes and conventions it takes. With B_ai the mean over the element of the derivative of corner a's shape
 * function along axis i (Flanagan & Belytschko 1981: the exact integral over V, so that a mesh of any shape passes the
 * patch test), and s_m the signs of mode m at the corners,
 *     H_ki = sum_a u_ka B_ai = sum_m mode_m(u_k) slope_mi,   slope_mi = (1/8) sum_a s_ma B_ai,
 *     gamma_g = s_g - sum_i twist_gi B_i,                     twist_gi = sum_a s_ga x_ai,
 * g the four hourglass modes: gamma_g . u is mode_g(u) - sum_i twist_gi H_i, and nothing where u is linear in x. Of a
 * box the slopes are 1/(4h) on the diagonal and nothing else, the twists are 0: element.h's.
 */
#ifndef SINEW_ELEMENT_ANY_H
#define SINEW_ELEMENT_ANY_H

#include "physics/element.h"

enum { ELEMENT_MODES = 7, ELEMENT_TWISTS = 4, ELEMENT_ANY = 3 * (ELEMENT_MODES + ELEMENT_TWISTS) + 1 };

/* slope: of modes x, y, z, xy, yz, zx, xyz along axes x, y, z (1/m); twist: of xy, yz, zx, xyz (m); volume: m3. */
typedef struct element_any {
    element_vector slope[ELEMENT_MODES], twist[ELEMENT_TWISTS];
    real volume;
    element_tensor basis; /* dX/dxi at the centre (m), a column an axis: of physical hourglass control */
} element_any;

#ifdef REAL_IS_DOUBLE
/* From a mesh's numbers (mesh/hexahedron.h): slope, 7 x 3; twist, 4 x 3; basis, 3 x 3. */
ELEMENT_FUNCTION element_any element_any_of(const double *slope, const double *twist, double volume,
                                            const double *basis)
{
    element_any s;
    s.volume = volume;
    for (int m = 0; m < ELEMENT_MODES; m++, slope += 3) {
        const element_vector v = {slope[0], slope[1], slope[2]};
        s.slope[m] = v;
    }
    for (int g = 0; g < ELEMENT_TWISTS; g++, twist += 3) {
        const element_vector v = {twist[0], twist[1], twist[2]};
        s.twist[g] = v;
    }
    const element_tensor columns = {basis[0], basis[1], basis[2], basis[3], basis[4],
                                    basis[5], basis[6], basis[7], basis[8]};
    s.basis = columns;
    return s;
}
#endif

ELEMENT_FUNCTION element_vector element_any_row(const element_any *s, element_modes u)
{
    element_vector h = {u.x * s->slope[0].x + u.y * s->slope[1].x + u.z * s->slope[2].x + u.xy * s->slope[3].x +
                            u.yz * s->slope[4].x + u.zx * s->slope[5].x + u.xyz * s->slope[6].x,
                        u.x * s->slope[0].y + u.y * s->slope[1].y + u.z * s->slope[2].y + u.xy * s->slope[3].y +
                            u.yz * s->slope[4].y + u.zx * s->slope[5].y + u.xyz * s->slope[6].y,
                        u.x * s->slope[0].z + u.y * s->slope[1].z + u.z * s->slope[2].z + u.xy * s->slope[3].z +
                            u.yz * s->slope[4].z + u.zx * s->slope[5].z + u.xyz * s->slope[6].z};
    return h;
}

/* H, the mean of grad u. */
ELEMENT_FUNCTION element_tensor element_any_gradient(const element_any *s, element_modes x, element_modes y,
                                                     element_modes z)
{
    element_vector a = element_any_row(s, x), b = element_any_row(s, y), c = element_any_row(s, z);
    element_tensor h = {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
    return h;
}

ELEMENT_FUNCTION real element_any_dot(element_vector a, real x, real y, real z)
{
    return a.x * x + a.y * y + a.z * z;
}

/* The hourglass modes of one component, gamma . u, in place of its own; hx, hy, hz: its row of H. */
ELEMENT_FUNCTION element_modes element_any_twisted(const element_any *s, element_modes u, real hx, real hy, real hz)
{
    element_modes q = u;
    q.xy = u.xy - element_any_dot(s->twist[0], hx, hy, hz);
    q.yz = u.yz - element_any_dot(s->twist[1], hx, hy, hz);
    q.zx = u.zx - element_any_dot(s->twist[2], hx, hy, hz);
    q.xyz = u.xyz - element_any_dot(s->twist[3], hx, hy, hz);
    return q;
}

/* H; and the hourglass modes of all three components in place of their own. */
ELEMENT_FUNCTION element_tensor element_any_twist(const element_any *s, element_modes *x, element_modes *y,
                                                  element_modes *z)
{
    element_tensor h = element_any_gradient(s, *x, *y, *z);
    *x = element_any_twisted(s, *x, h.xx, h.xy, h.xz);
    *y = element_any_twisted(s, *y, h.yx, h.yy, h.yz);
    *z = element_any_twisted(s, *z, h.zx, h.zy, h.zz);
    return h;
}

/* One component of f_a = V P B_a + sum_g gamma_g f_g, from its row of P and its hourglass forces. */
ELEMENT_FUNCTION element_corners element_any_gather(const element_any *s, real px, real py, real pz, real xy, real yz,
                                                    real zx, real xyz)
{
    const element_vector *slope = s->slope, *twist = s->twist;
    const real x = s->volume * px - (twist[0].x * xy + twist[1].x * yz + twist[2].x * zx + twist[3].x * xyz);
    const real y = s->volume * py - (twist[0].y * xy + twist[1].y * yz + twist[2].y * zx + twist[3].y * xyz);
    const real z = s->volume * pz - (twist[0].z * xy + twist[1].z * yz + twist[2].z * zx + twist[3].z * xyz);
    element_modes f = {element_any_dot(slope[0], x, y, z),      element_any_dot(slope[1], x, y, z),
                       element_any_dot(slope[2], x, y, z),      element_any_dot(slope[3], x, y, z) + xy,
                       element_any_dot(slope[4], x, y, z) + yz, element_any_dot(slope[5], x, y, z) + zx,
                       element_any_dot(slope[6], x, y, z) + xyz};
    return element_corners_of(f);
}

/* Of the modes, twisted, at H, by the kind. */
ELEMENT_FUNCTION hourglass_force element_any_hourglass(hourglass_kind kind, hourglass_modes m, element_tensor h,
                                                       const element_any *s, const real *law)
{
    if (kind == HOURGLASS_ISOTROPIC)
        return hourglass_isotropic(m, law[HOURGLASS_K]);
    return hourglass_physical_any(m, h, s->basis, s->volume, law);
}

/* As element_force of element.h, with what fibres of `count` volumes, none to two, resist being stretched. */
ELEMENT_FUNCTION element_field element_any_force_fibred(form f, hourglass_kind kind, element_field u,
                                                        const element_any *s, element_law law, element_fibre fibre,
                                                        int which, const fibre_set *sets, int count)
{
    element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    element_tensor h = element_any_twist(s, &x, &y, &z);
    const hourglass_modes modes = element_hourglass_modes(x, y, z);
    const int follows = element_follows(f, kind);
    const real slope = follows ? element_follow_numbers(f, h, &law) : REAL_ZERO;
    const hourglass_force held = element_any_hourglass(kind, modes, h, s, law.hourglass);
    const hourglass_modes *m = &held.f;
    if (follows)
        element_followed(hourglass_dot(m, &modes), slope / s->volume, &law);
    element_tensor p = element_stress(f, h, law.c, fibre, which, fibre, ELEMENT_NO_MUSCLE, sets, count);
    if (kind == HOURGLASS_PHYSICAL)
        p = element_sum(p, held.p);
    element_field force = {element_any_gather(s, p.xx, p.xy, p.xz, m->xy.x, m->yz.x, m->zx.x, m->xyz.x),
                           element_any_gather(s, p.yx, p.yy, p.yz, m->xy.y, m->yz.y, m->zx.y, m->xyz.y),
                           element_any_gather(s, p.zx, p.zy, p.zz, m->xy.z, m->yz.z, m->zx.z, m->xyz.z)};
    return force;
}

/* As element_force of element.h. */
ELEMENT_FUNCTION element_field element_any_force(form f, hourglass_kind kind, element_field u, const element_any *s,
                                                 element_law law, element_fibre fibre, int which)
{
    return element_any_force_fibred(f, kind, u, s, law, fibre, which, 0, 0);
}

#endif
