/* What the monitor wants to know of a state, found where it is: monitor.c's sums over elements and nodes, in
 * double whatever the state is in, in a fixed order. Blocks leave parts; some blocks settle the frequency and
 * add up parts, one adds up what these have.
 */
extern "C" {
#include "physics/stability_cut.h"
#include "tled/problem/cut.h"
}
#include "tled/cuda/cuda_fibres.cuh"
#include "tled/cuda/cuda_sums.cuh"

/* Blocks of settle_kernel: what an H200 has room for. */
#ifndef SOLVERS
#define SOLVERS 132
#endif

enum {
    LOOK_THREADS = 64, /* which go through a brick's cells: blocks that are small load and compute at different times */
    NODES_AT_ONCE = 2, /* of a thread, on their way together */
    SUM_THREADS = 256,
    SAVE_THREADS = 256
};

/* A block of the look has a tile and as many of the nodes, in the order of memory, as any other. It leaves a part of
 * the answer, with cells for elements, whose frequency no cell of the tile is past; and what is proven: that a cell
 * reaches it, or else that at rest. */
typedef struct look_parts {
    tled_sums *block;    /* then, of SOLVERS blocks at most, what they found of some each */
    double *proven;      /* blocks */
    int64_t share;       /* nodes of a block */
    element_shape shape; /* kernels then divide less */
    double slope;        /* its largest */
} look_parts;

size_t cuda_look_bytes(int64_t tiles)
{
    return (size_t)tiles * (sizeof(tled_sums) + sizeof(double));
}

template <class S> static look_parts parts_of(const cuda_look<S> *l)
{
    const double *side = l->view.side;
    tled_sums *block = (tled_sums *)l->parts;
    const element_shape shape = element_box(side[0], side[1], side[2]);
    return {block, (double *)(block + l->count), (l->view.nodes + l->count - 1) / l->count, shape,
            fmax(shape.slope.x, fmax(shape.slope.y, shape.slope.z))};
}

/* ---- cells */

/* What a thread's cell is made of, and how it is deformed. */
typedef struct one_cell {
    cuda_mixed own;
    element_tensor h;
    double hourglass;                /* its energy */
    double twist;                    /* the length that stability_twists_by takes */
    stability_stiffening stiffening; /* how hourglass control follows the law */
} one_cell;

/* What its hourglass modes have of energy, as hourglass_of would have it, with fewer operations. */
static __device__ void hold_cell(hourglass_kind control, hourglass_modes m, const element_shape &shape,
                                 const double *held, one_cell *c)
{
    if (control == HOURGLASS_ISOTROPIC) {
        c->hourglass = held[HOURGLASS_K] * hourglass_dot(&m, &m) / 2;
        c->twist = 0;
        return;
    }
    const double inverse = 1 / (1 + element_dilation(c->h));
    const hourglass_modes w = hourglass_all_by_columns(element_cofactor(c->h), m);
    const hourglass_modes t = hourglass_box(&w, shape, held, inverse * inverse);
    c->hourglass = c->stiffening.now * hourglass_dot(&t, &w) / 2;
    c->twist = sqrt(hourglass_dot(&w, &w));
}

