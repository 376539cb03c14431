/* The element header in double, and its stress against the derivative of its energy. */
#include "element_cases.h"

static element_tensor tensor_of(double f[3][3])
{
    element_tensor h = {f[0][0] - 1, f[0][1], f[0][2], f[1][0], f[1][1] - 1, f[1][2], f[2][0], f[2][1], f[2][2] - 1};
    return h;
}

/* The energy that the law's equation gives, written as the equation is. */
static double energy(double f[3][3])
{
    double trace = 0, mu = 3000 / 2.9, bulk = 10000;
    double j = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) - f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
               f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
    for (int i = 0; i < 9; i++)
        trace += f[i / 3][i % 3] * f[i / 3][i % 3];
    return mu / 2 * (pow(j, -2. / 3) * trace - 3) + bulk / 2 * (j - 1) * (j - 1);
}

/* The potential of the active stress on .6 to 1.4: a s times the integral of 1 - 4 (1 - l)^2. */
static double active_energy(double f[3][3], const double a[3], double tension)
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double m = f[k][0] * a[0] + f[k][1] * a[1] + f[k][2] * a[2];
        square += m * m;
    }
    double l = sqrt(square);
    return tension * (l + 4. / 3 * (1 - l) * (1 - l) * (1 - l));
}

static void test_derivative(double f[3][3], const double fibre[3], double tension)
{
    double p[3][3], moved[3][3], worst = 0, scale = 0;
    const double step = 1e-6;
    stress_from(force_of(affine(f, at_origin), .0075, tension, fibre), p);
    for (int i = 0; i < 9; i++) {
        double w[2];
        for (int side = 0; side < 2; side++) {
            memcpy(moved, f, sizeof moved);
            moved[i / 3][i % 3] += side ? step : -step;
            w[side] = energy(moved) + active_energy(moved, fibre, tension);
        }
        worst = fmax(worst, fabs((w[1] - w[0]) / (2 * step) - p[i / 3][i % 3]));
        scale = fmax(scale, fabs(p[i / 3][i % 3]));
    }
    near_(worst / scale, 0, 1e-6, "P = dW/dF, active stress %g Pa", tension);
    element_tensor h = tensor_of(f);
    near_(form_energy(FORM_NEO_HOOKEAN, h, tissue(0).c), energy(f), 1e-9 * energy(f), "the energy");
}

static void test_slope(void)
{
    double worst = 0;
    for (int i = 0; i < 110; i++) {
        double l = .35 + .0123 * i;
        double numeric = (muscle_force_length(l + 1e-7) - muscle_force_length(l - 1e-7)) / 2e-7;
        worst = fmax(worst, fabs(numeric - muscle_force_length_slope(l)));
    }
    near_(worst, 0, 1e-5, "the force-length factor's slope");
}

int main(void)
{
    double bent[3][3] = {{1.2, .3, -.1}, {.05, .8, .2}, {-.15, .1, 1.1}};
    const double fibre[3] = {2. / 7, 3. / 7, 6. / 7};
    double squeezed[3][3] = {{.7, .1, 0}, {0, .75, -.2}, {.3, 0, .8}};
    test_homogeneous(1e-6);
    test_rotation(1e-10);
    test_hourglass(1e-12);
    test_force_length();
    test_slope();
    test_cube_root(2e-15);
    test_derivative(bent, fibre, 0);
    test_derivative(bent, fibre, 4000);
    test_derivative(squeezed, fibre, 0);
    test_derivative(squeezed, fibre, 30000);
    return done_testing();
}
