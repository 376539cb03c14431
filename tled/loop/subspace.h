/* The least energy over the recent ways of a run to rest: of ways p, each with what it changed the forces out of
 * balance by, q = K p, the sum u + sum a p where (p . q) a = p . r, r the forces out of balance at u. With
 * corrections by multigrid among them, it joins what a correction leaves each time (Washio & Oosterlee 1997,
 * recombination of iterants). Owns its ways.
 */
#ifndef SINEW_SUBSPACE_H
#define SINEW_SUBSPACE_H

#include "base/err.h"

#include <stdint.h>

enum { SUBSPACE_WAYS = 5 };

typedef struct subspace {
    int64_t numbers;                                   /* of a way */
    int ways;                                          /* that there are, the newest first */
    double *way[SUBSPACE_WAYS], *force[SUBSPACE_WAYS]; /* p (m) and q (N) */
} subspace;

/* Empty, for ways of so many numbers. -1 with e filled, and s to be freed all the same. */
int subspace_make(subspace *s, int64_t numbers, err *e);
void subspace_free(subspace *s);

/* Makes room for a newer way, which the caller fills: s->way[0] and s->force[0]. The oldest goes where there are too
 * many. */
void subspace_push(subspace *s);

/* Writes sum a p (m): 0 where none lowers the energy; and r - sum a q (N), what that leaves of the residual r. */
void subspace_least(const subspace *s, const double *residual, double *sum, double *left);

#endif
