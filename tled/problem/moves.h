/* Where the script takes a component of a node: one source for every executor. Of a node that is displaced, all that
 * counts is its curve; one of a body that moves goes by four curves and its own place at rest, X:
 *     u = b + A X,  A = R - I,
 * whose values are b and the columns of A (script.h). Owns nothing.
 */
#ifndef SINEW_MOVES_H
#define SINEW_MOVES_H

#include <stdint.h>

#ifdef __CUDACC__
#define MOVES_FUNCTION static __host__ __device__ __forceinline__
#else
#define MOVES_FUNCTION static inline
#endif

/* In a component's hold, which is not below 0: the curve, and whether it is the first of a body's. */
enum { MOVES_BODY = 1 << 30, MOVES_CURVE = MOVES_BODY - 1 };

/* The displacement of component a, m. value: all curves' values; rest: x 3, m. */
MOVES_FUNCTION double moves_to(const double *value, int32_t hold, int a, const double *rest)
{
    const double *of = value + 3 * (int64_t)(hold & MOVES_CURVE) + a;
    if (hold & MOVES_BODY)
        return of[0] + ((of[3] * rest[0] + of[6] * rest[1]) + of[9] * rest[2]);
    return of[0];
}

#endif
