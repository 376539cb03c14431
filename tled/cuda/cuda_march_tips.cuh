/* A march's tips (march.h): eight threads compute the elements of one, a thread each, and add up what these pull it
 * with by exchanging sums; the first of them moves it. Each thread copies the displacements of its element's corners to
 * shared memory of its own, which layers have between units:
 *
 *     corner 0 of threads 0, 1, ... 255 | corner 1 ... | ... | corner 7 ... | velocities of first threads' tips
 *
 * Included by cuda_march.cu alone, after what a turn is.
 */
#ifndef SINEW_CUDA_MARCH_TIPS_CUH
#define SINEW_CUDA_MARCH_TIPS_CUH

enum { TIP_ROW = MARCH_THREADS * NODE, TIP_VELOCITY = 8 * TIP_ROW };
static_assert((int)MARCH_TIPS * 8 == (int)MARCH_THREADS, "a unit's tips take its threads");
static_assert((int)TIP_VELOCITY + (int)TIP_ROW <= (int)GRAVITY, "what stands from there on is not written over");

/* Of corners `corner` to corner + 3 of a thread's element. */
static __device__ __forceinline__ face tip_face(uint32_t at, int corner)
{
    const uint32_t first = at + (uint32_t)corner * TIP_ROW;
    return face_between(node_load(first), node_load(first + TIP_ROW), node_load(first + 2 * TIP_ROW),
                        node_load(first + 3 * TIP_ROW));
}

/* What a corner of a face gets of forces on the face's modes. */
static __device__ __forceinline__ real3 tip_share(const face &f, int corner)
{
    const real one = 1, x = corner & 1 ? one : -one, y = corner & 2 ? one : -one;
    real to[3];
#pragma unroll
    for (int a = 0; a < 3; a++)
        to[a] = (f.mean[a] + y * f.y[a]) + x * (f.x[a] + y * f.xy[a]);
    return {to[0], to[1], to[2]};
}

template <march_control K>
static __device__ __forceinline__ void tip_muscles(const cuda_march<real> &m, const double *now,
                                                   const cuda_march_cell<real> &cell, const face &low, const face &high,
                                                   const march_cut *cut, face *sum, push<K> *below)
{
    const element_tensor h = gradient_by(m, cut, low, high);
    const real peak[2] = {cell.peak, cell.second_peak};
    int32_t curve = cell.muscle[0].curve;
    for (int i = 0; i < 2 && curve >= 0; i++) {
        const march_muscle &muscle = cell.muscle[i];
        const real tension = peak[i] * (real)now[3 * (muscle.curve & ~MARCH_SECOND)];
        add_tension(m, h, {{muscle.fibre[0], muscle.fibre[1], muscle.fibre[2]}, tension}, cut, sum, below);
        curve = curve & MARCH_SECOND ? 0 : -1;
    }
}

/* What a thread's element pulls the tip with, in the march's unit of force. */
template <march_control K, bool CUTS>
static __device__ __forceinline__ real3 tip_pull(const cuda_march<real> &m, const double *now, const march_tip &of,
                                                 uint2 along, uint32_t at)
{
    const face low = tip_face(at, 0), high = tip_face(at, 4);
    const march_cut *cut = CUTS && of.special && of.special <= m.cuts ? m.cut + of.special - 1 : NULL;
    push<K> below = {};
    face sum;
    if constexpr (K == MARCH_ISOTROPIC) {
        real mu = m.law[0], bulk = m.law[1], hourglass = m.law[2];
        if (of.special) {
            const cuda_march_cell<real> &cell = m.cell[of.special - 1];
            mu = cell.mu, bulk = cell.bulk, hourglass = cell.second;
        }
        cell_forces(m, mu, bulk, hourglass, true, low, high, &sum, &below);
    } else {
        tissue<K> its = plain_tissue<K>(m);
        if (of.special) {
            const cuda_march_cell<real> &cell = m.cell[of.special - 1];
            special_tissue(m, cell, {cell.mu, cell.bulk, cell.second, 0}, &its);
        }
        its.along = along;
        cell_forces<K, false>(m, its, true, low, high, cut, &sum, &below);
    }
    if (of.special)
        tip_muscles(m, now, m.cell[of.special - 1], low, high, cut, &sum, &below);
    return tip_share(of.corner < 4 ? sum : face_of(below, high), of.corner);
}

