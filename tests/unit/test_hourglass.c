/* Physical hourglass control: its forces against the derivative, by complex steps, of an energy that is written anew
 * from strains in orthonormal axes; of boxes and of hexahedra of any shape, by themselves, turned, and as each other;
 * its moduli; and the bounds of frequencies against those of deformed elements.
 */
#include "mesh/hexahedron.h"
#include "model/hourglass_text.h"
#include "physics/element_any.h"
#include "physics/stability.h"

#include "corners.h"
#include "form_tried.h"
#include "tap.h"

#include <complex.h>
#include <string.h>

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
    element_law law;
} tried;

static void cross(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void take_any(tried *t)
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

/* A box of these sides, its corners moved by chance: by `by` of a side. */
static tried make(double x, double y, double z, double by)
{
    const double side[3] = {x, y, z};
    tried t = {.is_box = by == 0, .box = element_box(x, y, z), .law = {.c = {mu, bulk}}};
    for (int i = 0; i < 24; i++)
        t.at[i] = side[i % 3] * (corner_of[i / 3][i % 3] + by * chance());
    hourglass_moduli(mu, bulk, t.law.hourglass);
    t.volume = hexahedron_mean(t.at, t.b);
    take_any(&t);
    return t;
}

static element_field field_of(const double u[24])
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
static element_field field_of_forces(const tried *t, bool any, const double u[24])
{
    const element_fibre none = {.tension = 0};
    if (any)
        return element_any_force(FORM_NEO_HOOKEAN, HOURGLASS_PHYSICAL, field_of(u), &t->any, t->law, none, false);
    return element_force(FORM_NEO_HOOKEAN, HOURGLASS_PHYSICAL, field_of(u), t->box, t->law, none, false);
}

static void forces(const tried *t, bool any, const double u[24], double f[24])
{
    const element_field force = field_of_forces(t, any, u);
    for (int c = 0; c < 8; c++) {
        f[3 * c] = force.x.at[c];
        f[3 * c + 1] = force.y.at[c];
        f[3 * c + 2] = force.z.at[c];
    }
}

/* ---- the energy, anew */

static number det(number f[3][3])
{
    return f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) - f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
           f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
}

static void invert(number f[3][3], number to[3][3])
{
    const number j = det(f);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int a = (c + 1) % 3, b = (c + 2) % 3, p = (r + 1) % 3, q = (r + 2) % 3;
            to[r][c] = (f[a][p] * f[b][q] - f[a][q] * f[b][p]) / j;
        }
}

