/* A muscle whose force depends on the velocity at which it shortens (Hill 1938): a contractile element in series with a
 * spring, both along the fibre. With lambda the fibre's stretch, l = lambda / optimum and c the part of the stretch
 * that the contractile element has,
 *     sigma = k max(lambda - c, 0),   k = peak / (optimum^2 series),
 *     sigma = peak / optimum a f(l) v(w),   w = dc/dt / (optimum vmax),
 *     v(w) = (1 + w) / (1 - 4 w) from w = -1 to 0,   (.4 + 14 w) / (.4 + 10 w) from 0 on (Thelen 2003),
 * so that the muscle pulls with nothing where it shortens by vmax lengths a second, and with 1.4 of its isometric
 * stress at most. `series` is the spring's strain at peak stress. f is taken at the length of the fibre, of which both
 * are part, as it is measured: so where nothing moves the stress is that of muscle_curves.h, and at a steady force it
 * is that of the velocity of the fibre.
 *
 * In a step the muscle is the spring alone, which has an energy. Between steps c goes on at a given lambda, by backward
 * Euler: that is one number x = w from a quadratic equation, whatever the length of the step, and never lets the spring
 * pull with more than 1.4 of the isometric stress. Read from velocities within a step, v would damp with
 * 5 peak / vmax, which at a peak of 1e5 Pa asks for steps of .1 us. In the numbers of strain.h, whose rules
 * hold here. Owns nothing.
 */
#ifndef SINEW_MUSCLE_SERIES_H
#define SINEW_MUSCLE_SERIES_H

#include "physics/strain.h"

/* stiffness: k, Pa; 0: the muscle has no spring. contractile: c - 1, so that float keeps small strains. */
typedef struct muscle_series {
    real stiffness, contractile;
} muscle_series;

/* The most that v is. */
#define MUSCLE_SERIES_MOST 1.4

/* The spring's stress, Pa; strain: lambda - 1. */
ELEMENT_FUNCTION real muscle_spring(muscle_series s, real strain)
{
    const real pull = s.stiffness * (strain - s.contractile);
    return REAL_SELECT(pull > 0, pull, REAL_ZERO);
}

/* c - 1 at the end of a step. tension: of the muscle where nothing moves, peak / optimum a f(l), Pa; most: what c may
 * lose in the step, optimum vmax dt. With s the spring's stress at the old c, below 0 where it is slack, r = k most and
 * d = s - tension, the step's x solves, for the spring's stress s - r x at the new c,
 *     s - r x = tension v(x):   below 0, y = -x, 4 r y^2 + b y + d = 0,          b = r + 4 s + tension,
 *                               above,   10 r x^2 + b x - .4 d = 0,              b = .4 r + 14 tension - 10 s,
 * each of which has one root of its sign, by q = sqrt(b^2 + 16 r |d|); y = 1 where the spring stays slack. */
ELEMENT_FUNCTION real muscle_contract(muscle_series s, real strain, real tension, real most)
{
    const real pull = s.stiffness * (strain - s.contractile), r = s.stiffness * most, d = pull - tension;
    const real_mask shortens = d < 0;
    const real b = REAL_SELECT(shortens, r + 4 * pull + tension, R(.4) * r + 14 * tension - 10 * pull);
    const real far = REAL_SELECT(shortens, -d, d), q = real_sqrt(b * b + 16 * r * far), sum = b + q;
    const real by = far / REAL_SELECT(sum > 0, sum, REAL_ZERO + 1);
    const real y = REAL_SELECT(pull + r > 0, 2 * by, REAL_ZERO + 1);
    const real stiff = REAL_SELECT(s.stiffness > 0, s.stiffness, REAL_ZERO + 1);
    const real longer = REAL_SELECT(b > 0, R(.8) * most * by, (q - b) / (20 * stiff));
    return s.contractile + REAL_SELECT(shortens, -most * y, longer);
}

#endif
