/* The CUDA back end of msds-run, in single precision but for exact frames. A state belongs to who created it; what a
 * method needs is made when it is first asked for. Only where CUDA is built in.
 */
#ifndef SINEW_MSDS_CUDA_H
#define SINEW_MSDS_CUDA_H

#include "solve/backend.h"

extern const backend msds_cuda;

#endif
