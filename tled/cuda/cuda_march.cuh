/* What the march takes of the CUDA executor in single precision: cuda_march.cu. Its state stands node by node, in the
 * march's order: 4 floats each, of which the first three are components along the march's axes: rows, across, march.
 * The fourth of a displacement, and of an internal force, is 1/m; that of a velocity is what move_node needs to know:
 * MARCH_FREE, MARCH_EXTRA, as bits. The view's pointers and these are the card's, borrowed.
 */
#ifndef SINEW_CUDA_MARCH_CUH
#define SINEW_CUDA_MARCH_CUH

#include "tled/cuda/cuda_view.cuh"

extern "C" {
#include "tled/cuda/march.h"
}

enum {
    MARCH_FREE = 0, /* bit MARCH_FREE + a: nothing holds component a */
    MARCH_EXTRA = 3 /* displaced by the script, or forces act on it */
};

/* V/V', by which the march's numbers of a law are multiplied under physical control. */
#define MARCH_LAW (1.f / 64)

/* What holds a cell under physical control, in the march's unit of force: log2 of mu and K/V', both times MARCH_LAW; of
 * its modes hourglass_numbers times V, and what of torsion is a strain's own, but for the sum. `bending` is 1 of plain
 * cells. */
typedef struct march_hold {
    float log_mu, press;
    float coupling, torsion, corner, bending, own[3];
} march_hold;

/* Of an axis, with c = 4 h and V' = 64 V: c, V'/c, 1/(3 c^2), 1/V'; V'/c^2, (c_i^2/c_j^2 + c_i^2/c_k^2) - 1. */
typedef struct march_side {
    float width, face, thirds, density, squares, own;
} march_side;

typedef struct cuda_march {
    cuda_view<float> v;
    const march_unit *unit;
    const int32_t *near; /* march's */
    int32_t nears;
    uint32_t *done;   /* units: the last pass that each has made */
    uint32_t *ticket; /* how many units were taken, of all passes */
    int32_t units;
    const uint32_t *word;
    const int32_t *detail, *which;
    const march_cell *cell;
    float law[3];                /* isotropic: of plain cells mu, K, hourglass */
    float force;                 /* the unit of force, in newtons; isotropic: 1 */
    float weight;                /* physical: MARCH_LAW in that unit */
    alignas(16) march_hold held; /* physical: of plain cells */
    alignas(16) march_side side[3];
    float slope[3], area[3]; /* element_shape's, along the march's axes; area: in the unit of force */
    float volume;            /* V' */
    int32_t axis[3];         /* of the model: which these are */
    const march_tip *tip;    /* march's; NULL: there are none */
    int32_t tip_first;
} cuda_march;

/* What the kernel is compiled for: isotropic or physical control, and whether all sides are alike, which saves some
 * operations; and, beside that, whether there are tips. */
typedef enum march_control { MARCH_ISOTROPIC, MARCH_PHYSICAL, MARCH_PHYSICAL_CUBES } march_control;

static inline march_control march_control_of(hourglass_kind kind, const double side[3])
{
    if (kind == HOURGLASS_ISOTROPIC)
        return MARCH_ISOTROPIC;
    return side[0] == side[1] && side[1] == side[2] ? MARCH_PHYSICAL_CUBES : MARCH_PHYSICAL;
}

/* What a pass does: v = keep v + push a, with what a step begins and ends; u += dt v. pull: push, of forces in the
 * march's unit. */
typedef struct alignas(16) cuda_march_kind {
    float keep, pull, dt, push;
    int32_t what;
} cuda_march_kind;

enum { MARCH_FIRST, MARCH_STEP, MARCH_LAST, MARCH_KINDS };

/* Passes, each of the state that the one before left. */
typedef struct cuda_march_pass {
    float4 *state[2],
        *velocity; /* the first pass reads displacements in state[0] and leaves them, or internal forces, in state[1] */
    const double *now; /* the curves' values: `row` of them where the state stands, and so many more for each step */
    cuda_march_kind
        kind[MARCH_KINDS]; /* of the first; of the last, where it `ends` and is not the first; of the others */
    int32_t row, passes, ends;
    uint32_t number, ticket; /* of the first pass, from 1 on; units taken before */
} cuda_march_pass;

/* Blocks that the card runs at once; 0: it cannot run any, being of before compute capability 9.0. */
cudaError_t cuda_march_slots(march_control control, int64_t *slots);

/* By so many blocks, no more than the card runs at once; each takes one ticket more than there are units in all. */
cudaError_t cuda_march_start(march_control control, const cuda_march *m, const cuda_march_pass *p, int64_t blocks,
                             cudaStream_t stream);

/* From 3 rows of `stride` in the model's order of components into the march's; leaves the fourth. */
cudaError_t cuda_march_unpack(const cuda_march *m, const float *from, float4 *to, cudaStream_t stream);

#endif
