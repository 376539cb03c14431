/* The step of a tile, in `real`: the loops of the CUDA executors over element.h and node.h. One block of
 * threads a tile: loads the displacements around it, computes its cells, sums them at its nodes, moves
 * these on. Included by cuda_loops.cuh alone.
 *
 *     f_n = sum over elements at n of element_force(u),   a = g + (f_ext - f_n) / m,   then node.h.
 */
#ifndef SINEW_CUDA_KERNELS_CUH
#define SINEW_CUDA_KERNELS_CUH

extern "C" {
#include "tled/problem/node.h"
}
#include "tled/cuda/cuda_fibres.cuh"
#include "tled/cuda/cuda_ptx.cuh"

typedef struct cuda_pass {
    const real *from; /* displacements */
    real *to;         /* the next ones, or internal forces */
    real *velocity;
    const double *now, *next;  /* the curves' values */
    const real *law, *gravity; /* of the volumes; m/s2: where they are near */
    element_shape shape;
    node_factors factors;
    int what;
    double dt;
} cuda_pass;

template <class G> static __device__ element_field cell_field(const real *u, const int &place)
{
    element_field at = {cuda_corners<G>(u, place), cuda_corners<G>(u + G::PLACES, place),
                        cuda_corners<G>(u + 2 * G::PLACES, place)};
    return at;
}

/* H of a cell that may be cut; u: displacements at its corners. */
template <bool CUT>
static __device__ element_tensor gradient_to(element_field u, element_vector slope, const cuda_part<CUT> &part)
{
    if constexpr (CUT)
        if (part.is)
            return element_cut_gradient(element_modes_of(u.x), element_modes_of(u.y), element_modes_of(u.z), slope,
                                        part.c);
    return element_gradient_to(u, slope);
}

/* As element_force_from, of such a cell. */
template <bool CUT>
static __device__ element_field force_from(hourglass_kind control, element_field u, element_tensor stress,
                                           element_shape shape, const real *hourglass, const cuda_part<CUT> &part)
{
    if constexpr (CUT)
        if (part.is) {
            const element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
            const element_tensor h = element_cut_gradient(x, y, z, shape.slope, part.c);
            hourglass_force held = hourglass_of(control, element_hourglass_modes(x, y, z), h, shape, hourglass);
            return element_cut_force_of(control, stress, &held, shape, part.c);
        }
    return element_force_from(control, u, stress, shape, hourglass);
}

/* The law of a cell that control follows becomes that of its displacements. Returns `place`: what loads the
 * displacements by it loads them again, as they cost less than the registers that would keep them. */
template <class G, class L>
static __device__ int follow(const L &l, const cuda_pass &p, const real *u, const int &place,
                             const cuda_part<L::CUT> &part, element_law *law)
{
    if (!L::ASKS && !element_follows(l.which, l.control))
        return place;
    const element_field at = cell_field<G>(u, place);
    if constexpr (L::CUT)
        element_follow(l.which, l.control,
                       element_hourglass_modes(element_modes_of(at.x), element_modes_of(at.y), element_modes_of(at.z)),
                       gradient_to(at, p.shape.slope, part), p.shape, law);
    else
        element_follow_to(l.which, l.control, at, p.shape, law);
    return unknown(place);
}

/* As element_force_of_two, of a cell that may be cut, by a law that is that at u already (element_follow). */
template <class L>
static __device__ element_field force_by(const L &l, element_field u, element_shape shape, element_law law,
                                         element_fibre fibre, bool pulls, element_fibre second, bool second_pulls,
                                         const cuda_part<L::CUT> &part)
{
    const element_tensor h = gradient_to(u, shape.slope, part);
    const element_tensor stress = element_stress(l.which, h, law.c, fibre, pulls, second, second_pulls, NULL, 0);
    return force_from(l.control, u, stress, shape, law.hourglass, part);
}

static __device__ element_vector cell_along(const tile &t, int i, const float *fibre)
{
    const float *at = fibre + 3 * (int64_t)(t.direction + i);
    element_vector along = {at[0], at[1], at[2]};
    return along;
}

static __device__ real cell_tension(const cuda_kind &kind, const cuda_pass &p)
{
    return kind.contract < 0 ? 0 : (real)(kind.peak * p.now[3 * kind.contract]);
}

