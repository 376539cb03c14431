/* The table of back ends that this build has, the preferred first. */
#include "msds/msds_cpu.h"
#include "msds/problem.h"

#ifdef SINEW_CUDA
#include "msds/msds_cuda.h"
#endif

const backend *const msds_backends[] = {
#ifdef SINEW_CUDA
    &msds_cuda,
#endif
    &msds_cpu,
    NULL,
};
