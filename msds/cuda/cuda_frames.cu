#include "msds/cuda/cuda_frames.cuh"

#include "solve/card_layout.cuh"
#include "solve/start.cuh"

#include <stdlib.h>

extern "C" {
#include "base/mem.h"
#include "msds/problem/simplex.h"
}

enum { FRAME_THREADS = 256, WARP = 32 };

#define CUDA_TRY(call) card_check(call, #call, step, e)

static int64_t blocks_of(int64_t threads)
{
    return (threads + FRAME_THREADS - 1) / FRAME_THREADS;
}

/* A thread for each component, so that what is written follows each other. wide: numbers that a node has there. */
template <class T>
static __global__ void gather_kernel(const T *__restrict__ state, int wide, const int32_t *__restrict__ from,
                                     int64_t count, T *__restrict__ to)
{
    const int64_t i = (int64_t)blockIdx.x * FRAME_THREADS + threadIdx.x;
    if (i < 3 * count)
        to[i] = state[wide * (int64_t)from[i / 3] + i % 3];
}

/* Where a node is: the sum of doubles that the processor makes. */
static __device__ void find_place(const card_fields &s, uint32_t node, double x[3])
{
    const float *single = (const float *)(s.u + node);
    for (int a = 0; a < 3; a++)
        x[a] = s.position[3 * (int64_t)node + a] + (s.precise ? s.precise[3 * (int64_t)node + a] : (double)single[a]);
}

static __global__ void count_kernel(const __grid_constant__ card_fields s, const uint4 *__restrict__ corner,
                                    int64_t elements, unsigned long long *count)
{
    const int64_t t = (int64_t)blockIdx.x * FRAME_THREADS + threadIdx.x;
    bool bad = false;
    if (t < elements) {
        const uint4 n = corner[t];
        double x[4][3];
        find_place(s, n.x, x[0]);
        find_place(s, n.y, x[1]);
        find_place(s, n.z, x[2]);
        find_place(s, n.w, x[3]);
        bad = !(simplex_volume(x[0], x[1], x[2], x[3]) > 0);
    }
    const unsigned any = __ballot_sync(~0u, bad);
    if (any && threadIdx.x % WARP == 0)
        atomicAdd(count, (unsigned long long)__popc(any));
}

/* ---- what frames take */

/* On the host, until it is sent. */
typedef struct host_lists {
    int32_t *some; /* of the nodes that are listed */
    uint4 *corner;
} host_lists;

static int fill_lists(const card_frames *f, const msds_problem *p, const sell *order, host_lists *h, err *e)
{
    h->some = (int32_t *)mem_array(f->of.count, sizeof *h->some, "the frames", e);
    h->corner = (uint4 *)mem_array(f->elements, sizeof *h->corner, "the frames", e);
    if (!h->some || !h->corner)
        return -1;
    for (int64_t i = 0; i < f->of.count; i++)
        h->some[i] = order->own_node[f->of.node[i]];
    for (int64_t t = 0; t < f->elements; t++) {
        uint32_t own[4];
        for (int c = 0; c < 4; c++)
            own[c] = (uint32_t)order->own_node[p->element_node[4 * t + c]];
        h->corner[t] = {own[0], own[1], own[2], own[3]};
    }
    return 0;
}

static int put_lists(card_frames *f, const sell *order, const host_lists *h, err *e)
{
    card_layout l = {};
    const bool all = f->of.displacement || f->of.velocity;
    card_layout_copy(&l, &f->all, all ? order->own_node : NULL, f->nodes);
    card_layout_copy(&l, &f->some, h->some, f->of.count);
    card_layout_copy(&l, &f->corner, h->corner, f->elements);
    card_layout_add(&l, &f->inverted, 1);
    f->bytes = l.bytes;
    return card_layout_place(&l, false, "the frames", &f->memory, e);
}

/* As the message of a call has no step yet. */
static int make_streams(card_frames *f, err *e)
{
    const int64_t step = -1;
    if (CUDA_TRY(cudaStreamCreateWithFlags(&f->sending, cudaStreamNonBlocking)) ||
        CUDA_TRY(cudaMallocHost((void **)&f->told, sizeof *f->told)))
        return -1;
    for (card_sent &s : f->slot)
        if (CUDA_TRY(cudaEventCreateWithFlags(&s.ready, cudaEventDisableTiming)) ||
            CUDA_TRY(cudaEventCreateWithFlags(&s.arrived, cudaEventDisableTiming)))
            return -1;
    return CUDA_TRY(cudaDeviceSynchronize()); /* the lists are there before any stream reads them */
}

void card_frames_free(card_frames *f)
{
    if (f->sending)
        cudaStreamSynchronize(f->sending);
    for (card_sent &s : f->slot) {
        cudaFreeHost(s.host);
        card_give(s.card);
        if (s.ready)
            cudaEventDestroy(s.ready);
        if (s.arrived)
            cudaEventDestroy(s.arrived);
    }
    cudaFreeHost(f->told);
    card_give(f->memory);
    if (f->sending)
        cudaStreamDestroy(f->sending);
    *f = {};
}