/* A law's numbers, of what is tissue. */
template <class L, class T> static __device__ element_law law_of(const L &l, const T *c, const T *hourglass, real share)
{
    element_law law;
#pragma unroll
    for (int i = 0; i < L::COEFFICIENTS; i++)
        if (i < l.coefficients)
            law.c[i] = i < l.moduli ? share * (real)c[i] : (real)c[i];
#pragma unroll
    for (int i = 0; i < L::HELD; i++)
        if (i < l.held)
            law.hourglass[i] = share * (real)hourglass[i];
    return law;
}

/* A cell mixed of two volumes. */
template <class G, class L>
static __device__ element_field mixed_force(const L &l, const cuda_view<real> &v, const cuda_pass &p, const tile &t,
                                            int i, const real *u, const int &place, const cuda_kind &kind,
                                            const cuda_mixed &mixed, real share)
{
    const cuda_kind &mix = v.kind[mixed.mix];
    const real part = (real)mixed.share, own = share * (1 - part), other = share * part;
    element_law law = law_of(l, mixed.c, mixed.hourglass, share);
    const cuda_part<L::CUT> cut = cuda_part_of<L::CUT>(v, t.cell + i);
    const int again = follow<G>(l, p, u, place, cut, &law);
    element_fibre fibre = {{0, 0, 0}, 0, {0, 0, 0, 0}}, second = fibre;
    real tension = 0, tension_of_mix = 0;
    if (i < t.fibred) {
        tension = cell_tension(kind, p);
        fibre.along = cell_along(t, i, v.fibre);
        fibre.tension = own * tension;
    }
    if (i < t.fibred && v.mixfibre) {
        tension_of_mix = cell_tension(mix, p);
        second.along = cell_along(t, i, v.mixfibre);
        second.tension = other * tension_of_mix;
    }
    return force_by(l, cell_field<G>(u, again), p.shape, law, fibre, tension != 0, second, tension_of_mix != 0, cut);
}

template <class G, class L>
static __device__ element_field plain_force(const L &l, const cuda_view<real> &v, const cuda_pass &p, const tile &t,
                                            int i, const real *u, const int &place, uint32_t volume, real share)
{
    const real *stiff = p.law + (l.coefficients + l.held) * volume;
    element_law law = law_of(l, stiff, stiff + l.coefficients, share);
    const cuda_part<L::CUT> cut = cuda_part_of<L::CUT>(v, t.cell + i);
    const int again = follow<G>(l, p, u, place, cut, &law);
    element_fibre fibre = {{0, 0, 0}, 0, {0, 0, 0, 0}};
    if (i < t.fibred) {
        const cuda_kind &kind = v.kind[volume];
        fibre.along = cell_along(t, i, v.fibre);
        fibre.tension = share * (real)(kind.peak * p.now[3 * kind.contract]);
    }
    return force_by(l, cell_field<G>(u, again), p.shape, law, fibre, fibre.tension != 0, fibre, false, cut);
}

/* What is to be looked at of a volume's muscle: ELEMENT_MUSCLE and so on. */
static __device__ int muscle_of(const cuda_fibres<real> &of, real tension)
{
    if (of.serial)
        return ELEMENT_SERIAL_MUSCLE;
    if (of.curved)
        return ELEMENT_CURVED_MUSCLE;
    return tension != 0 ? ELEMENT_MUSCLE : ELEMENT_NO_MUSCLE;
}

/* What of a cell a volume's muscle has to do with: its share, and what is looked at of it. */
typedef struct cell_part {
    const cuda_fibres<real> *of;
    const float *along; /* directions; or NULL */
    const real *family;
    real *contractile; /* the cell's; or NULL */
    real share, tension;
    int which;
} cell_part;

static __device__ cell_part part_of(const cuda_view<real> &v, const cuda_pass &p, const cuda_fibres<real> *of,
                                    const float *along, const real *family, real *contractile, real share)
{
    const real tension = along ? cuda_tension(*of, p.now) : 0;
    return {of, along, family, contractile, share, tension, along ? muscle_of(*of, tension) : ELEMENT_NO_MUSCLE};
}

/* The contractile element of a muscle, which goes on by the step that this pass ends. */
static __device__ real contract(const cuda_pass &p, const cell_part &part, element_tensor h, element_fibre fibre)
{
    fibre.series.contractile = *part.contractile;
    if (p.what & PASS_FINISH)
        *part.contractile = fibre.series.contractile = element_contract(h, fibre, (real)(part.of->fastest * p.dt));
    return fibre.series.contractile;
}

