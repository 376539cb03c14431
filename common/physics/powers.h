/* Exponential, logarithm and powers, made of arithmetic only: the same bytes with any C library, on a card and in any
 * lane. In the numbers of strain.h, whose rules hold here. Each of them is within 2 units in the last place, but for
 * powers, where the exponent magnifies what the logarithm rounds. Owns nothing.
 */
#ifndef SINEW_POWERS_H
#define SINEW_POWERS_H

#include "physics/strain.h"

/* A number's bits, and how they are divided: digits below the exponent, its bias; 1.5 2^digits, to which a number
 * that is added is rounded to a whole one, in the lowest bits; ln 2 in two parts, of which the first has so many
 * zeros at its end that its products with exponents are exact; the bits of 2^(-1/2). */
#ifdef ELEMENT_SINGLE
typedef uint32_t powers_word_one;
enum { POWERS_DIGITS = 23, POWERS_BIAS = 127 };
#define POWERS_ROUND    R(0x1.8p23)
#define POWERS_LN2_HIGH R(0x1.62e4p-1)
#define POWERS_LN2_LOW  R(0x1.7f7d1cp-20)
#define POWERS_HALF_WAY 0x3f3504f3U
#else
typedef uint64_t powers_word_one;
enum { POWERS_DIGITS = 52, POWERS_BIAS = 1023 };
#define POWERS_ROUND    R(0x1.8p52)
#define POWERS_LN2_HIGH R(0x1.62e42fefa4p-1)
#define POWERS_LN2_LOW  R(-0x1.8432a1b0e2634p-43)
#define POWERS_HALF_WAY 0x3fe6a09e667f3bcdU
#endif
#ifdef ELEMENT_LANES
typedef powers_word_one powers_word __attribute__((vector_size(ELEMENT_LANES * sizeof(powers_word_one))));
#else
typedef powers_word_one powers_word;
#endif

ELEMENT_FUNCTION powers_word powers_bits(real x)
{
    powers_word bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

ELEMENT_FUNCTION real powers_of_bits(powers_word bits)
{
    real x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* e^r - 1 for |r| <= ln 2 / 2: its series, whose rest is below a tenth of a unit in the last place. */
ELEMENT_FUNCTION real powers_less(real r)
{
#ifdef ELEMENT_SINGLE
    real q = R(1. / 720) + r * R(1. / 5040);
#else
    real q = R(1. / 479001600) + r * R(1. / 6227020800.);
    q = R(1. / 3628800) + r * (R(1. / 39916800) + r * q);
    q = R(1. / 40320) + r * (R(1. / 362880) + r * q);
    q = R(1. / 720) + r * (R(1. / 5040) + r * q);
#endif
    q = R(1. / 24) + r * (R(1. / 120) + r * q);
    q = R(.5) + r * (R(1. / 6) + r * q);
    return r + r * r * q;
}

/* e^x = scale (1 + less): a power of two, and -.3 to .42. */
typedef struct powers_parts {
    real scale, less;
} powers_parts;

/* Of x from -700 to 700, in float from -87 to 87; of what lies beyond, that of the end. Of no number: less is none. */
ELEMENT_FUNCTION powers_parts powers_parts_of(real x)
{
    const real most = real_of(sizeof(real_one) == sizeof(float) ? 87 : 700);
    const real within = REAL_SELECT(x > most, most, REAL_SELECT(x < -most, -most, x));
    const real rounded = within * R(1.4426950408889634) + POWERS_ROUND, whole = rounded - POWERS_ROUND;
    const powers_parts p = {powers_of_bits((powers_bits(rounded) + POWERS_BIAS) << POWERS_DIGITS),
                            powers_less((within - whole * POWERS_LN2_HIGH) - whole * POWERS_LN2_LOW)};
    return p;
}

/* e^x; see powers_parts_of for the ends. */
ELEMENT_FUNCTION real real_exp(real x)
{
    const powers_parts p = powers_parts_of(x);
    return p.scale * (1 + p.less);
}

/* e^x - 1, which keeps the digits of a small x. */
ELEMENT_FUNCTION real real_exp_less(real x)
{
    const powers_parts p = powers_parts_of(x);
    return (p.scale - 1) + p.scale * p.less;
}

/* ln(1 + f) for 1 + f from 2^(-1/2) to 2^(1/2): with s = f/(2 + f), 2 artanh s = f - s (f - R), R = 2 s^2/3 + 2 s^4/5
 * + ...; the rest of this series is below a tenth of a unit in the last place. added: what is added to it. */
ELEMENT_FUNCTION real powers_log(real f, real added)
{
    const real s = f / (2 + f), z = s * s;
#ifdef ELEMENT_SINGLE
    real q = R(2. / 9) * z;
#else
    real q = z * (R(2. / 19) + z * R(2. / 21));
    q = z * (R(2. / 15) + z * (R(2. / 17) + q));
    q = z * (R(2. / 11) + z * (R(2. / 13) + q));
    q = z * (R(2. / 9) + q);
#endif
    q = z * (R(2. / 3) + z * (R(2. / 5) + z * (R(2. / 7) + q)));
    return f - (s * (f - q) - added);
}

/* ln(u + rest), where rest is 0 or at most half a unit in u's last place, and exact: u + rest - 1 where that is small.
 * No number where u is none, is below the normal ones or is infinite. */
ELEMENT_FUNCTION real powers_log_of(real u, real rest, real exact)
{
    const powers_word_one digits = ((powers_word_one)1 << POWERS_DIGITS) - 1;
    const powers_word_one one = (powers_word_one)POWERS_BIAS << POWERS_DIGITS;
    const powers_word_one unit = (powers_word_one)(POWERS_BIAS + POWERS_DIGITS) << POWERS_DIGITS; /* of 2^digits */
    const powers_word shifted = powers_bits(u) + (one - POWERS_HALF_WAY), exponent = shifted >> POWERS_DIGITS;
    const real whole = powers_of_bits(exponent | unit) - (R((uint64_t)1 << POWERS_DIGITS) + POWERS_BIAS);
    const real scale = powers_of_bits((2 * POWERS_BIAS - exponent) << POWERS_DIGITS); /* 2^-whole */
    const real part = powers_of_bits((shifted & digits) + POWERS_HALF_WAY) - 1;
    const real f = REAL_SELECT(whole == 0, exact, part + rest * scale);
    const real log = whole * POWERS_LN2_HIGH + powers_log(f, whole * POWERS_LN2_LOW);
    const real least = real_of(sizeof(real_one) == sizeof(float) ? 0x1p-126 : 0x1p-1022);
    return REAL_SELECT(u >= least, REAL_SELECT(u - u == 0, log, real_of(NAN)), real_of(NAN));
}

/* ln x. */
ELEMENT_FUNCTION real real_log(real x)
{
    return powers_log_of(x, REAL_ZERO, x - 1);
}

/* ln(1 + x), which keeps the digits of a small x. */
ELEMENT_FUNCTION real real_log_more(real x)
{
    const real u = 1 + x, larger = REAL_SELECT(x > 1, x - u + 1, x - (u - 1));
    return powers_log_of(u, larger, x);
}

/* x^y for x > 0, within 3 + 2 |y ln x| units in the last place. */
ELEMENT_FUNCTION real real_power(real x, real y)
{
    return real_exp(y * real_log(x));
}

/* (1 + x)^y - 1, which keeps the digits of a small x; within 4 + 2 |y ln(1 + x)| units in the last place. */
ELEMENT_FUNCTION real real_power_less(real x, real y)
{
    return real_exp_less(y * real_log_more(x));
}

#endif
