/* What the processor can do at most, measured beside what is compared with it: copying in memory, and
 * multiply-adds in the very instruction set that the solver chose, not fused, as the project computes. The
 * caller owns a roof, which needs its threads.
 */
#ifndef SINEW_ROOF_H
#define SINEW_ROOF_H

#include "base/pool.h"

typedef struct roof {
    pool *threads;
    const char *vectors; /* plain, AVX2 or AVX-512: as a cpu_pass is named */
    char *from, *to;
} roof;

/* In bytes and operations a second; a byte that is copied counts twice: read, and written. */
typedef struct roof_rates {
    double copy, flops;
} roof_rates;

/* Seconds. */
double roof_clock(void);

/* -1 with e filled, and r to be freed all the same. */
int roof_make(roof *r, pool *threads, const char *vectors, err *e);
void roof_free(roof *r);

/* One round of it, in float or in double; takes some hundredths of a second. */
roof_rates roof_take(const roof *r, bool single);

#endif
