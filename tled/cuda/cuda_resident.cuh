/* Many passes in one launch, where every tile has a place on the card at once: a tile keeps its nodes in
 * shared memory from pass to pass, and tells the tiles around it its new displacements by messages. So a step
 * waits for its neighbours alone, and costs one way through the card's L2 cache; a launch a step costs two,
 * and the launch. The same arithmetic in the same order as passes of a launch each (cuda_kernels.cuh): the
 * same bytes. Included by cuda_state.cuh alone.
 *
 * A message is a word of 64 bits, half of it a number (half a number, in double precision), half of it the count of the
 * pass, stored and loaded as one: who sees the count sees the number, without a fence. There are two copies by turns: a
 * tile writes over pass k at k + 2, when it has had k + 1 from each neighbour, which then has read k. Neighbours are
 * each other's: an element that touches nodes of both tiles is computed in both.
 */
#ifndef SINEW_CUDA_RESIDENT_CUH
#define SINEW_CUDA_RESIDENT_CUH

#include "tled/cuda/cuda_kernels.cuh"

enum {
    MESSAGE_WORDS = 3 * sizeof(real) / sizeof(float), /* of a node */
    MESSAGES = 2,
    RESIDENT_CURVES = 32 /* the most, whose values stand in shared memory */
};

typedef struct cuda_resident {
    cuda_pass pass; /* `from` and `velocity` at the start; `to` gets the last displacements; now: of the first pass */
    real *internal; /* where the last pass ends the steps */
    uint64_t *message; /* MESSAGES x MESSAGE_WORDS x stride */
    uint32_t count;    /* of passes before */
    int32_t passes, curves;
    bool starts, ends; /* the first pass begins a step only; the last ends one only */
} cuda_resident;

static __device__ void message_put(uint64_t *to, uint32_t bits, uint32_t count)
{
    relaxed_store(to, (uint64_t)count << 32 | bits);
}

/* A node's displacement, component by component. */
static __device__ void message_send(uint64_t *message, int64_t stride, int32_t n, const float u[3], uint32_t count)
{
    for (int a = 0; a < 3; a++)
        message_put(message + a * stride + n, __float_as_uint(u[a]), count);
}

static __device__ void message_send(uint64_t *message, int64_t stride, int32_t n, const double u[3], uint32_t count)
{
    for (int a = 0; a < 3; a++) {
        message_put(message + 2 * a * stride + n, (uint32_t)__double2loint(u[a]), count);
        message_put(message + (2 * a + 1) * stride + n, (uint32_t)__double2hiint(u[a]), count);
    }
}

static __device__ void message_open(const uint64_t *word, float u[3])
{
    for (int a = 0; a < 3; a++)
        u[a] = __uint_as_float((uint32_t)word[a]);
}

static __device__ void message_open(const uint64_t *word, double u[3])
{
    for (int a = 0; a < 3; a++)
        u[a] = __hiloint2double((int)(uint32_t)word[2 * a + 1], (int)(uint32_t)word[2 * a]);
}

/* The nodes around a tile whose displacements a thread fetches. */
template <class G> struct cuda_halo {
    int32_t node[G::HALO], place[G::HALO];
    int count;
};

template <class G> static __device__ cuda_halo<G> halo_of(const cuda_view<real> &v, const tile &t)
{
    cuda_halo<G> h = {{0}, {0}, 0};
#pragma unroll
    for (int b = 0; b < G::HALO; b++) {
        const int i = (int)threadIdx.x + b * G::THREADS;
        if (i < t.halos) {
            h.node[b] = v.halo_node[t.halo + i];
            h.place[b] = v.halo_place[t.halo + i];
            h.count = b + 1;
        }
    }
    return h;
}

/* Waits until all are there. */
template <class G>
static __device__ void hear(const cuda_halo<G> &h, const uint64_t *message, int64_t stride, uint32_t count, real *u)
{
    uint64_t word[G::HALO][MESSAGE_WORDS];
    bool all;
    do {
        all = true;
#pragma unroll
        for (int b = 0; b < G::HALO; b++)
#pragma unroll
            for (int w = 0; w < MESSAGE_WORDS; w++)
                word[b][w] = b < h.count ? relaxed_load(message + w * stride + h.node[b]) : 0;
#pragma unroll
        for (int b = 0; b < G::HALO; b++)
#pragma unroll
            for (int w = 0; w < MESSAGE_WORDS; w++)
                all = all && (b >= h.count || (uint32_t)(word[b][w] >> 32) == count);
    } while (!all);
#pragma unroll
    for (int b = 0; b < G::HALO; b++)
        if (b < h.count) {
            real at[3];
            message_open(word[b], at);
            for (int a = 0; a < 3; a++)
                u[a * G::PLACES + h.place[b]] = at[a];
        }
}

/* One node of the tile in a pass; f: the elements' pull. */
template <class G, bool CUT>
static __device__ void resident_node(const cuda_view<real> &v, const cuda_resident &r, const cuda_pass &p,
                                     const tile &t, int i, element_vector f, real *grid, own_node<CUT> *own,
                                     uint64_t *message, uint32_t count)
{
    const int32_t n = t.node + i;
    const int place = own->info & TILE_PLACE;
    real u[3] = {grid[place], grid[G::PLACES + place], grid[2 * G::PLACES + place]};
    if (p.what & PASS_INTERNAL) {
        r.internal[n] = f.x;
        r.internal[v.stride + n] = f.y;
        r.internal[2 * v.stride + n] = f.z;
    }
    step_node(v, p, n, f, own, u);
    if (p.what & PASS_BEGIN) {
        message_send(message, v.stride, n, u, count);
        for (int a = 0; a < 3; a++)
            grid[a * G::PLACES + place] = u[a];
    }
}

