/* Elements to try hourglass control with: boxes and hexahedra of any shape, what the code under test makes of them, and
 * their hourglass energy written anew, in complex numbers, from strains in orthonormal axes. Owns nothing.
 */
#ifndef SINEW_HOURGLASS_TRIED_H
#define SINEW_HOURGLASS_TRIED_H

#include "mesh/hexahedron.h"
#include "physics/element_any.h"
#include "physics/stability.h"

#include "corners.h"

#include <complex.h>

typedef double complex number;

static const double mu = 3000 / 2.9, bulk = 10000, density = 1000;

/* ---- an element: its corners at rest, and what the code under test has of it */

typedef struct tried {
    double at[24]; /* m, at rest */
    double b[24];  /* mean derivatives */
    double volume;
    double axis[3][3], dual[3][3]; /* dX/dxi at the centre: axis[c] is column c; and the dual basis */
    bool is_box;
    element_shape box;
    element_any any;
    form form;
    element_law law;
} tried;

static inline void cross(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static inline double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void take_any(tried *t)
{
    double slope[21], twist[12], basis[9];
    hexahedron_modes(t->at, t->b, slope, twist);
    hexahedron_basis(t->at, basis);
    t->any = element_any_of(slope, twist, t->volume, basis);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 3; i++)
            t->axis[c][i] = basis[3 * i + c];
    for (int c = 0; c < 3; c++) {
        cross(t->axis[(c + 1) % 3], t->axis[(c + 2) % 3], t->dual[c]);
        const double by = dot(t->dual[c], t->axis[c]);
        for (int i = 0; i < 3; i++)
            t->dual[c][i] /= by;
    }
}

/* A box of these sides, its corners moved by chance, by `by` of a side; neo-Hookean. */
static inline tried make(double x, double y, double z, double by)
{
    const double side[3] = {x, y, z};
    tried t = {.is_box = by == 0, .box = element_box(x, y, z), .form = FORM_NEO_HOOKEAN, .law = {.c = {mu, bulk}}};
    for (int i = 0; i < 24; i++)
        t.at[i] = side[i % 3] * (corner_of[i / 3][i % 3] + by * chance());
    hourglass_moduli(mu, bulk, t.law.hourglass);
    t.volume = hexahedron_mean(t.at, t.b);
    take_any(&t);
    return t;
}

static inline element_field field_of(const double u[24])
{
    element_field at = {.x = {{0}}};
    for (int c = 0; c < 8; c++) {
        at.x.at[c] = u[3 * c];
        at.y.at[c] = u[3 * c + 1];
        at.z.at[c] = u[3 * c + 2];
    }
    return at;
}

/* By the code under test. any: as a hexahedron of any shape. */
static inline element_field field_of_forces(const tried *t, bool any, const double u[24])
{
    const element_fibre none = {.tension = 0};
    if (any)
        return element_any_force(t->form, HOURGLASS_PHYSICAL, field_of(u), &t->any, t->law, none, false);
    return element_force(t->form, HOURGLASS_PHYSICAL, field_of(u), t->box, t->law, none, false);
}

static inline void forces(const tried *t, bool any, const double u[24], double f[24])
{
    const element_field force = field_of_forces(t, any, u);
    for (int c = 0; c < 8; c++) {
        f[3 * c] = force.x.at[c];
        f[3 * c + 1] = force.y.at[c];
        f[3 * c + 2] = force.z.at[c];
    }
}

/* ---- the energy, anew */

static inline number det(number f[3][3])
{
    return f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) - f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
           f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
}

static inline void invert(number f[3][3], number to[3][3])
{
    const number j = det(f);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int a = (c + 1) % 3, b = (c + 2) % 3, p = (r + 1) % 3, q = (r + 2) % 3;
            to[r][c] = (f[a][p] * f[b][q] - f[a][q] * f[b][p]) / j;
        }
}

/* Plane stress of the strain whose components are e (symmetric), in the plane of two vectors: energy by volume. */
static inline number plane_energy(number e[3][3], const double a[3], const double b[3])
{
    double first[3], second[3], along = dot(a, b) / dot(a, a);
    number in[3] = {0};
    for (int i = 0; i < 3; i++) {
        first[i] = a[i] / sqrt(dot(a, a));
        second[i] = b[i] - along * a[i];
    }
    const double length = sqrt(dot(second, second));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            in[0] += first[i] * e[i][j] * first[j];
            in[1] += second[i] * e[i][j] * second[j] / (length * length);
            in[2] += first[i] * e[i][j] * second[j] / length;
        }
    const double nu = (3 * bulk - 2 * mu) / (2 * (3 * bulk + mu)), young = 2 * mu * (1 + nu);
    return young / (1 - nu * nu) / 2 * (in[0] * in[0] + in[1] * in[1] + 2 * nu * in[0] * in[1]) +
           2 * mu * in[2] * in[2];
}

