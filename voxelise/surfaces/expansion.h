/* Exact sums and products of doubles. An expansion is a real number kept as the unevaluated sum of its components:
 * doubles that do not overlap, in order of growing magnitude, none of them zero; no components at all is zero. The
 * caller owns the arrays; what a function returns is the count of components that it wrote to h. Exact as long as no
 * product overflows or falls below the smallest double (grid.h keeps coordinates within limits that see to it).
 * Source: Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates (1997).
 */
#ifndef SINEW_EXPANSION_H
#define SINEW_EXPANSION_H

#include <math.h>

/* The most components of any result here: what the predicates of crossing.h come to at worst. */
enum { EXPANSION_MOST = 512 };

/* sum + error = a + b, exactly. */
static inline double expansion_two_sum(double a, double b, double *error)
{
    double sum = a + b, of_b = sum - a, of_a = sum - of_b;
    *error = (a - of_a) + (b - of_b);
    return sum;
}

/* product + error = a b, exactly. */
static inline double expansion_two_product(double a, double b, double *error)
{
    double product = a * b;
    *error = fma(a, b, -product);
    return product;
}

/* h = a + b of two doubles: up to 2 components. */
int expansion_of_sum(double a, double b, double *h);

/* h = a b of two doubles: up to 2 components. */
int expansion_of_product(double a, double b, double *h);

/* h = e + f: up to n + m components. h is neither e nor f. */
int expansion_sum(int n, const double *e, int m, const double *f, double *h);

/* h = e + b: up to n + 1 components. */
int expansion_add(int n, const double *e, double b, double *h);

/* h = e f: up to 2 n m components, at most EXPANSION_MOST. h is neither e nor f. */
int expansion_product(int n, const double *e, int m, const double *f, double *h);

/* e = -e. */
void expansion_negate(int n, double *e);

/* -1, 0 or 1. */
static inline int expansion_sign(int n, const double *e)
{
    if (n == 0)
        return 0;
    return e[n - 1] > 0 ? 1 : -1;
}

#endif
