/* An exact solver that is made by a thread of its own while others compute: its stiffness at rest, and the factor. It
 * reads what of the problem never changes, so the solver is the same whenever it is taken. The creator owns it.
 */
#ifndef SINEW_EXACT_MAKING_H
#define SINEW_EXACT_MAKING_H

#include "msds/cpu/exact.h"

typedef struct exact_making exact_making;

/* Begins, with so many threads, which let all others go first. NULL with e filled. */
exact_making *exact_making_start(const msds_problem *p, bool warped, contacts *c, const lanes *loops, int threads,
                                 err *e);

/* Whether it is done: 1, 0, or -1 with e filled where it failed. wait: until it is. */
int exact_making_look(exact_making *m, bool wait, err *e);

/* What was made, once it is done: into k, which x borrows, and which must stay where it is, as must x. Frees m. */
void exact_making_take(exact_making *m, stiffness *k, exact *x, pool *threads);

/* Ends it, done or not. m may be NULL. */
void exact_making_free(exact_making *m);

#endif
