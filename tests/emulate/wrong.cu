/* See wrong.h. Blocks of 64 threads, with 64 numbers on the card and as many in shared memory; the right ones stand
 * beside those that are wrong. */
#include "tests/emulate/wrong.h"

#include "solve/start.cuh"
#include "tled/cuda/cuda_ptx.cuh"

#include <stdlib.h>

enum { THREADS = 64 };

struct task {
    float4 *data; /* THREADS, with their numbers; and as many that nobody wrote */
    uint64_t *word;
};

/* ---- shared memory */

template <bool RIGHT> static __global__ void neighbours(task)
{
    DYNAMIC_SHARED(float, x);
    x[threadIdx.x] = 1;
    if (RIGHT)
        __syncthreads();
    x[threadIdx.x] += RIGHT ? 1 : x[(threadIdx.x + 1) % THREADS];
}

template <bool RIGHT> static __global__ void later(task)
{
    DYNAMIC_SHARED(float, x);
    x[threadIdx.x] = 1;
    __syncthreads();
    const float next = x[(threadIdx.x + 1) % THREADS];
    if (RIGHT)
        __syncthreads();
    x[threadIdx.x] = next;
}

/* A warp's meeting orders its threads, and no others. */
template <bool RIGHT> static __global__ void warps(task)
{
    __shared__ float x[THREADS];
    x[threadIdx.x] = 1;
    __syncwarp();
    x[threadIdx.x] = x[RIGHT ? threadIdx.x : THREADS - 1 - threadIdx.x];
}

/* A vote orders nothing. */
static __global__ void vote(task)
{
    __shared__ float x[THREADS];
    x[threadIdx.x] = 1;
    if (__any_sync(~0u, 1))
        x[threadIdx.x] = x[threadIdx.x ^ 1];
}

/* Not even where all have read, by the clock on the wall, before any writes. */
static __global__ void vote_late(task)
{
    __shared__ float x[THREADS];
    x[threadIdx.x] = 1;
    __syncwarp();
    const float next = x[threadIdx.x ^ 1];
    if (__any_sync(~0u, 1))
        x[threadIdx.x] = next;
}

static __global__ void vote_of_some(task)
{
    __any_sync(1, 1);
}

/* What a warp's threads tell each other arrives, and orders nothing either. */
template <bool RIGHT> static __global__ void told(task t)
{
    __shared__ float x[THREADS];
    const int i = (int)threadIdx.x;
    const bool arrived = __shfl_xor_sync(~0u, i, 5) == (i ^ 5) && __shfl_xor_sync(~0u, i + .5, 16) == (i ^ 16) + .5 &&
                         __ballot_sync(~0u, i & 2) == 0xcccccccc;
    x[i] = arrived ? 1 : t.data[THREADS].x;
    x[i] = x[i ^ (__shfl_xor_sync(~0u, 1, 1) - RIGHT)];
}

static __global__ void nobody(task)
{
    DYNAMIC_SHARED(float, x);
    if (threadIdx.x == 5)
        x[0] = x[1];
}

template <int AT> static __global__ void place(task)
{
    DYNAMIC_SHARED(float4, x);
    if (threadIdx.x == 0)
        shared_store(shared_at(x) + AT, 1, 2, 3);
}

static __global__ void beyond(task t)
{
    if (threadIdx.x == 0)
        t.data[2 * THREADS].x = 1;
}

template <bool RIGHT> static __global__ void least(task)
{
    __shared__ int x;
    if (threadIdx.x == 0)
        x = THREADS;
    __syncthreads();
    if (RIGHT)
        atomicMin(&x, (int)threadIdx.x);
    else if (x > (int)threadIdx.x)
        x = (int)threadIdx.x;
}

/* ---- blocks */

template <bool RIGHT> static __global__ void blocks(task t)
{
    if (threadIdx.x == 0)
        t.data[RIGHT ? blockIdx.x : 0].x = 1;
}

/* Whichever comes first, the other finds something. */
template <bool FIRST> static __global__ void another(task t)
{
    float4 *own = t.data + blockIdx.x, *other = t.data + 1 - blockIdx.x;
    if (threadIdx.x)
        return;
    if (FIRST)
        own->x = 1;
    own->x = other->x;
}

static __global__ void uninitialised(task t)
{
    t.data[THREADS + threadIdx.x].x += 1;
}

