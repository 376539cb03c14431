/* What the march takes of the CUDA executor: cuda_march.cu. Its state stands node by node, in the march's order: 4
 * numbers each, of which the first three are components along the march's axes: rows, across, march. The fourth of a
 * displacement, and of an internal force, is 1/m; that of a velocity is what move_node needs to know: MARCH_FREE,
 * MARCH_EXTRA, as the last bits; where elements are cut, these are the last of a number, which is what gravity acts on,
 * in parts of the node's mass. The view's pointers and these are the card's, borrowed.
 *
 * Memory has 16 bytes of a node side by side, a piece. In single precision this is all; in double precision the first
 * two numbers of all nodes come before the other two:
 *
 *     float:   x0 y0 z0 w0 | x1 y1 z1 w1 | ...            double:  x0 y0 | x1 y1 | ... | z0 w0 | z1 w1 | ...
 *                                                                  `stride` pieces ...  as many
 */
#ifndef SINEW_CUDA_MARCH_CUH
#define SINEW_CUDA_MARCH_CUH

#include "tled/cuda/cuda_view.cuh"

extern "C" {
#include "tled/cuda/march.h"
#include "tled/cuda/march_cells.h"
}

#ifdef ELEMENT_SINGLE
enum { SINGLE = true };
typedef float4 real4;
typedef float3 real3;
typedef uint32_t march_word; /* the bits of a number */
#else
enum { SINGLE = false };
typedef struct real4 {
    double x, y, z, w;
} real4;
typedef struct real3 {
    double x, y, z;
} real3;
typedef uint64_t march_word;
#endif

enum {
    MARCH_PIECES = sizeof(real4) / 16, /* of a node */
    MARCH_ALONG = 4 / MARCH_PIECES     /* numbers of one */
};

/* Where component a of node 0 stands, or the fourth number, a = 3. */
static __host__ __device__ inline int64_t march_offset(int a, int64_t stride)
{
    return a / MARCH_ALONG * MARCH_ALONG * stride + a % MARCH_ALONG;
}

enum {
    MARCH_FREE = 0,  /* bit MARCH_FREE + a: nothing holds component a */
    MARCH_EXTRA = 3, /* displaced by the script, or forces act on it */
    MARCH_APART = 4, /* it slides on bone: its step is another kernel's; then none of the above */
    MARCH_BITS = 31  /* all of these */
};

/* V/V', by which the march's numbers of a law are multiplied under physical control. */
#define MARCH_LAW (1.f / 64)

/* A march_cell, as kernels read it: 16 bytes at a time. */
template <class R> struct cuda_march_cell {
    R mu, bulk, second, peak;
    march_muscle muscle[2];
    R second_peak, more[3];
    R family[4];
};

/* What holds a cell under physical control, in the march's unit of force: mu and K/V', both times MARCH_LAW; of
 * its modes hourglass_numbers times V, and what of torsion is a strain's own, but for the sum. `bending` is 1 of plain
 * cells. */
template <class R> struct march_hold {
    R mu, press; /* mu: in single precision its log2 */
    R coupling, torsion, corner, bending, own[3];
};

/* Of an axis, with c = 4 h and V' = 64 V: c, V'/c, 1/(3 c^2), 1/V'; V'/c^2, (c_i^2/c_j^2 + c_i^2/c_k^2) - 1. */
template <class R> struct march_side {
    R width, face, thirds, density, squares, own;
};

/* Of laws beside the neo-Hookean, under physical control, times MARCH_LAW in the march's unit of force where they are
 * moduli. Form `first`, with y = x/3: 2 f'(x) = sum of slope[k] y^k; T/T(0) = 1 + sum of shear[k] y^(k + 1), and its
 * slope, d/dx, over V', sum of rise[k] y^k (form_shear.h). Mooney-Rivlin: slope[0] = 2 c01. */
enum { MARCH_POWERS = 5 };
template <class R> struct march_more {
    R slope[MARCH_POWERS], shear[MARCH_POWERS - 1], rise[MARCH_POWERS - 1];
};

/* A family of fibres (fibre.h): 2 k1, in that unit; k2 log2 e, and the most that it may be times Ebar^2; what Ebar has
 * of (tr C - 3)/3 and of c^2 (a0.C a0 - 1); of 2 W', the part of F, and that of F'a0 (x) a0. cos, sin: of two families,
 * of their angle. */
template <class R> struct march_family {
    R stiff, grow, most, around, along, all, own, cos, sin;
};

