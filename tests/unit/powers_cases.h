/* What the tests of powers.h share: each function against the C library's, in a precision that has digits to spare.
 * Owns nothing.
 */
#ifndef SINEW_POWERS_CASES_H
#define SINEW_POWERS_CASES_H

#include "physics/powers.h"

#include "tap.h"

#include <float.h>
#include <stdlib.h>

#ifdef ELEMENT_SINGLE
enum { CASE_DIGITS = FLT_MANT_DIG, CASE_LEAST = FLT_MIN_EXP };
#else
enum { CASE_DIGITS = DBL_MANT_DIG, CASE_LEAST = DBL_MIN_EXP };
#endif

/* How far x is from the exact value, in units of the exact value's last place; of what is no number: very far. */
static double units_off(real x, long double exact)
{
    int power;
    frexpl(exact, &power);
    if (power < CASE_LEAST)
        power = CASE_LEAST;
    const double off = (double)fabsl(ldexpl((long double)x - exact, CASE_DIGITS - power));
    return isnan(off) ? INFINITY : off;
}

/* The same numbers in every run, from -1 to 1. */
static double next_number(void)
{
    static uint64_t seed = 7;
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(seed >> 11) / 4503599627370496. - 1;
}

enum { CASE_TRIES = 40000 };

/* Worst of f over numbers that `pick` makes of those from -1 to 1. */
static void test_units(const char *name, real (*f)(real), long double (*exact)(long double), double (*pick)(double))
{
    double worst = 0;
    for (int i = 0; i < CASE_TRIES; i++) {
        const real x = R(pick(next_number()));
        worst = fmax(worst, units_off(f(x), exact((long double)x)));
    }
    ok(worst < 2, "%s is within 2 units in the last place: %.3f", name, worst);
}

static double pick_wide(double t)
{
    return t * (sizeof(real) == sizeof(float) ? 87 : 700);
}

static double pick_near(double t)
{
    return 3 * t;
}

static double pick_small(double t)
{
    return t * exp2(-30 * fabs(next_number()));
}

static double pick_positive(double t)
{
    return exp2(t * (sizeof(real) == sizeof(float) ? 125 : 1021));
}

static double pick_near_one(double t)
{
    return 1.5 + 1.4 * t;
}

static double pick_more(double t)
{
    return .9 * pick_small(t);
}

static double pick_large(double t)
{
    return exp2(40 * fabs(t)) * 1.1;
}

/* Powers: what is said of them. */
static void test_powers(void)
{
    double worst = 0, worst_less = 0;
    for (int i = 0; i < CASE_TRIES; i++) {
        const real x = R(pick_near_one(next_number())), y = R(20 * next_number()), less = R(pick_more(next_number()));
        const long double log = (long double)y * logl((long double)x),
                          more = (long double)y * log1pl((long double)less);
        if (fabsl(log) < 80)
            worst = fmax(worst, units_off(real_power(x, y), expl(log)) / (3 + 2 * (double)fabsl(log)));
        if (fabsl(more) < 80)
            worst_less =
                fmax(worst_less, units_off(real_power_less(less, y), expm1l(more)) / (4 + 2 * (double)fabsl(more)));
    }
    ok(worst < 1, "x^y is within 3 + 2 |y ln x| units in the last place: %.3f of that", worst);
    ok(worst_less < 1, "(1 + x)^y - 1 is within 4 + 2 |y ln(1 + x)|: %.3f of that", worst_less);
}

static void test_ends(void)
{
    const real most = R(sizeof(real) == sizeof(float) ? 87 : 700), large = R(1e30), none = R(NAN);
    ok(real_exp(R(0)) == 1 && real_exp_less(R(0)) == 0 && real_log(R(1)) == 0 && real_log_more(R(0)) == 0,
       "e^0, ln 1 and what is left of 1 are exact");
    ok(real_exp(large) == real_exp(most) && real_exp(-large) == real_exp(-most),
       "beyond its ends e^x is that of the end");
    ok(real_exp_less(-large) == -1 && real_exp_less(large) == real_exp(most), "and so is e^x - 1");
    ok(isnan(real_exp(none)) && isnan(real_exp_less(none)) && isnan(real_log(none)) && isnan(real_log_more(none)),
       "of no number there is none");
    ok(isnan(real_log(R(0))) && isnan(real_log(R(-1))) && isnan(real_log(R(INFINITY))) && isnan(real_log_more(R(-1))),
       "nor is there a logarithm of 0, of a number below or of infinity");
}

static void test_all_powers(void)
{
    test_units("e^x", real_exp, expl, pick_wide);
    test_units("e^x of 3 and less", real_exp, expl, pick_near);
    test_units("e^x - 1", real_exp_less, expm1l, pick_wide);
    test_units("e^x - 1 of 3 and less", real_exp_less, expm1l, pick_near);
    test_units("e^x - 1 of small x", real_exp_less, expm1l, pick_small);
    test_units("ln x", real_log, logl, pick_positive);
    test_units("ln x near 1", real_log, logl, pick_near_one);
    test_units("ln(1 + x)", real_log_more, log1pl, pick_more);
    test_units("ln(1 + x) of large x", real_log_more, log1pl, pick_large);
    test_powers();
    test_ends();
}

#endif
