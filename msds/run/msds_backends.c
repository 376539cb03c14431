/* The table of back ends that this build has, the preferred first. */
#include "msds/cpu/msds_cpu.h"
#include "msds/problem/problem.h"

#ifdef SINEW_CUDA
#include "msds/cuda/msds_cuda.h"
#endif

const backend *const msds_backends[] = {
#ifdef SINEW_CUDA
    &msds_cuda,
#endif
    &msds_cpu,
    NULL,
};
