/* How a march moves nodes: from what their elements pull with, where their displacements and velocities stand in shared
 * memory. Included by cuda_march.cu alone, after what a turn is.
 */
#ifndef SINEW_CUDA_MARCH_NODES_CUH
#define SINEW_CUDA_MARCH_NODES_CUH

/* The bits of a velocity's fourth number. CUTS: elements may be cut. */
template <bool CUTS> static __device__ __forceinline__ uint32_t bits_of(real fourth)
{
#ifdef ELEMENT_SINGLE
    const uint32_t bits = __float_as_uint(fourth);
#else
    const uint32_t bits = (uint32_t)__double2loint(fourth);
#endif
    return CUTS ? bits & MARCH_BITS : bits;
}

/* What gravity acts on, in parts of a node's mass, from there. */
template <bool CUTS> static __device__ __forceinline__ real weight_of(real fourth)
{
    if constexpr (!CUTS)
        return 1;
#ifdef ELEMENT_SINGLE
    return __uint_as_float(__float_as_uint(fourth) & ~(uint32_t)MARCH_BITS);
#else
    return __hiloint2double(__double2hiint(fourth), __double2loint(fourth) & ~(int)MARCH_BITS);
#endif
}

/* One component of a node that the script displaces or pushes, or that is held; pull: elements' forces
 * on it; weight: weight_of. It is worked on where it stands in shared memory, component by component: few
 * nodes are such, and others are to keep their registers. */
template <bool STEP>
static __device__ __forceinline__ void move_held(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                 const turn &t, uint32_t speed, uint32_t word, uint32_t node,
                                                 uint32_t bits, int a, real pull, real weight)
{
    const tile_extra *x = bits >> MARCH_EXTRA & 1 ? cuda_extra(m.v, (int32_t)(word & MARCH_NODE)) : NULL;
    const double *now = now_of(p, t);
    const cuda_march_kind<real> &k = kind_of<STEP>(p, t);
    const int axis = m.axis[a];
    real u = node_number(node, a), v = node_number(speed, a), net = -m.force * pull;
    for (int32_t i = x ? x->forces : 0; (i = unknown(i)) > 0; i--) /* of unknown length: else it is unrolled */
        net += (real)cuda_force(m.v, x->force + i - 1, now, axis, (double)u);
    if (bits >> (MARCH_FREE + a) & 1) {
        v = k.keep * v + weight * node_number(t.memory + GRAVITY, a) + k.push * node_number(node, 3) * net;
        u += k.dt * v;
    } else if (k.what & PASS_BEGIN && x && x->hold[axis] >= 0) {
        const real to = (real)moves_to(now + p.row, x->hold[axis], axis, x->rest);
        v = (to - u) / k.dt;
        u = to;
    }
    node_number_store(node, a, u);
    node_number_store(speed, a, v);
}

/* What a pass leaves of a node. */
template <bool STEP>
static __device__ __forceinline__ void put_node(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                const turn &t, uint32_t word, real4 u, real4 v)
{
    const cuda_march_kind<real> &k = kind_of<STEP>(p, t);
    if (STEP || k.what & PASS_BEGIN)
        put_four(m, node_of(to_of(p, t), word), u);
    if (STEP || k.what & (PASS_BEGIN | PASS_FINISH))
        put_four(m, node_of(p.velocity, word), v);
}

/* The forces at a thread's node, and its step, if it is owned; forces, node, speed: where its
 * forces, displacement and velocity stand. */
template <bool STEP, bool CUTS>
static __device__ __forceinline__ void move_node(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                 const turn &t, uint32_t word, uint32_t forces, uint32_t node,
                                                 uint32_t speed)
{
    if (!(word & MARCH_OWN))
        return;
    const real4 own = three_load(forces + 3 * FORCE), x = three_load(forces - NODE);
    const real4 y = three_load(forces + FORCE - GRID * NODE);
    const real4 xy = three_load(forces + 2 * FORCE - (GRID + 1) * NODE);
    real4 u = node_load(node), v = node_load(speed);
    real4 gravity = node_load(t.memory + GRAVITY);
    const real3 sum = {(own.x + x.x) + (y.x + xy.x), (own.y + x.y) + (y.y + xy.y), (own.z + x.z) + (y.z + xy.z)};
    const uint32_t bits = bits_of<CUTS>(v.w);
    const real weight = weight_of<CUTS>(v.w);
    if (CUTS)
        gravity.x *= weight, gravity.y *= weight, gravity.z *= weight;
    const cuda_march_kind<real> &k = kind_of<STEP>(p, t);
    /* What elements pull with, in newtons, goes where the next displacement goes else. */
    if (!STEP && k.what & PASS_INTERNAL)
        put_four(m, node_of(to_of(p, t), word), {m.force * sum.x, m.force * sum.y, m.force * sum.z, u.w});
    if (bits != 7) {
        if (bits >> MARCH_APART & 1) {
            put_four(m, node_of(to_of(p, t), word), {m.force * sum.x, m.force * sum.y, m.force * sum.z, u.w});
            return;
        }
#pragma unroll 1
        for (int a = 0; bits && a < 3; a++) /* of what is held and not displaced, all stays */
            move_held<STEP>(m, p, t, speed, word, node, bits, a, a == 0 ? sum.x : a == 1 ? sum.y : sum.z, weight);
        put_node<STEP>(m, p, t, word, node_load(node), node_load(speed));
    } else {
        const real pull = k.pull * u.w;
        v.x = (k.keep * v.x + gravity.x) - pull * sum.x;
        v.y = (k.keep * v.y + gravity.y) - pull * sum.y;
        v.z = (k.keep * v.z + gravity.z) - pull * sum.z;
        u.x += k.dt * v.x;
        u.y += k.dt * v.y;
        u.z += k.dt * v.z;
        put_node<STEP>(m, p, t, word, u, v);
    }
}

#endif
