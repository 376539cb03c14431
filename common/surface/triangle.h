/* A triangle's normal, as long as twice its area: (b - a) x (c - a); lengths. Nothing is kept.
 */
#ifndef SINEW_TRIANGLE_H
#define SINEW_TRIANGLE_H

#include <math.h>

static inline void triangle_normal(const double *a, const double *b, const double *c, double normal[3])
{
    const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    normal[0] = u[1] * v[2] - u[2] * v[1];
    normal[1] = u[2] * v[0] - u[0] * v[2];
    normal[2] = u[0] * v[1] - u[1] * v[0];
}

static inline double triangle_length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static inline double triangle_distance(const double *a, const double *b)
{
    const double way[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return triangle_length(way);
}

#endif
