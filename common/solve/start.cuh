/* How a kernel is started, so that its errors come out of the start itself. */
#ifndef SINEW_START_CUH
#define SINEW_START_CUH

#include <cuda_runtime.h>
#include <stddef.h>
#include <stdint.h>

extern "C" {
#include "solve/card.h"
}

typedef struct card_blocks {
    int64_t count;
    int threads;   /* each */
    size_t shared; /* bytes of a block, beside what the kernel declares */
    cudaStream_t stream;
    bool together; /* all at once, so that they may wait for each other */
} card_blocks;

/* Arguments are of the kernel's types, or become so. */
template <class... P, class... A>
static cudaError_t card_start(void (*kernel)(P...), const card_blocks &blocks, const A &...argument)
{
    cudaLaunchAttribute attribute = {};
    attribute.id = cudaLaunchAttributeCooperative;
    attribute.val.cooperative = 1;
    cudaLaunchConfig_t how = {};
    how.gridDim = dim3((unsigned)blocks.count);
    how.blockDim = dim3((unsigned)blocks.threads);
    how.dynamicSmemBytes = blocks.shared;
    how.stream = blocks.stream;
    how.attrs = &attribute;
    how.numAttrs = blocks.together;
    if (!blocks.together)
        return cudaLaunchKernelEx(&how, kernel, argument...);
    const int before = card_turn_begin(blocks.stream);
    const cudaError_t started = before ? (cudaError_t)before : cudaLaunchKernelEx(&how, kernel, argument...);
    const int after = card_turn_end(blocks.stream);
    return started ? started : (cudaError_t)after;
}

#endif
