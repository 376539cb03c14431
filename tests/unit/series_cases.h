/* Muscles in series with a spring, in either precision: Hill's figures as the steady states of steps, and that each
 * step solves its equation, whatever the state. */
#ifndef SINEW_SERIES_CASES_H
#define SINEW_SERIES_CASES_H

#include "physics/element.h"

#include "tap.h"

static double by_chance(void)
{
    static uint32_t seed = 3;
    seed = seed * 1664525 + 1013904223;
    return (double)seed / 4294967296.;
}

/* Peak 1e5 Pa, optimum 1, series .04, at full level: a fibre that goes on by w each step keeps v(w) of the peak. */
static void test_figures(double tolerance)
{
    static const double figure[][2] = {{-1, 0}, {-.5, .166667}, {-.25, .375}, {0, 1}, {.25, 1.344828}};
    for (int i = 0; i < 5; i++) {
        const double w = figure[i][0], most = 10 * 1e-4;
        muscle_series s = {R(1e5 / .04), R(0)};
        double strain = .04 * figure[i][1];
        for (int k = 0; k < 20; k++) {
            strain += w * most;
            s.contractile = muscle_contract(s, R(strain), R(1e5), R(most));
        }
        near_((double)muscle_spring(s, R(strain)) / 1e5, figure[i][1], tolerance, "at w = %g", w);
        near_((double)s.contractile, 20 * w * most, tolerance * .04, "and the contractile element goes as the fibre");
    }
}

/* By how much a step misses its equation, as a share of the stresses in it; but for what c is rounded by. */
static double miss(muscle_series s, double strain, double tension, double most)
{
    const double k = (double)s.stiffness, old = (double)s.contractile;
    const double now = (double)muscle_contract(s, R(strain), R(tension), R(most)), x = (now - old) / most;
    const double digits = sizeof(real) == sizeof(float) ? 6e-8 : 1.2e-16,
                 room = 4 * digits * (fabs(strain) + fabs(old));
    const double pull = fmax(k * (strain - now), 0), scale = tension + fabs(k * (strain - old)) + k * most;
    if (!isfinite(now))
        return INFINITY;
    if (x <= -1 + room / most && strain - now <= room) /* as fast as it can, and slack still */
        return 0;
    /* Times the denominator of v, as where a muscle yields x has no bound. */
    const double by = x < 0 ? 1 - 4 * x : .4 + 10 * x;
    const double wants = tension * (x < 0 ? 1 + x : .4 + 14 * x);
    const double rounded = room * (k + 20 * tension / most / by);
    return fmax(fmax(fabs(pull - wants / by), pull - 1.4 * tension) - rounded, 0) / scale;
}

/* least: of a step, as a power of 10. */
static void test_steps(double tolerance, double least)
{
    double worst = 0;
    int slack = 0, yields = 0;
    for (int i = 0; i < 100000; i++) {
        const double peak = pow(10, 6 * by_chance()), series = pow(10, -3 * by_chance());
        const double most = pow(10, -least * by_chance()), level = i % 10 ? by_chance() : 0;
        const muscle_series s = {R(peak / series), R(.5 * by_chance() - .25)};
        const double at = (double)s.contractile + (i % 3 ? 4 * series * (by_chance() - .4) : most * (by_chance() - 1));
        worst = fmax(worst, miss(s, (double)R(at), (double)R(level * peak), (double)R(most)));
        slack += at < (double)s.contractile;
        yields += (at - (double)s.contractile) / series > 1.4 * level;
    }
    ok(worst < tolerance, "each step solves its equation, to %.2g of the stresses", worst);
    ok(slack > 1000 && yields > 1000, "of %d that are slack and %d that yield too", slack, yields);
    ok(miss((muscle_series){R(1), R(0)}, 0, 0, 1e-3) == 0, "at rest nothing moves");
}

static element_fibre serial_of(double level, double contractile)
{
    const element_fibre fibre = {.along = {R(1), R(0), R(0)},
                                 .tension = R(level * 1e5),
                                 .series = {.stiffness = R(1e5 / .04), .contractile = R(contractile)}};
    return fibre;
}

/* Isometric: the stress of the plain curve, at any length, whatever it comes from. */
static void test_isometric(double tolerance)
{
    for (int i = 0; i < 12; i++) {
        const double stretch = .65 + .08 * i, level = 1 - .08 * i;
        const element_tensor h = {.xx = R(stretch - 1)};
        element_fibre fibre = serial_of(level, stretch - 1 + (i % 2 ? -.1 : .1));
        for (int k = 0; k < 600; k++)
            fibre.series.contractile = element_contract(h, fibre, R(10 * 1e-3));
        const double got = (double)element_serial(h, fibre).xx, want = (double)element_active(h, fibre).xx;
        near_(got, want, tolerance * 1e5, "held at %g, level %g: the isometric stress", stretch, level);
    }
}

static void test_all_series(double tolerance, double least)
{
    test_figures(tolerance);
    test_steps(tolerance, least);
    test_isometric(tolerance);
}

#endif
