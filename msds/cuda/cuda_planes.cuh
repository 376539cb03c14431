/* A convex probe's planes on a card, for kernels that ask it where a point is. Everything is static; who has a
 * card_planes frees it.
 */
#ifndef SINEW_CUDA_PLANES_CUH
#define SINEW_CUDA_PLANES_CUH

#include <cuda_runtime.h>
#include <stdlib.h>
#include <string.h>

extern "C" {
#include "base/mem.h"
#include "probe/probe.h"
#include "solve/card.h"
}

typedef struct card_planes { /* zeroed: of no probe yet */
    double *there, *here;    /* on the card, as those here */
    int32_t count;
} card_planes;

static inline void card_planes_free(card_planes *p)
{
    card_give(p->there);
    free(p->here);
    *p = {};
}

/* Puts a probe's planes on the card where they are not those of the call before: by the stream of the kernels that read
 * them, which waits for no other. step: as card_check's. -1 with e filled. */
static inline int card_planes_put(card_planes *p, const probe *shape, cudaStream_t stream, int64_t step, err *e)
{
    const size_t bytes = 4 * (size_t)shape->planes * sizeof *p->there;
    if (shape->kind != PROBE_CONVEX || (p->count == shape->planes && !memcmp(p->here, shape->plane, bytes)))
        return 0;
    if (p->there && card_check(cudaStreamSynchronize(stream), "cudaStreamSynchronize", step, e))
        return -1;
    card_planes_free(p);
    p->here = (double *)mem_array(shape->planes, 4 * sizeof *p->here, "the probe", e);
    p->there = p->here ? (double *)card_take((int64_t)bytes, "the probe", e) : NULL;
    if (!p->there || card_check(cudaMemcpyAsync(p->there, shape->plane, bytes, cudaMemcpyHostToDevice, stream),
                                "cudaMemcpyAsync", step, e))
        return -1;
    memcpy(p->here, shape->plane, bytes);
    p->count = shape->planes;
    return 0;
}

/* The probe as kernels see it. */
static inline probe_placed card_planes_placed(const card_planes *p, const probe_placed *at)
{
    probe_placed placed = *at;
    placed.shape.plane = p->there;
    return placed;
}

#endif
