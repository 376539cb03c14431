/* Coarser models on the way to rest (tled/coarse), each of half the elements a side: multigrid by the full
 * approximation scheme (Brandt 1977), whose smoother is the run itself. To begin with the coarsest comes to rest from
 * the beginning of the script, each finer one from the rest of the one before, as it is at the script's end, and the
 * last hands its rest over as the state that the run begins from. From then on corrections: where fine displacements
 * leave forces r out of balance, the coarser model, at u, is pushed so that R r is out of balance there, R the
 * transpose of the interpolation P, and comes to rest at u + d; P d goes to the finer displacements. Forces on fine
 * nodes that no coarse motion follows are no matter, as steps of the run take them away.
 *
 * The creator owns it; it borrows the run's setup, the problem and its model.
 */
#ifndef SINEW_MULTIGRID_H
#define SINEW_MULTIGRID_H

#include "tled/loop/run.h"

typedef struct multigrid multigrid;

/* Steps between two corrections of a run (run_setup's smooth). A coarser model's own runs, which have less far to go,
 * are corrected at their checks. */
enum { MULTIGRID_SMOOTH = 22 };

/* What the coarser models did. */
typedef struct multigrid_told {
    int models;              /* that there are, each with one that is coarser but for the last */
    int64_t elements, steps; /* of them all; steps: each part of a cut one for itself */
    double work;             /* what their steps are worth in steps of the run, by elements */
} multigrid_told;

/* The coarser models of p, which is at rest and r's, to be run on r's device, in its precision. least: elements of a
 * model that has one that is coarser; 0: the default. NULL with e filled: there is none, and why. */
multigrid *multigrid_make(const run_setup *r, const tled_problem *p, const model *m, int64_t least, err *e);
void multigrid_free(multigrid *g);

/* They come to rest, to ten times r's tolerance. p, that they were made of, begins from there, at the script's end, at
 * no velocity. -1 with e filled: it begins as it did. */
int multigrid_start(multigrid *g, tled_problem *p, err *e);

/* The correction P d (m, nodes x 3) of what is out of balance (N, nodes x 3); remaining: how far the finer model has to
 * go by itself, as a share of what it has moved. After multigrid_start. -1 with e filled. */
int multigrid_correct(multigrid *g, const double *residual, double remaining, double *correction, err *e);

/* From here on they run in double, where the run goes on in it. */
void multigrid_refine(multigrid *g);

/* Whether these displacements (m, nodes x 3) of the finer model leave its elements upright. */
bool multigrid_is_upright(const multigrid *g, const double *displacement);

multigrid_told multigrid_tell(const multigrid *g);

/* p begins at rest at time 0 again. */
void multigrid_forget(tled_problem *p);

#endif
