/* What the CUDA kernels of tled-run see, and the shape of their blocks; the headers of C that they share with the CPU.
 * A view is passed to kernels by value and owns nothing. S is the type of the state's numbers: float or double.
 *
 * Arrays over nodes are in the tiles' order or, where it marches, in the march's, one component after another:
 * component a of node n at a * stride + n. Those of the state alone, displacements, velocities and internal forces, may
 * stand node by node: at offset[a] + n * along.
 */
#ifndef SINEW_CUDA_VIEW_CUH
#define SINEW_CUDA_VIEW_CUH

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern "C" {
#include "base/mem.h"
#include "physics/element_cut.h"
#include "solve/card.h"
#include "tled/cuda/cuda.h"
#include "tled/tiles/tiles.h"
}

#include "solve/start.cuh"
#include "tled/cuda/cuda_forms.cuh"

/* A brick of nodes, one block of threads each. PLACES of nodes in its grid; CELLS: the last cell's place, and one;
 * HALO: the most places around it for a thread; TOGETHER: blocks that a multiprocessor is to have registers for, in
 * single precision. THREADS is a power of 2. */
template <int X, int Y, int Z, int T, int B> struct cuda_brick {
    enum {
        BX = X,
        BY = Y,
        BZ = Z,
        GX = X + 2,
        GY = Y + 2,
        GZ = Z + 2,
        NODES = X * Y * Z,
        PLACES = GX * GY * GZ,
        CELLS = X + GX * (Y + GY * Z) + 1,
        THREADS = T,
        TOGETHER = B,
        OWN = (NODES + T - 1) / T,
        HALO = (PLACES - NODES + T - 1) / T
    };
};
/* The larger, the fewer elements are computed twice; the smaller, the more blocks there are for the whole card. */
typedef enum cuda_size { CUDA_SMALL, CUDA_MIDDLE, CUDA_LARGE, CUDA_SIZES } cuda_size;

/* Calls f with a brick of this size. */
template <class F> static auto with_brick(cuda_size size, F f)
{
    return size == CUDA_LARGE    ? f(cuda_brick<8, 8, 4, 256, 4>())
           : size == CUDA_MIDDLE ? f(cuda_brick<8, 4, 4, 128, 1>())
                                 : f(cuda_brick<4, 4, 4, 128, 1>());
}

typedef struct cuda_kind { /* a volume */
    double c[FORM_NUMBERS], density, hourglass[HOURGLASS_NUMBERS], twists, peak;
    int32_t contract; /* its curve, or -1 */
} cuda_kind;

typedef struct cuda_mixed {                                                       /* a cell mixed of two volumes */
    double c[FORM_NUMBERS], density, hourglass[HOURGLASS_NUMBERS], twists, share; /* share: of the second volume */
    int32_t mix;                                                                  /* the second volume */
} cuda_mixed;

/* Of a volume, for kernels with fibres (physics/fibre.h, physics/muscle_curves.h). */
template <class R> struct cuda_fibres {
    R k1, k2, kappa;                       /* of a family */
    R c, all, along, both;                 /* of the law fung: fibre_fung */
    R less, passive, stiffening, straight; /* of its muscle: muscle_curves */
    R spring;                              /* in series with it, Pa: muscle_series */
    double peak, optimum, fastest;         /* Pa, 1, 1/s */
    int32_t contract;                      /* its curve, or -1 */
    int32_t families, is_fung;             /* how many; whether it is */
    int32_t curved, serial;                /* whether the muscle has curves of its own; a spring */
};