template <class G, bool CUT, class S>
static __device__ one_cell cell_of(const cuda_look<S> &l, const tile &t, int i, const S *u, const element_shape &shape)
{
    const cuda_view<S> &v = l.view;
    const uint32_t cell = v.cell[t.cell + i];
    const int place = cell & TILE_PLACE;
    const cuda_kind &kind = v.kind[cell >> TILE_VOLUME];
    const int32_t mixed = v.mixed ? v.mixed[t.cell + i] : -1;
    element_modes x = element_modes_of(cuda_corners<G>(u, place));
    element_modes y = element_modes_of(cuda_corners<G>(u + G::PLACES, place));
    element_modes z = element_modes_of(cuda_corners<G>(u + 2 * G::PLACES, place));
    one_cell c;
    c.own = {{0}, kind.density, {0}, kind.twists, 0, -1};
    if (mixed >= 0) {
        const cuda_mixed &m = v.mixture[mixed];
        c.own = {{0}, m.density, {0}, m.twists, m.share, m.mix};
    }
    const double *from = mixed >= 0 ? v.mixture[mixed].c : kind.c;
    const double *held = mixed >= 0 ? v.mixture[mixed].hourglass : kind.hourglass;
#pragma unroll
    for (int k = 0; k < FORM_NUMBERS; k++) /* 0, where the form has fewer */
        c.own.c[k] = from[k];
    c.h = element_gradient(x, y, z, shape.slope);
    if constexpr (CUT) {
        const cuda_part<true> part = cuda_part_of<true>(v, t.cell + i);
        if (part.is)
            c.h = element_cut_gradient(x, y, z, shape.slope, part.c);
    }
    c.stiffening = stability_stiffening_of(l.which, l.control, c.h, c.own.c);
    hold_cell(l.control, element_hourglass_modes(x, y, z), shape, held, &c);
    return c;
}

/* along: over cells whose fibres act, or NULL; share: of the tissue that is of this kind. */
template <class S>
static __device__ element_fibre look_fibre(const cuda_look<S> &l, const tile &t, int i, const float *along,
                                           uint32_t kind, double share)
{
    element_fibre fibre = {{0, 0, 0}, 0, {0, 0, 0, 0}};
    const int32_t contract = i < t.fibred && along ? l.view.kind[kind].contract : -1;
    if (contract < 0)
        return fibre;
    along += 3 * (int64_t)(t.direction + i);
    fibre.along.x = along[0], fibre.along.y = along[1], fibre.along.z = along[2];
    fibre.tension = share * (l.view.kind[kind].peak * l.now[3 * contract]);
    return fibre;
}

/* Its muscles: of its own volume, and of the second. */
template <bool FIBRED> struct cell_fibres {
    element_fibre muscle[2];
};

/* And what resists being stretched, of so many volumes. */
template <> struct cell_fibres<true> {
    element_fibre muscle[2];
    fibre_set sets[2];
    int count;
};

/* Adds those of one volume; along, family: NULL: it has none. */
template <class S>
static __device__ void add_fibres(const cuda_look<S> &l, int64_t row, uint32_t volume, const float *along,
                                  const S *family, double share, element_fibre *muscle, cell_fibres<true> *to)
{
    if (!along)
        return;
    const cuda_fibres<double> &of = l.fibres[volume];
    *muscle = cuda_muscle(of, along, row, share, cuda_tension(of, l.now));
    if (cuda_stretched(of))
        to->sets[to->count++] = cuda_fibre_set(l.view, of, along, family, row, share);
}

template <bool FIBRED, class S>
static __device__ cell_fibres<FIBRED> fibres_of(const cuda_look<S> &l, const tile &t, int i, const one_cell &c)
{
    const cuda_view<S> &v = l.view;
    const uint32_t volume = v.cell[t.cell + i] >> TILE_VOLUME, mix = (uint32_t)c.own.mix;
    cell_fibres<FIBRED> f = {};
    const float *const mixfibre = c.own.mix < 0 ? NULL : v.mixfibre;
    if constexpr (FIBRED) {
        if (i < t.fibred) {
            add_fibres(l, t.direction + i, volume, v.fibre, v.family, 1 - c.own.share, &f.muscle[0], &f);
            add_fibres(l, t.direction + i, mix, mixfibre, v.mixfamily, c.own.share, &f.muscle[1], &f);
        }
    } else {
        f.muscle[0] = look_fibre(l, t, i, v.fibre, volume, 1 - c.own.share);
        f.muscle[1] = look_fibre(l, t, i, mixfibre, mix, c.own.share);
    }
    return f;
}

/* What its fibres hold, J/m3 by volume at rest; no energy is told of active muscles. */
static __device__ double fibres_energy(const cell_fibres<true> &f, element_tensor h)
{
    double energy = element_fibre_energy(h, f.muscle[0]) + element_fibre_energy(h, f.muscle[1]);
    for (int k = 0; k < f.count; k++)
        energy += fibre_energy(h, &f.sets[k]);
    return energy;
}

