/* Vectors of three floats, for the tracer's inner loops.
 */
#ifndef SINEW_RENDER_VEC_H
#define SINEW_RENDER_VEC_H

#include <math.h>

typedef struct vec {
    float x, y, z;
} vec;

static inline vec vec_of(const float *p)
{
    return (vec){p[0], p[1], p[2]};
}

static inline vec vec_add(vec a, vec b)
{
    return (vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec vec_sub(vec a, vec b)
{
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec vec_scale(vec a, float s)
{
    return (vec){a.x * s, a.y * s, a.z * s};
}

/* a + s b */
static inline vec vec_along(vec a, vec b, float s)
{
    return (vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline float vec_dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec vec_cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The C library's take care of nans, and are calls. */
static inline float vec_least(float a, float b)
{
    return a < b ? a : b;
}

static inline float vec_most(float a, float b)
{
    return a > b ? a : b;
}

/* Zero stays zero. */
static inline vec vec_unit(vec a)
{
    float l = sqrtf(vec_dot(a, a));
    return l > 0 ? vec_scale(a, 1 / l) : a;
}

#endif
