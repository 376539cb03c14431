#include <cuda_runtime.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>

extern "C" {
#include "base/mem.h"
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

/* ---- Memory that is kept for who asks next */

enum { KEPT = 256 /* pieces of a kind that are not in use; what is more goes back */ };

typedef struct piece {
    void *at;
    int64_t bytes;
} piece;

typedef struct kept { /* of the card's memory, or of the host's */
    piece *used, free[KEPT];
    int64_t useds, room;
    int frees;
    cudaError_t (*give)(void *);
} kept;

/* One for the process, as its card is. */
static struct {
    pthread_mutex_t lock; /* of what is kept */
    pthread_mutex_t turn; /* of kernels whose blocks wait for each other */
    bool is_on;           /* written with both locks, read with either */
    kept of_card, of_host;
    cudaEvent_t turn_over; /* the last such kernel's; NULL: the card is not shared, or there was none */
} shared = {PTHREAD_MUTEX_INITIALIZER,     PTHREAD_MUTEX_INITIALIZER,         false,
            {NULL, {}, 0, 0, 0, cudaFree}, {NULL, {}, 0, 0, 0, cudaFreeHost}, NULL};

/* A piece of that size, or NULL. */
static void *kept_take(kept *k, int64_t bytes)
{
    void *at = NULL;
    pthread_mutex_lock(&shared.lock);
    for (int i = 0; i < k->frees && !at; i++)
        if (k->free[i].bytes == bytes) {
            at = k->free[i].at;
            k->free[i] = k->free[--k->frees];
        }
    pthread_mutex_unlock(&shared.lock);
    return at;
}

/* What is in use is noted, where the card is shared. -1 with e filled. */
static int kept_note(kept *k, void *at, int64_t bytes, err *e)
{
    pthread_mutex_lock(&shared.lock);
    const int failed = shared.is_on && MEM_ROOM(&k->used, &k->room, k->useds + 1, "the card's memory", e);
    if (shared.is_on && !failed)
        k->used[k->useds++] = {at, bytes};
    pthread_mutex_unlock(&shared.lock);
    return failed ? -1 : 0;
}

static void kept_give(kept *k, void *at)
{
    bool stays = false;
    pthread_mutex_lock(&shared.lock);
    for (int64_t i = 0; i < k->useds; i++)
        if (k->used[i].at == at) {
            stays = k->frees < KEPT;
            if (stays)
                k->free[k->frees++] = k->used[i];
            k->used[i] = k->used[--k->useds];
            break;
        }
    pthread_mutex_unlock(&shared.lock);
    if (!stays)
        k->give(at);
}

/* Gives back to the driver all that is not in use, and tells whether there was any. */
static bool kept_clear(kept *k)
{
    pthread_mutex_lock(&shared.lock);
    const bool any = k->frees > 0;
    while (k->frees > 0)
        k->give(k->free[--k->frees].at);
    pthread_mutex_unlock(&shared.lock);
    return any;
}

static cudaError_t take_new(int64_t bytes, size_t *left, size_t *all, void **memory)
{
    cudaError_t code = cudaMemGetInfo(left, all);
    if (code == cudaSuccess && (uint64_t)bytes > *left)
        code = cudaErrorMemoryAllocation;
    return code == cudaSuccess ? cudaMalloc(memory, (size_t)bytes) : code;
}

void *card_take(int64_t bytes, const char *what, err *e)
{
    size_t left = 0, all = 0;
    void *memory = kept_take(&shared.of_card, bytes);
    cudaError_t code = memory ? cudaSuccess : take_new(bytes, &left, &all, &memory);
    if (code == cudaErrorMemoryAllocation && kept_clear(&shared.of_card)) {
        cudaGetLastError();
        code = take_new(bytes, &left, &all, &memory);
    }
    if (code == cudaErrorMemoryAllocation) {
        cudaGetLastError();
        err_set(e, NULL, 0,
                "%s takes %.4g GB of the card's memory, which has %.4g GB free of %.4g; -d cpu needs none of it", what,
                1e-9 * (double)bytes, 1e-9 * (double)left, 1e-9 * (double)all);
        return NULL;
    }
    if (card_check(code, "cudaMalloc", -1, e))
        return NULL;
    if (!kept_note(&shared.of_card, memory, bytes, e))
        return memory;
    cudaFree(memory);
    return NULL;
}

void card_give(void *memory)
{
    if (memory)
        kept_give(&shared.of_card, memory);
}

void *card_host_take(int64_t bytes, err *e)
{
    void *memory = kept_take(&shared.of_host, bytes);
    if (!memory && card_check(cudaMallocHost(&memory, (size_t)bytes), "cudaMallocHost", -1, e))
        return NULL;
    if (!kept_note(&shared.of_host, memory, bytes, e))
        return memory;
    cudaFreeHost(memory);
    return NULL;
}

void card_host_give(void *memory)
{
    if (memory)
        kept_give(&shared.of_host, memory);
}

/* ---- Kernels whose blocks wait for each other */

void card_share(void)
{
    pthread_mutex_lock(&shared.turn);
    pthread_mutex_lock(&shared.lock);
    shared.is_on = true;
    pthread_mutex_unlock(&shared.lock);
    pthread_mutex_unlock(&shared.turn);
}

int card_turn_begin(void *stream)
{
    pthread_mutex_lock(&shared.turn);
    if (!shared.is_on)
        return cudaSuccess;
    return shared.turn_over ? cudaStreamWaitEvent((cudaStream_t)stream, shared.turn_over, 0)
                            : cudaEventCreateWithFlags(&shared.turn_over, cudaEventDisableTiming);
}

int card_turn_end(void *stream)
{
    const cudaError_t code = shared.turn_over ? cudaEventRecord(shared.turn_over, (cudaStream_t)stream) : cudaSuccess;
    pthread_mutex_unlock(&shared.turn);
    return code;
}
