/* The CUDA executor in double. */
#define CUDA_EXECUTOR tled_cuda_double
#include "tled/cuda/cuda_loops.cuh"