/* As move_node; n: where it stands; pull: in newtons. */
template <bool CUTS>
static __device__ __forceinline__ void move_tip(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                const turn &t, uint32_t n, real4 from, real4 speed, real3 pull)
{
    const cuda_march_kind<real> &k = p.kind[t.kind];
    const double *now = now_of(p, t);
    const uint32_t bits = bits_of<CUTS>(speed.w);
    const tile_extra *x = bits >> MARCH_EXTRA & 1 ? cuda_extra(m.v, (int32_t)n) : NULL;
    const real sum[3] = {pull.x, pull.y, pull.z};
    real u[3] = {from.x, from.y, from.z}, v[3] = {speed.x, speed.y, speed.z};
    if (k.what & PASS_INTERNAL || bits >> MARCH_APART & 1)
        put_four(m, nth(to_of(p, t), n), {sum[0], sum[1], sum[2], from.w});
    if (bits >> MARCH_APART & 1)
        return;
#pragma unroll
    for (int a = 0; a < 3; a++) {
        const int axis = m.axis[a];
        real net = -sum[a];
        for (int32_t i = x ? x->forces : 0; (i = unknown(i)) > 0; i--)
            net += (real)cuda_force(m.v, x->force + i - 1, now, axis, (double)u[a]);
        if (bits >> (MARCH_FREE + a) & 1) {
            const real gravity = m.v.gravity < 0 ? 0 : k.push * (real)now[3 * m.v.gravity + axis];
            v[a] = k.keep * v[a] + weight_of<CUTS>(speed.w) * gravity + k.push * from.w * net;
            u[a] += k.dt * v[a];
        } else if (k.what & PASS_BEGIN && x && x->hold[axis] >= 0) {
            const real to = (real)moves_to(now + p.row, x->hold[axis], axis, x->rest);
            v[a] = (to - u[a]) / k.dt;
            u[a] = to;
        }
    }
    put_node<false>(m, p, t, n, {u[0], u[1], u[2], from.w}, {v[0], v[1], v[2], speed.w});
}

/* `count` tips from t.base on, as a unit. */
template <march_control K, bool CUTS>
static __device__ __forceinline__ void move_tips(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                 const turn &t, uint32_t unit, int count)
{
    const int which = (int)threadIdx.x / 8, element = (int)threadIdx.x % 8;
    const uint32_t at = t.memory + threadIdx.x * NODE, n = (uint32_t)(m.tip_first + t.base + which);
    const bool moves = which < count && element == 0;
    real3 pull = {0, 0, 0};
    march_tip of = {{0, 0, 0, 0, 0, 0, 0, 0}, -1, 0};
    uint2 along = {0, 0};
    if (which < count) {
        of = m.tip[8 * (int64_t)(t.base + which) + element];
        fetch_along<K>(m.tip_along, 8 * (int64_t)(t.base + which) + element, &along);
    }
    wait_for_near(m, p, t, unit);
    if (threadIdx.x == 0)
        note_next(m, p, t.memory, take_ticket(m.ticket));
#pragma unroll
    for (int c = 0; c < 8; c++)
        send_node(m, at + (uint32_t)c * TIP_ROW, nth(from_of(p, t), (uint32_t)of.node[c]), of.corner >= 0);
    send_node(m, at + TIP_VELOCITY, nth(p.velocity, moves ? n : 0), moves);
    sent();
    arrived<0>();
    if (of.corner >= 0)
        pull = tip_pull<K, CUTS>(m, now_of(p, t), of, along, at);
#pragma unroll
    for (int with = 1; with < 8; with *= 2) {
        pull.x += __shfl_xor_sync(~0u, pull.x, with);
        pull.y += __shfl_xor_sync(~0u, pull.y, with);
        pull.z += __shfl_xor_sync(~0u, pull.z, with);
    }
    if (moves)
        move_tip<CUTS>(m, p, t, n, node_load(at + (uint32_t)of.corner * TIP_ROW), node_load(at + TIP_VELOCITY),
                       {m.force * pull.x, m.force * pull.y, m.force * pull.z});
}

#endif
