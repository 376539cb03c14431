/* The executors of a solver: the ways in which it can be computed, each on a device. Here is what the choice among
 * them needs; the functions of each solver's executors have that solver's types (tled/problem/tled_executor.h,
 * msds/problem/msds_executor.h), and begin with this part.
 */
#ifndef SINEW_EXECUTOR_H
#define SINEW_EXECUTOR_H

#include "base/err.h"

#include <stddef.h>

typedef struct executor {
    const char *device; /* "cpu" or "cuda", as the user says it */
    /* Why it cannot be used on this machine, or NULL. Initialises the device: called only where it may be chosen. */
    const char *(*unusable)(void);
} executor;

/* The place in `table` (ends with NULL, the preferred first) of the executor on the device of this name, or for
 * "auto" of the first that can be used. says (of `size` bytes) gets which device was chosen, and which was not and
 * why. -1 with e filled where the device is not in the table, or cannot be used here. */
int executor_choose(const executor *const *table, const char *device, char *says, size_t size, err *e);

#endif