/* Plane stress of the strain whose components are e (symmetric), in the plane of two vectors: energy by volume. */
static number plane_energy(number e[3][3], const double a[3], const double b[3])
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
static void add_strain(const number mode[3], const double dual[3], number e[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            e[i][j] += (mode[i] * dual[j] + mode[j] * dual[i]) / 16;
}

static number energy(const tried *t, const number u[24])
{
    static const int modes[4][3] = {{1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}};
    number f[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, inverse[3][3], q[4][3] = {{0}}, w;
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
    const number j = det(f);
    number trace = 0;
    for (int i = 0; i < 9; i++)
        trace += f[i / 3][i % 3] * f[i / 3][i % 3];
    w = t->volume * (mu / 2 * (cpow(j, -2. / 3) * trace - 3) + bulk / 2 * (j - 1) * (j - 1));
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

/* ---- */

/* Displacements of about so many sides. */
static void displace(const tried *t, double by, double u[24])
{
    const double size = cbrt(t->volume);
    for (int i = 0; i < 24; i++)
        u[i] = by * size * chance();
}

static void test_derivative(const char *name, tried t, double by)
{
    double worst = 0, scale = 0, u[24], f[24];
    for (int round = 0; round < 20; round++) {
        displace(&t, by, u);
        for (int any = t.is_box ? 0 : 1; any < 2; any++) {
            forces(&t, any, u, f);
            for (int i = 0; i < 24; i++) {
                number moved[24];
                for (int k = 0; k < 24; k++)
                    moved[k] = u[k] + (k == i ? 1e-30 * I : 0);
                const double want = cimag(energy(&t, moved)) / 1e-30;
                worst = fmax(worst, fabs(f[i] - want));
                scale = fmax(scale, fabs(want));
            }
        }
    }
    near_(worst / scale, 0, 1e-12, "%s, moved by %g of a side: forces are the energy's slope", name, by);
}

/* A turn of what is deformed turns the forces. */
static void test_turn(tried t)
{
    const double c = cos(1.1), s = sin(1.1), turn[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
    double u[24], turned[24] = {0}, f[24], g[24], worst = 0, scale = 0;
    displace(&t, .2, u);
    for (int i = 0; i < 24; i++) {
        for (int k = 0; k < 3; k++)
            turned[i] += turn[i % 3][k] * (t.at[i / 3 * 3 + k] + u[i / 3 * 3 + k]);
        turned[i] -= t.at[i];
    }
    forces(&t, !t.is_box, u, f);
    forces(&t, !t.is_box, turned, g);
    for (int i = 0; i < 24; i++) {
        double want = 0;
        for (int k = 0; k < 3; k++)
            want += turn[i % 3][k] * f[i / 3 * 3 + k];
        worst = fmax(worst, fabs(g[i] - want));
        scale = fmax(scale, fabs(want));
    }
    near_(worst / scale, 0, 1e-12, "turned by 63 degrees, %s pulls as before, turned", t.is_box ? "a box" : "another");
}

/* E/(1 - nu^2) and the others, as far as nu = .5 where K has no end. */
static void test_moduli(void)
{
    static const double ratios[] = {-.3, 0, .3, .45, .4999, .4999999};
    for (int i = 0; i < 6; i++) {
        const double nu = ratios[i], young = 3000, shear = young / (2 * (1 + nu)), k = young / (3 * (1 - 2 * nu));
        double got[HOURGLASS_NUMBERS];
        hourglass_moduli(shear, k, got);
        near_(got[HOURGLASS_BENDING], young / (1 - nu * nu) / 3, 1e-8 * young, "nu %g: bending", nu);
        near_(got[HOURGLASS_COUPLING], nu * young / (1 - nu * nu) / 3, 1e-8 * young, "coupling");
        near_(got[HOURGLASS_TORSION], shear / 3, 1e-12 * young, "torsion");
        near_(got[HOURGLASS_CORNER], young / 9, 1e-8 * young, "xyz");
    }
}

static void test_text(void)
{
    static const char *const good[] = {"physical", "isotropic", "isotropic:0.03", "0.03", "0", "0.012345678901234567"};
    static const char *const back[] = {"physical",       "isotropic:0.0075", "isotropic:0.03",
                                       "isotropic:0.03", "isotropic:0",      "isotropic:0.012345678901234567"};
    static const char *const bad[] = {"",   "physic", "physical:1", "isotropic:",  "isotropic:x",
                                      "-1", "nan",    "1001",       "isotropic 1", "0.03x"};
    hourglass_control control;
    char text[HOURGLASS_TEXT];
    for (int i = 0; i < 6; i++) {
        const bool read = !hourglass_read(good[i], &control);
        hourglass_text(control, text);
        ok(read && !strcmp(text, back[i]), "'%s' is %s", good[i], text);
    }
    for (int i = 0; i < 10; i++)
        ok(hourglass_read(bad[i], &control), "'%s' is none", bad[i]);
}

/* ---- bounds of frequencies */

/* The largest eigenvalue of M^-1 K at u, by power iteration on differences of forces. */
static double largest(const tried *t, const double u[24])
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

/* Of a box at u, by the code under test. */
static double bound(const double side[3], const tried *t, const double u[24], double *j)
{
    const element_field at = field_of(u);
    const element_fibre none = {.tension = 0};
    step_matrix a;
    const element_modes x = element_modes_of(at.x), y = element_modes_of(at.y), z = element_modes_of(at.z);
    const element_tensor h = element_gradient(x, y, z, t->box.slope);
    const hourglass_modes m = element_hourglass_modes(x, y, z);
    const double stiffest = hourglass_stiffest(HOURGLASS_PHYSICAL, t->law.hourglass, side);
    const double slope = fmax(t->box.slope.x, fmax(t->box.slope.y, t->box.slope.z));
    const stability_twists twists =
        stability_twists_of(HOURGLASS_PHYSICAL, 64 * stiffest / (density * t->volume), slope, h, &m);
    stability_matrix(FORM_NEO_HOOKEAN, t->law.c, density, side, h, none, none, &a);
    *j = 1 + element_dilation(h);
    return stability_square(twists, stability_largest(&a));
}

static void test_bound(double x, double y, double z, double by)
{
    const double side[3] = {x, y, z};
    const tried t = make(x, y, z, 0);
    double most = 0, least = INFINITY, u[24], j;
    int count = 0;
    for (int round = 0; round < 60; round++) {
        displace(&t, by, u);
        const double square = bound(side, &t, u, &j);
        if (j < .2)
            continue;
        const double share = largest(&t, u) / square;
        most = fmax(most, share);
        least = fmin(least, share);
        count++;
    }
    ok(count > 10 && most <= 1 + 1e-5 && (by > 0 || least > .999),
       "%g x %g x %g, moved by %g of a side: the largest w^2 of %d is %.4f to %.4f of its bound", x, y, z, by, count,
       least, most);
}

/* n of modes by components, as R^T D R makes it. */
static void stiffen(const tried *t, const double root[16], double n[12])
{
    double m[12] = {0}, f[12];
    hourglass_modes modes;
    for (int i = 0; i < 12; i++)
        for (int g = 0; g <= i / 3; g++)
            m[i] += root[4 * (i / 3) + g] * n[3 * g + i % 3];
    memcpy(&modes, m, sizeof modes);
    const hourglass_modes w = hourglass_all_by_columns(t->any.basis, modes);
    const hourglass_modes s = hourglass_hexahedron(&w, t->any.basis, t->law.hourglass, t->volume / 64);
    modes = hourglass_all_by_rows(t->any.basis, s);
    memcpy(f, &modes, sizeof f);
    for (int i = 0; i < 12; i++) {
        n[i] = 0;
        for (int g = i / 3; g < 4; g++)
            n[i] += root[4 * g + i / 3] * f[3 * g + i % 3];
    }
}

/* The largest eigenvalue, from below, by power iteration. */
static double largest_of_modes(const tried *t, const double root[16])
{
    double n[12], size = 0;
    for (int i = 0; i < 12; i++)
        n[i] = sin(3. * i * i + 1);
    for (int round = 0; round < 3000; round++) {
        size = 0;
        for (int i = 0; i < 12; i++)
            size += n[i] * n[i];
        size = sqrt(size);
        for (int i = 0; i < 12; i++)
            n[i] /= size;
        stiffen(t, root, n);
    }
    return size;
}

/* by: how far corners are moved by chance, of a side; and how far R is from 1 by chance. */
static void test_stiffest(double x, double y, double z, double by)
{
    double low = INFINITY, high = 0;
    for (int round = 0; round < 40; round++) {
        tried t = make(x, y, z, by);
        double root[16] = {0}, basis[9];
        for (int i = 0; i < 16; i++)
            root[i] = i / 4 > i % 4 ? by * chance() : i % 5 ? 0 : 1;
        hexahedron_basis(t.at, basis);
        const double share =
            hourglass_any_stiffest(t.law.hourglass, t.volume, basis, root) / largest_of_modes(&t, root);
        low = fmin(low, share);
        high = fmax(high, share);
    }
    ok(low >= 1 && high <= 1.0197, "%g x %g x %g, corners moved by %g: the stiffest mode's bound is %.6f to %.6f of it",
       x, y, z, by, low, high);
}

int main(void)
{
    test_derivative("a cube", make(.01, .01, .01, 0), .01);
    test_derivative("a cube", make(.01, .01, .01, 0), .2);
    test_derivative("a box", make(.01, .0125, .02, 0), .2);
    test_derivative("a flat box", make(.01, .01, .001, 0), .02);
    test_derivative("a hexahedron", make(.01, .0125, .02, .2), .15);
    test_turn(make(.01, .0125, .02, 0));
    test_turn(make(.01, .0125, .02, .2));
    test_moduli();
    test_text();
    test_bound(.01, .01, .01, 0);
    test_bound(.01, .01, .01, .05);
    test_bound(.01, .01, .01, .2);
    test_bound(.01, .0125, .02, .1);
    test_bound(.01, .01, .002, .05);
    test_stiffest(.01, .01, .01, 0);
    test_stiffest(.01, .0125, .02, .1);
    test_stiffest(.01, .0125, .02, .3);
    test_stiffest(.01, .01, .001, .3);
    return done_testing();
}
