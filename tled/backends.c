/* The tables of back ends that this build has, the preferred first. */
#include "tled/cpu.h"
#include "tled/state.h"

#ifdef SINEW_CUDA
#include "tled/cuda.h"
#define CUDA_THEN(back_end) &back_end,
#else
#define CUDA_THEN(back_end)
#endif

const backend *const tled_backends_double[] = {CUDA_THEN(tled_cuda_double) & tled_cpu_double, NULL};
const backend *const tled_backends_single[] = {CUDA_THEN(tled_cuda_single) & tled_cpu_single, NULL};
