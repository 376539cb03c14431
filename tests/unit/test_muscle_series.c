/* Muscles in series with a spring, in double: Hill's figures; the order of the update, against the differential
 * equation; the spring's stress against its energy; and that the matrix of the stable step is no less than the tangent,
 * whatever the contractile element has of the length.
 */
#include "series_cases.h"

#include "physics/stability.h"

/* dc/dt of the equation, without steps: c - 1 of a fibre of length `strain` + 1, optimum 1. */
static double rate(double c, double strain, double level)
{
    const double v = (strain - c) / .04 / (level * muscle_force_length(1 + strain));
    return 10 * (v < 0 ? -1 : v < 1 ? (v - 1) / (1 + 4 * v) : .4 * (v - 1) / (14 - 10 * v));
}

static double strain_at(double t)
{
    return .1 * sin(60 * t);
}

/* c - 1 after .03 s of a fibre that is shortened and stretched, by Runge and Kutta's method. */
static double exactly(void)
{
    const double dt = 1e-6;
    double c = -.04;
    for (int i = 0; i < 30000; i++) {
        const double t = i * dt, half = t + dt / 2;
        const double k1 = rate(c, strain_at(t), 1), k2 = rate(c + dt / 2 * k1, strain_at(half), 1);
        const double k3 = rate(c + dt / 2 * k2, strain_at(half), 1), k4 = rate(c + dt * k3, strain_at(t + dt), 1);
        c += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return c;
}

static double by_steps(int steps)
{
    const double dt = .03 / steps;
    element_fibre fibre = serial_of(1, -.04);
    for (int i = 1; i <= steps; i++) {
        const element_tensor h = {.xx = strain_at(i * dt)};
        fibre.series.contractile = element_contract(h, fibre, 10 * dt);
    }
    return fibre.series.contractile;
}

static void test_order(void)
{
    const double want = exactly(), coarse = fabs(by_steps(300) - want), fine = fabs(by_steps(600) - want);
    printf("# c - 1 is %.6f; steps of 100 us miss it by %.2g, of 50 us by %.2g\n", want, coarse, fine);
    ok(coarse < .04 * .01, "steps of 100 us are within 1 %% of the spring's strain");
    near_(coarse / fine, 2, .1, "half the step, half the error");
}

/* At once, as in a quick release, the muscle is its spring. */
static void test_release(void)
{
    const element_fibre fibre = serial_of(1, -.04);
    const element_tensor before = {.xx = 0}, after = {.xx = -.01}, far = {.xx = -.05};
    near_(element_serial(before, fibre).xx, 1e5, 1e-9, "peak stress");
    near_((element_serial(before, fibre).xx - element_serial(after, fibre).xx) / .01, 2.5e6, 1e-6,
          "a release by 1 %% of the length takes 1/4 of it");
    near_(element_serial(far, fibre).xx, 0, 1e-12, "and one by more than 4 %% all");
}

static element_tensor gradient_by_chance(double most)
{
    double entry[9];
    element_tensor h;
    for (int i = 0; i < 9; i++)
        entry[i] = most * (2 * by_chance() - 1);
    memcpy(&h, entry, sizeof h);
    return h;
}

/* Of any direction, optimum, passive stress and level, with a contractile element that a step may leave: its spring
 * pulls with 1.4 of the isometric stress at most. slack: it may have more of the length, too. */
static element_fibre fibre_by_chance(element_tensor h, bool slack)
{
    const double optimum = .8 + .4 * by_chance(), peak = 1e5, series = .02 + .08 * by_chance();
    element_fibre fibre = {{by_chance() - .5, by_chance() - .5, by_chance() - .5},
                           by_chance() * peak / optimum,
                           {1 / optimum - 1, .05 * peak / optimum, 6.6, .4},
                           {peak / (optimum * optimum * series), 0}};
    const double length = element_length(fibre.along);
    fibre.along.x /= length, fibre.along.y /= length, fibre.along.z /= length;
    const double lambda = element_length(element_fibre_now(h, fibre.along));
    const double most = 1.4 * fibre.tension * muscle_force_length(lambda * (1 + fibre.curves.less));
    const double pull = slack && by_chance() < .2 ? -1000 : by_chance() * most;
    fibre.series.contractile = element_fibre_strain(h, fibre.along, lambda) - pull / fibre.series.stiffness;
    return fibre;
}

/* dP/dF : (a (x) n) . (a (x) n) by differences, of two muscles in tissue. */
static double pushed(element_tensor h, element_tensor z, const double *c, element_fibre own, element_fibre other)
{
    const double d = 1e-6;
    double sum = 0;
    for (int side = -1; side < 2; side += 2) {
        element_tensor moved = h;
        tangent_add(&moved, side * d, z);
        const element_tensor p = element_stress(FORM_NEO_HOOKEAN, moved, c, own, ELEMENT_SERIAL_MUSCLE, other,
                                                ELEMENT_SERIAL_MUSCLE, NULL, 0);
        sum += side * tangent_dot(p, z) / (2 * d);
    }
    return sum;
}

/* z:(A z) of random z of length 1, with the sides' lengths in it, against what bounds and the matrix tell. */
static void test_bound(void)
{
    const double c[FORM_NUMBERS] = {5000, 62000}, side[3] = {.001, .0012, .0008};
    int past = 0, above = 0, close = 0;
    for (int i = 0; i < 2000; i++) {
        const element_tensor h = gradient_by_chance(.3);
        if (!(element_dilation(h) > -.7))
            continue;
        const element_fibre own = fibre_by_chance(h, true), other = fibre_by_chance(h, true);
        step_matrix a;
        stability_matrix(FORM_NEO_HOOKEAN, c, 1000, side, h, own, other, &a);
        const double largest = stability_largest(&a);
        const stability_range range = stability_range_of(FORM_NEO_HOOKEAN, c, 1000, side, h, own, other);
        above += range.high < largest * (1 - 1e-12);
        const element_vector unit = stability_diagonal(1000, side);
        double most = 0;
        for (int k = 0; k < 20; k++) {
            element_tensor z = gradient_by_chance(1);
            if (k < 2) { /* the direction in which the spring is stretched */
                const element_fibre along = k ? other : own;
                const element_vector m = element_fibre_now(h, along.along);
                z = element_along(1, m, along.along);
                z = (element_tensor){z.xx * unit.x, z.xy * unit.y, z.xz * unit.z, z.yx * unit.x, z.yy * unit.y,
                                     z.yz * unit.z, z.zx * unit.x, z.zy * unit.y, z.zz * unit.z};
            }
            const double square = tangent_dot(z, z);
            const element_tensor y = {z.xx * unit.x, z.xy * unit.y, z.xz * unit.z, z.yx * unit.x, z.yy * unit.y,
                                      z.yz * unit.z, z.zx * unit.x, z.zy * unit.y, z.zz * unit.z};
            const double quotient = pushed(h, y, c, own, other) / square;
            past += quotient > largest * (1 + 1e-6);
            most = fmax(most, quotient);
        }
        close += most > .8 * largest;
    }
    ok(!past, "no quotient is past the matrix's largest eigenvalue");
    ok(!above, "which is within its bounds");
    ok(close > 500, "and which some come near to: %d", close);
}

/* Where the spring is tight the matrix has more than the tangent across the fibre alone. */
static void test_matrix(void)
{
    const double c[FORM_NUMBERS] = {5000, 62000}, side[3] = {2, 2, 2};
    double least = INFINITY, worst = 0;
    for (int i = 0; i < 300; i++) {
        const element_tensor h = gradient_by_chance(.2);
        const element_fibre fibre = fibre_by_chance(h, false), none = {.tension = 0};
        const element_vector m = element_fibre_now(h, fibre.along);
        step_matrix a;
        stability_matrix(FORM_NEO_HOOKEAN, c, 1, side, h, fibre, none, &a);
        const element_tensor z = element_along(1 / element_length(m), m, fibre.along);
        const double along = pushed(h, z, c, fibre, none);
        double at[9], sum = 0;
        memcpy(at, &z, sizeof at);
        for (int r = 0; r < 81; r++)
            sum += at[r / 9] * a.at[r / 9][r % 9] * at[r % 9];
        worst = fmax(worst, fabs(sum / along - 1));
        least = fmin(least, along);
    }
    ok(worst < 1e-6 && least > 1e5, "along the fibre it is the stress's derivative: %.2g of it", worst);
}

int main(void)
{
    test_all_series(1e-6, 7);
    test_order();
    test_release();
    test_bound();
    test_matrix();
    return done_testing();
}
