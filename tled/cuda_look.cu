/* What the watch wants to know of a state, found where it is: watch.c's sums over elements and nodes, in double whatever
 * the state is in, in a fixed order. Kernels of blocks leave parts, a last one adds them up.
 */
extern "C" {
#include "tled/stability.h"
}
#include "tled/cuda_view.cuh"

enum {
    NODE_THREADS = 256,
    SUM_THREADS = 256,
    SOLVERS = 132 /* blocks of matrices_kernel: what an H200 has room for */
};

typedef struct look_nodes { /* of a block; tled_sums' */
    double kinetic, acceleration, speed, moved, mass, stiffness, inertia, largest;
} look_nodes;

typedef struct look_cells { /* of a tile */
    double strain;
    double frequency, proven;       /* as in `highest`: the limit, and what is proven */
    int32_t frequency_cell, broken; /* cells, or -1 */
} look_cells;

static int64_t node_blocks(int64_t nodes)
{
    return (nodes + NODE_THREADS - 1) / NODE_THREADS;
}

static size_t cells_bytes(int64_t tiles)
{
    return ((size_t)tiles * sizeof(look_cells) + 255) / 256 * 256;
}

size_t cuda_look_bytes(int64_t tiles, int64_t nodes)
{
    return cells_bytes(tiles) + (size_t)node_blocks(nodes) * sizeof(look_nodes);
}

/* A sum, or with `most` the largest, over a block's threads, in one order; all get it. scratch: a number a thread. */
template <int THREADS> static __device__ double block_sum(double x, bool most, double *scratch)
{
    __syncthreads();
    scratch[threadIdx.x] = x;
    for (int half = THREADS / 2; half; half /= 2) {
        __syncthreads();
        if (threadIdx.x < half) {
            double a = scratch[threadIdx.x], b = scratch[threadIdx.x + half];
            scratch[threadIdx.x] = most ? fmax(a, b) : a + b;
        }
    }
    __syncthreads();
    return scratch[0];
}

/* The least of what threads say, or INT32_MAX where none does. */
static __device__ int block_least(int mine, int *shared)
{
    __syncthreads();
    if (threadIdx.x == 0)
        *shared = INT32_MAX;
    __syncthreads();
    if (mine != INT32_MAX)
        atomicMin(shared, mine);
    __syncthreads();
    return *shared;
}

/* What a thread's cell is made of, and how it is deformed. */
typedef struct one_cell {
    cuda_mixed own;
    element_tensor h;
    element_fibre fibre, mixfibre;
    double hourglass; /* its energy */
} one_cell;

/* along: over cells that may contract, or NULL; share: of the tissue that is of this kind. */
template <class S>
static __device__ element_fibre look_fibre(const cuda_look<S> &l, const tile &t, int i, const float *along,
                                           const cuda_kind &kind, double share)
{
    element_fibre fibre = {{0, 0, 0}, 0};
    if (i >= t.fibred || !along || kind.contract < 0)
        return fibre;
    along += 3 * (int64_t)(t.direction + i);
    fibre.along.x = along[0], fibre.along.y = along[1], fibre.along.z = along[2];
    fibre.tension = share * (kind.peak * l.now[3 * kind.contract]);
    return fibre;
}

template <class G, class S> static __device__ one_cell cell_of(const cuda_look<S> &l, const tile &t, int i, const S *u)
{
    const cuda_view<S> &v = l.view;
    const uint32_t cell = v.cell[t.cell + i];
    const int place = cell & TILE_PLACE;
    const cuda_kind &kind = v.kind[cell >> TILE_VOLUME];
    const int32_t mixed = v.mixed ? v.mixed[t.cell + i] : -1;
    const element_shape shape = element_box(v.side[0], v.side[1], v.side[2]);
    element_modes x = element_modes_of(cuda_corners<G>(u, place));
    element_modes y = element_modes_of(cuda_corners<G>(u + G::PLACES, place));
    element_modes z = element_modes_of(cuda_corners<G>(u + 2 * G::PLACES, place));
    one_cell c;
    c.own = {kind.mu, kind.bulk, kind.density, kind.hourglass, 0, (int32_t)(cell >> TILE_VOLUME)};
    if (mixed >= 0)
        c.own = v.mixture[mixed];
    c.h = element_gradient(x, y, z, shape.slope);
    c.fibre = look_fibre(l, t, i, v.fibre, kind, 1 - c.own.share);
    c.mixfibre = look_fibre(l, t, i, mixed < 0 ? NULL : v.mixfibre, v.kind[c.own.mix], c.own.share);
    c.hourglass = element_hourglass_energy(x, c.own.hourglass) + element_hourglass_energy(y, c.own.hourglass) +
                  element_hourglass_energy(z, c.own.hourglass);
    return c;
}