/* Its strain energy; not finite where the cell is broken. */
template <bool FIBRED, class S>
static __device__ double strain_of(const cuda_look<S> &l, const tile &t, int i, const one_cell &c)
{
    const cuda_view<S> &v = l.view;
    double energy = form_energy(l.which, c.h, c.own.c);
    if constexpr (FIBRED)
        energy += fibres_energy(fibres_of<true>(l, t, i, c), c.h);
    if (!(1 + element_dilation(c.h) > 0) || !isfinite(energy) || !isfinite(c.hourglass))
        return INFINITY;
    return (v.share ? (double)v.share[t.cell + i] : 1) * (energy * v.side[0] * v.side[1] * v.side[2] + c.hourglass);
}

/* Once its energy is known: its law gets what hourglass energy adds to the tangent. */
template <class S> static __device__ void stiffen(const cuda_look<S> &l, one_cell *c)
{
    const double volume = l.view.side[0] * l.view.side[1] * l.view.side[2];
    stability_stiffen(c->stiffening, c->hourglass / (c->stiffening.now * volume), c->own.c);
}

/* Between which the largest eigenvalue of its matrix lies; d: stability_range_scaled's. */
template <bool FIBRED, class S>
static __device__ stability_range range_of(const cuda_look<S> &l, const one_cell &c, element_vector d,
                                           const cell_fibres<FIBRED> &f)
{
    if constexpr (FIBRED)
        return stability_range_fibred(l.which, c.own.c, d, c.h, f.muscle[0], f.muscle[1], f.sets, f.count);
    else
        return stability_range_scaled(l.which, c.own.c, d, c.h, f.muscle[0], f.muscle[1]);
}

template <bool FIBRED, class S>
static __device__ void matrix_of(const cuda_look<S> &l, const one_cell &c, const cell_fibres<FIBRED> &f, step_matrix *a)
{
    const double *side = l.view.side;
    if constexpr (FIBRED)
        stability_matrix_fibred(l.which, c.own.c, c.own.density, side, c.h, f.muscle[0], f.muscle[1], f.sets, f.count,
                                a);
    else
        stability_matrix(l.which, c.own.c, c.own.density, side, c.h, f.muscle[0], f.muscle[1], a);
}

static __device__ stability_twists twists_of(hourglass_kind control, const one_cell &c, const look_parts &parts)
{
    return stability_twists_by(control, c.own.twists, parts.slope, c.h, c.twist, c.stiffening);
}

/* With twists. Of a cell that is cut, the whole one's times |G| at most, and at least as much, as G has no eigenvalue
 * below 1 (stability_cut.h). */
template <class S>
static __device__ stability_range cut_range(const cuda_look<S> &l, int64_t cell, stability_range whole,
                                            stability_twists twists)
{
    const cuda_part<true> part = cuda_part_of<true>(l.view, cell);
    if (!part.is)
        return stability_range_with(whole, twists);
    const double by = cut_lighter(l.view.share[cell]);
    const stability_gram g = stability_gram_of(part.c);
    const stability_range range = {by * whole.low, by * stability_gram_bound(&g) * whole.high};
    return stability_range_with(range, stability_cut_twists(part.c, by, twists));
}

/* Strain energies, what is broken, and bounds of frequencies, of a thread's cells; no matrices, which take a thread
 * nearly twice the registers. Returns what is proven. */