template <class S> struct cuda_view {
    const tile *tiles;
    const uint32_t *node_info, *cell;
    const int32_t *halo_node;
    const uint16_t *halo_place;
    const float *fibre, *share; /* share: or NULL, as are: */
    const float *mixfibre;
    const int32_t *order; /* the tiles' */
    const int32_t *mixed; /* cells: which of: */
    const cuda_mixed *mixture;
    const tile_extra *extra;
    const int32_t *force_curve, *force_spring;
    const double *force_share;
    const S *mass_inverse;
    const cuda_kind *kind;
    const S *law; /* volumes x a law's numbers */
    int64_t stride;
    int64_t offset[3], along, mass_along;    /* mass_along: of mass_inverse */
    int32_t nodes, extras, volumes, gravity; /* gravity: its curve, or -1 */
    double side[3];
    const int32_t *list; /* the tiles'; NULL: none is listed */
    const uint4 *pull;   /* rows of listed nodes: 8 numbers of 16 bits */
    /* Of models with fibres, else NULL. Two families at an angle have directions of their own: component a of family k
     * in row r is family[(3 k + a) directions + r], r as of `fibre`. */
    const cuda_fibres<S> *fibres; /* volumes */
    const S *family, *mixfamily;  /* or NULL: no volume has such */
    int64_t directions;
    S *contractile, *mixcontractile; /* cells, which steps move on; or NULL: no muscle has a spring */
    /* Of models with cut elements (tled/problem/cut.h), else NULL. */
    const int32_t *cut;   /* cells: which row of moments is its own, or -1 */
    const float *moments; /* rows of CUT_MOMENTS */
    const S *weight;      /* nodes: what gravity acts on, in parts of their mass */
};

/* Whether a cell is cut, and its moments; nothing, in kernels that do not look for it. */
template <bool CUT> struct cuda_part {
};
template <> struct cuda_part<true> {
    bool is;
    element_cut c;
};

template <bool CUT, class S> static __device__ cuda_part<CUT> cuda_part_of(const cuda_view<S> &v, int64_t cell)
{
    if constexpr (CUT) {
        const int32_t row = v.cut[cell];
        if (row < 0)
            return {false, {0, 0, 0, 0, 0, 0}};
        const float *m = v.moments + CUT_MOMENTS * (int64_t)row;
        return {true, {m[0], m[1], m[2], m[3], m[4], m[5]}};
    } else {
        return {};
    }
}

/* Where a tile's list begins, or -1; nothing, where no tile is listed. */
template <bool LISTED> struct cuda_list {
};
template <> struct cuda_list<true> {
    int32_t pull;
};

/* T: cuda_tiles, or cuda_any_tiles. */
template <class T, class S> static __device__ cuda_list<T::LISTED> cuda_list_of(const cuda_view<S> &v, int64_t which)
{
    if constexpr (!T::LISTED)
        return {};
    else if (T::ASKS && !v.list)
        return {-1};
    else
        return {v.list[which]};
}

/* Number i of a row. */
static __device__ __forceinline__ uint32_t cuda_entry(const uint4 &row, int i)
{
    const uint32_t two = i < 2 ? row.x : i < 4 ? row.y : i < 6 ? row.z : row.w;
    return i % 2 ? two >> 16 : two & 0xffff;
}

/* A node's three components along the model's axes: at one go where they stand node by node, as they may in single
 * precision. ROWS: they stand so, whatever the view says. */
template <bool ROWS, class S> static __device__ void cuda_three(const cuda_view<S> &v, const S *from, int64_t n, S *to)
{
    if constexpr (!ROWS && sizeof(S) == sizeof(float)) {
        if (v.along == 4) {
            const float4 x = ((const float4 *)from)[n];
            for (int a = 0; a < 3; a++)
                to[a] = v.offset[a] == 0 ? x.x : v.offset[a] == 1 ? x.y : x.z;
            return;
        }
    }
    for (int a = 0; a < 3; a++)
        to[a] = from[ROWS ? a * v.stride + n : v.offset[a] + n * v.along];
}

/* Loads the displacements of all places of a tile's grid that nodes have; to: 3 x PLACES. All that a thread loads is on
 * its way at once: first where, then what. ROWS: also, the tiles' order is the nodes'. */
