/* On which side of an edge the origin of a plane is, exactly, and never on it: the origin counts as moved by (e, e^2),
 * e -> 0+, so that a ray upright to the plane crosses a closed surface as often one way as the other. Owns nothing.
 */
#ifndef SINEW_EDGE_SIDE_H
#define SINEW_EDGE_SIDE_H

#include <math.h>

static inline int edge_sign(double x)
{
    return (x > 0) - (x < 0);
}

/* The sign of a d - b c, exactly: where the rounded products are equal, what they were rounded by decides. */
static inline int edge_cross_sign(double a, double b, double c, double d)
{
    const double p = a * d, q = b * c;
    if (p != q)
        return p > q ? 1 : -1;
    return edge_sign(fma(a, d, -p) - fma(b, c, -q));
}

/* 1: the origin is to the left of the edge from p to q; -1: to the right; 0: p and q are one place. */
static inline int edge_side(const double p[2], const double q[2])
{
    const int sign = edge_cross_sign(p[0], p[1], q[0], q[1]);
    if (sign)
        return sign;
    return p[1] != q[1] ? edge_sign(p[1] - q[1]) : edge_sign(q[0] - p[0]);
}

#endif
