/* A cycle of multigrid on the card: smooths, goes through the coarser lattices, smooths again; symmetric,
 * so that it can stand in for the inverse in conjugate gradients. A phase ends with a barrier; sums in a
 * row have one order. Everything is static.
 */
#ifndef SINEW_CUDA_CYCLE_CUH
#define SINEW_CUDA_CYCLE_CUH

#include "msds/cuda/cuda_contact.cuh"
#include "msds/cuda/cuda_exact.cuh"

/* block_add of a block in half precision. */
static __device__ inline void half_add(uint4 eight, __half ninth, float4 p, float4 *y)
{
    const float2 a = __half22float2(*(const __half2 *)&eight.x), b = __half22float2(*(const __half2 *)&eight.y);
    const float2 c = __half22float2(*(const __half2 *)&eight.z), d = __half22float2(*(const __half2 *)&eight.w);
    y->x += a.x * p.x + a.y * p.y + b.x * p.z;
    y->y += b.y * p.x + c.x * p.y + c.y * p.z;
    y->z += d.x * p.x + d.y * p.y + __half2float(ninth) * p.z;
}

/* left - matrix z at a node. The matrix is one of half precision, but what it does to a field without strain is exact:
 * differences to the neighbours, and the sum of the row. */
static __device__ inline float4 level_rest(const tissue_level *l, int32_t n, const float4 *z)
{
    const int32_t slice = n / LANES, lane = n % LANES, last = l->start[slice + 1];
    const float4 own = z[n];
    float4 y = {0, 0, 0, 0};
#pragma unroll 4
    for (int32_t slot = l->start[slice]; slot < last; slot++) {
        const int32_t at = slot * LANES + lane;
        half_add(l->eight[at], l->ninth[at], minus(z[l->neighbour[at]], own), &y);
    }
    y = {l->back * y.x, l->back * y.y, l->back * y.z, 0};
    if (l->sums)
        block_add(l->sums + slice * 9 * LANES + lane, own, &y);
    return minus(l->left[n], y);
}

/* A row of weights times a field. */
static __device__ inline float4 weights_sum(const tissue_weights *w, int32_t n, const float4 *field)
{
    const int32_t slice = n / LANES, lane = n % LANES, last = w->start[slice + 1];
    float4 sum = {0, 0, 0, 0};
#pragma unroll 4
    for (int32_t slot = w->start[slice]; slot < last; slot++)
        sum = plus_times(sum, w->weight[slot * LANES + lane], field[w->column[slot * LANES + lane]]);
    return sum;
}

/* On the mesh: without what a node has along its contact's way, where that is prescribed. */
static __device__ inline float4 keep_out(const tissue *t, const tissue_frame *f, const tissue_exact *x, int l,
                                         int32_t n, float4 v)
{
    if (l > 0 || f->penalty || !x->active[n])
        return v;
    const tissue_contact *c = &t->contact[n];
    return contact_add(c, v, -contact_along(c, v));
}

/* The first step from zero, of what is left at a node. */
static __device__ inline void smooth_first(const tissue *t, const tissue_frame *f, const tissue_exact *x, int l,
                                           int32_t n, float4 left)
{
    const tissue_level *v = &x->at[l];
    float4 step = {0, 0, 0, 0};
    block_add(v->inverse + n / LANES * 9 * LANES + n % LANES, left, &step);
    step = {v->take[0] * step.x, v->take[0] * step.y, v->take[0] * step.z, 0};
    step = keep_out(t, f, x, l, n, step);
    v->step[n] = step;
    v->z[0][n] = step;
}

/* A later one, from one z to the other; returns the new z. */
static __device__ inline float4 smooth_node(const tissue *t, const tissue_frame *f, const tissue_exact *x, int l,
                                            int32_t n, int which, const float4 *from, float4 *to)
{
    const tissue_level *v = &x->at[l];
    const float4 rest = keep_out(t, f, x, l, n, level_rest(v, n, from)), before = v->step[n];
    const float keep = v->keep[which], take = v->take[which];
    float4 step = {0, 0, 0, 0};
    block_add(v->inverse + n / LANES * 9 * LANES + n % LANES, rest, &step);
    step = {keep * before.x + take * step.x, keep * before.y + take * step.y, keep * before.z + take * step.z, 0};
    step = keep_out(t, f, x, l, n, step);
    v->step[n] = step;
    const float4 z = plus_times(from[n], 1, step);
    to[n] = z;
    return z;
}