/* Each waits for the other's word. */
template <bool RIGHT> static __global__ void words(task t)
{
    if (threadIdx.x)
        return;
    if (RIGHT || blockIdx.x)
        relaxed_store(t.word + blockIdx.x, 1);
    while (!relaxed_load(t.word + (1 - blockIdx.x)))
        ;
}

/* Each number once, whoever takes it. */
template <bool RIGHT> static __global__ void tickets(task t)
{
    uint32_t *next = (uint32_t *)t.word;
    if (threadIdx.x == 0)
        t.data[RIGHT ? take_ticket(next) : (*next)++].x = 1;
}

/* Block after block; the third relies on the first by way of the second. */
template <bool BEFORE, bool MEET> static __global__ void done(task t)
{
    uint32_t *word = (uint32_t *)t.word + blockIdx.x;
    while (threadIdx.x == 0 && blockIdx.x && !hear_done(word - 1))
        ;
    if (MEET)
        __syncthreads();
    if (!BEFORE && threadIdx.x == 0)
        tell_done(word, 1);
    if (threadIdx.x == 1)
        t.data[0].x += 1;
    __syncthreads();
    if (BEFORE && threadIdx.x == 0)
        tell_done(word, 1);
}

/* Words are for those who know that they are. */
static __global__ void overhears(task t)
{
    if (threadIdx.x == 0 && blockIdx.x)
        relaxed_store(t.word, 1);
    else if (threadIdx.x == 0)
        t.data[0].x = t.word[0];
}

static __global__ void hears(task t)
{
    relaxed_load((const uint64_t *)(t.data + THREADS));
}

/* ---- copies */

template <int BUT_FOR, bool MEET> static __global__ void copies(task t)
{
    DYNAMIC_SHARED(float4, x);
    const unsigned at = shared_at(x + threadIdx.x / 2), i = threadIdx.x;
    if (i % 2) {
        send(at, t.data + i, true);
        sent();
        sent();
    }
    arrived<BUT_FOR>();
    if (MEET)
        __syncthreads();
    else
        __syncwarp();
    if (shared_load(shared_at(x + (MEET ? THREADS / 2 - 1 - i / 2 : i / 2))).x < 0)
        t.data[i].x = 0;
    arrived<0>();
}

/* BYTE: where what it copies begins; NOTHING: zeros instead. */
template <int BYTE, bool NOTHING> static __global__ void copies_from(task t)
{
    DYNAMIC_SHARED(float4, x);
    const unsigned at = shared_at(x + threadIdx.x);
    send(at, (const float4 *)((const char *)t.data + BYTE), !NOTHING);
    sent();
    arrived<0>();
    shared_load(at);
}

static __global__ void copies_shared(task)
{
    DYNAMIC_SHARED(float4, x);
    send(shared_at(x + threadIdx.x), x, true);
}

/* Of what changes on the way. */
template <bool READ> static __global__ void copies_change(task t)
{
    DYNAMIC_SHARED(float4, x);
    const unsigned at = shared_at(x + threadIdx.x);
    send(at, t.data + threadIdx.x, true);
    sent();
    t.data[threadIdx.x].x += 1;
    arrived<0>();
    if (READ)
        shared_load(at);
}

static __global__ void left(task t)
{
    DYNAMIC_SHARED(float4, x);
    send(shared_at(x) + 16 * threadIdx.x, t.data, true);
    sent();
    arrived<1>();
}

static __global__ void open_group(task t)
{
    DYNAMIC_SHARED(float4, x);
    send(shared_at(x) + 16 * threadIdx.x, t.data, true);
    arrived<0>();
}

/* ---- barriers */

template <bool MADE, int COUNT, bool WAITED> static __global__ void barriers(task)
{
    __shared__ uint64_t said;
    __shared__ float x;
    if (MADE && threadIdx.x == 0)
        barrier_make(shared_at(&said), COUNT);
    else if (threadIdx.x == 0)
        said = 0;
    __syncthreads();
    if (threadIdx.x == 0)
        x = 1;
    if (threadIdx.x % 32 == 0)
        barrier_arrive(shared_at(&said));
    if (WAITED)
        barrier_wait(shared_at(&said), 0);
    if (threadIdx.x == 40)
        x += 1;
}

static __global__ void made_again(task)
{
    __shared__ uint64_t said;
    if (threadIdx.x == 0)
        barrier_make(shared_at(&said), 2);
    if (threadIdx.x == 0)
        barrier_make(shared_at(&said), 2);
}

static __global__ void unequal(task)
{
    if (threadIdx.x < 60)
        __syncthreads();
}

