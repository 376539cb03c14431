/* The tables of back ends that this build has, the preferred first. */
#include "tled/cpu/cpu.h"
#include "tled/problem/state.h"

#ifdef SINEW_CUDA
#include "tled/cuda/cuda.h"
#endif

const backend *const tled_backends_double[] = {
#ifdef SINEW_CUDA
    &tled_cuda_double,
#endif
    &tled_cpu_double,
    NULL,
};

const backend *const tled_backends_single[] = {
#ifdef SINEW_CUDA
    &tled_cuda_single,
#endif
    &tled_cpu_single,
    NULL,
};
