/* Frames of the FEM by conjugate gradients on the card: cg.c's, sum for sum, all iterations of a frame in one launch.
 * The search's direction is made where it is multiplied, so an iteration takes two barriers.
 */
#include "msds/cuda/cuda_contact.cuh"

/* What the elements pull node n with at u. */
template <int AHEAD> static __device__ inline float4 pulled_at(const tissue *t, int32_t n)
{
    const int32_t slice = n / LANES, lane = n % LANES, last = t->start[slice + 1];
    float4 y = {0, 0, 0, 0};
    block_add(t->diagonal + slice * 9 * LANES + lane, t->u[n], &y);
#pragma unroll AHEAD
    for (int32_t slot = t->start[slice]; slot < last; slot++)
        block_add(t->block + (int64_t)slot * 9 * LANES + lane, t->u[t->neighbour[slot * LANES + lane]], &y);
    return y;
}

/* The same of the way, which is left + beta times the one before; that of node n to *own. */
template <int AHEAD>
static __device__ inline float4 pulled_along(const tissue *t, int32_t n, float beta, const float4 *before, float4 *own)
{
    const int32_t slice = n / LANES, lane = n % LANES, last = t->start[slice + 1];
    float4 y = {0, 0, 0, 0};
    *own = plus_times(t->left[n], beta, before[n]);
    block_add(t->diagonal + slice * 9 * LANES + lane, *own, &y);
#pragma unroll AHEAD
    for (int32_t slot = t->start[slice]; slot < last; slot++) {
        const int32_t other = t->neighbour[slot * LANES + lane];
        block_add(t->block + (int64_t)slot * 9 * LANES + lane, plus_times(t->left[other], beta, before[other]), &y);
    }
    return y;
}

static __device__ inline float square_of(float4 x)
{
    float square = 0;
    square += x.x * x.x;
    square += x.y * x.y;
    square += x.z * x.z;
    return square;
}

/* Lists the contacts; PART_FIRST: those pressed in the frame before, PART_SECOND: those of them that are listed. */
static __device__ void find_contacts(const tissue *t, const tissue_frame *f, grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        bool held = false, listed = false;
        if (n < t->nodes) {
            const float4 u = t->u[n];
            t->listed[n] = 0;
            held = t->held[n] > 0;
            if (contact_candidate(t, f, n, u)) {
                const double from[3] = {(double)u.x, (double)u.y, (double)u.z};
                contact_consider(t, f, n, from, CONTACT_CLINGING, 0, false);
            }
            listed = t->listed[n] && t->contact[n].force > 0;
        }
        const int before = __syncthreads_count(held), now = __syncthreads_count(listed);
        if (threadIdx.x == 0) {
            t->part[PART_FIRST * t->chunks + chunk] = before;
            t->part[PART_SECOND * t->chunks + chunk] = now;
        }
    }
    grid_barrier(t->arrived);
}

/* Prescribed contact moves the nodes. */
static __device__ void touch(const tissue *t, const tissue_frame *f)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        if (n < t->nodes && t->listed[n] && !f->penalty)
            t->u[n] = contact_add(&t->contact[n], t->u[n], t->contact[n].depth);
    }
    grid_barrier(t->arrived);
}

/* What is left of the load at u; PART_FIRST: its square. */
template <int AHEAD> static __device__ void begin(const tissue *t, const tissue_frame *f, grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        float4 left = {0, 0, 0, 0};
        if (n < t->nodes) {
            const float4 y = pulled_at<AHEAD>(t, n), w = t->weight[n];
            left = minus(w, y);
            if (t->listed[n]) {
                const tissue_contact *c = &t->contact[n];
                left = f->penalty ? contact_add(c, left, t->repulsion[n] * c->depth)
                                  : contact_add(c, left, -contact_along(c, left));
            }
            t->left[n] = left;
            t->way[0][n] = {0, 0, 0, 0};
        }
        grid_lanes_sum(square_of(left), t->part + PART_FIRST * t->chunks + chunk, s);
    }
    grid_barrier(t->arrived);
}

/* PART_SECOND: way . pulled of the elements; PART_THIRD: of the penalty. */
template <int AHEAD>
static __device__ void multiply(const tissue *t, const tissue_frame *f, float beta, const float4 *before, float4 *way,
                                grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        float4 p = {0, 0, 0, 0}, y = p;
        double stiffer = 0;
        float product = 0;
        if (n < t->nodes) {
            y = pulled_along<AHEAD>(t, n, beta, before, &p);
            product = p.x * y.x + p.y * y.y + p.z * y.z;
            if (t->listed[n]) {
                const tissue_contact *c = &t->contact[n];
                const double by = contact_along(c, p);
                y = f->penalty ? contact_add(c, y, t->repulsion[n] * by) : contact_add(c, y, -contact_along(c, y));
                stiffer = f->penalty ? t->repulsion[n] * by * by : 0;
            }
            way[n] = p;
            t->pulled[n] = y;
        }
        grid_lanes_sum(product, t->part + PART_SECOND * t->chunks + chunk, s);
        stiffer = f->penalty ? grid_block_sum(stiffer, s) : 0;
        if (threadIdx.x == 0)
            t->part[PART_THIRD * t->chunks + chunk] = stiffer;
    }
    grid_barrier(t->arrived);
}