/* ---- the list */

/* A launch of `count` blocks; shared: bytes. */
static int run(void (*kernel)(task), int64_t count = 1, bool together = false, size_t shared = THREADS * sizeof(float4))
{
    const float4 number[THREADS] = {};
    task t = {};
    int e = cudaMalloc((void **)&t.data, 2 * sizeof number);
    e = e ? e : cudaMalloc((void **)&t.word, 2 * sizeof *t.word);
    e = e ? e : cudaMemcpy(t.data, number, sizeof number, cudaMemcpyHostToDevice);
    e = e ? e : cudaMemset(t.word, 0, 2 * sizeof *t.word);
    e = e ? e : card_start(kernel, {count, THREADS, shared, NULL, together}, t);
    e = e ? e : cudaDeviceSynchronize();
    cudaFree(t.data);
    cudaFree(t.word);
    return e;
}

static const bool alone = false, together = true;

#define KERNEL(says, ...)                                                                                              \
    {                                                                                                                  \
#__VA_ARGS__, says, [] { return run(__VA_ARGS__); }                                                            \
    }
const wrong_kernel wrong_kernels[] = {
    KERNEL(NULL, neighbours<true>),
    KERNEL("reads what ", neighbours<false>),
    KERNEL(NULL, later<true>),
    KERNEL("a race", later<false>),
    KERNEL(NULL, warps<true>),
    KERNEL("reads what ", warps<false>),
    KERNEL("reads what ", vote),
    KERNEL("writes what thread ", vote_late),
    KERNEL("asks some of its warp only", vote_of_some),
    KERNEL(NULL, told<true>),
    KERNEL("a race", told<false>),
    KERNEL("reads what nobody wrote", nobody),
    KERNEL(NULL, place<16>),
    KERNEL("no multiple of 16", place<8>),
    KERNEL("past the block's shared memory", place<16 * THREADS>),
    KERNEL("which is not the card's", beyond),
    KERNEL(NULL, least<true>),
    KERNEL("a race", least<false>),
    KERNEL(NULL, blocks<true>, 3),
    KERNEL("what another block writes", blocks<false>, 3),
    KERNEL("reads what another block writes", another<false>, 2),
    KERNEL("writes what another block reads", another<true>, 2),
    KERNEL("reads what nobody wrote", uninitialised),
    KERNEL(NULL, words<true>, 2, together),
    KERNEL("waits for a word that nobody writes", words<false>, 2, together),
    KERNEL(NULL, tickets<true>, 3),
    KERNEL("what another block ", tickets<false>, 3),
    KERNEL(NULL, done<true, true>, 3, together),
    KERNEL("what another block ", done<true, false>, 3, together),
    KERNEL("what another block ", done<false, true>, 3, together),
    KERNEL("what another block ", overhears, 2),
    KERNEL("hears what nobody wrote", hears),
    KERNEL("the emulated card cannot", words<true>, 65, together),
    KERNEL(NULL, blocks<true>, 1, alone, 48 << 10),
    KERNEL("the emulated card cannot", blocks<true>, 1, alone, 49 << 10),
    KERNEL(NULL, copies<0, true>),
    KERNEL(NULL, copies<1, true>),
    KERNEL(NULL, copies<1, false>),
    KERNEL("reads what is on its way", copies<2, true>),
    KERNEL(NULL, copies_from<0, false>),
    KERNEL(NULL, copies_from<THREADS * 16, true>),
    KERNEL("reads a copy of what nobody wrote", copies_from<THREADS * 16, false>),
    KERNEL("no multiple of 16", copies_from<8, false>),
    KERNEL("which is not the card's", copies_from<2 * THREADS * 16, false>),
    KERNEL("which is not the card's", copies_shared),
    KERNEL(NULL, copies_change<false>),
    KERNEL("reads a copy of what has changed", copies_change<true>),
    KERNEL("ends with copies on their way", left),
    KERNEL("ends with copies on their way", open_group),
    KERNEL(NULL, barriers<true, 2, true>),
    KERNEL("reads what ", barriers<true, 2, false>),
    KERNEL("waits for ever", barriers<true, 3, true>),
    KERNEL("uses a barrier that nobody made", barriers<false, 2, true>),
    KERNEL("makes a barrier again", made_again),
    KERNEL("waits for ever", unequal),
    {},
};

const char *wrong_text(int error)
{
    return cudaGetErrorString((cudaError_t)error);
}