template <class G, bool FIBRED, bool CUT, class S>
static __device__ double look_at_cells(const cuda_look<S> &l, const tile &t, const S *u, const own_cells<G> &own,
                                       int count, const look_parts &parts, tled_sums *to)
{
    double proven = l.question.rest;
#pragma unroll 1
    for (int k = threadIdx.x; k < count; k += G::THREADS) {
        const int i = own.cell[k];
        one_cell c = cell_of<G, CUT>(l, t, i, u, parts.shape);
        const double strain = strain_of<FIBRED>(l, t, i, c);
        if (!(strain < INFINITY)) {
            to->broken = to->broken < 0 ? t.cell + i : to->broken;
            continue;
        }
        to->strain += strain;
        stiffen(l, &c);
        const cell_fibres<FIBRED> fibres = fibres_of<FIBRED>(l, t, i, c);
        const double unit = 8 / sqrt(c.own.density);
        const element_vector slope = parts.shape.slope, d = {unit * slope.x, unit * slope.y, unit * slope.z};
        const stability_range whole = range_of(l, c, d, fibres);
        const stability_twists twists = twists_of(l.control, c, parts);
        stability_range range;
        if constexpr (CUT)
            range = cut_range(l, t.cell + i, whole, twists);
        else
            range = stability_range_with(whole, twists);
        if (range.high <= l.question.rest)
            continue;
        const double bound = isnan(range.high) ? INFINITY : range.high;
        proven = fmax(proven, range.low);
        if (bound > to->frequency) {
            to->frequency = bound;
            to->frequency_element = t.cell + i;
        }
    }
    return proven;
}

/* ---- matrices */

/* Of a cell that is cut, from what is known of a whole one (tled/problem/cut.h). */
template <class S>
static __device__ void cut_cell(const cuda_look<S> &l, int64_t cell, step_matrix *a, stability_twists *twists)
{
    const cuda_part<true> part = cuda_part_of<true>(l.view, cell);
    if (!part.is)
        return;
    const double by = cut_lighter(l.view.share[cell]);
    stability_cut_matrix(part.c, by, a);
    *twists = stability_cut_twists(part.c, by, *twists);
}

/* What a tile's block knows of its highest frequency so far. */
typedef struct highest {
    double limit; /* no cell is past it */
    int32_t cell; /* whose the limit is, or -1: that at rest */
} highest;

/* Some thread's matrix reaches past the limit: raises it by halving until it is the
 * highest, or too high by `raise` at most. */
template <int THREADS>
static __device__ void raise_limit(const step_matrix *a, stability_twists twists, bool past, double raise, int32_t cell,
                                   highest *h, double *scratch, int *least)
{
    double low = h->limit, high = block_most<THREADS>(past ? stability_square(twists, stability_bound(a)) : 0, scratch);
    const double gap = fmax(raise - 1, 1e-13);
    high = fmax(high, low);
    bool at_low = past;
    for (int i = 0; i < 100 && high - low > gap * low; i++) {
        double middle = low + (high - low) / 2;
        bool mine = past && !stability_below(a, stability_room(twists, middle));
        if (__syncthreads_or(mine)) {
            low = middle;
            at_low = mine;
        } else {
            high = middle;
        }
    }
    int32_t which = block_least(at_low ? cell : NONE, least);
    h->limit = high;
    h->cell = which;
}

/* The frequency of a tile by its cells' matrices. */
template <class G, bool FIBRED, bool CUT, class S>
static __device__ void solve_tile(const cuda_look<S> &l, const tile &t,

                                  const look_parts &parts, tled_sums *out, S *u, double *scratch, int *least)
{
    highest h = {l.question.rest, -1};
    __syncthreads();
    cuda_load<G, false>(l.view, t, l.displacement, u);
    __syncthreads();
    for (int base = 0; base < t.cells; base += G::THREADS) {
        const int i = base + (int)threadIdx.x;
        bool past = i < t.cells && l.view.cell[t.cell + i] >> TILE_OWN & 1;
        step_matrix a;
        stability_twists twists = {0, 0};
        if (past) {
            one_cell c = cell_of<G, CUT>(l, t, i, u, parts.shape);
            const cell_fibres<FIBRED> fibres = fibres_of<FIBRED>(l, t, i, c);
            twists = twists_of(l.control, c, parts);
            past = strain_of<FIBRED>(l, t, i, c) < INFINITY;
            stiffen(l, &c);
            matrix_of(l, c, fibres, &a);
            if constexpr (CUT)
                cut_cell(l, t.cell + i, &a, &twists);
        }
        past = past && !stability_below(&a, stability_room(twists, h.limit));
        if (__syncthreads_or(past))
            raise_limit<G::THREADS>(&a, twists, past, l.question.raise, t.cell + i, &h, scratch, least);
    }
    if (threadIdx.x == 0) {
        out->frequency = h.limit;
        out->frequency_element = h.cell;
    }
}

