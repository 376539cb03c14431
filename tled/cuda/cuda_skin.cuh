/* Skin that touches itself or bone, on a card: after each pass that begins a step, one kernel finds what touches and
 * puts it back, by contact_maths.h (self_contact.h has the equations). A warp has a sample, or a contact, at a time.
 *
 * Sums over contacts are sums of whole numbers, which do not depend on the order: bytes are the same run after run, and
 * numbers are nearly the processor's. Blocks wait for each other between phases:
 *
 *     slide    nodes that slide on bone take their steps
 *     gather   where nodes are, and how far they have come
 *     list     the table of elements, where nodes have come further than its margin: 6 phases
 *     touch    which samples touch; their nodes' shares
 *     begin    how deep each is, and the first pass of Jacobi's iteration
 *     press    the other passes
 *     rub      friction, in as many
 *     end      displacements and velocities of the nodes about contacts
 *
 * Included by cuda_state.cuh alone.
 */
#ifndef SINEW_CUDA_SKIN_CUH
#define SINEW_CUDA_SKIN_CUH

#include "tled/cuda/cuda_skin_find.cuh"
#include "tled/cuda/cuda_skin_solve.cuh"

/* What the next launch begins with; one thread. */
static __device__ void leave(const cuda_skin &s, int odd, double drift)
{
    s.all->drift[!odd] = drift;
    s.all->most[!odd] = s.all->listed[!odd] = 0;
    s.all->touches[!odd] = s.all->abouts[!odd] = s.all->actives[!odd] = s.all->finding[!odd] = 0;
}

/* And the next list. */
static __device__ void leave_lists(const cuda_skin &s)
{
    s.all->longest = s.all->widest = 0;
    s.all->filled = s.all->large = s.all->listing = 0;
    for (int k = 0; k < CONTACT_SIZES; k++)
        s.all->longer[k] = 0;
}

/* Where skin is, is known once these stand where they are to. */
static __device__ void slide_nodes(const cuda_touch &k, uint32_t *phase)
{
    if (!k.slide.of.count)
        return;
    for (int32_t i = (int32_t)(blockIdx.x * SKIN_THREADS + threadIdx.x); i < k.slide.of.count;
         i += (int32_t)(gridDim.x * SKIN_THREADS))
        slide_node(k.slide, i);
    all_wait(k, phase, gridDim.x);
}

static __global__ void __launch_bounds__(SKIN_THREADS, SKIN_TOGETHER) skin_kernel(const __grid_constant__ cuda_touch k)
{
    __shared__ skin_desk desk[SKIN_WARPS];
    const cuda_skin &s = k.skin;
    const int odd = k.launch & 1;
    const double most = CONTACT_LISTED * s.c.shortest;
    uint32_t phase = 0;
    slide_nodes(k, &phase);
    gather(k, odd);
    all_wait(k, &phase, gridDim.x);
    const double drift = k.anew ? 0 : s.all->drift[odd] + sqrt(of_bits(s.all->most[odd]));
    const bool lists = k.anew || !(of_bits(s.all->listed[odd]) <= most * most);
    if (lists)
        list_elements(k, &phase, &desk[threadIdx.x / 32]);
    if (lists && blockIdx.x == 0 && threadIdx.x == 0)
        leave_lists(s);
    if (blockIdx.x == 0 && threadIdx.x == 0) {
        s.all->spare = contact_spare(&s.c, lists ? 0 : sqrt(of_bits(s.all->listed[odd])));
        leave(s, odd, drift);
    }
    find_active(s, drift, odd);
    all_wait(k, &phase, gridDim.x);
    find_touches(k, drift, odd, &desk[threadIdx.x / 32]);
    all_wait(k, &phase, gridDim.x);
    if (blockIdx.x < solving(s.all->touches[odd]))
        solve(k, odd, &phase);
}

/* How many blocks the card has at once, that are of use. */
static int64_t skin_blocks(const self_contact *c)
{
    int device = 0, processors = 0, together = 0;
    if (cudaGetDevice(&device) != cudaSuccess ||
        cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device) != cudaSuccess ||
        cudaDeviceGetAttribute(&together, cudaDevAttrCooperativeLaunch, device) != cudaSuccess || !together)
        return 1;
    const int64_t useful = (c->nodes + SKIN_BLOCK_NODES - 1) / SKIN_BLOCK_NODES;
    const int64_t part = (SKIN_FIFTHS * processors + 4) / 5, most = part < SKIN_BLOCKS ? part : SKIN_BLOCKS;
    return useful < most ? useful : most;
}

static cudaError_t skin_start(const cuda_touch &k, int64_t blocks, cudaStream_t stream)
{
    return card_start(skin_kernel, {blocks, SKIN_THREADS, 0, stream, blocks > 1}, k);
}

#endif
