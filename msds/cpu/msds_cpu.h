/* The CPU executor of msds-run: complete in itself; a state belongs to who created it. What a method needs is made
 * when it is first asked for.
 */
#ifndef SINEW_MSDS_CPU_H
#define SINEW_MSDS_CPU_H

#include "msds/problem/msds_executor.h"

extern const msds_executor msds_cpu;

/* What a state consists of, for who derives from it: the state's own, until its next step; none of it is to be changed,
 * but what the solvers work with. */
typedef struct msds_parts {
    const msds_problem *p;
    struct pool *threads;
    const struct lanes *loops;
    const struct sell *order;
    const struct lanes_springs *springs; /* with the displacement, u, whatever the method */
    const double *place;                 /* the model's nodes x 3, m: the displacement to more digits; or NULL */
    const struct contacts *contacts;     /* with their forces */
    const struct probe_placed *probe;    /* NULL: nothing presses */
    msds_method method;                  /* of the last step */
    struct cg *cg;                       /* of the last step's linear or warped elements; NULL: another method */
    struct tissue *tissue;               /* NULL: another method */
} msds_parts;

/* What msds-run's benchmark times apart: finding the nodes that the plan's probe presses, for each method's rule. */
void msds_cpu_touch(msds_state *state, const msds_plan *plan);

#endif