/* PART_FIRST: the square of what is left. */
static __device__ void advance(const tissue *t, float alpha, const float4 *way, grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        float4 r = {0, 0, 0, 0};
        if (n < t->nodes) {
            const float4 p = way[n], y = t->pulled[n], u = t->u[n];
            r = t->left[n];
            t->u[n] = plus_times(u, alpha, p);
            r = {r.x - alpha * y.x, r.y - alpha * y.y, r.z - alpha * y.z, 0};
            t->left[n] = r;
        }
        grid_lanes_sum(square_of(r), t->part + PART_FIRST * t->chunks + chunk, s);
    }
    grid_barrier(t->arrived);
}

static __device__ double square_of_double(double x, double y, double z)
{
    return x * x + y * y + z * z;
}

/* The forces of contact, for the next frame too, and the squares of what is left, of the load and of the pulls. */
template <int AHEAD> static __device__ void conclude(const tissue *t, const tissue_frame *f, grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        double left[3] = {0, 0, 0}, load[3] = {0, 0, 0}, pulled = 0;
        if (n < t->nodes) {
            const float4 y = pulled_at<AHEAD>(t, n), w = t->weight[n], u = t->u[n];
            const float4 r = minus(w, y);
            left[0] = (double)r.x, left[1] = (double)r.y, left[2] = (double)r.z;
            load[0] = (double)w.x, load[1] = (double)w.y, load[2] = (double)w.z;
            pulled = square_of_double((double)y.x, (double)y.y, (double)y.z);
            if (t->listed[n]) {
                tissue_contact *c = &t->contact[n];
                const double gone = c->way[0] * ((double)u.x - c->from[0]) + c->way[1] * ((double)u.y - c->from[1]) +
                                    c->way[2] * ((double)u.z - c->from[2]);
                c->force = f->penalty ? t->repulsion[n] * (c->depth - gone) : -contact_along(c, r);
                for (int a = 0; a < 3; a++)
                    left[a] += c->force * c->way[a], load[a] += c->force * c->way[a];
            }
            contact_hold(t, n);
            t->v[n] = {0, 0, 0, 0};
        }
        const double sum[] = {grid_block_sum(square_of_double(left[0], left[1], left[2]), s),
                              grid_block_sum(square_of_double(load[0], load[1], load[2]), s),
                              grid_block_sum(pulled, s)};
        for (int i = 0; i < 3 && threadIdx.x == 0; i++)
            t->part[(PART_LEFT + i) * t->chunks + chunk] = sum[i];
        sight_parts(t, f, chunk, n < t->nodes ? t->u[n] : float4{0, 0, 0, 0}, s);
    }
    grid_barrier(t->arrived);
}

static __device__ double total(const tissue *t, tissue_part which, grid_scratch *s)
{
    return grid_total(t->part + which * t->chunks, t->chunks, s);
}

/* cg_solve. What is summed after a barrier is summed by every block, in the same order; no part
 * is filled again before another barrier. */
template <int AHEAD>
static __device__ void solve(const tissue *t, const tissue_frame *f, int32_t iterations, grid_scratch *s)
{
    float beta = 0;
    touch(t, f);
    begin<AHEAD>(t, f, s);
    double squared = total(t, PART_FIRST, s);
    for (int32_t i = 0; i < iterations && squared > 0; i++) {
        float4 *before = t->way[i % 2], *way = t->way[1 - i % 2];
        multiply<AHEAD>(t, f, beta, before, way, s);
        const double curvature = total(t, PART_SECOND, s) + total(t, PART_THIRD, s);
        if (!(curvature > 0))
            break;
        advance(t, (float)(squared / curvature), way, s);
        const double next = total(t, PART_FIRST, s);
        beta = (float)(next / squared);
        squared = next;
    }
    conclude<AHEAD>(t, f, s);
}

template <int AHEAD, int BLOCKS>
static __global__ void __launch_bounds__(GRID_THREADS, BLOCKS) fem_kernel(tissue t, tissue_frame f)
{
    __shared__ grid_scratch scratch;
    grid_scratch *s = &scratch;
    int32_t count = f.count;
    find_contacts(&t, &f, s);
    if (total(&t, PART_SECOND, s) < total(&t, PART_FIRST, s) &&
        count > 1) { /* let go of: tissue may come after the probe */
        solve<AHEAD>(&t, &f, count / 2, s);
        find_contacts(&t, &f, s);
        count -= count / 2;
    }
    solve<AHEAD>(&t, &f, count, s);
    if (blockIdx.x == 0) {
        const double left = total(&t, PART_LEFT, s);
        const double load = fmax(t.slight, fmax(total(&t, PART_LOAD, s), total(&t, PART_PULLS, s)));
        sight_sum(&t, load > 0 ? sqrt(left / load) : 0, 0, s);
    }
}

static const void *kernel_of(const tissue *t, int processors)
{
    return t->chunks <= 2 * processors ? (const void *)fem_kernel<6, 2> : (const void *)fem_kernel<2, 6>;
}

cudaError_t tissue_fem_start(const tissue *t, const tissue_frame *f, cudaStream_t stream)
{
    return tissue_start(TISSUE_FEM, kernel_of, t, f, NULL, t->chunks, stream);
}
