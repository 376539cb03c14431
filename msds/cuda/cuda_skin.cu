/* The steps of a skin on a card, in double, a launch each: skin_step.h, with the processor's bytes. They go on beside
 * the tissue's, on a stream of their own.
 */
#include "solve/card_layout.cuh"
#include "solve/start.cuh"

#include "msds/cuda/cuda_planes.cuh"

extern "C" {
#include "msds/cuda/msds_cuda.h"
}

enum { SKIN_THREADS = 128 };

struct skin_state {
    skin_view view;      /* on the card */
    double *u[2], *v[2]; /* of `now`, and the next */
    double *inertia, *anchor, *held;
    int now;
    int64_t steps; /* since it was made */
    card_planes planes;
    char *memory;
    cudaStream_t stream;
};

#define CUDA_TRY(call) card_check(call, #call, s->steps, e)

static __global__ void __launch_bounds__(SKIN_THREADS)
    step_kernel(const __grid_constant__ skin_view s, const __grid_constant__ probe_placed at, bool touched)
{
    const int64_t v = (int64_t)blockIdx.x * SKIN_THREADS + threadIdx.x;
    if (v < s.vertices)
        skin_step_vertex(&s, touched ? &at : NULL, v);
}

static void skin_destroy(skin_state *s)
{
    if (!s)
        return;
    if (s->stream)
        cudaStreamSynchronize(s->stream);
    card_planes_free(&s->planes);
    card_give(s->memory);
    if (s->stream)
        cudaStreamDestroy(s->stream);
    free(s);
}

static int put_skin(skin_state *s, const skin_view *from, err *e)
{
    card_layout l = {0};
    const int64_t count = from->vertices;
    s->view.vertices = count;
    s->view.options = from->options;
    card_layout_copy(&l, &s->view.position, from->position, 3 * count);
    card_layout_copy(&l, &s->view.start, from->start, count + 1);
    card_layout_copy(&l, &s->view.spring, from->spring, 2 * from->edges);
    card_layout_copy(&l, &s->inertia, from->inertia, count);
    card_layout_copy(&l, &s->anchor, from->anchor, count);
    card_layout_copy(&l, &s->held, from->held, count);
    card_layout_copy(&l, &s->u[0], from->u, 3 * count);
    card_layout_copy(&l, &s->v[0], from->v, 3 * count);
    card_layout_add(&l, &s->u[1], 3 * count);
    card_layout_add(&l, &s->v[1], 3 * count);
    if (card_layout_place(&l, false, "the skin", &s->memory, e))
        return -1;
    s->view.inertia = s->inertia;
    s->view.anchor = s->anchor;
    s->view.held = s->held;
    return CUDA_TRY(cudaDeviceSynchronize());
}

static skin_state *skin_create(const skin_view *from, err *e)
{
    skin_state *s = (skin_state *)mem_array(1, sizeof *s, "the skin", e);
    if (!s)
        return NULL;
    if (CUDA_TRY(cudaStreamCreateWithFlags(&s->stream, cudaStreamNonBlocking)) || put_skin(s, from, e)) {
        skin_destroy(s);
        return NULL;
    }
    return s;
}

static int send(skin_state *s, double *to, const double *from, err *e)
{
    const size_t bytes = (size_t)s->view.vertices * sizeof *to;
    return CUDA_TRY(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, s->stream));
}

static int skin_change_there(skin_state *s, const skin_view *from, err *e)
{
    s->view.options = from->options;
    return send(s, s->inertia, from->inertia, e) || send(s, s->anchor, from->anchor, e) ||
                   send(s, s->held, from->held, e) || CUDA_TRY(cudaStreamSynchronize(s->stream))
               ? -1
               : 0;
}

static int skin_reset_there(skin_state *s, err *e)
{
    const size_t bytes = 3 * (size_t)s->view.vertices * sizeof(double);
    return CUDA_TRY(cudaMemsetAsync(s->u[s->now], 0, bytes, s->stream)) ||
                   CUDA_TRY(cudaMemsetAsync(s->v[s->now], 0, bytes, s->stream))
               ? -1
               : 0;
}

static int skin_step_there(skin_state *s, const probe_placed *at, int64_t count, err *e)
{
    if (at && card_planes_put(&s->planes, &at->shape, s->stream, s->steps, e))
        return -1;
    const probe_placed placed = at ? card_planes_placed(&s->planes, at) : probe_placed{};
    const card_blocks blocks = {(s->view.vertices + SKIN_THREADS - 1) / SKIN_THREADS, SKIN_THREADS, 0, s->stream};
    for (int64_t i = 0; i < count; i++, s->now = !s->now, s->steps++) {
        s->view.u = s->u[s->now], s->view.v = s->v[s->now];
        s->view.next_u = s->u[!s->now], s->view.next_v = s->v[!s->now];
        if (card_check(card_start(step_kernel, blocks, s->view, placed, at != NULL), "the start of a step of the skin",
                       s->steps, e))
            return -1;
    }
    return 0;
}

static int skin_get(skin_state *s, double *u, err *e)
{
    const size_t bytes = 3 * (size_t)s->view.vertices * sizeof *u;
    return CUDA_TRY(cudaMemcpyAsync(u, s->u[s->now], bytes, cudaMemcpyDeviceToHost, s->stream)) ||
                   CUDA_TRY(cudaStreamSynchronize(s->stream))
               ? -1
               : 0;
}

const skin_device msds_cuda_skin = {.create = skin_create,
                                    .destroy = skin_destroy,
                                    .change = skin_change_there,
                                    .reset = skin_reset_there,
                                    .step = skin_step_there,
                                    .get = skin_get};
