/* Sums and the largest over a warp and a block, in one order. Any kernel may include it.
 */
#ifndef SINEW_CUDA_WARP_CUH
#define SINEW_CUDA_WARP_CUH

#include <cuda_runtime.h>
#include <math.h>

/* Over a warp; all its threads get it. */
static __device__ double warp_sum(double x)
{
    for (int with = 16; with; with /= 2)
        x += __shfl_xor_sync(~0u, x, with);
    return x;
}

static __device__ double warp_most(double x)
{
    for (int with = 16; with; with /= 2)
        x = fmax(x, __shfl_xor_sync(~0u, x, with));
    return x;
}

/* The largest over a block. scratch: a number a warp. */
template <int THREADS> static __device__ double block_most(double x, double *scratch)
{
    x = warp_most(x);
    __syncthreads();
    if (threadIdx.x % 32 == 0)
        scratch[threadIdx.x / 32] = x;
    __syncthreads();
    for (int i = 0; i < THREADS / 32; i++)
        x = fmax(x, scratch[i]);
    return x;
}

#endif