static __device__ inline double dot_of(float4 a, float4 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y + (double)a.z * (double)b.z;
}

/* One step on all nodes; with `sum`, left . z is summed to PART_THIRD. */
static __device__ void smooth(const tissue *t, const tissue_frame *f, const tissue_exact *x, int l, int which, int from,
                              bool sum, grid_scratch *s)
{
    const tissue_level *v = &x->at[l];
    for (int32_t chunk = blockIdx.x; chunk < v->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        double product = 0;
        if (n < v->nodes) {
            const float4 z = smooth_node(t, f, x, l, n, which, v->z[from], v->z[1 - from]);
            product = sum ? dot_of(z, v->left[n]) : 0;
        }
        if (!sum)
            continue;
        product = grid_block_sum(product, s);
        if (threadIdx.x == 0)
            t->part[PART_THIRD * t->chunks + chunk] = product;
    }
    grid_barrier(t->arrived);
}

/* What is left on level l goes to the next, where the first step is made. */
static __device__ void descend(const tissue *t, const tissue_frame *f, const tissue_exact *x, int l)
{
    const tissue_level *v = &x->at[l], *next = &x->at[l + 1];
    for (int32_t n = blockIdx.x * GRID_THREADS + threadIdx.x; n < v->nodes; n += gridDim.x * GRID_THREADS)
        v->rest[n] = keep_out(t, f, x, l, n, level_rest(v, n, v->z[(SMOOTH - 1) % 2]));
    grid_barrier(t->arrived);
    for (int32_t n = blockIdx.x * GRID_THREADS + threadIdx.x; n < next->nodes; n += gridDim.x * GRID_THREADS) {
        const float4 left = weights_sum(&v->down, n, v->rest);
        next->left[n] = left;
        smooth_first(t, f, x, l + 1, n, left);
    }
    grid_barrier(t->arrived);
}

/* What the next level has found comes in. */
static __device__ void ascend(const tissue *t, const tissue_frame *f, const tissue_exact *x, int l)
{
    const tissue_level *v = &x->at[l];
    float4 *z = v->z[(SMOOTH - 1) % 2];
    for (int32_t n = blockIdx.x * GRID_THREADS + threadIdx.x; n < v->nodes; n += gridDim.x * GRID_THREADS)
        z[n] = keep_out(t, f, x, l, n, plus_times(z[n], 1, weights_sum(&v->up, n, x->at[l + 1].z[FINISHED])));
    grid_barrier(t->arrived);
}

/* The coarsest level, directly: a warp a row. */
static __device__ void solve_coarsest(const tissue *t, const tissue_exact *x)
{
    const tissue_level *v = &x->at[x->count - 1];
    const float *left = (const float *)v->left;
    float *z = (float *)v->z[FINISHED];
    const int32_t lane = threadIdx.x % 32;
    for (int32_t i = blockIdx.x * GRID_WARPS + threadIdx.x / 32; i < x->order; i += gridDim.x * GRID_WARPS) {
        float sum = 0;
        for (int32_t j = lane; j < x->order; j += 32)
            sum += x->coarsest[i * x->order + j] * left[j / 3 * 4 + j % 3];
        for (int width = 1; width < 32; width *= 2)
            sum += __shfl_xor_sync(~0u, sum, width);
        if (lane == 0)
            z[i / 3 * 4 + i % 3] = sum;
    }
    grid_barrier(t->arrived);
}

/* From left on the mesh, where the first step has been made, to z[FINISHED]; left . z is summed to PART_THIRD. */
static __device__ void cycle(const tissue *t, const tissue_frame *f, const tissue_exact *x, grid_scratch *s)
{
    for (int l = 0; l < x->count - 1; l++) {
        for (int i = 1; i < SMOOTH; i++)
            smooth(t, f, x, l, i, (i - 1) % 2, false, s);
        descend(t, f, x, l);
    }
    solve_coarsest(t, x);
    for (int l = x->count - 2; l >= 0; l--) {
        ascend(t, f, x, l);
        for (int i = 0; i < SMOOTH; i++)
            smooth(t, f, x, l, i, (SMOOTH - 1 + i) % 2, l == 0 && i == SMOOTH - 1, s);
    }
}

#endif
