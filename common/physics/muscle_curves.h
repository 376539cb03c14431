/* The curves of a muscle: what its fibres pull with at a stretch, along the fibre, by area at rest. With lambda the
 * fibre's stretch and l = lambda / optimum,
 *     sigma = peak / optimum (a f(l) + passive fp(l)),
 * a the activation; f is the active force-length curve, fp the passive one of Blemker, Pinsky & Delp 2005 (J Biomech
 * 38, 657): nothing up to l = 1, an exponential up to the stretch at which fibres are straight, from there on a line
 * with the slope that the exponential has there. Both have an energy by l. In the numbers of strain.h, whose rules hold
 * here. Owns nothing.
 */
#ifndef SINEW_MUSCLE_CURVES_H
#define SINEW_MUSCLE_CURVES_H

#include "physics/muscle_numbers.h"

#ifdef ELEMENT_FORCES_ALONE /* numbers without bits have no powers, so no passive curve */
#include "physics/strain.h"
#else
#include "physics/powers.h"
#endif

/* As muscle_numbers.h has them. */
typedef struct muscle_curves {
    real less;                 /* 1/optimum - 1 */
    real passive;              /* Pa: peak passive / optimum */
    real stiffening, straight; /* fp's exponent; the l from which it is a line, less 1 */
} muscle_curves;

/* f(l): 9 (l - .4)^2 on .4 to .6, 1 - 4 (1 - l)^2 to 1.4, 9 (l - 1.6)^2 to 1.6, else 0. */
ELEMENT_FUNCTION real muscle_force_length(real l)
{
    real low = 9 * (l - R(.4)) * (l - R(.4)), middle = 1 - 4 * (1 - l) * (1 - l);
    real high = 9 * (l - R(1.6)) * (l - R(1.6));
    real f = REAL_SELECT(l < R(.6), low, REAL_SELECT(l <= R(1.4), middle, high));
    return REAL_SELECT(l < R(.4), REAL_ZERO, REAL_SELECT(l > R(1.6), REAL_ZERO, f));
}

/* Its derivative. */
ELEMENT_FUNCTION real muscle_force_length_slope(real l)
{
    real f = REAL_SELECT(l < R(.6), 18 * (l - R(.4)), REAL_SELECT(l <= R(1.4), 8 * (1 - l), 18 * (l - R(1.6))));
    return REAL_SELECT(l < R(.4), REAL_ZERO, REAL_SELECT(l > R(1.6), REAL_ZERO, f));
}

#ifndef ELEMENT_FORCES_ALONE

/* l - 1 of strain = lambda - 1: no difference of nearly equal numbers where the optimum is 1. */
ELEMENT_FUNCTION real muscle_beyond(muscle_curves c, real strain)
{
    return strain + (strain * c.less + c.less);
}

/* fp(l) / passive, beyond = l - 1. */
ELEMENT_FUNCTION real muscle_passive(muscle_curves c, real beyond)
{
    const real over = beyond - c.straight;
    const real bent = REAL_SELECT(over > 0, c.straight, REAL_SELECT(beyond > 0, beyond, REAL_ZERO));
    const real less = real_exp_less(c.stiffening * bent);
    return less + REAL_SELECT(over > 0, c.stiffening * (1 + less) * over, REAL_ZERO);
}

#endif

#ifdef REAL_IS_DOUBLE

/* Its derivative; at l = 1, that towards longer fibres. */
ELEMENT_FUNCTION double muscle_passive_slope(muscle_curves c, double beyond)
{
    return beyond < 0 ? 0 : c.stiffening * real_exp(c.stiffening * fmin(beyond, c.straight));
}

/* The integrals from l = 1 of fp / passive, and from l = 0 of f: a muscle's energy by volume at rest is peak times
 * these, as d lambda = optimum dl. */
ELEMENT_FUNCTION double muscle_passive_sum(muscle_curves c, double beyond)
{
    const double bent = fmax(fmin(beyond, c.straight), 0.), over = fmax(beyond - c.straight, 0.);
    if (!(bent > 0) && !(over > 0))
        return 0;
    const double less = real_exp_less(c.stiffening * bent);
    return (less / c.stiffening - bent) + over * (less + c.stiffening * (1 + less) * over / 2);
}

ELEMENT_FUNCTION double muscle_force_length_sum(double l)
{
    const double low = fmin(fmax(l, .4), .6) - .4, middle = fmin(fmax(l, .6), 1.4),
                 high = fmin(fmax(l, 1.4), 1.6) - 1.6;
    const double off = middle - 1;
    return 3 * low * low * low + (middle - .6) - 4. / 3 * (off * off * off + .064) + 3 * (high * high * high + .008);
}

#endif

#endif
