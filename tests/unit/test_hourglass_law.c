/* Physical hourglass control of laws that stiffen: their shear stiffness, against their own stress and closed forms;
 * forces against the derivative, by complex steps, of s(x) times an energy that is written anew, of boxes, of
 * hexahedra, and of turned ones; the bound of frequencies; and the bending of a bar that is stretched, in closed form.
 */
#include "physics/law.h"

#include "form_tried.h"
#include "hourglass_tried.h"
#include "tap.h"

#include <stdio.h>
#include <string.h>

/* ---- laws, all of the modulus mu at rest, with T(x) in complex numbers, anew */

typedef struct known {
    const char *name, *law;
    double value[3];
    law_key key[3];
    number (*shear)(const double *value, number x);
    double bends; /* how far bending may be off in a bar stretched by 1.3 (test_bar) */
} known;

static number shear_of_yeoh(const double *c, number x)
{
    return c[0] + 6 * c[1] * x + 15 * c[2] * x * x;
}

/* f' + 2 x f'' of the series in I1. */
static number shear_of_chains(const double *v, number x)
{
    static const double series[] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};
    number sum = 0;
    for (int i = 1; i <= 5; i++) {
        const double by = v[0] * series[i - 1] / pow(v[1], 2 * i - 2);
        sum += by * i * cpow(3 + x, i - 1);
        if (i > 1)
            sum += 2 * x * by * i * (i - 1) * cpow(3 + x, i - 2);
    }
    return sum;
}

static number shear_of_skin(const double *v, number x)
{
    return v[0] * v[1] * (cexp(v[1] * x) * (1 + 2 * v[1] * x) - .5);
}

/* (mu/2a) (a cosh(a l) cosh l - sinh(a l) sinh l) / cosh^3 l, x = 4 sinh^2 l. */
static number shear_of_stretches(const double *v, number x)
{
    const number l = casinh(csqrt(x) / 2), c = ccosh(l);
    return v[0] / (2 * v[1]) * (v[1] * ccosh(v[1] * l) * c - csinh(v[1] * l) * csinh(l)) / (c * c * c);
}

#define YEOH                                                                                                           \
    {                                                                                                                  \
        LAW_c10, LAW_c20, LAW_c30                                                                                      \
    }
#define CHAINS                                                                                                         \
    {                                                                                                                  \
        LAW_mu, LAW_lock, LAW_nu                                                                                       \
    }
#define SKIN                                                                                                           \
    {                                                                                                                  \
        LAW_c1, LAW_c2, LAW_nu                                                                                         \
    }
#define OGDEN                                                                                                          \
    {                                                                                                                  \
        LAW_mu1, LAW_a1, LAW_nu                                                                                        \
    }

static const known laws[] = {
    {"yeoh", "yeoh", {mu / 2, mu, mu / 2}, YEOH, shear_of_yeoh, .15},
    {"yeoh that softens first", "yeoh", {mu / 2, -.15 * mu, .1 * mu}, YEOH, shear_of_yeoh, .05},
    {"arruda-boyce", "arruda-boyce", {mu, 1.3}, CHAINS, shear_of_chains, .1},
    {"veronda-westmann", "veronda-westmann", {mu / 3, 3}, SKIN, shear_of_skin, .2},
    {"ogden, a 1", "ogden", {mu, 1}, OGDEN, shear_of_stretches, .06},
    {"ogden, a 8", "ogden", {mu, 8}, OGDEN, shear_of_stretches, .4},
    {"ogden, a -3", "ogden", {mu, -3}, OGDEN, shear_of_stretches, 1},
    {"ogden, a -2", "ogden", {mu, -2}, OGDEN, shear_of_stretches, .7},
};
enum { LAWS = sizeof laws / sizeof *laws };

/* Its coefficients, with K = bulk. */
static form take(const known *of, double c[FORM_NUMBERS])
{
    const law_row *row = law_find(of->law);
    double value[LAW_OWN_KEYS];
    memset(c, 0, FORM_NUMBERS * sizeof *c);
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        value[k] = NAN;
    for (int k = 0; k < 3; k++)
        if (of->key[k] != LAW_nu)
            value[of->key[k]] = of->value[k];
    value[LAW_K] = bulk;
    row->fill(value, c);
    return row->form;
}