/* ---- nodes */

/* A node's state, along the model's axes. */
template <class S> struct look_node {
    S u[3], speed[3], internal[3], mass_inverse;
    uint32_t info;
};

template <class S> static __device__ look_node<S> node_at(const cuda_look<S> &l, int64_t n)
{
    look_node<S> x;
    cuda_three<false>(l.view, l.displacement, n, x.u);
    cuda_three<false>(l.view, l.velocity, n, x.speed);
    cuda_three<false>(l.view, l.internal, n, x.internal);
    x.mass_inverse = l.view.mass_inverse[n * l.view.mass_along];
    x.info = l.view.node_info[n];
    return x;
}

/* What acts on it from outside; weight: what gravity acts on, kg. */
template <class S>
static __device__ void forces_on(const cuda_look<S> &l, int32_t n, const look_node<S> &x, double weight, double *to)
{
    const cuda_view<S> &v = l.view;
    for (int a = 0; a < 3; a++)
        to[a] = v.gravity >= 0 ? weight * l.now[3 * v.gravity + a] : 0;
    if (!(x.info >> TILE_EXTRA & 1))
        return;
    const tile_extra *extra = cuda_extra(v, n);
    for (int32_t k = extra->force; k < extra->force + extra->forces; k++)
        for (int a = 0; a < 3; a++)
            to[a] += cuda_force(v, k, l.now, a, (double)x.u[a]);
}

template <bool CUT, class S>
static __device__ void look_at_node(const cuda_look<S> &l, int32_t n, const look_node<S> &x, tled_sums *to)
{
    const double inverse = x.mass_inverse, mass = 1 / inverse;
    double outside[3], square = 0;
    if constexpr (CUT)
        forces_on(l, n, x, mass * (double)l.view.weight[n], outside);
    else
        forces_on(l, n, x, mass, outside);
    for (int a = 0; a < 3; a++) {
        const double u = x.u[a], speed = x.speed[a], drive = mass * speed * speed;
        const double gap = outside[a] - x.internal[a];
        to->kinetic += drive / 2;
        square += u * u;
        if (!(x.info >> (TILE_FREE + a) & 1))
            continue;
        to->acceleration += gap * gap * inverse;
        to->speed += drive;
        if (l.saved_displacement) {
            const int64_t at = a * l.view.stride + n;
            const double du = u - l.saved_displacement[at];
            to->stiffness += du * (x.internal[a] - (double)l.saved_internal[at]);
            to->inertia += mass * du * du;
        }
    }
    to->mass += mass;
    to->moved += mass * square;
    to->largest = fmax(to->largest, square);
}

/* A thread's of a block's share of the nodes. */
template <int THREADS, bool CUT, class S>
static __device__ void look_at_nodes(const cuda_look<S> &l, int64_t share, tled_sums *to)
{
    const int64_t all = l.view.nodes, first = blockIdx.x * share;
    const int64_t end = first + share < all ? first + share : all;
#pragma unroll 1
    for (int64_t n = first + threadIdx.x; n < end; n += NODES_AT_ONCE * THREADS) {
        look_node<S> x[NODES_AT_ONCE];
#pragma unroll
        for (int k = 0; k < NODES_AT_ONCE; k++)
            if (n + k * THREADS < end)
                x[k] = node_at(l, n + k * THREADS);
#pragma unroll
        for (int k = 0; k < NODES_AT_ONCE; k++)
            if (n + k * THREADS < end)
                look_at_node<CUT>(l, (int32_t)(n + k * THREADS), x[k], to);
    }
}

