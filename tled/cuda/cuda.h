/* The CUDA back end of tled-run, in its two precisions. A state belongs to who created it. Only where CUDA is built in.
 */
#ifndef SINEW_CUDA_H
#define SINEW_CUDA_H

#include "solve/backend.h"

extern const backend tled_cuda_double, tled_cuda_single;

#endif
