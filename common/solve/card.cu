#include <cuda_runtime.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>

extern "C" {
#include "solve/card.h"
}

enum { LEAST = 75 }; /* compute capability that builds have code for: 10 major + minor */

static char reason[200];
static pthread_once_t looked = PTHREAD_ONCE_INIT;

/* Whether this build has code for the card. */
static cudaError_t look_at_capability(void)
{
    int major = 0, minor = 0;
    cudaError_t code = cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, 0);
    if (code == cudaSuccess)
        code = cudaDeviceGetAttribute(&minor, cudaDevAttrComputeCapabilityMinor, 0);
    if (code == cudaSuccess && 10 * major + minor < LEAST)
        snprintf(reason, sizeof reason, "its compute capability is %d.%d; expected at least %d.%d", major, minor,
                 LEAST / 10, LEAST % 10);
    return code;
}

static void look(void)
{
    int count = 0;
    cudaError_t code = cudaGetDeviceCount(&count);
    if (code == cudaSuccess && count < 1)
        snprintf(reason, sizeof reason, "there is no device");
    else if (code == cudaSuccess)
        code = look_at_capability();
    if (code == cudaSuccess && !*reason)
        code = cudaFree(NULL); /* makes the context, so that a card that cannot be used is known now */
    if (code == cudaErrorInsufficientDriver)
        snprintf(reason, sizeof reason, "there is no driver, or it is older than this build's CUDA %d.%d",
                 CUDART_VERSION / 1000, CUDART_VERSION % 1000 / 10);
    else if (code != cudaSuccess)
        snprintf(reason, sizeof reason, "%s", cudaGetErrorString(code));
    cudaGetLastError(); /* said: not to come out again of a later call */
}

/* Jobs of a batch ask at once. */
const char *card_unusable(void)
{
    pthread_once(&looked, look);
    return *reason ? reason : NULL;
}

int card_check(int code, const char *call, int64_t step, err *e)
{
    if (code == cudaSuccess)
        return 0;
    char at[40] = "";
    if (step >= 0)
        snprintf(at, sizeof at, " at step %lld", (long long)step);
    return err_set(e, NULL, 0, "CUDA: %s failed%s: %s", call, at, cudaGetErrorString((cudaError_t)code));
}

void *card_take(int64_t bytes, const char *what, err *e)
{
    size_t left = 0, all = 0;
    void *memory = NULL;
    cudaError_t code = cudaMemGetInfo(&left, &all);
    if (code == cudaSuccess && (uint64_t)bytes > left)
        code = cudaErrorMemoryAllocation;
    if (code == cudaSuccess)
        code = cudaMalloc(&memory, (size_t)bytes);
    if (code == cudaErrorMemoryAllocation) {
        cudaGetLastError();
        err_set(e, NULL, 0,
                "%s takes %.4g GB of the card's memory, which has %.4g GB free of %.4g; -d cpu needs none of it", what,
                1e-9 * (double)bytes, 1e-9 * (double)left, 1e-9 * (double)all);
        return NULL;
    }
    return card_check(code, "cudaMalloc", -1, e) ? NULL : memory;
}

void card_give(void *memory)
{
    cudaFree(memory);
}
