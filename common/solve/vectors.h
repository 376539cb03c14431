/* Which instruction set a solver's loops run in: the same source is compiled for several, and gives the same bytes in each, so that
 * a table of them is gone through, the fastest first. The environment's SINEW_VECTORS names one, for tests. Owns nothing.
 */
#ifndef SINEW_VECTORS_H
#define SINEW_VECTORS_H

#include "base/err.h"

#include <stdbool.h>

/* Whether this processor has what is named plain, AVX2 or AVX-512, and nothing else is asked for. */
bool vectors_are(const char *name);

/* Where no table has one: fills e. */
void vectors_none(err *e);

#endif
