/* Where things stand in the shared memory of a march's block, in bytes from its start, and each thread's place in grids
 * of nodes. Layers of displacements and of velocities take turns in as many places as there are layers on their way or
 * in use: displacements of layers c - 1 to c + 6 while a thread is at layer c of cells, velocities of c - 1 to c + 2.
 * Included by cuda_march.cu alone.
 */
#ifndef SINEW_CUDA_MARCH_ROOM_CUH
#define SINEW_CUDA_MARCH_ROOM_CUH

#include "tled/cuda/cuda_march.cuh"

enum {
    SIDE = MARCH_SIDE,
    GRID = SIDE + 1,          /* nodes along a side */
    NODE = 16,                /* bytes of 4 floats, of a node's displacement, velocity or force */
    STAGES = MARCH_AHEAD + 1, /* layers of displacements in shared memory */
    SPEEDS = 4,               /* layers of velocities: that of layer c - 1 of nodes stands in place c % SPEEDS */
    STAGE = GRID * GRID * NODE,
    VELOCITIES = STAGES * STAGE, /* from here on grids have a row fewer */
    FORCE = GRID * SIDE * NODE,
    FORCES = VELOCITIES + SPEEDS * FORCE, /* two times four of them: on corners (1, 0), (0, 1), (1, 1), (0, 0) */
    FORCES_EACH = 4 * FORCE,
    GRAVITY = FORCES + 2 * FORCES_EACH, /* its part of a velocity */
    SAID = GRAVITY + NODE,              /* the barrier */
    NEXT = SAID + 16,                   /* the unit that the block takes next, and in which pass: */
    TURN = NEXT + 16,
    RECORDS = TURN + 16, /* three layers of halves of special cells, one half after the other, for each thread */
    RECORD = MARCH_THREADS * NODE,
    SHARED = RECORDS + 3 * 2 * RECORD,
    WARPS = MARCH_THREADS / 32,
    EXTRA = 2 * SIDE + 1 /* words of places beyond the threads' */
};

/* A thread's place in the grid of a layer's nodes. */
static __device__ __forceinline__ int place_of(int thread)
{
    const int warp = thread / 32, lane = thread % 32;
    const int half = warp / 4, row = (warp + 2 * half) % 4; /* march.c's warp_of */
    return (row * 4 + lane / 8) * GRID + half * 8 + lane % 8;
}

/* The first threads have a place beyond the threads' as well. */
static __device__ __forceinline__ bool has_extra(void)
{
    return threadIdx.x < EXTRA;
}

/* at: the thread's own place. */
static __device__ __forceinline__ uint32_t extra_at(uint32_t at)
{
    const int t = (int)threadIdx.x, own = place_of(t), extra = t < GRID ? t * GRID + SIDE : SIDE * GRID + t - GRID;
    return at + (uint32_t)((extra - own) * NODE);
}

#endif
