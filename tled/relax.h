/* Dynamic relaxation (Underwood 1983): the mass damping that takes a run to rest soonest, twice the lowest frequency
 * that still moves, guessed from two states by Rayleigh's quotient. The caller owns the struct.
 */
#ifndef SINEW_RELAX_H
#define SINEW_RELAX_H

#include "tled/watch.h"

typedef struct relax {
    double damping;                  /* 1/s: for now */
    double low, high;                /* its bounds */
    double *displacement, *internal; /* nodes x 3: of the state before; owned */
    bool primed;
} relax;

/* The damping that a run begins with, and keeps where it is not to be found on the way: critical for the slowest shear
 * wave across the model, alpha = 2 w, w = (pi/2) c / L, c the least of sqrt(mu/rho), L tled_reach. -1 with e filled. */
double relax_estimate(const tled_problem *p, err *e);

int relax_make(relax *r, const tled_problem *p, double estimate, double stable, err *e);
void relax_free(relax *r);

/* Takes the state that was looked at: w^2 = du . dK / (du . M du) over what is free, du the displacement since the last
 * state, dK the change of the elements' pulls. */
void relax_update(relax *r, const watch *w);

#endif
