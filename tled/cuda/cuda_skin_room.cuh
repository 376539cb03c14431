/* What skin that touches itself works in on a card: what the kernel of cuda_skin.cuh sees, and how its threads, warps
 * and blocks add up and wait for each other. Included by cuda_skin_find.cuh and cuda_skin_solve.cuh alone.
 *
 * Numbers that one launch leaves for the next stand twice: a launch reads those of its parity, and fills the others.
 */
#ifndef SINEW_CUDA_SKIN_ROOM_CUH
#define SINEW_CUDA_SKIN_ROOM_CUH

#include "solve/card_layout.cuh"
#include "tled/cuda/cuda_ptx.cuh"
#include "tled/cuda/cuda_sliding.cuh"
#include "tled/cuda/cuda_view.cuh"
#include "tled/cuda/cuda_warp.cuh"

extern "C" {
#include "surface/hash.h"
#include "tled/contact/contact_blend.h"
#include "tled/contact/contact_maths.h"
}

enum {
    SKIN_THREADS = 256,
    SKIN_WARPS = SKIN_THREADS / 32,
    SKIN_TOGETHER = 2,                     /* blocks that a multiprocessor is to have registers for */
    SKIN_FIFTHS = 3,                       /* of multiprocessors: the others go on with the pass beside */
    SKIN_TOUCHES = 2,                      /* contacts that are worth a block */
    SKIN_BLOCK_NODES = 96,                 /* the least that a block is worth its waiting for */
    SKIN_BLOCKS = SKIN_THREADS,            /* the most: each is waited for by a thread */
    SKIN_PHASES = 17 + 2 * CONTACT_PASSES, /* no fewer than a launch has */
    SKIN_CHANGES = 3,
    SKIN_SOLIDS = 32,               /* bones that skin may not enter */
    SKIN_LISTED = 128,              /* candidates that a warp sorts */
    SKIN_EACH = 2 * BLEND_MOST / 32 /* of a contact's nodes, a thread's */
};

enum { SKIN_OWN = 1 << 30 };

typedef unsigned long long skin_whole; /* a signed whole number, modulo 2^64 */

/* Of 1: a unit of shares, and, of an element's shortest side, of ways. */
#define SKIN_SHARE_UNIT (1. / (1ll << 40))
#define SKIN_WAY_UNIT   (1. / (1ll << 50))

/* A node about skin. */
typedef struct cuda_skin_node {
    double position[3], mass; /* m, at rest; kg */
    int32_t stand;            /* where it stands */
    uint32_t free;            /* bits: its components that nothing holds */
} cuda_skin_node;

/* Numbers of all, by parity where there are two. */
typedef struct cuda_skin_all {
    double drift[2], solid_drift[2][SKIN_SOLIDS]; /* m: as of self_contact_work */
    sliding_bone solid_was[2][SKIN_SOLIDS];       /* where they were at the end of a step */
    skin_whole most[2], listed[2]; /* bits of the most that a node has come since the launch before, and since the
                                        list, squared, m2 */
    skin_whole longest, widest;    /* bits, m: of boxes */
    double spare;                  /* m: of their margin, in this launch */
    int32_t touches[2], abouts[2], actives[2], finding[2]; /* finding: of these, those that are taken */
    int32_t filled, large, listing;                        /* of the table, and of owners, so far */
    int32_t longer[CONTACT_SIZES];                         /* boxes */
} cuda_skin_all;

/* All on the card, but for c.blend and c.bones, which kernels do not follow. */
typedef struct cuda_skin {
    self_contact c;
    contact_blend blend;  /* of no elements: skin does not move blended */
    const int32_t *entry; /* elements x 8 x BLEND_MOST: the row of its coefficients in each of the maps; SKIN_OWN + k:
                             it is node k of the element's own; -1: it is none of the map's */
    contact_table table;
    int32_t *taken;       /* its cells: as `filled` */
    const int32_t *owner; /* owners: elements that have samples */
    int32_t owners;
    sliding_ground ground; /* its bones */
    const cuda_skin_node *node;
    double *x, *listed;         /* nodes x 3, m */
    double *until, *bone_until; /* samples; solids x samples */
    int32_t *active;            /* samples: those that may touch, in any order */
    touch *found;               /* samples x 2 */
    int32_t *place_node;        /* samples x place_most: what `found` points to */
    double *place_share;
    int32_t place_most;
    skin_whole *sum, *change[SKIN_CHANGES], *fresh; /* nodes: of shares; nodes x 3: ways, and those that came now; 0
                                                       between launches */
    double *moved;                                  /* nodes x 3, m: by what presses */
    int32_t *about;                                 /* nodes: which have contacts, in any order */
    cuda_skin_all *all;
    uint32_t *done; /* blocks: the phases that each has done, of all launches */
} cuda_skin;