/* Its strain energy; not finite where the cell is broken. */
template <class S> static __device__ double strain_of(const cuda_look<S> &l, const tile &t, int i, const one_cell &c)
{
    const cuda_view<S> &v = l.view;
    const double energy = element_energy(c.h, c.own.mu, c.own.bulk);
    if (!(1 + element_dilation(c.h) > 0) || !isfinite(energy) || !isfinite(c.hourglass))
        return INFINITY;
    return (v.share ? (double)v.share[t.cell + i] : 1) * (energy * v.side[0] * v.side[1] * v.side[2] + c.hourglass);
}

/* What a tile's block knows of its highest frequency so far. */
typedef struct highest {
    double limit, proven; /* no cell is past limit; one reaches proven, or that is the one at rest */
    int32_t cell;         /* whose the limit is, or -1: that at rest */
} highest;

/* Raises the limit to the highest bound of those past it. */
template <int THREADS>
static __device__ void raise_by_bounds(stability_range range, bool past, int32_t cell, highest *h, double *scratch,
                                       int *least)
{
    const double bound = isnan(range.high) ? INFINITY : range.high;
    h->proven = fmax(block_sum<THREADS>(past ? range.low : 0, true, scratch), h->proven);
    h->limit = block_sum<THREADS>(past ? bound : 0, true, scratch);
    h->cell = block_least(past && bound == h->limit ? cell : INT32_MAX, least);
}

/* Strain energies, what is broken, and bounds of frequencies; no matrices, which take a thread nearly twice the registers. */
template <class G, class S>
static __global__ void __launch_bounds__(G::THREADS, 512 / G::THREADS)
    cells_kernel(const __grid_constant__ cuda_look<S> l, look_cells *out)
{
    __shared__ S u[3 * G::PLACES];
    __shared__ double scratch[G::THREADS];
    __shared__ int least;
    const tile t = l.view.tiles[blockIdx.x];
    cuda_load<G, false>(l.view, t, l.displacement, u);
    __syncthreads();
    highest h = {l.question.rest, l.question.rest, -1};
    double strain = 0;
    int broken = INT32_MAX;
    for (int base = 0; base < t.cells; base += G::THREADS) {
        const int i = base + (int)threadIdx.x;
        const bool mine = i < t.cells && l.view.cell[t.cell + i] >> TILE_OWN & 1;
        stability_range range = {0, 0};
        double own = 0;
        if (mine) {
            const one_cell c = cell_of<G>(l, t, i, u);
            own = strain_of(l, t, i, c);
            range = stability_range_of(c.own.mu, c.own.bulk, c.own.density, l.view.side, c.h, c.fibre, c.mixfibre);
        }
        const bool whole = own < INFINITY, past = mine && whole && !(range.high <= h.limit);
        if (!whole && broken == INT32_MAX)
            broken = t.cell + i;
        strain += whole ? own : 0;
        if (__syncthreads_or(past))
            raise_by_bounds<G::THREADS>(range, past, t.cell + i, &h, scratch, &least);
    }
    strain = block_sum<G::THREADS>(strain, false, scratch);
    broken = block_least(broken, &least);
    if (threadIdx.x == 0)
        out[blockIdx.x] = {strain, h.limit, h.proven, h.cell, broken == INT32_MAX ? -1 : broken};
}

/* Some thread's matrix reaches past the limit: raises it by halving until it is the highest, or too high by `raise` at most. */
template <int THREADS>
static __device__ void raise_limit(const step_matrix *a, bool past, double raise, int32_t cell, highest *h,
                                   double *scratch, int *least)
{
    double low = h->limit, high = block_sum<THREADS>(past ? stability_bound(a) : 0, true, scratch);
    const double gap = fmax(raise - 1, 1e-13);
    high = fmax(high, low);
    bool at_low = past;
    for (int i = 0; i < 100 && high - low > gap * low; i++) {
        double middle = low + (high - low) / 2;
        bool mine = past && !stability_below(a, middle);
        if (__syncthreads_or(mine)) {
            low = middle;
            at_low = mine;
        } else {
            high = middle;
        }
    }
    int32_t which = block_least(at_low ? cell : INT32_MAX, least);
    h->limit = high;
    h->cell = which;
}