/* The strain sym(sum of mode (x) dual) / 8. */
static inline void add_strain(const number mode[3], const double dual[3], number e[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            e[i][j] += (mode[i] * dual[j] + mode[j] * dual[i]) / 16;
}

/* The energy of the modes, with the moduli at rest; *volume and *trace get J and tr C. */
static inline number held_energy(const tried *t, const number u[24], number *volume, number *trace)
{
    static const int modes[4][3] = {{1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}};
    number f[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, inverse[3][3], q[4][3] = {{0}}, w = 0;
    for (int c = 0; c < 8; c++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                f[i][j] += u[3 * c + i] * t->b[3 * c + j];
    invert(f, inverse);
    for (int g = 0; g < 4; g++)
        for (int i = 0; i < 3; i++) {
            number mode[3] = {0}; /* gamma . u = gamma . x, x the place now; gamma takes nothing of what is linear */
            for (int k = 0; k < 3; k++)
                for (int c = 0; c < 8; c++) {
                    double gamma = 1;
                    for (int a = 0; a < 3; a++)
                        gamma *= modes[g][a] && !corner_of[c][a] ? -1 : 1;
                    mode[k] += gamma * u[3 * c + k];
                    for (int a = 0; a < 3; a++)
                        mode[k] -= gamma * t->at[3 * c + a] * (f[k][a] - (k == a));
                }
            for (int k = 0; k < 3; k++)
                q[g][i] += inverse[i][k] * mode[k];
        }
    *volume = det(f);
    *trace = 0;
    for (int i = 0; i < 9; i++)
        *trace += f[i / 3][i % 3] * f[i / 3][i % 3];
    for (int a = 0; a < 3; a++) { /* linear along a: the modes of a and each other axis, along that axis */
        number e[3][3] = {{0}};
        const int b = (a + 1) % 3, c = (a + 2) % 3, with_b[3] = {0, 1, 2}, with_c[3] = {2, 0, 1};
        add_strain(q[with_b[a]], t->dual[b], e);
        add_strain(q[with_c[a]], t->dual[c], e);
        w += t->volume / 3 * plane_energy(e, t->axis[b], t->axis[c]);
    }
    const double young = 9 * bulk * mu / (3 * bulk + mu);
    for (int a = 0; a < 3; a++) {
        number along = 0;
        for (int i = 0; i < 3; i++)
            along += q[3][i] * t->axis[a][i];
        along /= 8 * dot(t->axis[a], t->axis[a]);
        w += t->volume / 18 * young * along * along;
    }
    return w;
}

/* Displacements of about so many sides. */
static inline void displace(const tried *t, double by, double u[24])
{
    const double size = cbrt(t->volume);
    for (int i = 0; i < 24; i++)
        u[i] = by * size * chance();
}

/* ---- bounds of frequencies */

/* The largest eigenvalue of M^-1 K at u, by power iteration on differences of forces. */
static inline double largest(const tried *t, const double u[24])
{
    double way[24], moved[24], low[24] = {0}, high[24] = {0}, value = 0;
    for (int i = 0; i < 24; i++)
        way[i] = sin(3. * i * i + 1);
    for (int round = 0; round < 400; round++) {
        double size = 0;
        for (int i = 0; i < 24; i++)
            size = fmax(size, fabs(way[i]));
        for (int side = -1; side <= 1; side += 2) {
            for (int i = 0; i < 24; i++)
                moved[i] = u[i] + side * 1e-8 * way[i] / size;
            forces(t, false, moved, side < 0 ? low : high);
        }
        double square = 0, own = 0;
        for (int i = 0; i < 24; i++) {
            const double next = (high[i] - low[i]) / (2e-8 * density * t->volume / 8);
            square += next * way[i] / size;
            own += way[i] / size * (way[i] / size);
            way[i] = next;
        }
        value = square / own;
    }
    return value;
}

/* Of modes at H, with the moduli at rest. */
static inline double hourglass_energy(const tried *t, element_tensor h, const hourglass_modes *m)
{
    const hourglass_force held = hourglass_physical(*m, h, t->box, t->law.hourglass);
    return hourglass_dot(&held.f, m) / 2;
}

/* Of a box at u, by the code under test. */
static inline double bound(const double side[3], const tried *t, const double u[24], double *j)
{
    const element_field at = field_of(u);
    const element_fibre none = {.tension = 0};
    step_matrix a;
    const element_modes x = element_modes_of(at.x), y = element_modes_of(at.y), z = element_modes_of(at.z);
    const element_tensor h = element_gradient(x, y, z, t->box.slope);
    const hourglass_modes m = element_hourglass_modes(x, y, z);
    const double stiffest = hourglass_stiffest(HOURGLASS_PHYSICAL, t->law.hourglass, side);
    const double slope = fmax(t->box.slope.x, fmax(t->box.slope.y, t->box.slope.z));
    const stability_stiffening s = stability_stiffening_of(t->form, HOURGLASS_PHYSICAL, h, t->law.c);
    const double w0 = hourglass_energy(t, h, &m);
    const stability_twists twists =
        stability_twists_of(HOURGLASS_PHYSICAL, 64 * stiffest / (density * t->volume), slope, h, &m, s);
    element_law law = t->law;
    stability_stiffen(s, w0 / t->volume, law.c);
    stability_matrix(t->form, law.c, density, side, h, none, none, &a);
    *j = 1 + element_dilation(h);
    return stability_square(twists, stability_largest(&a));
}

#endif
