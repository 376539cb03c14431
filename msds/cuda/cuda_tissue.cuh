/* What the kernels of msds-run see of a model on the card, what they are asked for a frame, and how it is started.
 * Views are passed by value and own nothing. Arrays over nodes are in the slices' order (sell.h); a number in each
 * direction and a fourth are a float4.
 */
#ifndef SINEW_CUDA_TISSUE_CUH
#define SINEW_CUDA_TISSUE_CUH

#include "msds/cuda/cuda_grid.cuh"

extern "C" {
#include "msds/problem/problem.h"
#include "probe/probe.h"
}

typedef struct tissue_contact {
    double way[3], depth, from[3], force; /* as contacts.h has them */
} tissue_contact;

typedef enum tissue_kernel { TISSUE_SPRINGS, TISSUE_FEM, TISSUE_EXACT, TISSUE_NEWTON, TISSUE_KERNELS } tissue_kernel;

enum { TISSUE_NOBODY, TISSUE_FREE, TISSUE_FIXED };

/* Sums over chunks, in tissue.part: a row of chunks each. */
typedef enum tissue_part {
    PART_FIRST,
    PART_SECOND,
    PART_THIRD,
    PART_LEFT, /* squares of what is left, of the load and of the pulls */
    PART_LOAD,
    PART_PULLS,
    PART_FORCE,
    PART_TORQUE = PART_FORCE + 3,
    PART_PRESSED = PART_TORQUE + 3,
    PART_LARGEST,
    PART_BROKEN,
    PART_FREE, /* from here on: cuda_newton.cu's */
    PART_OFF,
    PART_WORK,
    PART_CURVATURE,
    PART_STIFFER,
    PART_STEEPEST,
    PART_ALONG,
    PART_SLOPE,
    PART_MORE_LEFT,
    PART_MORE_LOAD,
    PARTS
} tissue_part;

typedef struct tissue_outcome { /* of a frame */
    msds_reading reading;
    bool failed; /* an exact one did not come to its tolerance: here, or in a frame before that nobody looked at */
} tissue_outcome;

typedef struct tissue {
    int32_t nodes, chunks;
    const int32_t *start, *neighbour; /* slices + 1; slots x LANES */
    const float4 *spring;             /* slots x LANES: length at rest, stiffness, damper, and the neighbour's bits */
    const float *diagonal, *block;    /* of the stiffness, as lanes_matrix has them; or NULL, not yet made */
    const uint8_t *kind;              /* TISSUE_NOBODY: only fills up */
    const float4 *place, *weight;     /* m, w: 1 / inertia, 0 where fixed; N, w: N/m of contact */
    const double *position;           /* nodes x 3, m */
    const double *repulsion;          /* N/m */
    float4 *u, *v, *next_u, *next_v;
    float4 *left, *pulled, *way[2]; /* of conjugate gradients */
    double *precise;                /* nodes x 3, m: the displacement of exact frames */
    tissue_contact *contact;
    uint8_t *listed;
    double *held;  /* as contacts.h has it */
    double *part;  /* PARTS x chunks */
    double slight; /* N2: msds_problem's */
    tissue_outcome *outcome;
    unsigned long long
        *arrived; /* of grid_barrier: TISSUE_KERNELS, each its own, whose number of blocks never changes */
} tissue;

typedef struct tissue_frame {
    probe_placed probe;
    float centre[3], reach, wide; /* m: the ball that holds the probe; its reach while contacts are looked for */
    float dt;
    double damping; /* s: of the repulsion, over its stiffness */
    int32_t count;
    bool touched, penalty;
} tissue_frame;

/* Starts a frame on the stream, by the kernel that `of` names for a card of so many multiprocessors; more: its third
 * argument, or NULL. As many blocks as there are chunks of its work, or as the card holds at once. */
cudaError_t tissue_start(tissue_kernel which, const void *(*of)(const tissue *t, int processors), const tissue *t,
                         const tissue_frame *f, void *more, int32_t chunks, cudaStream_t stream);

cudaError_t tissue_springs_start(const tissue *t, const tissue_frame *f, cudaStream_t stream);
cudaError_t tissue_fem_start(const tissue *t, const tissue_frame *f, cudaStream_t stream);

static __device__ inline float4 minus(float4 a, float4 b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z, 0};
}

static __device__ inline float4 plus_times(float4 a, float by, float4 b)
{
    return {a.x + by * b.x, a.y + by * b.y, a.z + by * b.z, 0};
}

/* y += the 3 x 3 block that begins at k for this lane, times p. */
static __device__ inline void block_add(const float *k, float4 p, float4 *y)
{
    y->x += k[0] * p.x + k[LANES] * p.y + k[2 * LANES] * p.z;
    y->y += k[3 * LANES] * p.x + k[4 * LANES] * p.y + k[5 * LANES] * p.z;
    y->z += k[6 * LANES] * p.x + k[7 * LANES] * p.y + k[8 * LANES] * p.z;
}

#endif
