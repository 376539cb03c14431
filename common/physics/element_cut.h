/* The maths of a box of which only a part is tissue, by the mean strain of that part. Owns nothing.
 *
 * Over the box a component of the displacement is the sum of its eight modes (element.h), so with xi, eta and zeta from
 * -1 to 1 the slope along x is, at a point,
 *     du/dx = (m_x + eta m_xy + zeta m_zx + eta zeta m_xyz)/(4 h_x),
 * and its mean over the part has the part's means of eta, zeta and eta zeta in it; along y and z likewise. These six
 * means, the part's moments, and the share of the box that it fills are all that the mean gradient takes. Forces are
 * the transpose: with V the part's volume, mode xy gets V (P_.x y/(4 h_x) + P_.y x/(4 h_y)), and so on. So where P is
 * the same everywhere, the nodes' forces are those of tractions P n on the part's surface, however it lies in the box
 * (a patch test that a share alone fails), and all that is of H and P, fibres and muscles too, holds as it stands.
 *
 * Hourglass modes are held as those of a whole box, times the share: an affine displacement has none. */
#ifndef SINEW_ELEMENT_CUT_H
#define SINEW_ELEMENT_CUT_H

#include "physics/element.h"

/* Means over the part of xi, eta, zeta, xi eta, eta zeta and zeta xi; all 0 of a whole box. */
typedef struct element_cut {
    real x, y, z, xy, yz, zx;
} element_cut;

/* What hourglass modes of a component add to its mean slopes. */
ELEMENT_FUNCTION element_vector element_cut_slopes(element_modes m, element_vector slope, element_cut c)
{
    element_vector s = {slope.x * (c.y * m.xy + c.z * m.zx + c.yz * m.xyz),
                        slope.y * (c.x * m.xy + c.z * m.yz + c.zx * m.xyz),
                        slope.z * (c.y * m.yz + c.x * m.zx + c.xy * m.xyz)};
    return s;
}

/* H = grad u, its mean over the part. */
ELEMENT_FUNCTION element_tensor element_cut_gradient(element_modes x, element_modes y, element_modes z,
                                                     element_vector slope, element_cut c)
{
    const element_vector u = element_cut_slopes(x, slope, c), v = element_cut_slopes(y, slope, c),
                         w = element_cut_slopes(z, slope, c);
    const element_tensor more = {u.x, u.y, u.z, v.x, v.y, v.z, w.x, w.y, w.z};
    return element_sum(element_gradient(x, y, z, slope), more);
}

ELEMENT_FUNCTION element_vector element_cut_sum(element_vector a, element_vector b)
{
    element_vector s = {a.x + b.x, a.y + b.y, a.z + b.z};
    return s;
}

/* by_i P_.i + by_j P_.j: what P pulls a mode with. */
ELEMENT_FUNCTION element_vector element_cut_mode(element_vector i, real by_i, element_vector j, real by_j)
{
    element_vector f = {i.x * by_i + j.x * by_j, i.y * by_i + j.y * by_j, i.z * by_i + j.z * by_j};
    return f;
}

/* The transpose: adds to the forces on hourglass modes what P pulls them with. */
ELEMENT_FUNCTION hourglass_modes element_cut_pull(hourglass_modes f, element_tensor p, element_vector area,
                                                  element_cut c)
{
    const element_vector x = {p.xx * area.x, p.yx * area.x, p.zx * area.x},
                         y = {p.xy * area.y, p.yy * area.y, p.zy * area.y},
                         z = {p.xz * area.z, p.yz * area.z, p.zz * area.z};
    const element_vector corner = {z.x * c.xy, z.y * c.xy, z.z * c.xy};
    hourglass_modes to = {element_cut_sum(f.xy, element_cut_mode(x, c.y, y, c.x)),
                          element_cut_sum(f.yz, element_cut_mode(y, c.z, z, c.y)),
                          element_cut_sum(f.zx, element_cut_mode(x, c.z, z, c.x)),
                          element_cut_sum(f.xyz, element_cut_sum(element_cut_mode(x, c.yz, y, c.zx), corner))};
    return to;
}

/* As element_force_of, of a part. */
ELEMENT_FUNCTION element_field element_cut_force_of(hourglass_kind kind, element_tensor p, hourglass_force *held,
                                                    element_shape shape, element_cut c)
{
    if (kind == HOURGLASS_PHYSICAL)
        p = element_sum(p, held->p);
    held->f = element_cut_pull(held->f, p, shape.area, c);
    return element_force_of(HOURGLASS_ISOTROPIC, p, held, shape); /* P has held->p by now */
}

/* The strain that the forces of a part are computed from. */
typedef struct element_cut_state {
    element_tensor h;
    hourglass_modes modes;
} element_cut_state;

/* The state of a part; control follows the law from here. */
ELEMENT_FUNCTION element_cut_state element_cut_begin(form f, hourglass_kind kind, element_field u, element_shape shape,
                                                     element_law *law, element_cut c)
{
    const element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    const element_cut_state s = {element_cut_gradient(x, y, z, shape.slope, c), element_hourglass_modes(x, y, z)};
    element_follow(f, kind, s.modes, s.h, shape, law);
    return s;
}

/* The forces of P. */
ELEMENT_FUNCTION element_field element_cut_end(hourglass_kind kind, element_tensor p, element_cut_state s,
                                               element_shape shape, const real *hourglass, element_cut c)
{
    hourglass_force held = hourglass_of(kind, s.modes, s.h, shape, hourglass);
    return element_cut_force_of(kind, p, &held, shape, c);
}

/* As element_force_fibred, of a part; what is linear in its volume is the law's and the fibres', as share is there. */
ELEMENT_FUNCTION element_field element_force_cut(form f, hourglass_kind kind, element_field u, element_shape shape,
                                                 element_law law, element_fibre fibre, int which, element_fibre second,
                                                 int which_second, const fibre_set *sets, int count, element_cut c)
{
    const element_cut_state s = element_cut_begin(f, kind, u, shape, &law, c);
    const element_tensor p = element_stress(f, s.h, law.c, fibre, which, second, which_second, sets, count);
    return element_cut_end(kind, p, s, shape, law.hourglass, c);
}

/* As element_force_cut, of a law alone: without fibres that a compiler would fill and copy. */
ELEMENT_FUNCTION element_field element_force_cut_plain(form f, hourglass_kind kind, element_field u,
                                                       element_shape shape, element_law *law, element_cut c)
{
    const element_cut_state s = element_cut_begin(f, kind, u, shape, law, c);
    return element_cut_end(kind, form_stress(f, s.h, law->c), s, shape, law->hourglass, c);
}

#ifdef REAL_IS_DOUBLE
/* moments: a row of cut.moments (mesh/cut_moments.h). */
ELEMENT_FUNCTION element_cut element_cut_of(const float *moments)
{
    const element_cut c = {moments[0], moments[1], moments[2], moments[3], moments[4], moments[5]};
    return c;
}

/* H of a box that may be cut; moments: NULL where it is whole. */
ELEMENT_FUNCTION element_tensor element_gradient_by(const float *moments, element_modes x, element_modes y,
                                                    element_modes z, element_vector slope)
{
    return moments ? element_cut_gradient(x, y, z, slope, element_cut_of(moments)) : element_gradient(x, y, z, slope);
}
#endif

#endif