/* Adds the stress of a muscle, if it is looked at. */
static __device__ void add_muscle(const cuda_pass &p, const cell_part &part, int64_t row, element_tensor h,
                                  element_tensor *to)
{
    if (!part.which)
        return;
    element_fibre fibre = cuda_muscle(*part.of, part.along, row, part.share, part.tension);
    if (part.which == ELEMENT_SERIAL_MUSCLE)
        fibre.series.contractile = contract(p, part, h, fibre);
    *to = element_sum(*to, element_muscle(h, fibre, part.which));
}

/* Adds S of what resists being stretched. */
static __device__ void add_stretched(const cuda_view<real> &v, const cell_part &part, int64_t row, element_symmetric e,
                                     element_symmetric *to)
{
    if (part.along) {
        const fibre_set set = cuda_fibre_set(v, *part.of, part.along, part.family, row, part.share);
        fibre_add_set(e, &set, to);
    }
}

/* Adds P of a cell's fibres, in the order of element_stress; MIXED: of two volumes, of which cpu_lanes.c looks at both
 * muscles alike where no fibres resist being stretched, and adds zeros, which have signs. */
template <bool MIXED>
static __device__ void add_fibres(const cuda_view<real> &v, const cuda_pass &p, cell_part own, cell_part other,
                                  int64_t row, element_tensor h, element_tensor *to)
{
    const bool stretched = cuda_stretched(*own.of) || (MIXED && cuda_stretched(*other.of));
    const bool serial = own.of->serial || (MIXED && other.of->serial);
    if (MIXED && other.along && !stretched && !serial && (own.of->curved || other.of->curved))
        own.which = other.which = ELEMENT_CURVED_MUSCLE;
    add_muscle(p, own, row, h, to);
    if (MIXED)
        add_muscle(p, other, row, h, to);
    if (!stretched)
        return;
    const element_symmetric e = element_green(h);
    element_symmetric s = {0, 0, 0, 0, 0, 0};
    add_stretched(v, own, row, e, &s);
    if (MIXED)
        add_stretched(v, other, row, e, &s);
    *to = element_sum(*to, fibre_moved(h, s));
}

/* A cell of a model with fibres, as element_force_fibred: what fibres need is loaded where it is needed. mixed: of
 * MIXED. */
template <bool MIXED, class G, class L>
static __device__ element_field fibred_force(const L &l, const cuda_view<real> &v, const cuda_pass &p, const tile &t,
                                             int i, const real *u, const int &place, uint32_t volume,
                                             const cuda_mixed *mixed, real share)
{
    const real *stiff = p.law + (l.coefficients + l.held) * volume;
    element_law law =
        MIXED ? law_of(l, mixed->c, mixed->hourglass, share) : law_of(l, stiff, stiff + l.coefficients, share);
    const cuda_part<L::CUT> cut = cuda_part_of<L::CUT>(v, t.cell + i);
    const int again = follow<G>(l, p, u, place, cut, &law);
    const element_tensor h = gradient_to(cell_field<G>(u, again), p.shape.slope, cut);
    element_tensor stress = form_stress(l.which, h, law.c);
    if (i < t.fibred) {
        const real part = MIXED ? (real)mixed->share : 0;
        const int64_t cell = t.cell + i;
        const cell_part own =
            part_of(v, p, v.fibres + volume, v.fibre, v.family, v.contractile + cell, share * (1 - part));
        const cell_part other = part_of(v, p, v.fibres + (MIXED ? mixed->mix : volume), MIXED ? v.mixfibre : NULL,
                                        v.mixfamily, v.mixcontractile + cell, share * part);
        add_fibres<MIXED>(v, p, own, other, t.direction + i, h, &stress);
    }
    return force_from(l.control, cell_field<G>(u, unknown(again)), stress, p.shape, law.hourglass, cut);
}

