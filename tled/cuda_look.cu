/* What the watch wants to know of a state, found where it is: watch.c's sums over elements and nodes, in double whatever
 * the state is in, in a fixed order. Kernels of blocks leave parts, a last one adds them up.
 */
extern "C" {
#include "tled/stability.h"
}
#include "tled/cuda_view.cuh"

enum { NODE_THREADS = 256, SUM_THREADS = 256 };

typedef struct look_nodes { /* of a block; tled_sums' */
    double kinetic, acceleration, speed, moved, mass, stiffness, inertia, largest;
} look_nodes;

typedef struct look_cells { /* of a tile */
    double strain, frequency;
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

/* A sum, or with `most` the largest, over a block's threads, in one order; the answer is thread 0's. scratch: a number a thread. */
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

typedef struct one_cell { /* what a thread found of its cell */
    double strain;
    bool broken;
    step_matrix matrix;
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

template <class G, class S>
static __device__ void look_at_cell(const cuda_look<S> &l, const tile &t, int i, const S *u, one_cell *c)
{
    const cuda_view<S> &v = l.view;
    const uint32_t cell = v.cell[t.cell + i];
    const int place = cell & TILE_PLACE;
    const cuda_kind &kind = v.kind[cell >> TILE_VOLUME];
    const int32_t mixed = v.mixed ? v.mixed[t.cell + i] : -1;
    cuda_mixed own = {kind.mu, kind.bulk, kind.density, kind.hourglass, 0, (int32_t)(cell >> TILE_VOLUME)};
    if (mixed >= 0)
        own = v.mixture[mixed];
    const element_shape shape = element_box(v.side[0], v.side[1], v.side[2]);
    element_modes x = element_modes_of(cuda_corners<G>(u, place));
    element_modes y = element_modes_of(cuda_corners<G>(u + G::PLACES, place));
    element_modes z = element_modes_of(cuda_corners<G>(u + 2 * G::PLACES, place));
    element_tensor h = element_gradient(x, y, z, shape.slope);
    const element_fibre fibre = look_fibre(l, t, i, v.fibre, kind, 1 - own.share);
    const element_fibre mixfibre = look_fibre(l, t, i, mixed < 0 ? NULL : v.mixfibre, v.kind[own.mix], own.share);
    double volume = 1 + element_dilation(h);
    double energy = element_energy(h, own.mu, own.bulk);
    double hourglass = element_hourglass_energy(x, own.hourglass) + element_hourglass_energy(y, own.hourglass) +
                       element_hourglass_energy(z, own.hourglass);
    c->broken = !(volume > 0) || !isfinite(energy) || !isfinite(hourglass);
    c->strain = (v.share ? (double)v.share[t.cell + i] : 1) * (energy * v.side[0] * v.side[1] * v.side[2] + hourglass);
    stability_matrix(own.mu, own.bulk, own.density, v.side, h, fibre, mixfibre, &c->matrix);
}

/* What a tile's block knows of its highest frequency so far. */
typedef struct highest {
    double limit;
    int32_t cell;
} highest;

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

template <class G, class S>
static __global__ void __launch_bounds__(G::THREADS) cells_kernel(cuda_look<S> l, look_cells *out)
{
    __shared__ S u[3 * G::PLACES];
    __shared__ double scratch[G::THREADS];
    __shared__ int least;
    const tile t = l.view.tiles[blockIdx.x];
    cuda_load<G, false>(l.view, t, l.displacement, u);
    __syncthreads();
    highest h = {l.question.rest, -1};
    double strain = 0;
    int broken = INT32_MAX;
    for (int base = 0; base < t.cells; base += G::THREADS) {
        const int i = base + (int)threadIdx.x;
        const bool mine = i < t.cells && l.view.cell[t.cell + i] >> TILE_OWN & 1;
        one_cell c;
        c.broken = false;
        if (mine)
            look_at_cell<G>(l, t, i, u, &c);
        if (c.broken && broken == INT32_MAX)
            broken = t.cell + i;
        const bool whole = mine && !c.broken;
        strain += whole ? c.strain : 0;
        const bool past = whole && !stability_below(&c.matrix, h.limit);
        if (__syncthreads_or(past))
            raise_limit<G::THREADS>(&c.matrix, past, l.question.raise, t.cell + i, &h, scratch, &least);
    }
    strain = block_sum<G::THREADS>(strain, false, scratch);
    broken = block_least(broken, &least);
    if (threadIdx.x == 0)
        out[blockIdx.x] = {strain, h.limit, h.cell, broken == INT32_MAX ? -1 : broken};
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
        return card_start(cells_kernel<G, S>, {l->count, G::THREADS, 0, stream}, *l, cells);
    });
    e = e == cudaSuccess ? card_start(nodes_kernel<S>, {blocks, NODE_THREADS, 0, stream}, *l, nodes) : e;
    return e == cudaSuccess ? card_start(sums_kernel, {1, SUM_THREADS, 0, stream}, cells, l->count, nodes, blocks,
                                         l->question.rest, sums)
                            : e;
}

template cudaError_t cuda_look_start<float>(const cuda_look<float> *, tled_sums *, cudaStream_t);
template cudaError_t cuda_look_start<double>(const cuda_look<double> *, tled_sums *, cudaStream_t);
