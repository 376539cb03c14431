#include "msds/cuda/cuda_frames.cuh"

#include "solve/card_layout.cuh"

extern "C" {
#include "tests/emulate/emulated_frames.h"
}

struct emulated_frames {
    card_frames frames;
    card_fields now;
    int64_t nodes; /* of the slices */
    float4 *u, *v;
    double *precise, *position;
    char *memory;
    cudaStream_t stream;
};

#define TRY(call) card_check(call, #call, -1, e)

static int make(emulated_frames *f, const msds_frames *of, const msds_problem *p, const sell *order,
                const double *position, err *e)
{
    card_layout l = {};
    f->nodes = order->nodes;
    card_layout_add(&l, &f->u, f->nodes);
    card_layout_add(&l, &f->v, f->nodes);
    card_layout_add(&l, &f->precise, 3 * f->nodes);
    card_layout_copy(&l, &f->position, position, 3 * f->nodes);
    return card_layout_place(&l, false, "a state", &f->memory, e) ||
                   TRY(cudaStreamCreateWithFlags(&f->stream, cudaStreamNonBlocking)) ||
                   card_frames_make(&f->frames, of, p, order, e)
               ? -1
               : 0;
}

extern "C" void emulated_frames_free(emulated_frames *f)
{
    if (f->stream)
        cudaStreamSynchronize(f->stream);
    card_frames_free(&f->frames);
    card_give(f->memory);
    if (f->stream)
        cudaStreamDestroy(f->stream);
    free(f);
}

extern "C" emulated_frames *emulated_frames_make(const msds_frames *of, const msds_problem *p, const sell *order,
                                                 const double *position, err *e)
{
    emulated_frames *f = (emulated_frames *)calloc(1, sizeof *f);
    if (f && !make(f, of, p, order, position, e))
        return f;
    if (f)
        emulated_frames_free(f);
    return NULL;
}

/* In the solver's stream, as its own steps write it; but the numbers of the host are to be read at once. */
extern "C" int emulated_frames_put(emulated_frames *f, const float *u, const float *v, const double *precise, err *e)
{
    const size_t four = (size_t)f->nodes * sizeof(float4), three = 3 * (size_t)f->nodes * sizeof(double);
    f->now = {f->u, f->v, precise ? f->precise : NULL, f->position};
    return TRY(cudaMemcpyAsync(f->u, u, four, cudaMemcpyHostToDevice, f->stream)) ||
                   TRY(cudaMemcpyAsync(f->v, v, four, cudaMemcpyHostToDevice, f->stream)) ||
                   (precise && TRY(cudaMemcpyAsync(f->precise, precise, three, cudaMemcpyHostToDevice, f->stream))) ||
                   TRY(cudaStreamSynchronize(f->stream))
               ? -1
               : 0;
}

extern "C" int emulated_frames_send(emulated_frames *f, int slot, err *e)
{
    return card_frames_send(&f->frames, &f->now, slot, f->stream, 7, e);
}

extern "C" int emulated_frames_wait(emulated_frames *f, int slot, msds_values *to, err *e)
{
    return card_frames_wait(&f->frames, slot, to, e);
}

extern "C" int emulated_frames_count(emulated_frames *f, int64_t *count, err *e)
{
    if (card_frames_count(&f->frames, &f->now, f->stream, 7, e) || TRY(cudaStreamSynchronize(f->stream)))
        return -1;
    *count = (int64_t)*f->frames.told;
    return 0;
}