template <class G, class L, class T>
static __global__ void __launch_bounds__(G::THREADS, together<G, L>())
    resident_kernel(cuda_view<real> v, const __grid_constant__ cuda_resident r, const __grid_constant__ L l)
{
    DYNAMIC_SHARED(double, memory);
    real *u = (real *)(memory + 6 * r.curves), *near = u + 3 * G::PLACES, *force = near + L::NEAR;
    const tile t = v.tiles[blockIdx.x];
    const cuda_list<T::LISTED> list = cuda_list_of<T>(v, blockIdx.x);
    uint32_t first = cell_at(v, t, threadIdx.x);
    const cuda_halo<G> halo = halo_of<G>(v, t);
    own_node<L::CUT> own[G::OWN];
    cuda_pass p = r.pass;
    bring_laws<G>(l, v, &p, near);
    p.now = memory, p.next = memory + 3 * r.curves;
    cuda_load<G, true>(v, t, p.from, u);
#pragma unroll
    for (int k = 0; k < G::OWN; k++)
        own[k] = node_at<L::CUT>(v, p, t, (int)threadIdx.x + k * G::THREADS);
    for (int32_t k = 0; k < r.passes; k++) {
        const bool last = r.ends && k == r.passes - 1;
        const uint32_t count = r.count + (uint32_t)k;
        const double *now = r.pass.now + 3 * (int64_t)k * r.curves;
        uint64_t *message = r.message + (count % MESSAGES) * MESSAGE_WORDS * v.stride;
        p.what = (r.starts && k == 0 ? 0 : PASS_FINISH) | (last ? PASS_INTERNAL : PASS_BEGIN);
        for (int i = threadIdx.x; i < (last ? 3 : 6) * r.curves; i += G::THREADS)
            memory[i] = now[i];
        bring_gravity(v, now, near);
        __syncthreads();
        cell_forces<G, T>(l, v, p, t, first, u, force);
        node_told<T::LISTED> told[G::OWN]; /* from the L1 cache: registers would leave fewer tiles room */
#pragma unroll
        for (int i = 0; i < G::OWN; i++)
            told[i] = node_row(v, t, list, (int)threadIdx.x + i * G::THREADS);
        __syncthreads();
#pragma unroll
        for (int i = 0; i < G::OWN; i++)
            if ((int)threadIdx.x + i * G::THREADS < t.nodes)
                resident_node<G>(v, r, p, t, (int)threadIdx.x + i * G::THREADS,
                                 node_sum<G>(own[i].info, told[i], list, force), u, &own[i], message, count);
        if (k < r.passes - 1)
            hear<G>(halo, message, v.stride, count, u);
        __syncthreads(); /* the curves' values change next */
    }
#pragma unroll
    for (int k = 0; k < G::OWN; k++) {
        const int i = (int)threadIdx.x + k * G::THREADS;
        for (int a = 0; a < 3 && i < t.nodes; a++) {
            r.pass.to[a * v.stride + t.node + i] = u[a * G::PLACES + (own[k].info & TILE_PLACE)];
            r.pass.velocity[a * v.stride + t.node + i] = own[k].velocity[a];
        }
    }
}

template <class G, class L> static size_t resident_shared(int64_t curves)
{
    return 6 * (size_t)curves * sizeof(double) +
           (3 * (size_t)G::PLACES + L::NEAR + 24 * (size_t)G::CELLS) * sizeof(real);
}

/* How many tiles have a place at once; 0: none, or the card starts no kernels that wait for each other. A kernel is
 * allowed what it takes at most: the states that share it have more and fewer curves. */
template <class G, class L, class T> static int64_t resident_places(int64_t curves)
{
    int device = 0, processors = 0, together = 0, each = 0;
    const size_t shared = resident_shared<G, L>(curves);
    const int most = (int)resident_shared<G, L>(RESIDENT_CURVES);
    const bool fits =
        curves <= RESIDENT_CURVES && cudaGetDevice(&device) == cudaSuccess &&
        cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device) == cudaSuccess &&
        cudaDeviceGetAttribute(&together, cudaDevAttrCooperativeLaunch, device) == cudaSuccess && together &&
        cudaFuncSetAttribute(resident_kernel<G, L, T>, cudaFuncAttributeMaxDynamicSharedMemorySize, most) ==
            cudaSuccess &&
        cudaOccupancyMaxActiveBlocksPerMultiprocessor(&each, resident_kernel<G, L, T>, G::THREADS, shared) ==
            cudaSuccess;
    cudaGetLastError(); /* a card with too little shared memory has said so */
    return fits ? (int64_t)each * processors : 0;
}

template <class G, class T, class L>
static cudaError_t resident_start(const L &l, const cuda_view<real> &v, const cuda_resident &r, int64_t tiles,
                                  cudaStream_t s)
{
    return card_start(resident_kernel<G, L, T>, {tiles, G::THREADS, resident_shared<G, L>(r.curves), s, true}, v, r, l);
}

#endif
