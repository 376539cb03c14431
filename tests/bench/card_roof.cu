extern "C" {
#include "tests/bench/card_roof.h"

#include "base/mem.h"
#include "solve/card.h"
}

#include <cuda_runtime.h>
#include <stdlib.h>

enum {
    BLOCKS = 8, /* for each multiprocessor */
    THREADS = 256,
    CHAINS = 8,
    LENGTH = 4096,    /* multiply-adds in a chain */
    COPIES = 4,       /* in memory */
    CACHE_PART = 4,   /* of the L2 cache that both buffers together take, one in so many */
    CACHE_COPIES = 60 /* within it, in one launch */
};

static const size_t memory_bytes = (size_t)1 << 30;

struct card_roof {
    char *from, *to;
    cudaEvent_t start, end;
    int blocks;
    int64_t cache, cached; /* bytes: the L2 cache; of each of its two buffers */
};

/* Each thread its own part, again and again, past the L1 cache. */
static __global__ void copy_kernel(const float4 *from, float4 *to, int64_t count)
{
    for (int k = 0; k < CACHE_COPIES; k++)
        for (int64_t i = blockIdx.x * (int64_t)blockDim.x + threadIdx.x; i < count;
             i += (int64_t)gridDim.x * blockDim.x)
            __stcg(to + i, __ldcg(from + i));
}

static __device__ float fused(float x, float a, float b)
{
    return __fmaf_rn(x, a, b);
}

static __device__ double fused(double x, double a, double b)
{
    return __fma_rn(x, a, b);
}

/* Chains side by side of x = a x + b. */
template <class S, bool FUSED> static __global__ void chains_kernel(S *result, S a, S b)
{
    S x[CHAINS], sum = 0;
#pragma unroll
    for (int i = 0; i < CHAINS; i++)
        x[i] = (S)(threadIdx.x + i);
#pragma unroll 16
    for (int n = 0; n < LENGTH; n++)
#pragma unroll
        for (int i = 0; i < CHAINS; i++)
            x[i] = FUSED ? fused(x[i], a, b) : x[i] * a + b;
#pragma unroll
    for (int i = 0; i < CHAINS; i++)
        sum += x[i];
    result[blockIdx.x * (int64_t)blockDim.x + threadIdx.x] = sum;
}

#define ROOF_TRY(call) card_check(call, #call, -1, e)

/* Starts `work`, twice, and gets the seconds that the second took. */
template <class F> static int timed(card_roof *r, double *seconds, err *e, F work)
{
    float ms = 0;
    work();
    if (ROOF_TRY(cudaEventRecord(r->start)))
        return -1;
    work();
    if (ROOF_TRY(cudaGetLastError()) || ROOF_TRY(cudaEventRecord(r->end)) || ROOF_TRY(cudaEventSynchronize(r->end)) ||
        ROOF_TRY(cudaEventElapsedTime(&ms, r->start, r->end)))
        return -1;
    *seconds = 1e-3 * (double)ms;
    return 0;
}

template <class S> static int take_flops(card_roof *r, card_rates *rates, err *e)
{
    const double flops = 2. * CHAINS * LENGTH * THREADS * r->blocks;
    double apart, together;
    if (timed(r, &apart, e, [&] { chains_kernel<S, false><<<r->blocks, THREADS>>>((S *)r->to, (S).999, (S).5); }) ||
        timed(r, &together, e, [&] { chains_kernel<S, true><<<r->blocks, THREADS>>>((S *)r->to, (S).999, (S).5); }))
        return -1;
    rates->flops = flops / apart;
    rates->fused = flops / together;
    return 0;
}

int card_roof_take(card_roof *r, bool single, card_rates *rates, err *e)
{
    double memory, cache;
    if (timed(r, &memory, e,
              [&] {
                  for (int i = 0; i < COPIES; i++)
                      cudaMemcpyAsync(r->to, r->from, memory_bytes, cudaMemcpyDeviceToDevice);
              }) ||
        timed(r, &cache, e,
              [&] { copy_kernel<<<r->blocks, THREADS>>>((float4 *)r->from, (float4 *)r->to, r->cached / 16); }))
        return -1;
    rates->memory = 2. * COPIES * (double)memory_bytes / memory;
    rates->cache = 2. * CACHE_COPIES * (double)r->cached / cache;
    return single ? take_flops<float>(r, rates, e) : take_flops<double>(r, rates, e);
}

int64_t card_roof_cache(const card_roof *r)
{
    return r->cache;
}

static int look_at_card(card_roof *r, err *e)
{
    int device = 0, cache = 0, processors = 0;
    if (ROOF_TRY(cudaGetDevice(&device)) || ROOF_TRY(cudaDeviceGetAttribute(&cache, cudaDevAttrL2CacheSize, device)) ||
        ROOF_TRY(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device)) ||
        ROOF_TRY(cudaEventCreate(&r->start)) || ROOF_TRY(cudaEventCreate(&r->end)))
        return -1;
    r->blocks = BLOCKS * processors;
    r->cache = cache;
    r->cached = cache / CACHE_PART / 2 / 16 * 16;
    return 0;
}

card_roof *card_roof_create(err *e)
{
    card_roof *r = (card_roof *)mem_array(1, sizeof *r, "a probe", e);
    if (!r)
        return NULL;
    if (!look_at_card(r, e)) {
        r->from = (char *)card_take((int64_t)memory_bytes, "a probe", e);
        r->to = r->from ? (char *)card_take((int64_t)memory_bytes, "a probe", e) : NULL;
    }
    if (r->to && !ROOF_TRY(cudaMemset(r->from, 1, memory_bytes)))
        return r;
    card_roof_destroy(r);
    return NULL;
}

void card_roof_destroy(card_roof *r)
{
    if (!r)
        return;
    card_give(r->from);
    card_give(r->to);
    if (r->start)
        cudaEventDestroy(r->start);
    if (r->end)
        cudaEventDestroy(r->end);
    free(r);
}
