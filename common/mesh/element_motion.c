#include "mesh/element_motion.h"

#include "mesh/gradient.h"
#include "mesh/hexahedron.h"
#include "mesh/lattice.h"
#include "physics/element_cut.h"
#include "physics/hourglass_numbers.h"

#include <string.h>

int element_mesh_of(element_mesh *to, const model *m, err *e)
{
    const model_array *node = model_need(m, "element.node", e), *rest = model_need(m, "node.position", e);
    const model_array *fraction = model_find(m, "element.fraction");
    lattice l = {0};
    if (!node || !rest)
        return -1;
    *to = (element_mesh){.node = node->i32, .corners = node->columns, .elements = node->rows, .rest = rest->f64};
    to->is_lattice = node->columns == 8 && model_meta_of(m, "lattice.spacing");
    if (to->is_lattice &&
        (lattice_of(m, &l, e) || cut_moments_of(&to->cut, m, e) || borders_of(&to->borders, &to->cut, m, e)))
        return -1;
    memcpy(to->side, l.spacing, sizeof to->side);
    to->fraction = fraction ? fraction->f32 : NULL;
    return 0;
}

static element_modes modes_of(const int32_t *node, const double *u, int axis)
{
    element_corners c;
    for (int i = 0; i < 8; i++)
        c.at[i] = u[3 * (int64_t)node[i] + axis];
    return element_modes_of(c);
}

/* Makes the shape of an element that is no box, and the sum of its B^2 (1/m2). */
static element_any shape_of(const element_mesh *m, const int32_t *node, double *squares)
{
    double at[24], b[24], slope[21], twist[12], basis[9];
    for (int i = 0; i < 24; i++)
        at[i] = m->rest[3 * (int64_t)node[i / 3] + i % 3] - m->rest[3 * (int64_t)node[0] + i % 3];
    const double volume = hexahedron_mean(at, b);
    hexahedron_modes(at, b, slope, twist);
    hexahedron_basis(at, basis);
    *squares = 0;
    for (int i = 0; i < 24; i++)
        *squares += b[i] * b[i];
    return element_any_of(slope, twist, volume, basis);
}

/* cut: the moments of one that is cut, or NULL. */
static element_motion of_hexahedron(const element_mesh *m, const int32_t *node, const float *cut, const double *u)
{
    element_motion to = {.volume = m->side[0] * m->side[1] * m->side[2]};
    element_modes x = modes_of(node, u, 0), y = modes_of(node, u, 1), z = modes_of(node, u, 2);
    if (m->is_lattice) {
        to.squares = hourglass_squares(m->side);
        const element_vector slope = element_box(m->side[0], m->side[1], m->side[2]).slope;
        to.h = element_gradient_by(cut, x, y, z, slope);
        to.along[0] = x, to.along[1] = y, to.along[2] = z;
    } else {
        to.any = shape_of(m, node, &to.squares);
        to.volume = to.any.volume;
        to.h = element_any_twist(&to.any, &x, &y, &z);
    }
    to.modes = element_hourglass_modes(x, y, z);
    return to;
}

static element_motion of_tetrahedron(const element_mesh *m, const int32_t *node, const double *u)
{
    double h[9], edge[3][3];
    gradient_of(node, 4, m->rest, u, h);
    for (int i = 0; i < 9; i++)
        edge[i / 3][i % 3] = m->rest[3 * (int64_t)node[1 + i / 3] + i % 3] - m->rest[3 * (int64_t)node[0] + i % 3];
    const double *a = edge[0], *b = edge[1], *c = edge[2];
    return (element_motion){.h = {h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8]},
                            .volume = (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                                       a[2] * (b[0] * c[1] - b[1] * c[0])) /
                                      6};
}

element_motion element_motion_of(const element_mesh *m, int64_t element, const double *u)
{
    const int32_t *node = m->node + element * m->corners;
    const float *cut = m->cut.count ? cut_moments_at(&m->cut, element) : NULL;
    return m->corners == 8 ? of_hexahedron(m, node, cut, u) : of_tetrahedron(m, node, u);
}

/* ---- laminates */

bool laminates_at(const element_mesh *mesh, const materials_map *map, hourglass_control control, int64_t element,
                  const element_motion *motion, laminate_motion *to)
{
    const int64_t row = mesh->borders.count ? borders_at(&mesh->borders, element) : -1;
    if (row < 0)
        return false;
    const double share = (double)map->mixture[element];
    const material_numbers own = material_numbers_of(&map->of_volume[map->volume[element]]),
                           other = material_numbers_of(&map->of_volume[map->mix[element]]),
                           between = material_mixed(&own, &other, share);
    double n[LAMINATE_NUMBERS];
    borders_numbers(&mesh->borders, row, cut_moments_at(&mesh->cut, element), mesh->side,
                    mesh->fraction ? (double)mesh->fraction[element] : 1, share, n);
    const element_laminate l = laminate_by(n, share, own.at_rest.bulk, other.at_rest.bulk);
    to->form = form_of_both(own.form, own.c, other.form, other.c, to->c[0], to->c[1]);
    for (int i = 0; i < form_moduli(to->form); i++) {
        to->c[0][i] *= 1 - share;
        to->c[1][i] *= share;
    }
    memcpy(to->law.c, between.c, sizeof between.c);
    hourglass_numbers(control, between.at_rest.mu, between.at_rest.bulk, mesh->side, to->law.hourglass);
    const element_shape box = element_box(mesh->side[0], mesh->side[1], mesh->side[2]);
    to->is = laminate_held(to->form, control.kind, motion->along[0], motion->along[1], motion->along[2], box, &to->law,
                           to->c[0], to->c[1], &l);
    return true;
}

/* P F^T. */
static element_tensor pushed(element_tensor p, element_tensor h)
{
    const element_tensor f = {1 + h.xx, h.yx, h.zx, h.xy, 1 + h.yy, h.zy, h.xz, h.yz, 1 + h.zz};
    return element_product(p, f);
}

element_tensor laminates_stress(const laminate_motion *of)
{
    return element_sum(pushed(of->is.p1, of->is.h1), pushed(of->is.p2, of->is.h2));
}

double laminates_energy(const laminate_motion *of, int part)
{
    return form_energy(of->form, part ? of->is.h2 : of->is.h1, of->c[part]);
}
