/* Where things stand in the shared memory of a march's block, in bytes from its start, and each thread's place in grids
 * of nodes. Layers of displacements and of velocities take turns in as many places as there are layers on their way or
 * in use: displacements of layers c - 1 to c + 6 while a thread is at layer c of cells, velocities of c - 1 to c + 2.
 * Each of these has 16 bytes of a node; in double precision the rest of it stands PLANE bytes after them. Included by
 * cuda_march.cu alone.
 */
#ifndef SINEW_CUDA_MARCH_ROOM_CUH
#define SINEW_CUDA_MARCH_ROOM_CUH

#include "tled/cuda/cuda_march.cuh"

enum {
    SIDE = MARCH_SIDE,
    GRID = SIDE + 1,          /* nodes along a side */
    NODE = 16,                /* bytes of a piece of a node's displacement, velocity or force */
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
    RECORDS = TURN + 16, /* three layers of parts of special cells, one part after the other, for each thread: */
    RECORD = MARCH_THREADS * NODE,
    MUSCLES = MARCH_PIECES * RECORD, /* the law's numbers, then the first muscle */
    RECORDS_EACH = MUSCLES + RECORD,
    PLANE = RECORDS + 3 * RECORDS_EACH,
    SHARED = PLANE + (MARCH_PIECES - 1) * (GRAVITY + NODE),
    WARPS = MARCH_THREADS / 32,
    EXTRA = 2 * SIDE + 1 /* words of places beyond the threads' */
};

/* The four numbers of a node. */
static __device__ __forceinline__ real4 node_load(uint32_t at)
{
#ifdef ELEMENT_SINGLE
    return shared_load(at);
#else
    const double2 first = shared_pair(at), second = shared_pair(at + PLANE);
    return {first.x, first.y, second.x, second.y};
#endif
}

/* Three of them; the fourth is nobody's. */
static __device__ __forceinline__ void node_store(uint32_t at, real x, real y, real z)
{
#ifdef ELEMENT_SINGLE
    shared_store(at, x, y, z);
#else
    shared_pair_store(at, x, y);
    shared_double_store(at + PLANE, z);
#endif
}

/* These three; in double precision the fourth is 0. */
static __device__ __forceinline__ real4 three_load(uint32_t at)
{
#ifdef ELEMENT_SINGLE
    return shared_load(at);
#else
    const double2 first = shared_pair(at);
    return {first.x, first.y, shared_double(at + PLANE), 0};
#endif
}

/* Where number a of a node stands. */
static __device__ __forceinline__ uint32_t number_at(uint32_t node, int a)
{
    return SINGLE ? node + 4 * a : node + (uint32_t)(a / 2 * PLANE + a % 2 * 8);
}

static __device__ __forceinline__ real node_number(uint32_t node, int a)
{
#ifdef ELEMENT_SINGLE
    return shared_number(number_at(node, a));
#else
    return shared_double(number_at(node, a));
#endif
}

static __device__ __forceinline__ void node_number_store(uint32_t node, int a, real x)
{
#ifdef ELEMENT_SINGLE
    shared_number_store(number_at(node, a), x);
#else
    shared_double_store(number_at(node, a), x);
#endif
}

static __device__ __forceinline__ const float4 *node_of(const float4 *p, uint32_t word)
{
    return nth(p, word & MARCH_NODE);
}

/* A node on its way to shared memory; if is: 0, zeros. from: its first piece, as in what follows. */
static __device__ __forceinline__ void send_node(const cuda_march<real> &m, uint32_t to, const float4 *from,
                                                 uint32_t is)
{
    send(to, from, is);
    if constexpr (!SINGLE)
        send(to + PLANE, from + m.v.stride, is);
}

/* Two of them. */
static __device__ __forceinline__ void send_nodes(const cuda_march<real> &m, uint32_t to, const float4 *from,
                                                  uint32_t is, uint32_t other_to, const float4 *other,
                                                  uint32_t is_other)
{
    if constexpr (SINGLE) {
        send_both(to, from, is, other_to, other, is_other);
    } else {
        send_both(to, from, is, to + PLANE, from + m.v.stride, is);
        send_both(other_to, other, is_other, other_to + PLANE, other + m.v.stride, is_other);
    }
}

/* To an array of the state. */
static __device__ __forceinline__ void put_four(const cuda_march<real> &m, const float4 *to, real4 x)
{
#ifdef ELEMENT_SINGLE
    (void)m;
    *(float4 *)to = x;
#else
    *(double2 *)to = make_double2(x.x, x.y);
    *(double2 *)(to + m.v.stride) = make_double2(x.z, x.w);
#endif
}

/* Of a special cell: mu, bulk, second, peak. */
static __device__ __forceinline__ real4 record_law(uint32_t record)
{
#ifdef ELEMENT_SINGLE
    return shared_load(record);
#else
    const double2 first = shared_pair(record), second = shared_pair(record + RECORD);
    return {first.x, first.y, second.x, second.y};
#endif
}

static __device__ __forceinline__ real record_peak(uint32_t record)
{
#ifdef ELEMENT_SINGLE
    return shared_number(record + 12);
#else
    return shared_double(record + RECORD + 8);
#endif
}

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
