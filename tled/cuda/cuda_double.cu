/* The CUDA back end in double. */
#define CUDA_BACKEND tled_cuda_double
#include "tled/cuda/cuda_loops.cuh"