/* A cell's forces at its corners. mixed: which of v.mixture it is, or -1. */
template <class G, class T, class L>
static __device__ element_field force_of_cell(const L &l, const cuda_view<real> &v, const cuda_pass &p, const tile &t,
                                              int i, const real *u, const int &place, uint32_t volume, int32_t mixed,
                                              real share)
{
    if constexpr (L::FIBRED)
        return T::MIXED && mixed >= 0 ? fibred_force<true, G>(l, v, p, t, i, u, place, volume, &v.mixture[mixed], share)
                                      : fibred_force<false, G>(l, v, p, t, i, u, place, volume, NULL, share);
    else
        return T::MIXED && mixed >= 0 ? mixed_force<G>(l, v, p, t, i, u, place, v.kind[volume], v.mixture[mixed], share)
                                      : plain_force<G>(l, v, p, t, i, u, place, volume, share);
}

template <class G, class T, class L>
static __device__ void cell_force(const L &l, const cuda_view<real> &v, const cuda_pass &p, const tile &t, int i,
                                  uint32_t cell, const real *u, real *force)
{
    const int place = cell & TILE_PLACE;
    const uint32_t volume = cell >> TILE_VOLUME;
    const real share = v.share ? (real)v.share[t.cell + i] : 1; /* forces are linear in all of these */
    const int32_t mixed = T::MIXED && (!T::ASKS || v.mixed) ? v.mixed[t.cell + i] : -1;
    const element_field f = force_of_cell<G, T>(l, v, p, t, i, u, place, volume, mixed, share);
#pragma unroll
    for (int c = 0; c < 8; c++) {
        force[c * G::CELLS + place] = f.x.at[c];
        force[(8 + c) * G::CELLS + place] = f.y.at[c];
        force[(16 + c) * G::CELLS + place] = f.z.at[c];
    }
}

/* A thread's first cell, and each after it while the one before is computed. */
static __device__ uint32_t cell_at(const cuda_view<real> &v, const tile &t, int i)
{
    return i < t.cells ? v.cell[t.cell + i] : 0;
}

template <class G, class T, class L>
static __device__ void cell_forces(const L &l, const cuda_view<real> &v, const cuda_pass &p, const tile &t,
                                   const uint32_t &first, const real *u, real *force)
{
    uint32_t cell = first;
#pragma unroll 1
    for (int i = threadIdx.x; i < t.cells; i += G::THREADS) {
        const uint32_t next = cell_at(v, t, i + G::THREADS);
        cell_force<G, T>(l, v, p, t, i, cell, u, force);
        cell = next;
    }
}

/* Brings near what all of the threads ask for: *p gets where; room: L::NEAR. */
static __device__ void bring_gravity(const cuda_view<real> &v, const double *now, real *room)
{
    if (threadIdx.x < 3)
        room[threadIdx.x] = v.gravity < 0 ? 0 : (real)now[3 * v.gravity + threadIdx.x];
}

template <class G, class L>
static __device__ void bring_laws(const L &l, const cuda_view<real> &v, cuda_pass *p, real *room)
{
    constexpr bool more = L::LAW * LAWS_NEAR > G::THREADS; /* than one number a thread */
    const bool near = v.volumes <= LAWS_NEAR;
    p->gravity = room;
    p->law = near ? room + 4 : v.law;
    if (near && threadIdx.x < (l.coefficients + l.held) * v.volumes)
        room[4 + threadIdx.x] = v.law[threadIdx.x];
    if (more && near)
        for (int i = (int)threadIdx.x + G::THREADS; i < (l.coefficients + l.held) * v.volumes; i += G::THREADS)
            room[4 + i] = v.law[i];
}

/* The sum of the pulls at a node, elements in the lattice's order. */
template <class G> static __device__ element_vector node_internal(uint32_t info, const real *force)
{
    constexpr int order[8] = {6, 7, 5, 4, 2, 3, 1, 0};
    const int place = info & TILE_PLACE;
    element_vector sum = {0, 0, 0};
#pragma unroll
    for (int i = 0; i < 8; i++) {
        const int c = order[i];
        if (info >> (TILE_CORNERS + c) & 1) {
            const real *at = force + c * G::CELLS + place - cuda_corner<G>(c);
            sum.x += at[0];
            sum.y += at[8 * G::CELLS];
            sum.z += at[16 * G::CELLS];
        }
    }
    return sum;
}

/* A node's row, where tiles may be listed. */
template <bool LISTED> struct node_told {
};
template <> struct node_told<true> {
    uint4 row;
};

template <bool LISTED>
static __device__ node_told<LISTED> node_row(const cuda_view<real> &v, const tile &t, const cuda_list<LISTED> &list,
                                             int i)
{
    if constexpr (LISTED)
        return {list.pull >= 0 && i < t.nodes ? v.pull[list.pull + i] : uint4{0, 0, 0, 0}};
    else
        return {};
}

