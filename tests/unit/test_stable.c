/* The stable neo-Hookean law of one element: its stress and its tangent are derivatives of the energy that Smith, de
 * Goes & Kim print; its moduli at rest are those of linear elasticity; it does not see rotations; and no element that
 * is inside out or flat is at rest.
 */
#include "msds/problem/stable_double.h"

#include "tap.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { STATES = 50 };

static const double mu = 1000, kappa = 5000;

static double uniform(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / (double)(UINT64_C(1) << 53);
}

static double determinant(const double f[9])
{
    double c[9];
    stable_cofactors(f, c);
    return f[0] * c[0] + f[1] * c[1] + f[2] * c[2];
}

/* Their equations 13 and 14, and what a pressure p that does not change does, in double. */
static double energy(const double g[9], double p)
{
    const double alpha = 1 + 3 * mu / (4 * kappa);
    double f[9], i = 0;
    for (int k = 0; k < 9; k++) {
        f[k] = g[k] + (k % 4 == 0);
        i += f[k] * f[k];
    }
    const double j = determinant(f);
    return mu / 2 * (i - 3) - mu / 2 * log(i + 1) + kappa / 2 * (j - alpha) * (j - alpha) + p * (j - 1) +
           110 * mu * .04 * pow(fmax(0, 1 - j / (double)STABLE_THIN), 3);
}

/* Derivatives of a displacement, of this size; every other state is inside out if it is large. */
static void state(uint64_t *seed, double size, double g[9])
{
    for (int k = 0; k < 9; k++)
        g[k] = size * (2 * uniform(seed) - 1);
}

static double largest(const double a[9], const double b[9])
{
    double most = 0;
    for (int k = 0; k < 9; k++)
        most = fmax(most, fabs(a[k] - b[k]));
    return most;
}

static void test_derivatives(void)
{
    const double step = 1e-5, none[9] = {0};
    double off = 0, off_along = 0, size = 0, size_along = 0;
    uint64_t seed = 7;
    int inside_out = 0;
    for (int i = 0; i < STATES; i++) {
        double g[9], d[9], stress[9], by_energy[9], above[9], below[9], along[9], by_stress[9], less[9];
        const double p = i % 3 ? 0 : 700;
        state(&seed, 1.5, g);
        state(&seed, 1, d);
        const stable_state at = stable_stress(g, mu, kappa, p, stress);
        for (int k = 0; k < 9; k++) {
            double up[9], down[9];
            memcpy(up, g, sizeof up);
            memcpy(down, g, sizeof down);
            up[k] += step;
            down[k] -= step;
            by_energy[k] = (energy(up, p) - energy(down, p)) / (2 * step);
        }
        for (int k = 0; k < 9; k++)
            above[k] = g[k] + step * d[k], below[k] = g[k] - step * d[k];
        stable_tangent(g, d, &at, 0, along);
        stable_stress(above, mu, kappa, p, by_stress);
        stable_stress(below, mu, kappa, p, less);
        for (int k = 0; k < 9; k++)
            by_stress[k] = (by_stress[k] - less[k]) / (2 * step);
        off = fmax(off, largest(stress, by_energy));
        size = fmax(size, largest(stress, none));
        off_along = fmax(off_along, largest(along, by_stress));
        size_along = fmax(size_along, largest(along, none));
        for (int k = 0; k < 9; k += 4)
            g[k] += 1;
        inside_out += determinant(g) < 0;
    }
    ok(inside_out > 5 && inside_out < STATES - 5, "%d of %d states are inside out", inside_out, (int)STATES);
    ok(off < 1e-7 * size, "the stress is the energy's derivative: %.1e off", off / size);
    ok(off_along < 1e-7 * size_along, "the tangent is the stress's: %.1e off", off_along / size_along);
}

/* A pressure that changes by r adds r cof F. */
static void test_pressure(void)
{
    double g[9], d[9], with[9], without[9], cofactors[9];
    uint64_t seed = 9;
    state(&seed, .5, g);
    state(&seed, .5, d);
    const stable_state at = stable_stress(g, mu, kappa, 50, with);
    stable_tangent(g, d, &at, 3, with);
    stable_tangent(g, d, &at, 0, without);
    for (int k = 0; k < 9; k += 4)
        g[k] += 1;
    stable_cofactors(g, cofactors);
    for (int k = 0; k < 9; k++)
        without[k] += 3 * cofactors[k];
    ok(largest(with, without) < 1e-9, "what a pressure changes by adds cofactors");
}

