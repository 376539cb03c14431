/* Anderson's mixing (1965): what an iteration x <- G(x) does next, from its last few steps, so that it comes to rest
 * in fewer of them than by steps alone. The next x is the combination of the last ones whose steps G(x) - x would
 * cancel best, moved by what is left of the step. The creator owns it; it takes no memory after it is made.
 */
#ifndef SINEW_MIXING_H
#define SINEW_MIXING_H

#include "base/err.h"

enum { MIXING_DEPTH = 8 };

typedef struct mixing {
    int64_t count, led; /* numbers in x; of which the first are what steps are measured by */
    int held;           /* differences that are known */
    int next;           /* where the next goes */
    bool begun;         /* x and step are of the call before */
    double *x, *step;   /* count */
    double *dx, *dstep; /* MIXING_DEPTH x count: differences of those from call to call */
} mixing;

/* m is zeroed. -1 with e filled, and to be freed all the same. */
int mixing_make(mixing *m, int64_t count, int64_t led, err *e);
void mixing_free(mixing *m);

/* Forgets all steps: the iteration is another from here on. */
void mixing_begin(mixing *m);

/* From x and step = G(x) - x to the next x, in place. */
void mixing_next(mixing *m, double *x, const double *step);

#endif