template <class G>
static __device__ element_vector node_sum(uint32_t info, const node_told<false> &, const cuda_list<false> &,
                                          const real *force)
{
    return node_internal<G>(info, force);
}

/* Of a listed tile, in the order of the row. */
template <class G>
static __device__ element_vector node_sum(uint32_t info, const node_told<true> &told, const cuda_list<true> &list,
                                          const real *force)
{
    element_vector sum = {0, 0, 0};
    if (list.pull < 0)
        return node_internal<G>(info, force);
#pragma unroll
    for (int i = 0; i < 8; i++) {
        const uint32_t entry = cuda_entry(told.row, i);
        if (entry != TILE_NO_PULL) {
            const real *at = force + (entry >> TILE_PULL) * G::CELLS + (entry & TILE_PLACE);
            sum.x += at[0];
            sum.y += at[8 * G::CELLS];
            sum.z += at[16 * G::CELLS];
        }
    }
    return sum;
}

/* What pulls at a node (N), but for gravity, and what else the script does to it, or NULL. */
typedef struct node_pull {
    real net[3];
    const tile_extra *extra;
} node_pull;

/* One component of a node; gravity: its part of the acceleration. */
static __device__ void move_node(const cuda_pass &p, int a, bool is_free, real gravity, const node_pull &pull,
                                 real mass_inverse, real *velocity, real *u)
{
    real acceleration = is_free ? gravity + pull.net[a] * mass_inverse : 0;
    if (p.what & PASS_FINISH && is_free)
        *velocity = node_finish(*velocity, acceleration, p.factors);
    if (p.what & PASS_BEGIN) {
        if (is_free) {
            *velocity = node_begin(*velocity, acceleration, p.factors);
            *u += p.factors.dt * *velocity;
        } else if (pull.extra && pull.extra->hold[a] >= 0) {
            real to = (real)moves_to(p.next, pull.extra->hold[a], a, pull.extra->rest);
            *velocity = (to - *u) / p.factors.dt;
            *u = to;
        }
    }
}

/* What a thread knows of its node. CUT: where elements may be cut, what gravity acts on too, in parts of its mass. */
template <bool CUT> struct own_node {
    uint32_t info;
    real mass_inverse, velocity[3];
};
template <> struct own_node<true> {
    uint32_t info;
    real mass_inverse, velocity[3], weight;
};

template <bool CUT> static __device__ real gravity_on(const cuda_pass &p, const own_node<CUT> &own, int a)
{
    if constexpr (CUT)
        return p.gravity[a] * own.weight;
    else
        return p.gravity[a];
}

static __device__ node_pull node_pulled(const cuda_view<real> &v, const cuda_pass &p, int32_t n, uint32_t info,
                                        element_vector f, const real u[3])
{
    node_pull pull = {{-f.x, -f.y, -f.z}, NULL};
    if (info >> TILE_EXTRA & 1) {
        const tile_extra *x = pull.extra = cuda_extra(v, n);
        for (int32_t k = x->force; k < x->force + x->forces; k++)
            for (int a = 0; a < 3; a++)
                pull.net[a] += (real)cuda_force(v, k, p.now, a, (double)u[a]);
    }
    return pull;
}

/* A node's step for the elements' pull f: own->velocity and u (its three components) move on. */
template <bool CUT>
static __device__ void step_node(const cuda_view<real> &v, const cuda_pass &p, int32_t n, element_vector f,
                                 own_node<CUT> *own, real u[3])
{
    const node_pull pull = node_pulled(v, p, n, own->info, f, u);
#pragma unroll
    for (int a = 0; a < 3; a++)
        move_node(p, a, own->info >> (TILE_FREE + a) & 1, gravity_on(p, *own, a), pull, own->mass_inverse,
                  &own->velocity[a], &u[a]);
}

template <bool CUT>
static __device__ own_node<CUT> node_at(const cuda_view<real> &v, const cuda_pass &p, const tile &t, int i)
{
    own_node<CUT> own = {0, 0, {0, 0, 0}};
    if (i < t.nodes) {
        const int32_t n = t.node + i;
        own.info = v.node_info[n];
        own.mass_inverse = v.mass_inverse[n];
        if constexpr (CUT)
            own.weight = v.weight[n];
        for (int a = 0; a < 3; a++)
            own.velocity[a] = p.velocity[a * v.stride + n];
    }
    return own;
}