int64_t card_frames_bytes(const card_frames *f)
{
    int64_t bytes = f->bytes;
    for (const card_sent &s : f->slot)
        bytes += s.room;
    return bytes;
}

/* ---- a frame */

/* Where the velocity begins, and where all ends. */
static int64_t displacement_bytes(const card_frames *f, bool precise)
{
    return 3 * f->count * (int64_t)(precise ? sizeof(double) : sizeof(float));
}

static int64_t sent_bytes(const card_frames *f, bool precise)
{
    return displacement_bytes(f, precise) + (f->of.velocity ? 3 * f->nodes * (int64_t)sizeof(float) : 0);
}

/* Room for a frame: exact ones take more than others. What the slot had is no longer wanted. */
static int make_room(card_sent *s, int64_t bytes, int64_t step, err *e)
{
    if (bytes <= s->room)
        return 0;
    cudaFreeHost(s->host);
    card_give(s->card);
    s->host = NULL;
    s->room = 0;
    s->card = (char *)card_take(bytes, "a frame", e);
    if (!s->card || CUDA_TRY(cudaMallocHost((void **)&s->host, (size_t)bytes)))
        return -1;
    s->room = bytes;
    return 0;
}

int card_frames_make(card_frames *f, const msds_frames *of, const msds_problem *p, const sell *order, err *e)
{
    host_lists h = {};
    f->of = *of;
    f->nodes = p->nodes;
    f->elements = p->elements;
    f->count = of->displacement ? p->nodes : of->count;
    int failed = fill_lists(f, p, order, &h, e) || put_lists(f, order, &h, e) || make_streams(f, e) ? -1 : 0;
    for (int i = 0; i < MSDS_SLOTS && !failed; i++)
        failed = make_room(&f->slot[i], sent_bytes(f, false), -1, e);
    f->of.node = NULL; /* the caller's */
    free(h.some);
    free(h.corner);
    return failed;
}

template <class T>
static int gather(const T *state, int wide, const int32_t *from, int64_t count, char *to, cudaStream_t stream,
                  int64_t step, err *e)
{
    const card_blocks blocks = {blocks_of(3 * count), FRAME_THREADS, 0, stream, false};
    return count ? card_check(card_start(gather_kernel<T>, blocks, state, wide, from, count, (T *)to),
                              "the start of a frame's copy", step, e)
                 : 0;
}

static int gather_all(const card_frames *f, const card_fields *state, const card_sent *s, cudaStream_t stream,
                      int64_t step, err *e)
{
    const int32_t *from = f->of.displacement ? f->all : f->some;
    if (s->precise ? gather(state->precise, 3, from, f->count, s->card, stream, step, e)
                   : gather((const float *)state->u, 4, from, f->count, s->card, stream, step, e))
        return -1;
    return f->of.velocity ? gather((const float *)state->v, 4, f->all, f->nodes,
                                   s->card + displacement_bytes(f, s->precise), stream, step, e)
                          : 0;
}

int card_frames_send(card_frames *f, const card_fields *state, int slot, cudaStream_t stream, int64_t step, err *e)
{
    card_sent *s = &f->slot[slot];
    s->precise = state->precise != NULL;
    s->step = step;
    const int64_t bytes = sent_bytes(f, s->precise);
    if (!bytes)
        return 0;
    return make_room(s, bytes, step, e) || gather_all(f, state, s, stream, step, e) ||
                   CUDA_TRY(cudaEventRecord(s->ready, stream)) ||
                   CUDA_TRY(cudaStreamWaitEvent(f->sending, s->ready, 0)) ||
                   CUDA_TRY(cudaMemcpyAsync(s->host, s->card, (size_t)bytes, cudaMemcpyDeviceToHost, f->sending)) ||
                   CUDA_TRY(cudaEventRecord(s->arrived, f->sending))
               ? -1
               : 0;
}

int card_frames_wait(const card_frames *f, int slot, msds_values *to, err *e)
{
    const card_sent *s = &f->slot[slot];
    *to = {};
    if (!sent_bytes(f, s->precise))
        return 0;
    if (card_check(cudaEventSynchronize(s->arrived), "the wait for a frame", s->step, e))
        return -1;
    if (s->precise)
        to->precise = (const double *)s->host;
    else
        to->displacement = (const float *)s->host;
    if (f->of.velocity)
        to->velocity = (const float *)(s->host + displacement_bytes(f, s->precise));
    return 0;
}

int card_frames_count(card_frames *f, const card_fields *state, cudaStream_t stream, int64_t step, err *e)
{
    const card_blocks blocks = {blocks_of(f->elements), FRAME_THREADS, 0, stream, false};
    return CUDA_TRY(cudaMemsetAsync(f->inverted, 0, sizeof *f->inverted, stream)) ||
                   card_check(card_start(count_kernel, blocks, *state, f->corner, f->elements, f->inverted),
                              "the start of a count", step, e) ||
                   CUDA_TRY(cudaMemcpyAsync(f->told, f->inverted, sizeof *f->told, cudaMemcpyDeviceToHost, stream))
               ? -1
               : 0;
}