/* The frequency of a tile by its cells' matrices. */
template <class G, class S>
static __device__ void solve_tile(const cuda_look<S> &l, const tile &t, look_cells *out, S *u, double *scratch,
                                  int *least)
{
    highest h = {l.question.rest, 0, -1};
    __syncthreads();
    cuda_load<G, false>(l.view, t, l.displacement, u);
    __syncthreads();
    for (int base = 0; base < t.cells; base += G::THREADS) {
        const int i = base + (int)threadIdx.x;
        bool past = i < t.cells && l.view.cell[t.cell + i] >> TILE_OWN & 1;
        step_matrix a;
        if (past) {
            const one_cell c = cell_of<G>(l, t, i, u);
            past = strain_of(l, t, i, c) < INFINITY;
            stability_matrix(c.own.mu, c.own.bulk, c.own.density, l.view.side, c.h, c.fibre, c.mixfibre, &a);
        }
        past = past && !stability_below(&a, h.limit);
        if (__syncthreads_or(past))
            raise_limit<G::THREADS>(&a, past, l.question.raise, t.cell + i, &h, scratch, least);
    }
    if (threadIdx.x == 0) {
        out->frequency = h.limit;
        out->frequency_cell = h.cell;
    }
}

/* The highest frequency that a cell of any tile is known to reach. */
template <int THREADS>
static __device__ double proven_of_all(const look_cells *cells, int64_t tiles, double rest, double *scratch)
{
    double proven = rest;
    for (int64_t i = threadIdx.x; i < tiles; i += THREADS)
        proven = fmax(proven, cells[i].proven);
    return block_sum<THREADS>(proven, true, scratch);
}

/* Goes through tiles, every gridDim.x-th, for those whose limit is past `raise` times what some tile is known to reach: others' limits
 * may stay, for if one of them is the highest of all, it is too high by `raise` at most. Where no tile is known to pass the frequency
 * at rest, it is for all that may. */
template <class G, class S>
static __global__ void __launch_bounds__(G::THREADS)
    matrices_kernel(const __grid_constant__ cuda_look<S> l, look_cells *out)
{
    __shared__ S u[3 * G::PLACES];
    __shared__ double scratch[G::THREADS];
    __shared__ int least;
    const int64_t stride = gridDim.x;
    const double rest = l.question.rest, proven = proven_of_all<G::THREADS>(out, l.count, rest, scratch);
    const double enough = proven > rest ? l.question.raise * proven : rest;
    for (int64_t base = blockIdx.x; base < l.count; base += G::THREADS * stride) {
        const int64_t own = base + threadIdx.x * stride;
        int next = own < l.count && out[own].frequency > enough ? (int)threadIdx.x : INT32_MAX;
        for (int which; (which = block_least(next, &least)) != INT32_MAX;) {
            const int64_t at = base + which * stride;
            solve_tile<G>(l, l.view.tiles[at], &out[at], u, scratch, &least);
            next = next == which ? INT32_MAX : next;
        }
    }
}

template <class S> static __device__ void look_at_node(const cuda_look<S> &l, int32_t n, look_nodes *to)
{
    const cuda_view<S> &v = l.view;
    const uint32_t info = v.node_info[n];
    const double mass = 1 / (double)v.mass_inverse[n * v.mass_along];
    double outside[3] = {0, 0, 0}, square = 0;
    for (int a = 0; a < 3 && v.gravity >= 0; a++)
        outside[a] = mass * l.now[3 * v.gravity + a];
    if (info >> TILE_EXTRA & 1) {
        const tile_extra *x = cuda_extra(v, n);
        for (int32_t k = x->force; k < x->force + x->forces; k++)
            for (int a = 0; a < 3; a++)
                outside[a] += v.force_share[k] * l.now[3 * v.force_curve[k] + a];
    }
    for (int a = 0; a < 3; a++) {
        const int64_t at = v.offset[a] + n * v.along, kept = a * v.stride + n;
        const double u = l.displacement[at], speed = l.velocity[at], drive = mass * speed * speed;
        const double gap = outside[a] - l.internal[at];
        to->kinetic += drive / 2;
        square += u * u;
        if (!(info >> (TILE_FREE + a) & 1))
            continue;
        to->acceleration += gap * gap / mass;
        to->speed += drive;
        if (l.kept_displacement) {
            const double du = u - l.kept_displacement[kept];
            to->stiffness += du * (l.internal[at] - (double)l.kept_internal[kept]);
            to->inertia += mass * du * du;
        }
    }
    to->mass += mass;
    to->moved += mass * square;
    to->largest = fmax(to->largest, square);
}