/* f: the elements' pull. */
template <class G, bool CUT>
static __device__ void one_node(const cuda_view<real> &v, const cuda_pass &p, const tile &t, int i, own_node<CUT> own,
                                element_vector f, const real *grid)
{
    const int32_t n = t.node + i;
    const int place = own.info & TILE_PLACE;
    const bool is_apart = own.info >> TILE_APART & 1;
    if (p.what & PASS_INTERNAL || is_apart) {
        p.to[n] = f.x, p.to[v.stride + n] = f.y, p.to[2 * v.stride + n] = f.z;
        if (is_apart || !(p.what & PASS_FINISH))
            return;
    }
    real u[3] = {grid[place], grid[G::PLACES + place], grid[2 * G::PLACES + place]};
    step_node(v, p, n, f, &own, u);
    for (int a = 0; a < 3; a++) {
        if (p.what & PASS_BEGIN)
            p.to[a * v.stride + n] = u[a];
        p.velocity[a * v.stride + n] = own.velocity[a];
    }
}

/* Double precision takes more registers than so many blocks would leave it, and any form and cut elements may do. */
template <class G, class L> static constexpr int together(void)
{
    return sizeof(real) == sizeof(float) ? (L::ASKS || L::CUT ? (G::TOGETHER + 1) / 2 : G::TOGETHER) : 1;
}

/* But 16 warps of it are to be on a multiprocessor: of physical control, a few more registers would halve them. */
template <class G, class L> static constexpr int passes_together(void)
{
    return sizeof(real) == sizeof(float) ? together<G, L>() : L::ASKS || L::CUT ? 1 : 512 / G::THREADS;
}

template <class G, class L, class T>
static __global__ void __launch_bounds__(G::THREADS, passes_together<G, L>())
    pass_kernel(cuda_view<real> v, const __grid_constant__ cuda_pass given, const __grid_constant__ L l)
{
    DYNAMIC_SHARED(double, memory);
    real *u = (real *)memory, *near = u + 3 * G::PLACES, *force = near + L::NEAR;
    const tile t = v.tiles[blockIdx.x];
    const cuda_list<T::LISTED> list = cuda_list_of<T>(v, blockIdx.x);
    const uint32_t first = cell_at(v, t, threadIdx.x);
    cuda_pass p = given;
    bring_laws<G>(l, v, &p, near);
    bring_gravity(v, p.now, near);
    cuda_load<G, true>(v, t, p.from, u);
    __syncthreads();
    cell_forces<G, T>(l, v, p, t, first, u, force);
    own_node<L::CUT> own = node_at<L::CUT>(v, p, t, threadIdx.x);
    node_told<T::LISTED> told = node_row(v, t, list, threadIdx.x);
    __syncthreads();
    for (int i = threadIdx.x; i < t.nodes; i += G::THREADS) {
        one_node<G>(v, p, t, i, own, node_sum<G>(own.info, told, list, force), u);
        own = node_at<L::CUT>(v, p, t, i + G::THREADS);
        told = node_row(v, t, list, i + G::THREADS);
    }
}

template <class G, class L> static size_t pass_shared(void)
{
    return (3 * (size_t)G::PLACES + L::NEAR + 24 * (size_t)G::CELLS) * sizeof(real);
}

/* Lets the kernels have so much shared memory; nonzero where the card has not so much. */
template <class G, class L> static cudaError_t pass_allow(void)
{
    const int shared = (int)pass_shared<G, L>();
    cudaError_t e = cudaSuccess;
    for (int kind = 0; e == cudaSuccess && kind < 4; kind++)
        e = with_tiles<L>(kind & 1, kind & 2, [&](auto t) {
            return cudaFuncSetAttribute(pass_kernel<G, L, decltype(t)>, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                        shared);
        });
    return e;
}

template <class G, class L>
static cudaError_t pass_start(const L &l, const cuda_view<real> &v, const cuda_pass &p, int64_t tiles,
                              cudaStream_t stream)
{
    const card_blocks blocks = {tiles, G::THREADS, pass_shared<G, L>(), stream};
    return with_tiles<L>(v.mixed, v.list,
                         [&](auto t) { return card_start(pass_kernel<G, L, decltype(t)>, blocks, v, p, l); });
}

#endif
