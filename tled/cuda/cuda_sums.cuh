/* Which cells a tile owns; the least over warps and blocks, and a look's answers put together: in one order, whichever
 * ends first. Included by cuda_look.cu alone.
 */
#ifndef SINEW_CUDA_SUMS_CUH
#define SINEW_CUDA_SUMS_CUH

#include <cuda_runtime.h>
#include <math.h>
#include <stdint.h>

extern "C" {
#include "tled/problem/tled_executor.h"
#include "tled/tiles/tiles.h"
}

#include "tled/cuda/cuda_warp.cuh"

enum { NONE = INT32_MAX }; /* of cells; the least of some is told */

/* Over a warp; all its threads get it. */
static __device__ int warp_least(int x)
{
    for (int with = 16; with; with /= 2) {
        const int other = __shfl_xor_sync(~0u, x, with);
        x = other < x ? other : x;
    }
    return x;
}

/* The least of what threads say, or NONE. */
static __device__ int block_least(int mine, int *shared)
{
    __syncthreads();
    if (threadIdx.x == 0)
        *shared = NONE;
    __syncthreads();
    if (mine != NONE)
        atomicMin(shared, mine);
    __syncthreads();
    return *shared;
}

static __device__ tled_sums nothing_seen(double rest)
{
    tled_sums s = {};
    s.frequency = rest;
    s.frequency_element = s.broken = -1;
    return s;
}

/* -1 is past all others. */
static __device__ bool before(int64_t a, int64_t b)
{
    return (uint64_t)a < (uint64_t)b;
}

static __device__ void add_part(tled_sums *to, const tled_sums &part)
{
    to->kinetic += part.kinetic;
    to->strain += part.strain;
    to->acceleration += part.acceleration;
    to->speed += part.speed;
    to->moved += part.moved;
    to->mass += part.mass;
    to->stiffness += part.stiffness;
    to->inertia += part.inertia;
    to->largest = fmax(to->largest, part.largest);
    if (part.frequency > to->frequency ||
        (part.frequency == to->frequency && before(part.frequency_element, to->frequency_element))) {
        to->frequency = part.frequency;
        to->frequency_element = part.frequency_element;
    }
    to->broken = before(part.broken, to->broken) ? part.broken : to->broken;
}

/* A warp's sums over nodes; all its threads get them. */
static __device__ void sum_nodes(tled_sums *s, bool differences)
{
    s->kinetic = warp_sum(s->kinetic);
    s->acceleration = warp_sum(s->acceleration);
    s->speed = warp_sum(s->speed);
    s->moved = warp_sum(s->moved);
    s->mass = warp_sum(s->mass);
    s->largest = warp_most(s->largest);
    if (differences) {
        s->stiffness = warp_sum(s->stiffness);
        s->inertia = warp_sum(s->inertia);
    }
}

/* And over cells. */
static __device__ void sum_cells(tled_sums *s)
{
    const double highest = warp_most(s->frequency);
    const bool mine = s->frequency == highest && s->frequency_element >= 0;
    const int cell = warp_least(mine ? (int)s->frequency_element : NONE);
    const int broken = warp_least(s->broken >= 0 ? (int)s->broken : NONE);
    s->strain = warp_sum(s->strain);
    s->frequency = highest;
    s->frequency_element = cell == NONE ? -1 : cell;
    s->broken = broken == NONE ? -1 : broken;
}

/* Adds up what a block's threads have, in `to`. scratch: one a warp. */
template <int THREADS>
static __device__ void sum_block(tled_sums mine, bool differences, tled_sums *scratch, tled_sums *to)
{
    sum_nodes(&mine, differences);
    sum_cells(&mine);
    if (threadIdx.x % 32 == 0)
        scratch[threadIdx.x / 32] = mine;
    __syncthreads();
    if (threadIdx.x)
        return;
    for (int i = 1; i < THREADS / 32; i++)
        add_part(&mine, scratch[i]);
    *to = mine;
}

/* The cells that a tile owns: of each cell and each of its nodes, one. */
template <class G> struct own_cells {
    enum { WARPS = G::THREADS / 32, ROUNDS = ((G::BX + 1) * (G::BY + 1) * (G::BZ + 1) + G::THREADS - 1) / G::THREADS };
    int32_t cell[G::NODES];
    int32_t count[ROUNDS * WARPS]; /* in each 32 cells */
};

/* Who of the threads beside this one has one of the tile's own, in each round; their counts go to *to. */
template <class G>
static __device__ void count_own(const uint32_t *cell, const tile &t, unsigned *who, own_cells<G> *to)
{
    constexpr int ROUNDS = own_cells<G>::ROUNDS, WARPS = own_cells<G>::WARPS;
    uint32_t mine[ROUNDS];
#pragma unroll
    for (int k = 0; k < ROUNDS; k++) {
        const int i = k * G::THREADS + (int)threadIdx.x;
        mine[k] = i < t.cells ? cell[t.cell + i] : 0;
    }
#pragma unroll
    for (int k = 0; k < ROUNDS; k++) {
        who[k] = __ballot_sync(~0u, mine[k] >> TILE_OWN & 1);
        if (threadIdx.x % 32 == 0)
            to->count[k * WARPS + threadIdx.x / 32] = __popc(who[k]);
    }
}

/* Lists them, in their order, when the counts are there. Returns how many there are. */
template <class G> static __device__ int list_own(const unsigned *who, own_cells<G> *to)
{
    constexpr int ROUNDS = own_cells<G>::ROUNDS, WARPS = own_cells<G>::WARPS;
    const unsigned warp = threadIdx.x / 32, lane = threadIdx.x % 32;
    int count = 0;
#pragma unroll
    for (int k = 0; k < ROUNDS; k++)
        for (unsigned w = 0; w < WARPS; w++) {
            if (w == warp && who[k] >> lane & 1)
                to->cell[count + __popc(who[k] & ((1u << lane) - 1))] = (int)(k * G::THREADS + threadIdx.x);
            count += to->count[k * WARPS + w];
        }
    return count;
}

#endif
