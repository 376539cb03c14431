/* What leaves the card for the model's arrays: the state, which stands in the tiles' order or the march's, in single
 * precision perhaps. A frame is put into the model's order on the card, between two steps, and goes to the host in a
 * stream of its own while the steps go on. Included by cuda_loops.cuh alone.
 */
#ifndef SINEW_CUDA_FRAME_CUH
#define SINEW_CUDA_FRAME_CUH

#include "tled/cuda/cuda_state.cuh"

/* ---- by the host */

typedef struct permutation { /* of arrays as the state, to nodes x 3 in the model's order */
    const cuda_state *s;
    const real *from;
    double *to;
} permutation;

static void permute_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const permutation *m = (const permutation *)context;
    const cuda_view<real> *v = &m->s->view;
    (void)chunk;
    for (int64_t k = from; k < to; k++)
        for (int a = 0; a < 3; a++)
            m->to[3 * (int64_t)m->s->tiles.node[k] + a] = m->from[v->offset[a] + k * v->along];
}

static void permute(const cuda_state *s, const real *from, double *to)
{
    permutation m = {s, from, to};
    pool_run(s->threads, s->tiles.nodes, COPY_CHUNK, permute_work, &m);
}

/* ---- by the card. A frame: displacement, then velocity, 3 numbers a node in the model's order; after them, for the
 * kernel, where each node stands in the state. */

enum { FRAME_THREADS = 256, FRAME_EACH = 3 /* numbers, of displacement and of velocity: as many nodes as threads */ };

/* A thread has one component of three nodes: what is written follows each other, and what a node has side by side is
 * read by threads side by side. */
static __global__ void frame_kernel(const __grid_constant__ cuda_view<real> v, const int32_t *__restrict__ place,
                                    const real *__restrict__ u, const real *__restrict__ velocity,
                                    real *__restrict__ to)
{
    const int32_t first = (int32_t)(blockIdx.x * FRAME_THREADS);
    real *const to_velocity = to + 3 * (int64_t)v.nodes;
#pragma unroll
    for (int k = 0; k < FRAME_EACH; k++) {
        const int32_t i = k * FRAME_THREADS + (int32_t)threadIdx.x, n = first + i / 3;
        if (n < v.nodes) {
            const int64_t from = v.offset[i % 3] + place[n] * v.along, at = 3 * (int64_t)first + i;
            to[at] = u[from];
            to_velocity[at] = velocity[from];
        }
    }
}

static int64_t frame_bytes(const cuda_state *s)
{
    return s->tiles.nodes * (int64_t)(6 * sizeof(real) + sizeof(int32_t));
}

static int32_t *frame_place(const cuda_state *s)
{
    return (int32_t *)(s->frame + 6 * s->tiles.nodes);
}

/* Puts on the card where each of the model's nodes stands; by way of `staging`,
 * which only the stream writes from now on. */
static int put_place(cuda_state *s, err *e)
{
    int32_t *place = (int32_t *)s->staging;
    for (int64_t k = 0; k < s->tiles.nodes; k++)
        place[s->tiles.node[k]] = (int32_t)k;
    return CUDA_TRY(cudaMemcpyAsync(frame_place(s), place, (size_t)s->tiles.nodes * sizeof *place,
                                    cudaMemcpyHostToDevice, s->stream));
}

/* What a frame goes by, where there is room for it on the card. */
static int make_way(cuda_state *s, err *e)
{
    err full = {0};
    s->frame = (real *)card_take(frame_bytes(s), "a frame", &full);
    s->frame_direct = !s->frame;
    if (s->frame_direct)
        return 0;
    const int threads = pool_threads(s->threads);
    s->wideners = pool_create(threads < WIDENERS ? threads : WIDENERS, &full); /* or the caller does without */
    return put_place(s, e);
}

/* Where the card has no room for it, a frame holds up the steps: better than a run that ends at its
 * first frame, which may be its last state. */
