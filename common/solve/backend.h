/* Back ends of a solver: a table of functions each, and the choice among them. The same for every solver: what a
 * problem, a plan and a state are is the solver's own affair. The first in a table is the one preferred; a table ends with NULL.
 * A caller owns the state that create gives, until destroy. A state is used by one thread at a time, but for taken.
 *
 * step, keep, back and take may return before the device is done: what went wrong then comes out of a later call. look and
 * taken wait.
 */
#ifndef SINEW_BACKEND_H
#define SINEW_BACKEND_H

#include "base/err.h"
#include "base/pool.h"

#include <stddef.h>

typedef struct backend {
    const char *name;
    /* Why it cannot be used on this machine, or NULL. Looks at the device: not called before it is asked for. */
    const char *(*unusable)(void);
    /* Allocates all that the steps take. The problem stays the caller's and unchanged. NULL with e filled. */
    void *(*create)(const void *problem, pool *threads, err *e);
    /* Goes `count` steps on. -1 with e filled, as for all below. */
    int (*step)(void *state, const void *plan, int64_t count, err *e);
    /* Copies one of the state's arrays out. */
    int (*get)(void *state, int what, double *to, err *e);
    /* Keeps a copy of the state in place of the one kept before; and goes back to it. */
    int (*keep)(void *state, err *e);
    int (*back)(void *state, err *e);
    /* Takes a copy of the results as they are into a slot (from 0; how many is the solver's affair), to be fetched later. */
    int (*take)(void *state, int slot, err *e);
    /* Fetches what was taken, in any thread, while the state goes on. */
    int (*taken)(void *state, int slot, void *to, err *e);
    /* What the solver looks at now and then, found where the state is; NULL: the solver does it from what get gives. */
    int (*look)(void *state, const void *question, void *answer, err *e);
    /* Bytes of the device's memory that the state has by now. */
    int64_t (*bytes)(const void *state);
    void (*destroy)(void *state);
    /* How many elements a pass computes, those that are computed twice counted twice, for benchmarks; NULL: not told. */
    int64_t (*computed)(const void *state);
} backend;

/* The back end named so, or for "auto" the first that is usable; says (of `size` bytes) gets what was taken, and what was not and
 * why. NULL with e filled where the name is not in the table, or what it names is not usable here. */
const backend *backend_choose(const backend *const *table, const char *name, char *says, size_t size, err *e);

#endif
