/* What a kernel needs that runs a whole frame in one launch: a barrier for all its blocks, which are all on the card at
 * once (a cooperative launch), and sums in one fixed order, those of the CPU's loops (lanes.h, sums.h) where it has
 * them. Everything here is static and owns nothing.
 */
#ifndef SINEW_CUDA_GRID_CUH
#define SINEW_CUDA_GRID_CUH

#include <cuda_runtime.h>
#include <stdint.h>

extern "C" {
#include "msds/cpu/sums.h"
#include "msds/problem/sell.h"
}

/* A block takes a chunk of nodes at a time, the one that a thread of the CPU takes: a thread a node. */
enum { GRID_THREADS = SELL_CHUNK * LANES, GRID_WARPS = GRID_THREADS / 32 };
static_assert((int)GRID_THREADS == (int)SUMS_WIDE, "a block sums as wide as sums.h does");

typedef struct grid_scratch {
    double row[GRID_THREADS];
    double warp[GRID_WARPS];
} grid_scratch;

/* Waits for all blocks: what they wrote before is there for all after. `arrived` counts on from
 * launch to launch, all of so many blocks. */
static __device__ inline void grid_barrier(unsigned long long *arrived)
{
    __syncthreads();
    if (threadIdx.x == 0) {
        unsigned long long now;
        __threadfence();
        const unsigned long long ticket = atomicAdd(arrived, 1ull), goal = (ticket / gridDim.x + 1) * gridDim.x;
        do
            asm volatile("ld.acquire.gpu.global.u64 %0, [%1];" : "=l"(now) : "l"(arrived) : "memory");
        while (now < goal);
        __threadfence();
    }
    __syncthreads();
}

static __device__ inline double grid_pairs(double x, int lanes)
{
    for (int width = 1; width < lanes; width *= 2)
        x += __shfl_xor_sync(~0u, x, width);
    return x;
}

/* The sum over a block's threads, for all of them: pairs of neighbours, then pairs of those. */
static __device__ inline double grid_block_sum(double x, grid_scratch *s)
{
    x = grid_pairs(x, 32);
    if (threadIdx.x % 32 == 0)
        s->warp[threadIdx.x / 32] = x;
    __syncthreads();
    x = (s->warp[0] + s->warp[1]) + (s->warp[2] + s->warp[3]);
    __syncthreads();
    return x;
}
static_assert(GRID_WARPS == 4, "grid_block_sum and grid_block_most write out four warps");

static __device__ inline double grid_block_most(double x, grid_scratch *s)
{
    for (int width = 1; width < 32; width *= 2)
        x = fmax(x, __shfl_xor_sync(~0u, x, width));
    if (threadIdx.x % 32 == 0)
        s->warp[threadIdx.x / 32] = x;
    __syncthreads();
    x = fmax(fmax(s->warp[0], s->warp[1]), fmax(s->warp[2], s->warp[3]));
    __syncthreads();
    return x;
}

/* As the CPU's loops sum a chunk: each of eight lanes over the slices, then pairs. Thread 0 writes it. */
static __device__ inline void grid_lanes_sum(float x, double *to, grid_scratch *s)
{
    s->row[threadIdx.x] = (double)x;
    __syncthreads();
    if (threadIdx.x < 32) {
        double sum = 0;
        for (int slice = 0; slice < SELL_CHUNK && threadIdx.x < LANES; slice++)
            sum += s->row[slice * LANES + threadIdx.x];
        sum = grid_pairs(sum, LANES);
        if (threadIdx.x == 0)
            *to = sum;
    }
    __syncthreads();
}

/* sums_of, for all threads of every block. */
static __device__ inline double grid_total(const double *part, int32_t count, grid_scratch *s)
{
    double sum = 0;
    for (int32_t i = threadIdx.x; i < count; i += GRID_THREADS)
        sum += part[i];
    return grid_block_sum(sum, s);
}

static __device__ inline double grid_most(const double *part, int32_t count, grid_scratch *s)
{
    double most = 0;
    for (int32_t i = threadIdx.x; i < count; i += GRID_THREADS)
        most = fmax(most, part[i]);
    return grid_block_most(most, s);
}

#endif
