/* The CUDA executor of msds-run, in single precision but for exact frames. A state belongs to who created it; what a
 * method needs is made when it is first asked for. Only where CUDA is built in.
 */
#ifndef SINEW_MSDS_CUDA_H
#define SINEW_MSDS_CUDA_H

#include "msds/problem/msds_executor.h"

extern const msds_executor msds_cuda;

/* Its skins, in double. */
extern const skin_device msds_cuda_skin;

#endif
