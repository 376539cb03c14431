/* How long a step of PST's equations 3 to 5 may be. With gamma = c k for every spring, a mode of M^-1 K's eigenvalue l
 * is stable where dt^2 l + 2 c dt l < 4, since velocity first and position after make v' = v - dt (l u + c l v), u' = u
 * + dt v'. The largest eigenvalue is found by Lanczos, at rest; and with springs that are as stiff in every direction
 * as along themselves, and the probe at every node, which no configuration exceeds.
 */
#ifndef SINEW_LARGEST_H
#define SINEW_LARGEST_H

#include "msds/problem/problem.h"

typedef struct largest {
    double rest;  /* 1/s2: of M^-1 K at rest, M the inertia (weight times mass_factor); from above, to 1e-3 */
    double bound; /* 1/s2: no configuration has more, contact with the probe included */
} largest;

/* -1 with e filled. */
int largest_of(const msds_problem *p, largest *l, err *e);

/* The longest stable step, s, for an eigenvalue and gamma = c k. */
double largest_step(double eigenvalue, double c);

/* By what factor inertia must grow that a step of dt is stable. */
double largest_factor(double eigenvalue, double c, double dt);

#endif
