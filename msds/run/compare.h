/* The other method beside the one that runs: the same poses from the same start, each on its own, and how far apart
 * their fields are. The creator owns it.
 */
#ifndef SINEW_COMPARE_H
#define SINEW_COMPARE_H

#include "msds/problem/msds_executor.h"

typedef struct compare {
    const msds_problem *p;
    msds_state *state;
    double *ours, *other; /* nodes x 3, m */
    msds_reading reading; /* of the other */
    double mean,
        worst; /* of the last frame: root mean square over that of the FEM; the largest over the FEM's largest */
} compare;

/* NULL with e filled. */
compare *compare_make(const msds_problem *p, const msds_executor *device, pool *threads, err *e);
void compare_free(compare *c, const msds_executor *device);

/* Solves the plan's frame by its method, and compares with the state that the other one led to. */
int compare_frame(compare *c, const msds_executor *device, msds_state *state, const msds_plan *plan, int64_t count,
                  err *e);

#endif