/* ---- kernels */

/* What bounds tell of a tile's cells, and sums over them and over a share of the nodes: what waits for memory in one
 * block is beside what computes in others. */
template <class G, bool FIBRED, bool CUT, class S>
static __global__ void __launch_bounds__(G::THREADS, 512 / G::THREADS)
    look_kernel(const __grid_constant__ cuda_look<S> l, const __grid_constant__ look_parts out)
{
    constexpr int WARPS = G::THREADS / 32;
    __shared__ S u[3 * G::PLACES];
    __shared__ own_cells<G> own;
    __shared__ tled_sums part[WARPS];
    __shared__ double proven[WARPS];
    const unsigned warp = threadIdx.x / 32;
    const tile t = l.view.tiles[blockIdx.x];
    unsigned who[own_cells<G>::ROUNDS];
    count_own<G>(l.view.cell, t, who, &own);
    cuda_load<G, false>(l.view, t, l.displacement, u);
    tled_sums mine = nothing_seen(l.question.rest);
    look_at_nodes<G::THREADS, CUT>(l, out.share, &mine);
    sum_nodes(&mine, l.saved_displacement);
    if (threadIdx.x % 32 == 0)
        part[warp] = mine;
    __syncthreads();
    const int count = list_own<G>(who, &own);
    __syncthreads();
    mine = nothing_seen(l.question.rest);
    const double most = warp_most(look_at_cells<G, FIBRED, CUT>(l, t, u, own, count, out, &mine));
    sum_cells(&mine);
    if (threadIdx.x % 32 == 0) {
        add_part(&part[warp], mine);
        proven[warp] = most;
    }
    __syncthreads();
    if (threadIdx.x)
        return;
    for (int i = 1; i < WARPS; i++) {
        add_part(&part[0], part[i]);
        proven[0] = fmax(proven[0], proven[i]);
    }
    out.block[blockIdx.x] = part[0];
    out.proven[blockIdx.x] = proven[0];
}

/* The highest frequency that a cell of any tile is known to reach. */
template <int THREADS>
static __device__ double proven_of_all(const double *proven, int64_t tiles, double rest, double *scratch)
{
    double most = rest;
#pragma unroll 8
    for (int64_t i = threadIdx.x; i < tiles; i += THREADS)
        most = fmax(most, proven[i]);
    return block_most<THREADS>(most, scratch);
}

/* Goes through tiles, every gridDim.x-th, for those whose limit is past `raise` times what some tile is known to
 * reach: others' limits may stay, for if one of them is the highest of all, it is too high by `raise` at most.
 * Where no tile is known to pass the frequency at rest, it is for all that may. Then it adds up what their
 * blocks left, where the first of these was. */
template <class G, bool FIBRED, bool CUT, class S>
static __global__ void __launch_bounds__(G::THREADS)
    settle_kernel(const __grid_constant__ cuda_look<S> l, const __grid_constant__ look_parts parts)
{
    __shared__ S u[3 * G::PLACES];
    __shared__ tled_sums scratch[G::THREADS / 32];
    __shared__ double number[G::THREADS / 32];
    __shared__ int least;
    const int64_t stride = gridDim.x;
    const double rest = l.question.rest, proven = proven_of_all<G::THREADS>(parts.proven, l.count, rest, number);
    const double enough = proven > rest ? l.question.raise * proven : rest;
    tled_sums mine = nothing_seen(rest);
    for (int64_t base = blockIdx.x; base < l.count; base += G::THREADS * stride) {
        const int64_t own = base + threadIdx.x * stride;
        int next = own < l.count && parts.block[own].frequency > enough ? (int)threadIdx.x : NONE;
        for (int which; (which = block_least(next, &least)) != NONE;) {
            const int64_t at = base + which * stride;
            solve_tile<G, FIBRED, CUT>(l, l.view.tiles[at], parts, &parts.block[at], u, number, &least);
            next = next == which ? NONE : next;
        }
        if (own < l.count)
            add_part(&mine, parts.block[own]);
    }
    sum_block<G::THREADS>(mine, l.saved_displacement, scratch, &parts.block[blockIdx.x]);
}

