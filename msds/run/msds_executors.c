/* The table of executors that this build has, the preferred first. */
#include "msds/cpu/msds_cpu.h"
#include "msds/problem/msds_executor.h"

#ifdef SINEW_CUDA
#include "msds/cuda/msds_cuda.h"
#endif

const executor *const msds_executors[] = {
#ifdef SINEW_CUDA
    &msds_cuda.is,
#endif
    &msds_cpu.is,
    NULL,
};
