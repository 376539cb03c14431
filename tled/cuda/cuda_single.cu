/* The CUDA executor in float: half the memory, twice the speed or more. */
#define CUDA_EXECUTOR tled_cuda_single
#define ELEMENT_SINGLE
#include "tled/cuda/cuda_loops.cuh"