/* Strains so small that they tell moduli at rest; and 1e-7, where nothing may be lost. */
static void test_moduli(void)
{
    const double lambda_l = 4000, mu_l = 900;
    double off = 0, size = 0;
    uint64_t seed = 11;
    for (int i = 0; i < STATES; i++) {
        double g[9], stress[9], linear[9];
        state(&seed, 1e-7, g);
        stable_stress(g, STABLE_MU(mu_l), STABLE_KAPPA(lambda_l, mu_l), 0, stress);
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                linear[3 * a + b] =
                    mu_l * (g[3 * a + b] + g[3 * b + a]) + (a == b ? lambda_l * (g[0] + g[4] + g[8]) : 0);
        off = fmax(off, largest(stress, linear));
        size = fmax(size, largest(linear, (double[9]){0}));
    }
    ok(off < 1e-6 * size, "at rest it has the moduli of linear elasticity: %.1e off", off / size);
}

/* P(Q F) = Q P(F), and P F^T is symmetric. */
static void test_rotation(void)
{
    const double c = cos(.9), s = sin(.9), q[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
    double g[9], turned[9] = {0}, stress[9], want[9] = {0}, got[9], kirchhoff[9] = {0}, twisted = 0;
    uint64_t seed = 13;
    state(&seed, .6, g);
    stable_stress(g, mu, kappa, 20, stress);
    for (int k = 0; k < 9; k += 4)
        g[k] += 1;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int k = 0; k < 3; k++) {
                turned[3 * a + b] += q[3 * a + k] * g[3 * k + b];
                want[3 * a + b] += q[3 * a + k] * stress[3 * k + b];
                kirchhoff[3 * a + b] += stress[3 * a + k] * g[3 * b + k];
            }
    for (int k = 0; k < 9; k += 4)
        turned[k] -= 1;
    stable_stress(turned, mu, kappa, 20, got);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < a; b++)
            twisted = fmax(twisted, fabs(kirchhoff[3 * a + b] - kirchhoff[3 * b + a]));
    ok(largest(got, want) < 1e-9, "a rotation turns the stress");
    ok(twisted < 1e-9, "and no stress twists");
}

/* The stretch to the side by Newton's method on the stress there. The figures are of the energy as printed, E 3000 Pa:
 * the side by 200 bisections of its derivative, by a program of its own. */
static void test_uniaxial(void)
{
    static const struct {
        double poisson, stretch, stress, side;
    } want[] = {{.3, .7, -1118.69954, 1.08529926},   {.3, 1.2, 540.027537, .94222296},
                {.45, .7, -1311.79384, 1.16737826},  {.45, 1.2, 516.96946, .920161894},
                {.499, .7, -1375.21695, 1.19467092}, {.499, 1.2, 510.070538, .913016493}};
    for (size_t i = 0; i < sizeof want / sizeof *want; i++) {
        const double young = 3000, nu = want[i].poisson;
        const double m = STABLE_MU(young / (2 * (1 + nu)));
        const double k = STABLE_KAPPA(young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu)));
        double side = 1 - nu * (want[i].stretch - 1), g[9] = {0}, stress[9], along[9];
        const double d[9] = {0, 0, 0, 0, 1, 0, 0, 0, 1};
        g[0] = want[i].stretch - 1;
        for (int turn = 0; turn < 50; turn++) {
            g[4] = g[8] = side - 1;
            const stable_state at = stable_stress(g, m, k, 0, stress);
            stable_tangent(g, d, &at, 0, along);
            side -= stress[4] / along[4];
        }
        near_(stress[0], want[i].stress, 1e-6 * fabs(want[i].stress), "uniaxial stress");
        near_(side, want[i].side, 1e-7, "and the stretch to the side");
    }
}

/* Flat, or turned inside out: the stress pulls it back to its side. */
static void test_inverted(void)
{
    double g[9] = {0}, stress[9];
    int pulled = 0;
    for (int i = 0; i <= 20; i++) {
        g[8] = -1 - .1 * i; /* z goes from 0 to -2 of what it was */
        stable_stress(g, mu, kappa, 0, stress);
        pulled += stress[8] < -mu / 2;
    }
    ok(pulled == 21, "an element that is flat or inside out is pulled back: %d of 21", pulled);
    for (int k = 0; k < 9; k += 4)
        g[k] = -1;
    stable_stress(g, mu, kappa, 0, stress);
    ok(isfinite(stress[0]) && largest(stress, (double[9]){0}) < 1e-9,
       "a point is where it is in balance, as in the paper");
}

int main(void)
{
    test_derivatives();
    test_pressure();
    test_moduli();
    test_rotation();
    test_uniaxial();
    test_inverted();
    return done_testing();
}
