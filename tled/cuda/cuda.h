/* The CUDA executors of tled-run, in its two precisions. A state belongs to who created it. Only where CUDA is built
 * in.
 */
#ifndef SINEW_CUDA_H
#define SINEW_CUDA_H

#include "tled/problem/tled_executor.h"

extern const tled_executor tled_cuda_double, tled_cuda_single;

#endif
