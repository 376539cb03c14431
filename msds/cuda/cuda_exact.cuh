/* What the kernel of exact frames sees besides the tissue: the coarser lattices (levels.h) on
 * the card. Passed by value; owns nothing.
 */
#ifndef SINEW_CUDA_EXACT_CUH
#define SINEW_CUDA_EXACT_CUH

#include "msds/cuda/cuda_tissue.cuh"

#include <cuda_fp16.h>

extern "C" {
#include "msds/cuda/levels.h"
}

/* Steps of Chebyshev's polynomial before and after a coarser lattice has its say: odd, see
 * FINISHED. It damps eigenvalues from the largest down to so small a share of it; by trials on
 * lattices of 8,192 and 524,288 nodes at nu = .45. */
enum { SMOOTH = 3, FINISHED = 1 /* where the steps leave the result, of the two that they go between */ };
static const double smooth_share = .1;

/* An exact frame is in equilibrium to this share of its load: msds_cpu.c's. */
static const double exact_tolerance = 1e-6;

typedef struct tissue_weights {
    const int32_t *start, *column;
    const float *weight;
} tissue_weights;

typedef struct tissue_level {
    int32_t nodes, chunks;
    const int32_t *start, *neighbour;
    const uint4 *eight; /* slots x LANES: the first eight numbers of a block in half precision, over `back` */
    const __half *ninth;
    float back;
    const float *sums;    /* count x 9 x LANES: of each row's blocks; NULL on the mesh, where they are nothing */
    const float *inverse; /* as levels.h has it */
    tissue_weights up, down;
    float4 *left, *rest; /* right-hand side; what is left of it */
    float4 *z[2], *step;
    float keep[SMOOTH],
        take[SMOOTH]; /* of each step: the share of the last one, and of the inverse times what is left */
} tissue_level;

typedef struct tissue_exact {
    tissue_level at[LEVELS_MOST];
    int32_t count, order;
    const float *coarsest;
    float4 *gone;    /* what a search adds to the displacement */
    uint8_t *active; /* nodes: kept on their plane */
} tissue_exact;

/* Puts them on the card, from the stiffness on the host; what the mesh has already stays with t. *memory and *bytes get
 * the piece of the card's memory that they take, which is the caller's. -1 with e filled. */
int tissue_exact_make(tissue_exact *x, const tissue *t, const msds_problem *p, const sell *s, const lanes_matrix *m,
                      pool *threads, char **memory, int64_t *bytes, err *e);

/* Makes the displacement of exact frames that of the others. */
void tissue_widen(const tissue *t, cudaStream_t stream);

cudaError_t tissue_exact_start(const tissue *t, const tissue_frame *f, const tissue_exact *x, cudaStream_t stream);

#endif