/* Sums over a block's threads; thread 0's is good. */
template <int THREADS> static __device__ look_nodes sum_nodes(look_nodes x, double *scratch)
{
    look_nodes s;
    s.kinetic = block_sum<THREADS>(x.kinetic, false, scratch);
    s.acceleration = block_sum<THREADS>(x.acceleration, false, scratch);
    s.speed = block_sum<THREADS>(x.speed, false, scratch);
    s.moved = block_sum<THREADS>(x.moved, false, scratch);
    s.mass = block_sum<THREADS>(x.mass, false, scratch);
    s.stiffness = block_sum<THREADS>(x.stiffness, false, scratch);
    s.inertia = block_sum<THREADS>(x.inertia, false, scratch);
    s.largest = block_sum<THREADS>(x.largest, true, scratch);
    return s;
}

template <class S> static __global__ void __launch_bounds__(NODE_THREADS) nodes_kernel(cuda_look<S> l, look_nodes *out)
{
    __shared__ double scratch[NODE_THREADS];
    const int32_t n = (int32_t)(blockIdx.x * NODE_THREADS + threadIdx.x);
    look_nodes mine = {0};
    if (n < l.view.nodes)
        look_at_node(l, n, &mine);
    mine = sum_nodes<NODE_THREADS>(mine, scratch);
    if (threadIdx.x == 0)
        out[blockIdx.x] = mine;
}

/* One block adds up all parts, in the order of its threads' shares. */
static __global__ void __launch_bounds__(SUM_THREADS)
    sums_kernel(const look_cells *cells, int64_t tiles, const look_nodes *nodes, int64_t blocks, double rest,
                tled_sums *out)
{
    __shared__ double scratch[SUM_THREADS];
    __shared__ int least;
    look_nodes mine = {0};
    double strain = 0, frequency = rest;
    int cell = INT32_MAX, broken = INT32_MAX;
    for (int64_t i = threadIdx.x; i < blocks; i += SUM_THREADS) {
        mine.kinetic += nodes[i].kinetic;
        mine.acceleration += nodes[i].acceleration;
        mine.speed += nodes[i].speed;
        mine.moved += nodes[i].moved;
        mine.mass += nodes[i].mass;
        mine.stiffness += nodes[i].stiffness;
        mine.inertia += nodes[i].inertia;
        mine.largest = fmax(mine.largest, nodes[i].largest);
    }
    for (int64_t i = threadIdx.x; i < tiles; i += SUM_THREADS) {
        strain += cells[i].strain;
        if (cells[i].frequency_cell >= 0 && cells[i].frequency > frequency) {
            frequency = cells[i].frequency;
            cell = cells[i].frequency_cell;
        }
        if (cells[i].broken >= 0 && cells[i].broken < broken)
            broken = cells[i].broken;
    }
    mine = sum_nodes<SUM_THREADS>(mine, scratch);
    strain = block_sum<SUM_THREADS>(strain, false, scratch);
    const double highest = block_sum<SUM_THREADS>(frequency, true, scratch);
    cell = block_least(frequency == highest ? cell : INT32_MAX, &least);
    broken = block_least(broken, &least);
    if (threadIdx.x)
        return;
    *out = {mine.kinetic,
            strain,
            mine.acceleration,
            mine.speed,
            mine.moved,
            mine.mass,
            mine.stiffness,
            mine.inertia,
            mine.largest,
            highest,
            cell == INT32_MAX ? -1 : cell,
            broken == INT32_MAX ? -1 : broken};
}

template <class S> cudaError_t cuda_look_start(const cuda_look<S> *l, tled_sums *sums, cudaStream_t stream)
{
    look_cells *cells = (look_cells *)l->parts;
    look_nodes *nodes = (look_nodes *)((char *)l->parts + cells_bytes(l->count));
    const int64_t blocks = node_blocks(l->view.nodes);
    cudaError_t e = with_brick(l->size, [&](auto g) {
        typedef decltype(g) G;
        const int64_t solvers = l->count < SOLVERS ? l->count : SOLVERS;
        const cudaError_t bounds = card_start(cells_kernel<G, S>, {l->count, G::THREADS, 0, stream}, *l, cells);
        return bounds == cudaSuccess ? card_start(matrices_kernel<G, S>, {solvers, G::THREADS, 0, stream}, *l, cells)
                                     : bounds;
    });
    e = e == cudaSuccess ? card_start(nodes_kernel<S>, {blocks, NODE_THREADS, 0, stream}, *l, nodes) : e;
    return e == cudaSuccess ? card_start(sums_kernel, {1, SUM_THREADS, 0, stream}, cells, l->count, nodes, blocks,
                                         l->question.rest, sums)
                            : e;
}

template cudaError_t cuda_look_start<float>(const cuda_look<float> *, tled_sums *, cudaStream_t);
template cudaError_t cuda_look_start<double>(const cuda_look<double> *, tled_sums *, cudaStream_t);
