/* msds-run's frames (msds/cuda/cuda_frames.cuh) on an emulated card, by themselves: a state that the host makes is put
 * there, and sent as those of the solver are. */
#ifndef SINEW_EMULATE_FRAMES_H
#define SINEW_EMULATE_FRAMES_H

#include "msds/problem/msds_executor.h"
#include "msds/problem/sell.h"

typedef struct emulated_frames emulated_frames;

/* position: in the order of the slices, x 3. The caller owns it. NULL with e filled; the rest: -1. */
emulated_frames *emulated_frames_make(const msds_frames *of, const msds_problem *p, const sell *order,
                                      const double *position, err *e);
void emulated_frames_free(emulated_frames *f);

/* The state as it is from now on, in the order of the slices: x 4, and x 3 for precise, which may be NULL. */
int emulated_frames_put(emulated_frames *f, const float *u, const float *v, const double *precise, err *e);

int emulated_frames_send(emulated_frames *f, int slot, err *e);
int emulated_frames_wait(emulated_frames *f, int slot, msds_values *to, err *e);
int emulated_frames_count(emulated_frames *f, int64_t *count, err *e);

#endif
