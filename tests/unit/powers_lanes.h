/* The functions of powers.h, of two numbers at once. Owns nothing. */
#ifndef SINEW_POWERS_LANES_H
#define SINEW_POWERS_LANES_H

enum { POWERS_LANES = 6 };

/* e^x, e^x - 1, ln x, ln(1 + x), x^y, (1 + x)^y - 1. */
void powers_lanes(const double x[2], double y, double to[POWERS_LANES][2]);

#endif
