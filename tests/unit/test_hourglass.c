/* Physical hourglass control: its forces against the derivative, by complex steps, of an energy that is written anew
 * from strains in orthonormal axes; of boxes and of hexahedra of any shape, by themselves, turned, and as each other;
 * its moduli; and the bounds of frequencies against those of deformed elements.
 */
#include "model/hourglass_text.h"

#include "hourglass_tried.h"
#include "tap.h"

#include <string.h>

static number energy(const tried *t, const number u[24])
{
    number j, trace;
    const number w = held_energy(t, u, &j, &trace);
    return w + t->volume * (mu / 2 * (cpow(j, -2. / 3) * trace - 3) + bulk / 2 * (j - 1) * (j - 1));
}

/* ---- */

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