template <class G, bool ROWS, class S>
static __device__ void cuda_load(const cuda_view<S> &v, const tile &t, const S *u, S *to)
{
    constexpr int OWN = G::OWN, HALO = G::HALO;
    int32_t node[OWN + HALO], place[OWN + HALO];
    S value[3 * (OWN + HALO)] = {};
#pragma unroll
    for (int k = 0; k < OWN + HALO; k++) {
        const int i = (int)threadIdx.x + (k < OWN ? k : k - OWN) * G::THREADS;
        node[k] = -1;
        if (k < OWN && i < t.nodes) {
            node[k] = ROWS || !v.order ? t.node + i : v.order[t.node + i];
            place[k] = v.node_info[node[k]] & TILE_PLACE;
        }
        if (k >= OWN && i < t.halos)
            node[k] = v.halo_node[t.halo + i], place[k] = v.halo_place[t.halo + i];
    }
#pragma unroll
    for (int k = 0; k < OWN + HALO; k++)
        if (node[k] >= 0)
            cuda_three<ROWS>(v, u, node[k], &value[3 * k]);
#pragma unroll
    for (int k = 0; k < OWN + HALO; k++)
#pragma unroll
        for (int a = 0; a < 3; a++)
            if (node[k] >= 0)
                to[a * G::PLACES + place[k]] = value[3 * k + a];
}

/* Where corner c of a cell lies, from its low corner; VTK order. */
template <class G> static __device__ constexpr int cuda_corner(int c)
{
    return (c == 1 || c == 2 || c == 5 || c == 6) + G::GX * (c == 2 || c == 3 || c == 6 || c == 7) +
           G::GX * G::GY * (c >= 4);
}

/* One component at a cell's corners. */
template <class G, class S> static __device__ element_corners cuda_corners(const S *u, int place)
{
    const S *at = u + place;
    element_corners c = {{at[cuda_corner<G>(0)], at[cuda_corner<G>(1)], at[cuda_corner<G>(2)], at[cuda_corner<G>(3)],
                          at[cuda_corner<G>(4)], at[cuda_corner<G>(5)], at[cuda_corner<G>(6)], at[cuda_corner<G>(7)]}};
    return c;
}

/* What the script does to a node whose TILE_EXTRA is set. */
template <class S> static __device__ const tile_extra *cuda_extra(const cuda_view<S> &v, int32_t node)
{
    int32_t low = 0, high = v.extras - 1;
    while (low < high) {
        int32_t middle = (low + high) / 2;
        if (v.extra[middle].node < node)
            low = middle + 1;
        else
            high = middle;
    }
    return &v.extra[low];
}

/* What entry k of the table of forces adds to component a (N) of the force on its node, displaced by u: loads.h. */
template <class S>
static __device__ double cuda_force(const cuda_view<S> &v, int32_t k, const double *now, int a, double u)
{
    const int32_t spring = v.force_spring[k];
    const double less = spring < 0 ? 0 : now[3 * spring + a] * u;
    return v.force_share[k] * (now[3 * v.force_curve[k] + a] - less);
}

/* What look() answers, found on the device: cuda_look.cu. */
template <class S> struct cuda_look {
    cuda_view<S> view;
    cuda_size size;                                                                    /* the bricks */
    int64_t count;                                                                     /* tiles */
    const S *displacement, *velocity, *internal, *saved_displacement, *saved_internal; /* the last two: or NULL */
    const double *now;                                                                 /* the curves' values */
    tled_question question;
    void *parts; /* cuda_look_bytes of them */
    form which;  /* of the laws */
    hourglass_kind control;
    const cuda_fibres<double> *fibres; /* volumes, where the view has them; else NULL */
};

size_t cuda_look_bytes(int64_t tiles);

/* Starts the work on the stream; *sums (on the device) gets the answer, with cells for elements. */
template <class S> cudaError_t cuda_look_start(const cuda_look<S> *l, tled_sums *sums, cudaStream_t stream);

/* The first fields of the table, which the kernels know: nodes x 3, as the view says. */
enum { CUDA_STEPPED = TLED_VELOCITY + 1 };

/* Arrays over nodes that are copied into rows: these fields, then the internal forces. */
enum { CUDA_SAVED = CUDA_STEPPED + 1 };
template <class S> struct cuda_saved {
    const S *from[CUDA_SAVED]; /* or NULL: not that one */
    S *to[CUDA_SAVED];
};

template <class S> cudaError_t cuda_save_start(const cuda_view<S> *v, const cuda_saved<S> *saved, cudaStream_t stream);

/* Has the card load the code of looks and of what is saved. */
void cuda_look_load(void);

#endif
