/* The CPU executor of msds-run: complete in itself; a state belongs to who created it. What a method needs is made
 * when it is first asked for.
 */
#ifndef SINEW_MSDS_CPU_H
#define SINEW_MSDS_CPU_H

#include "msds/problem/msds_executor.h"

extern const msds_executor msds_cpu;

/* What msds-run's benchmark times apart: finding the nodes that the plan's probe presses, for each method's rule. */
void msds_cpu_touch(msds_state *state, const msds_plan *plan);

#endif