template <class R> struct cuda_march {
    cuda_view<R> v;
    const march_unit *unit;
    const int32_t *near; /* march's */
    int32_t nears;
    uint32_t *done;   /* units: the last pass that each has made */
    uint32_t *ticket; /* how many units were taken, of all passes */
    int32_t units;
    const uint32_t *word;
    const int32_t *detail, *which;
    const cuda_march_cell<R> *cell;
    int64_t specials;               /* how many of them */
    R law[3];                       /* isotropic: of plain cells mu, K, hourglass */
    R force;                        /* the unit of force, in newtons; isotropic: 1 */
    R weight;                       /* physical: MARCH_LAW in that unit */
    alignas(16) march_hold<R> held; /* physical: of plain cells, as are: */
    alignas(16) march_more<R> more;
    alignas(16) march_family<R> family;
    const uint2 *along, *tip_along; /* march's */
    alignas(16) march_side<R> side[3];
    R slope[3], area[3];  /* element_shape's, along the march's axes; area: in the unit of force */
    R volume;             /* V' */
    int32_t axis[3];      /* of the model: which these are */
    const march_tip *tip; /* march's; NULL: there are none */
    int32_t tip_first;
    const march_cut *cut; /* march's, of so many: */
    int32_t cuts;
};

/* X(NAME, form, families, double): what kernels are compiled for, beside whether there are tips: the neo-Hookean form
 * under isotropic or physical control; and under the latter, where all sides are alike, which saves some operations,
 * other forms, and families of fibres. double: in double precision too. The directions of families, 8 bytes a cell, are
 * not exact enough for that. */
#define MARCHES(X)                                                                                                     \
    X(MARCH_ISOTROPIC, FORM_NEO_HOOKEAN, 0, true)                                                                      \
    X(MARCH_PHYSICAL, FORM_NEO_HOOKEAN, 0, true)                                                                       \
    X(MARCH_CUBES, FORM_NEO_HOOKEAN, 0, true)                                                                          \
    X(MARCH_CUBES_MOONEY_RIVLIN, FORM_MOONEY_RIVLIN, 0, true)                                                          \
    X(MARCH_CUBES_FIRST, FORM_FIRST, 0, true)                                                                          \
    X(MARCH_CUBES_FAMILY, FORM_NEO_HOOKEAN, 1, false)                                                                  \
    X(MARCH_CUBES_FAMILIES, FORM_NEO_HOOKEAN, 2, false)

#define MARCH_ROW(NAME, form, families, doubles) NAME,
typedef enum march_control { MARCHES(MARCH_ROW) MARCH_CONTROLS } march_control; /* the last: no kernel */
#undef MARCH_ROW

#define MARCH_ROW(NAME, form, families, doubles)                                                                       \
    if (k == NAME)                                                                                                     \
        return form;
static constexpr form march_form(march_control k)
{
    MARCHES(MARCH_ROW)
    return FORM_COUNT;
}
#undef MARCH_ROW

#define MARCH_ROW(NAME, form, families, doubles)                                                                       \
    if (k == NAME)                                                                                                     \
        return families;
static constexpr int march_families(march_control k)
{
    MARCHES(MARCH_ROW)
    return 0;
}
#undef MARCH_ROW

#define MARCH_ROW(NAME, form, families, doubles)                                                                       \
    if (k == NAME)                                                                                                     \
        return SINGLE || doubles;
/* Whether there are kernels in this precision. */
static constexpr bool march_has(march_control k)
{
    MARCHES(MARCH_ROW)
    return false;
}
#undef MARCH_ROW

/* The forms that it has kernels for: bit i for form i. */
static constexpr uint32_t march_forms(void)
{
    uint32_t forms = 0;
    for (int k = 0; k < MARCH_CONTROLS; k++)
        forms |= march_has((march_control)k) ? 1u << march_form((march_control)k) : 0;
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
            return march_has((march_control)k) ? (march_control)k : MARCH_CONTROLS;
    return MARCH_CONTROLS;
}

/* What a pass does: v = keep v + push a, with what a step begins and ends; u += dt v. pull: push, of forces in the
 * march's unit. */
template <class R> struct alignas(16) cuda_march_kind {
    R keep, pull, dt, push;
    int32_t what;
};

enum { MARCH_FIRST, MARCH_STEP, MARCH_LAST, MARCH_KINDS };

/* Passes, each of the state that the one before left. */
template <class R> struct cuda_march_pass {
    float4 *state[2],
        *velocity; /* the first pass reads displacements in state[0] and leaves them, or internal forces, in state[1] */
    const double *now; /* the curves' values: `row` of them where the state stands, and so many more for each step */
    cuda_march_kind<R>
        kind[MARCH_KINDS]; /* of the first; of the last, where it `ends` and is not the first; of the others */
    int32_t row, passes, ends;
    int32_t amid;            /* the first ends a step and begins the next, as the others */
    uint32_t number, ticket; /* of the first pass, from 1 on; units taken before */
};

/* Blocks that the card runs at once; 0: it cannot run any, being of before compute capability 9.0. cut: as above. */
template <class R> cudaError_t cuda_march_slots(march_control control, bool cut, int64_t *slots);

/* By so many blocks, no more than the card runs at once; each takes one ticket more than there are units in all. */
template <class R>
cudaError_t cuda_march_start(march_control control, const cuda_march<R> *m, const cuda_march_pass<R> *p, int64_t blocks,
                             cudaStream_t stream);

/* From 3 rows of `stride` in the model's order of components into the march's; leaves the fourth. */
template <class R>
cudaError_t cuda_march_unpack(const cuda_march<R> *m, const R *from, float4 *to, cudaStream_t stream);

#endif