static int make_frame(cuda_state *s, cuda_frame *f, err *e)
{
    const int64_t bytes = 6 * s->view.stride * (int64_t)sizeof(real);
    if (bytes > FRAME_DIRECT && !s->kept_internal && !s->frame && !s->frame_direct && make_way(s, e))
        return -1;
    if (f->host)
        return 0;
    const int64_t numbers = s->frame ? 6 * s->tiles.nodes : 2 * s->numbers;
    return CUDA_TRY(cudaEventCreateWithFlags(&f->arrived, cudaEventDisableTiming)) ||
                   CUDA_TRY(cudaMallocHost((void **)&f->host, (size_t)numbers * sizeof(real)))
               ? -1
               : 0;
}

/* As it stands, between two steps. */
static int send_directly(cuda_state *s, const cuda_frame *f, err *e)
{
    const size_t bytes = (size_t)s->numbers * sizeof(real);
    return CUDA_TRY(cudaMemcpyAsync(f->host, s->displacement, bytes, cudaMemcpyDeviceToHost, s->stream)) ||
                   CUDA_TRY(
                       cudaMemcpyAsync(f->host + s->numbers, s->velocity, bytes, cudaMemcpyDeviceToHost, s->stream)) ||
                   CUDA_TRY(cudaEventRecord(f->arrived, s->stream))
               ? -1
               : 0;
}

/* The steps wait where the frame before is not yet sent: far less time passes between two that anyone would see. */
static int send_frame(cuda_state *s, const cuda_frame *f, err *e)
{
    const card_blocks blocks = {(s->tiles.nodes + FRAME_THREADS - 1) / FRAME_THREADS, FRAME_THREADS, 0, s->stream};
    if (!s->frame)
        return send_directly(s, f, e);
    return CUDA_TRY(cudaStreamWaitEvent(s->stream, s->frame_free, 0)) ||
                   card_check(card_start(frame_kernel, blocks, s->view, frame_place(s), s->displacement, s->velocity,
                                         s->frame),
                              "the start of a frame", s->step, e) ||
                   CUDA_TRY(cudaEventRecord(s->frame_ready, s->stream)) ||
                   CUDA_TRY(cudaStreamWaitEvent(s->sending, s->frame_ready, 0)) ||
                   CUDA_TRY(cudaMemcpyAsync(f->host, s->frame, 6 * (size_t)s->tiles.nodes * sizeof(real),
                                            cudaMemcpyDeviceToHost, s->sending)) ||
                   CUDA_TRY(cudaEventRecord(s->frame_free, s->sending)) ||
                   CUDA_TRY(cudaEventRecord(f->arrived, s->sending))
               ? -1
               : 0;
}

static int cuda_snapshot(cuda_state *s, int slot, err *e)
{
    cuda_frame *f = &s->slot[slot];
    if (make_frame(s, f, e))
        return -1;
    f->step = s->step;
    return send_frame(s, f, e);
}

typedef struct widening { /* of a frame that came */
    const real *displacement, *velocity;
    const field_values *to;
} widening;

static void widen_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const widening *w = (const widening *)context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        w->to->of[TLED_DISPLACEMENT][i] = w->displacement[i];
    for (int64_t i = from; i < to; i++)
        w->to->of[TLED_VELOCITY][i] = w->velocity[i];
}

static int cuda_fetch(cuda_state *s, int slot, const field_values *to, err *e)
{
    const cuda_frame *f = &s->slot[slot];
    const int64_t numbers = 3 * s->tiles.nodes;
    const permutation u = {s, f->host, to->of[TLED_DISPLACEMENT]}, v = {s, f->host + s->numbers, to->of[TLED_VELOCITY]};
    widening w = {f->host, f->host + numbers, to};
    if (card_check(cudaEventSynchronize(f->arrived), "the wait for a frame", f->step, e))
        return -1;
    if (s->frame) {
        if (s->wideners)
            pool_run(s->wideners, numbers, COPY_CHUNK, widen_work, &w);
        else
            widen_work(&w, 0, 0, numbers);
        return 0;
    }
    permute_work((void *)&u, 0, 0, s->tiles.nodes);
    permute_work((void *)&v, 0, 0, s->tiles.nodes);
    return 0;
}

#endif