static __global__ void __launch_bounds__(SUM_THREADS)
    sums_kernel(const tled_sums *part, int64_t count, double rest, tled_sums *out)
{
    __shared__ tled_sums scratch[SUM_THREADS / 32];
    tled_sums mine = nothing_seen(rest);
    for (int64_t i = threadIdx.x; i < count; i += SUM_THREADS)
        add_part(&mine, part[i]);
    sum_block<SUM_THREADS>(mine, true, scratch, out);
}

/* By bricks G. */
template <class G, bool FIBRED, bool CUT, class S>
static cudaError_t start_in(const cuda_look<S> *l, const look_parts &parts, int64_t solvers, cudaStream_t stream)
{
    typedef cuda_brick<G::BX, G::BY, G::BZ, LOOK_THREADS, 1> W;
    const cudaError_t bounds = card_start(look_kernel<W, FIBRED, CUT, S>, {l->count, W::THREADS, 0, stream}, *l, parts);
    return bounds == cudaSuccess
               ? card_start(settle_kernel<G, FIBRED, CUT, S>, {solvers, G::THREADS, 0, stream}, *l, parts)
               : bounds;
}

template <class S> cudaError_t cuda_look_start(const cuda_look<S> *l, tled_sums *sums, cudaStream_t stream)
{
    const look_parts parts = parts_of(l);
    const int64_t solvers = l->count < SOLVERS ? l->count : SOLVERS;
    cudaError_t e = with_brick(l->size, [&](auto g) {
        typedef decltype(g) G;
        if (l->view.cut)
            return start_in<G, true, true>(l, parts, solvers, stream);
        return l->fibres ? start_in<G, true, false>(l, parts, solvers, stream)
                         : start_in<G, false, false>(l, parts, solvers, stream);
    });
    return e == cudaSuccess
               ? card_start(sums_kernel, {1, SUM_THREADS, 0, stream}, parts.block, solvers, l->question.rest, sums)
               : e;
}

/* ---- what is saved */

template <class S>
static __global__ void __launch_bounds__(SAVE_THREADS)
    save_kernel(const __grid_constant__ cuda_view<S> v, const __grid_constant__ cuda_saved<S> saved)
{
    const int64_t n = (int64_t)blockIdx.x * SAVE_THREADS + threadIdx.x;
    S x[CUDA_SAVED][3];
    if (n >= v.nodes)
        return;
#pragma unroll
    for (int i = 0; i < CUDA_SAVED; i++)
        if (saved.from[i])
            cuda_three<false>(v, saved.from[i], n, x[i]);
#pragma unroll
    for (int i = 0; i < CUDA_SAVED; i++)
        for (int a = 0; a < 3 && saved.from[i]; a++)
            saved.to[i][a * v.stride + n] = x[i][a];
}

template <class S> cudaError_t cuda_save_start(const cuda_view<S> *v, const cuda_saved<S> *saved, cudaStream_t stream)
{
    const int64_t blocks = (v->nodes + SAVE_THREADS - 1) / SAVE_THREADS;
    return card_start(save_kernel<S>, {blocks, SAVE_THREADS, 0, stream}, *v, *saved);
}

void cuda_look_load(void)
{
    int each = 0;
    cudaOccupancyMaxActiveBlocksPerMultiprocessor(&each, sums_kernel, SUM_THREADS, 0);
}

template cudaError_t cuda_look_start<float>(const cuda_look<float> *, tled_sums *, cudaStream_t);
template cudaError_t cuda_look_start<double>(const cuda_look<double> *, tled_sums *, cudaStream_t);
template cudaError_t cuda_save_start<float>(const cuda_view<float> *, const cuda_saved<float> *, cudaStream_t);
template cudaError_t cuda_save_start<double>(const cuda_view<double> *, const cuda_saved<double> *, cudaStream_t);
