/* What the march takes of the CUDA executor in single precision: cuda_march.cu. Its state stands node by node, in the
 * march's order: 4 floats each, of which the first three are components along the march's axes: rows, across, march.
 * The fourth of a displacement, and of an internal force, is 1/m; that of a velocity is what move_node needs to know:
 * MARCH_FREE, MARCH_EXTRA, as bits; where elements are cut, these are the last of a number, which is what gravity acts
 * on, in parts of the node's mass. The view's pointers and these are the card's, borrowed.
 */
#ifndef SINEW_CUDA_MARCH_CUH
#define SINEW_CUDA_MARCH_CUH

#include "tled/cuda/cuda_view.cuh"

extern "C" {
#include "tled/cuda/march.h"
#include "tled/cuda/march_cells.h"
}

enum {
    MARCH_FREE = 0,  /* bit MARCH_FREE + a: nothing holds component a */
    MARCH_EXTRA = 3, /* displaced by the script, or forces act on it */
    MARCH_APART = 4, /* it slides on bone: its step is another kernel's; then none of the above */
    MARCH_BITS = 31  /* all of these */
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

/* Of laws beside the neo-Hookean, under physical control, times MARCH_LAW in the march's unit of force where they are
 * moduli. Form `first`, with y = x/3: 2 f'(x) = sum of slope[k] y^k; T/T(0) = 1 + sum of shear[k] y^(k + 1), and its
 * slope, d/dx, over V', sum of rise[k] y^k (form_shear.h). Mooney-Rivlin: slope[0] = 2 c01. */
enum { MARCH_POWERS = 5 };
typedef struct march_more {
    float slope[MARCH_POWERS], shear[MARCH_POWERS - 1], rise[MARCH_POWERS - 1];
} march_more;

/* A family of fibres (fibre.h): 2 k1, in that unit; k2 log2 e, and the most that it may be times Ebar^2; what Ebar has
 * of (tr C - 3)/3 and of c^2 (a0.C a0 - 1); of 2 W', the part of F, and that of F'a0 (x) a0. cos, sin: of two families,
 * of their angle. */
typedef struct march_family {
    float stiff, grow, most, around, along, all, own, cos, sin;
} march_family;

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
    int64_t specials;            /* how many of them */
    float law[3];                /* isotropic: of plain cells mu, K, hourglass */
    float force;                 /* the unit of force, in newtons; isotropic: 1 */
    float weight;                /* physical: MARCH_LAW in that unit */
    alignas(16) march_hold held; /* physical: of plain cells, as are: */
    alignas(16) march_more more;
    alignas(16) march_family family;
    const uint2 *along, *tip_along; /* march's */
    alignas(16) march_side side[3];
    float slope[3], area[3]; /* element_shape's, along the march's axes; area: in the unit of force */
    float volume;            /* V' */
    int32_t axis[3];         /* of the model: which these are */
    const march_tip *tip;    /* march's; NULL: there are none */
    int32_t tip_first;
    const march_cut *cut; /* march's, of so many: */
    int32_t cuts;
} cuda_march;

/* X(NAME, form, families): what kernels are compiled for, beside whether there are tips: the neo-Hookean form under
 * isotropic or physical control; and under the latter, where all sides are alike, which saves some operations, other
 * forms, and families of fibres. */
#define MARCHES(X)                                                                                                     \
    X(MARCH_ISOTROPIC, FORM_NEO_HOOKEAN, 0)                                                                            \
    X(MARCH_PHYSICAL, FORM_NEO_HOOKEAN, 0)                                                                             \
    X(MARCH_CUBES, FORM_NEO_HOOKEAN, 0)                                                                                \
    X(MARCH_CUBES_MOONEY_RIVLIN, FORM_MOONEY_RIVLIN, 0)                                                                \
    X(MARCH_CUBES_FIRST, FORM_FIRST, 0)                                                                                \
    X(MARCH_CUBES_FAMILY, FORM_NEO_HOOKEAN, 1)                                                                         \
    X(MARCH_CUBES_FAMILIES, FORM_NEO_HOOKEAN, 2)

#define MARCH_ROW(NAME, form, families) NAME,
typedef enum march_control { MARCHES(MARCH_ROW) MARCH_CONTROLS } march_control; /* the last: no kernel */
#undef MARCH_ROW

#define MARCH_ROW(NAME, form, families)                                                                                \
    if (k == NAME)                                                                                                     \
        return form;
static constexpr form march_form(march_control k)
{
    MARCHES(MARCH_ROW)
    return FORM_COUNT;
}
#undef MARCH_ROW

#define MARCH_ROW(NAME, form, families)                                                                                \
    if (k == NAME)                                                                                                     \
        return families;
static constexpr int march_families(march_control k)
{
    MARCHES(MARCH_ROW)
    return 0;
}
#undef MARCH_ROW

/* The forms that it has kernels for: bit i for form i. */
static constexpr uint32_t march_forms(void)
{
    uint32_t forms = 0;
    for (int k = 0; k < MARCH_CONTROLS; k++)
        forms |= 1u << march_form((march_control)k);
    return forms;
}

static constexpr bool march_cubes(march_control k)
{
    return k >= MARCH_CUBES;
}

/* These, as constants of kernels. */
template <march_control K> struct march_kind {
    static constexpr form FORM = march_form(K);
    static constexpr int FAMILIES = march_families(K);
    static constexpr bool CUBES = march_cubes(K);
};

/* The one that a model takes. families: the most of an element; cut: some elements are cut, of which there are no
 * kernels under isotropic control. */
static inline march_control march_control_of(form which, hourglass_kind kind, const double side[3], int families,
                                             bool cut)
{
    const bool cubes = kind == HOURGLASS_PHYSICAL && side[0] == side[1] && side[1] == side[2];
    if (cut && kind == HOURGLASS_ISOTROPIC)
        return MARCH_CONTROLS;
    for (int k = cubes ? MARCH_CUBES : 0; k < MARCH_CONTROLS; k++)
        if (march_form((march_control)k) == which && march_families((march_control)k) == families &&
            cubes == march_cubes((march_control)k) && (kind == HOURGLASS_ISOTROPIC) == (k == MARCH_ISOTROPIC))
            return (march_control)k;
    return MARCH_CONTROLS;
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
    int32_t amid;            /* the first ends a step and begins the next, as the others */
    uint32_t number, ticket; /* of the first pass, from 1 on; units taken before */
} cuda_march_pass;

/* Blocks that the card runs at once; 0: it cannot run any, being of before compute capability 9.0. cut: as above. */
cudaError_t cuda_march_slots(march_control control, bool cut, int64_t *slots);

/* By so many blocks, no more than the card runs at once; each takes one ticket more than there are units in all. */
cudaError_t cuda_march_start(march_control control, const cuda_march *m, const cuda_march_pass *p, int64_t blocks,
                             cudaStream_t stream);

/* From 3 rows of `stride` in the model's order of components into the march's; leaves the fourth. */
cudaError_t cuda_march_unpack(const cuda_march *m, const float *from, float4 *to, cudaStream_t stream);

#endif