/* mu of the series is less than that of the law. */
static double scale_of(const known *of)
{
    return mu / 2 / creal(of->shear(of->value, 0));
}

static tried make_of(const known *of, double x, double y, double z, double by)
{
    tried t = make(x, y, z, by);
    const double scale = scale_of(of);
    t.form = take(of, t.law.c);
    for (int i = 0; i < form_moduli(t.form); i++)
        t.law.c[i] *= scale;
    return t;
}

/* ---- T against the stress in simple shear */

static double shear_stress(form f, double g, const double *c)
{
    const element_tensor h = {0, g, 0, 0, 0, 0, 0, 0, 0};
    return form_stress(f, h, c).xy;
}

/* Of x from rest to 2: T as it is written here, the slope of the stress, T > 0, and derivatives of T by x. */
static void test_shear(const known *of)
{
    double c[FORM_NUMBERS], worst = 0, least = INFINITY, stress = 0, slope = 0, curve = 0;
    const form f = take(of, c);
    for (int i = 0; i <= 40; i++) {
        const double x = i ? 2e-9 * pow(1e9, i / 40.) : 0, d = 1e-4 * x, g = sqrt(x), step = 1e-5;
        const form_shear t = form_sheared(f, x, c);
        const double want = creal(of->shear(of->value, x)), size = mu * (1 + t.now / mu);
        worst = fmax(worst, fabs(t.now - want) / size);
        least = fmin(least, t.now / t.rest);
        stress = fmax(stress,
                      fabs((shear_stress(f, g + step, c) - shear_stress(f, g - step, c)) / (4 * step) - t.now) / size);
        if (x < 1e-3)
            continue;
        const form_shear low = form_sheared(f, x - d, c), high = form_sheared(f, x + d, c);
        slope = fmax(slope, fabs((high.now - low.now) / (2 * d) - t.slope) / (fabs(t.slope) + size));
        curve = fmax(curve, fabs((high.slope - low.slope) / (2 * d) - form_sheared_curve(f, x, c)) /
                                (fabs(form_sheared_curve(f, x, c)) + size));
    }
    near_(worst, 0, 1e-13, "%s: shear stiffness", of->name);
    ok(least > 0, "%s: it is above 0, at least %g of that at rest", of->name, least);
    near_(stress, 0, 1e-7, "%s: half the slope of its stress in simple shear", of->name);
    near_(slope, 0, 1e-6, "%s: its slope", of->name);
    near_(curve, 0, 1e-6, "%s: the slope of that", of->name);
}

/* At rest and near it the derivatives have no poles; and they are no jump where another formula takes over. */
static void test_near_rest(const known *of)
{
    double c[FORM_NUMBERS], off = 0;
    const form f = take(of, c);
    const double rest = form_sheared_curve(f, 0, c);
    for (int i = 0; i < 30; i++) {
        const double x = 1e-10 * pow(1e6, i / 30.);
        off = fmax(off, fabs(form_sheared_curve(f, x, c) - rest) / (fabs(rest) + mu));
    }
    near_(off, 0, 1e-2, "%s: no jump near rest", of->name);
}

/* ---- forces */

/* Forces without those of the law: of the same element that nothing holds. */
static void held_forces(const tried *t, bool any, const double u[24], double f[24], double *scale)
{
    tried loose = *t;
    double without[24];
    memset(loose.law.hourglass, 0, sizeof loose.law.hourglass);
    forces(t, any, u, f);
    forces(&loose, any, u, without);
    for (int i = 0; i < 24; i++) {
        *scale = fmax(*scale, fabs(f[i]));
        f[i] -= without[i];
    }
}

