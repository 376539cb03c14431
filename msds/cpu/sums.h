/* The sum of what the chunks of a loop leave (pool.h), in an order that a card can follow with a block of threads:
 * sums of every SUMS_WIDE-th, then pairs of neighbours, then pairs of those. Owns nothing.
 */
#ifndef SINEW_SUMS_H
#define SINEW_SUMS_H

#include <stdint.h>

enum { SUMS_WIDE = 128 };

static inline double sums_of(const double *x, int64_t count)
{
    double sum[SUMS_WIDE] = {0};
    for (int64_t i = 0; i < count; i++)
        sum[i % SUMS_WIDE] += x[i];
    for (int width = 1; width < SUMS_WIDE; width *= 2)
        for (int i = 0; i < SUMS_WIDE; i += 2 * width)
            sum[i] += sum[i + width];
    return sum[0];
}

#endif
