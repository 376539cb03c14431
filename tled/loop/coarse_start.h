/* A start near the end of a run to rest: coarser models (tled/coarse), each with half the elements a side, come to rest
 * first, the coarsest from the beginning of the script, each finer one from the rest of the one before, as it is at the
 * script's end. The last hands its rest over as the state that the run begins from. Owns nothing.
 */
#ifndef SINEW_COARSE_START_H
#define SINEW_COARSE_START_H

#include "tled/loop/run.h"

typedef struct coarse_told {
    int models;              /* that came to rest, but for those that did without their own coarser one */
    int64_t elements, steps; /* of them all; steps: each part of a cut one for itself */
    char why[200];           /* there is none, in words */
} coarse_told;

/* Lets coarser models of p, which is at rest and r's, come to rest on r's device, in its precision, to ten times its
 * tolerance. 0: p begins from there, at the script's end, at no velocity. -1: it begins as it did, and told->why says
 * why. */
int coarse_start(const run_setup *r, tled_problem *p, const model *m, coarse_told *told);

/* p begins at rest at time 0 again. */
void coarse_forget(tled_problem *p);

#endif