static void test_derivative(const known *of, tried t, double by)
{
    double worst = 0, scale = 0, largest_force = 0, u[24], f[24];
    for (int round = 0; round < 10; round++) {
        displace(&t, by, u);
        for (int any = t.is_box ? 0 : 1; any < 2; any++) {
            held_forces(&t, any, u, f, &scale);
            for (int i = 0; i < 24; i++) {
                number moved[24], j, trace;
                for (int k = 0; k < 24; k++)
                    moved[k] = u[k] + (k == i ? 1e-30 * I : 0);
                const number w0 = held_energy(&t, moved, &j, &trace), x = cpow(j, -2. / 3) * trace - 3;
                const double want = cimag(w0 * of->shear(of->value, x)) / creal(of->shear(of->value, 0)) / 1e-30;
                worst = fmax(worst, fabs(f[i] - want));
                largest_force = fmax(largest_force, fabs(want));
            }
        }
    }
    near_(worst / scale, 0, 1e-12, "%s, %s moved by %g: forces are the slope of s(x) w0, up to %.2g of all", of->name,
          t.is_box ? "a box" : "a hexahedron", by, largest_force / scale);
}

static void test_turn(const known *of, tried t)
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
    near_(worst / scale, 0, 1e-12, "%s, turned: pulls as before, turned", of->name);
}

/* ---- bounds */

static void test_bound(const known *of, double x, double y, double z, double by)
{
    const double side[3] = {x, y, z};
    const tried t = make_of(of, x, y, z, 0);
    double most = 0, least = INFINITY, u[24], j;
    int count = 0;
    for (int round = 0; round < 25; round++) {
        displace(&t, by, u);
        const double square = bound(side, &t, u, &j);
        if (j < .2)
            continue;
        const double share = largest(&t, u) / square;
        most = fmax(most, share);
        least = fmin(least, share);
        count++;
    }
    ok(count > 5 && most <= 1 + 1e-5,
       "%s, %g x %g x %g, moved by %g: the largest w^2 of %d is %.4f to %.4f of its bound", of->name, x, y, z, by,
       count, least, most);
}

/* ---- the bending of a bar that is stretched along it by l, and keeps its volume: a strain of l is resisted by
 * l^2 W''(l), and in a bending element by 3 mu s(x), x = l^2 + 2/l - 3. Negative powers soften such a bar and stiffen
 * one that is pressed; x does not tell these apart. */

static double bar_stiffness(const tried *t, double l)
{
    const double step = 1e-4;
    double w[3];
    for (int k = 0; k < 3; k++) {
        const double at = l + (k - 1) * step, side = 1 / sqrt(at);
        const element_tensor h = {at - 1, 0, 0, 0, side - 1, 0, 0, 0, side - 1};
        w[k] = form_energy(t->form, h, t->law.c);
    }
    return l * l * (w[0] - 2 * w[1] + w[2]) / (step * step);
}

static void test_bar(const known *of)
{
    const tried t = make_of(of, .01, .01, .01, 0);
    double off = 0;
    for (int i = 1; i <= 3; i++) {
        const double l = 1 + .1 * i, want = bar_stiffness(&t, l);
        const form_shear s = form_sheared(t.form, l * l + 2 / l - 3, t.law.c);
        off = 3 * mu * s.now / s.rest / want - 1;
        printf("# %s, stretched by %g: bending is %+.1f %% off, %+.1f %% with the moduli at rest\n", of->name, l,
               100 * off, 100 * (3 * mu / want - 1));
    }
    ok(fabs(off) < of->bends, "%s: a bar stretched by 1.3 bends as stiffly to %g %%", of->name, 100 * of->bends);
}

int main(void)
{
    ok(!form_stiffens(FORM_NEO_HOOKEAN) && !form_stiffens(FORM_MOONEY_RIVLIN), "two forms do not stiffen");
    for (int i = 0; i < LAWS; i++) {
        const known *of = &laws[i];
        test_shear(of);
        test_near_rest(of);
        test_derivative(of, make_of(of, .01, .01, .01, 0), .01);
        test_derivative(of, make_of(of, .01, .0125, .02, 0), .2);
        test_derivative(of, make_of(of, .01, .0125, .02, .2), .15);
        test_turn(of, make_of(of, .01, .0125, .02, 0));
        test_turn(of, make_of(of, .01, .0125, .02, .2));
        test_bound(of, .01, .01, .01, .05);
        test_bound(of, .01, .01, .01, .15);
        test_bound(of, .01, .01, .002, .05);
        test_bar(of);
    }
    return done_testing();
}
