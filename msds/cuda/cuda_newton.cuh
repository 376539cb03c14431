/* What the kernel of the method tissue sees besides the tissue: tetrahedra and their sums as tissue_mesh.h has them,
 * a thread an element or a node. Passed by value; owns nothing.
 */
#ifndef SINEW_CUDA_NEWTON_CUH
#define SINEW_CUDA_NEWTON_CUH

#include "msds/cuda/cuda_tissue.cuh"

extern "C" {
#include "msds/cpu/tissue_mesh.h"
}

typedef struct newton_sums { /* tissue_sums */
    const int32_t *start;
    const int2 *slot; /* first, has */
    const int32_t *list;
} newton_sums;

typedef struct tissue_newton {
    int32_t lanes, points; /* elements, with those that only fill up groups */
    int32_t spans, span;   /* of nodes, whose sums are one part each: how many, and chunks in each */
    int64_t stride;
    double side; /* m: of a cell */
    const int4 *first, *first_point;
    const int32_t *node, *point;
    const int32_t *shape; /* groups: the shape of all, of 9 gradients; below 0: ~ of the first of eight, by lanes */
    const float *gradient, *volume, *mu, *kappa, *bulk, *keep, *inverse;
    newton_sums corners, swells;
    float *law, *counted, *force, *swollen;
    float *held, *pressure, *pressed;                    /* points */
    float4 *step, *left, *way, *pulled, *started, *gone; /* nodes; gone: what was left where a Newton step began */
    uint8_t *active, *meets;                             /* nodes: contacts.h's, as is: */
    double *pull;
    double *residual; /* 1: of the frame before */
} tissue_newton;

/* Puts them on the card. *memory and *bytes get the piece of the card's memory that they take, which is the caller's.
 * -1 with e filled. */
int tissue_newton_make(tissue_newton *x, const msds_problem *p, const sell *s, char **memory, int64_t *bytes, err *e);

/* Holds no pressure: the tissue is at rest. */
cudaError_t tissue_newton_reset(const tissue_newton *x, cudaStream_t stream);

cudaError_t tissue_newton_start(const tissue *t, const tissue_frame *f, const tissue_newton *x, cudaStream_t stream);

#endif
