/* Where the steps of a run lie in time. Steps are counted, and times are counts over a rate, so that a run that goes on
 * from another's end takes the same steps as one that never stopped. Owns nothing.
 */
#ifndef SINEW_TIMELINE_H
#define SINEW_TIMELINE_H

#include "tled/problem/state.h"

/* The least step count whose time is at or past t (s), to a millionth of a step, seen from the plan's
 * origin. rate: steps a second, as below. */
int64_t timeline_steps_to(double t, double rate);

/* Whether t lies between two steps, by more than that. */
bool timeline_is_between(double t, double rate);

/* Where the run that begins at `start` (s) counts from: an origin of 0 where its start is a whole number of steps, so
 * that it goes on as if it had never stopped. */
tled_plan timeline_plan(double start, double rate);

/* The first step past step `after` that is at or past a multiple of `every` (s); 0: there is none, INT64_MAX. */
int64_t timeline_next(const tled_plan *plan, double every, int64_t after);

#endif
