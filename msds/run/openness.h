/* How far the cavities of a run are open, frame by frame: their volumes, over those at rest, whatever the mesh within
 * them does. The creator owns it; it borrows the problem.
 */
#ifndef SINEW_OPENNESS_H
#define SINEW_OPENNESS_H

#include "msds/run/cavities.h"

typedef struct openness {
    const msds_problem *p;
    int32_t *element; /* of cavities, in the model's order; owned */
    int64_t elements;
    double at_rest[CAVITIES_MOST];    /* m3 */
    double now[CAVITIES_MOST];        /* of that, in the last frame */
    double least[CAVITIES_MOST];      /* in any, */
    double least_time[CAVITIES_MOST]; /* s: then */
} openness;

/* -1 with e filled, and to be freed all the same. */
int openness_make(openness *o, const msds_problem *p, err *e);
void openness_free(openness *o);

/* Measures a frame; u: displacements, nodes x 3, m. */
void openness_measure(openness *o, const double *u, double time);

#endif