typedef struct cuda_touch {
    cuda_view<real> view;
    cuda_skin skin;
    cuda_slide slide;         /* of nodes whose steps are to be taken before */
    real *to, *velocity;      /* to: the next displacements */
    const double *now, *next; /* the curves' values, at the step's two ends */
    double dt;
    uint32_t launch;
    bool anew; /* nothing is known from launches before */
} cuda_touch;

/* ---- of a warp, a block, and all of them */

static __device__ void warp_sums(double *x, int count)
{
#pragma unroll
    for (int with = 16; with; with /= 2)
        for (int a = 0; a < count; a++)
            x[a] += __shfl_xor_sync(~0u, x[a], with);
}

static __device__ skin_whole bits_of(double at_least_0)
{
    return (skin_whole)(uint32_t)__double2hiint(at_least_0) << 32 | (uint32_t)__double2loint(at_least_0);
}

static __device__ double of_bits(skin_whole bits)
{
    return __hiloint2double((int)(uint32_t)(bits >> 32), (int)(uint32_t)bits);
}

/* Raises *to to the bits of the most of all threads of a block, which all call it. */
static __device__ void raise_most(double mine, skin_whole *to)
{
    __shared__ double scratch[SKIN_WARPS];
    const double most = block_most<SKIN_THREADS>(mine, scratch);
    if (threadIdx.x == 0)
        atomicMax(to, bits_of(most));
}

/* Waits until the first so many blocks, which alone call it, have come here; *phase counts. */
static __device__ void all_wait(const cuda_touch &k, uint32_t *phase, unsigned blocks)
{
    const uint32_t word = k.launch * SKIN_PHASES + ++*phase;
    __syncthreads();
    if (blocks == 1)
        return;
    if (threadIdx.x == 0)
        tell_done(&k.skin.done[blockIdx.x], word);
    if (threadIdx.x < blocks)
        while ((int32_t)(hear_done(&k.skin.done[threadIdx.x]) - word) < 0)
            ;
    __syncthreads();
}

static __device__ skin_whole whole_of(double x, double per_unit)
{
    return (skin_whole)llrint(x * per_unit);
}

static __device__ double of_whole(skin_whole x, double unit)
{
    return (double)(long long)x * unit;
}

static __device__ double way_unit(const cuda_skin &s)
{
    return SKIN_WAY_UNIT * s.c.shortest;
}

/* What a warp works in. */
typedef struct skin_desk {
    double share[BLEND_MOST], place[3];
    int32_t slot, cell[32], start[32], filled[32], count, list[SKIN_LISTED];
} skin_desk;

/* Of a warp, among those of the first so many blocks: neighbours are in other blocks. */
static __device__ int32_t warp_number(unsigned blocks)
{
    return (int32_t)(blockIdx.x + blocks * (threadIdx.x / 32));
}

/* Of the threads that a ballot names, those before this one. */
static __device__ int warp_before(unsigned which, int lane)
{
    return __popc(which & ((1u << lane) - 1));
}

/* Takes so many of a list's slots for a warp. Returns the first. */
static __device__ int32_t warp_slots(int32_t *taken, int count, int lane, skin_desk *desk)
{
    __syncwarp();
    if (lane == 0)
        desk->slot = atomicAdd(taken, count);
    __syncwarp();
    return desk->slot;
}

/* ---- nodes of contacts */

/* Those that a thread of a warp has of a contact: both sides'. Loops over them take all, so that what they read is
 * asked for at once: of none, node 0 with share 0. */
typedef struct skin_lever {
    int32_t node[SKIN_EACH];
    double share[SKIN_EACH]; /* 0: there is none; below 0 on the place's side, but where shares are so */
    uint32_t place, free;    /* bits: of the place's side; three a node, as cuda_skin_node.free */
} skin_lever;

static __device__ skin_lever lever_of(const cuda_skin &s, const touch &t, int lane)
{
    const int32_t from = s.c.lever_start[t.sample], own = s.c.lever_start[t.sample + 1] - from;
    const int count = own + (t.sides > 1 ? t.count : 0);
    skin_lever l;
    l.place = l.free = 0;
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++) {
        const int i = lane + 32 * j;
        const bool place = i >= own;
        const int32_t *node = place ? t.node + (i - own) : s.c.lever_node + (from + i);
        const double *share = place ? t.share + (i - own) : s.c.lever_share + (from + i);
        l.node[j] = i < count ? *node : 0;
        l.share[j] = i < count ? *share : 0;
        l.place |= (uint32_t)place << j;
    }
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++) {
        l.share[j] = l.place >> j & 1 ? -l.share[j] : l.share[j];
        l.free |= l.share[j] != 0 ? s.node[l.node[j]].free << 3 * j : 0;
    }
    return l;
}

#endif
