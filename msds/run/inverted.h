/* How many tetrahedra are inverted, frame by frame, whatever method moved them: volumes of 0 or less. The creator owns
 * it, zeroed but for the problem and the threads, which it borrows.
 */
#ifndef SINEW_INVERTED_H
#define SINEW_INVERTED_H

#include "base/pool.h"
#include "msds/problem/problem.h"

typedef struct inverted {
    const msds_problem *p;
    pool *threads;
    const double *u;  /* the frame's */
    double *place;    /* nodes x 3, m; owned, as sum; NULL, as it is: nothing was counted here */
    int64_t *sum;     /* chunks */
    int64_t now;      /* in the last frame */
    int64_t most;     /* in any, */
    double most_time; /* s: then */
    int64_t frames;   /* that had any */
} inverted;

void inverted_free(inverted *v);

/* Counts a frame; u: displacements, nodes x 3, m. -1 with e filled. */
int inverted_count(inverted *v, const double *u, double time, err *e);

/* Adds a frame of which the device has counted them. */
void inverted_add(inverted *v, int64_t count, double time);

/* What a run is warned of in the end: nothing where none was inverted. frames: in all. */
void inverted_warn(const inverted *v, int64_t frames, const char *method, notes *warnings);

#endif
