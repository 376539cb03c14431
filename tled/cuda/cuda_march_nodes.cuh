/* How a march moves nodes: from what their elements pull with, where their displacements and velocities stand in shared
 * memory. Included by cuda_march.cu alone, after what a turn is.
 */
#ifndef SINEW_CUDA_MARCH_NODES_CUH
#define SINEW_CUDA_MARCH_NODES_CUH

/* The bits of a velocity's fourth number. CUTS: elements may be cut. */
template <bool CUTS> static __device__ __forceinline__ uint32_t bits_of(float fourth)
{
    return CUTS ? __float_as_uint(fourth) & MARCH_BITS : __float_as_uint(fourth);
}

/* What gravity acts on, in parts of a node's mass, from there. */
template <bool CUTS> static __device__ __forceinline__ float weight_of(float fourth)
{
    return CUTS ? __uint_as_float(__float_as_uint(fourth) & ~(uint32_t)MARCH_BITS) : 1;
}

/* One component of a node that the script displaces or pushes, or that is held; pull: elements' forces
 * on it; weight: weight_of. It is worked on where it stands in shared memory, component by component: few
 * nodes are such, and others are to keep their registers. */
template <bool STEP>
static __device__ __forceinline__ void move_held(const cuda_march &m, const cuda_march_pass &p, const turn &t,
                                                 uint32_t speed, uint32_t word, uint32_t node, uint32_t bits, int a,
                                                 float pull, float weight)
{
    const tile_extra *x = bits >> MARCH_EXTRA & 1 ? cuda_extra(m.v, (int32_t)(word & MARCH_NODE)) : NULL;
    const double *now = now_of(p, t);
    const cuda_march_kind &k = kind_of<STEP>(p, t);
    const int axis = m.axis[a];
    float u = shared_number(node + 4 * a), v = shared_number(speed + 4 * a), net = -m.force * pull;
    for (int32_t i = x ? x->forces : 0; (i = unknown(i)) > 0; i--) /* of unknown length: else it is unrolled */
        net += (float)cuda_force(m.v, x->force + i - 1, now, axis, (double)u);
    if (bits >> (MARCH_FREE + a) & 1) {
        v = k.keep * v + weight * shared_number(t.memory + GRAVITY + 4 * a) + k.push * shared_number(node + 12) * net;
        u += k.dt * v;
    } else if (k.what & PASS_BEGIN && x && x->hold[axis] >= 0) {
        const float to = (float)moves_to(now + p.row, x->hold[axis], axis, x->rest);
        v = (to - u) / k.dt;
        u = to;
    }
    shared_number_store(node + 4 * a, u);
    shared_number_store(speed + 4 * a, v);
}

/* What a pass leaves of a node. */
template <bool STEP>
static __device__ __forceinline__ void put_node(const cuda_march_pass &p, const turn &t, uint32_t word, float4 u,
                                                float4 v)
{
    const cuda_march_kind &k = kind_of<STEP>(p, t);
    if (STEP || k.what & PASS_BEGIN)
        *(float4 *)node_of(to_of(p, t), word) = u;
    if (STEP || k.what & (PASS_BEGIN | PASS_FINISH))
        *(float4 *)node_of(p.velocity, word) = v;
}

/* Leaves what elements pull at a node with, N, where its next displacement goes else. */
static __device__ __forceinline__ void put_pull(const void *to, float x, float y, float z, float fourth)
{
    *(float4 *)to = make_float4(x, y, z, fourth);
}

/* The forces at a thread's node, and its step, if it is owned; forces, node, speed: where its
 * forces, displacement and velocity stand. */
template <bool STEP, bool CUTS>
static __device__ __forceinline__ void move_node(const cuda_march &m, const cuda_march_pass &p, const turn &t,
                                                 uint32_t word, uint32_t forces, uint32_t node, uint32_t speed)
{
    if (!(word & MARCH_OWN))
        return;
    const float4 own = shared_load(forces + 3 * FORCE), x = shared_load(forces - NODE);
    const float4 y = shared_load(forces + FORCE - GRID * NODE);
    const float4 xy = shared_load(forces + 2 * FORCE - (GRID + 1) * NODE);
    float4 u = shared_load(node), v = shared_load(speed);
    float4 gravity = shared_load(t.memory + GRAVITY);
    const float3 sum = {(own.x + x.x) + (y.x + xy.x), (own.y + x.y) + (y.y + xy.y), (own.z + x.z) + (y.z + xy.z)};
    const uint32_t bits = bits_of<CUTS>(v.w);
    const float weight = weight_of<CUTS>(v.w);
    if (CUTS)
        gravity.x *= weight, gravity.y *= weight, gravity.z *= weight;
    const cuda_march_kind &k = kind_of<STEP>(p, t);
    if (!STEP && k.what & PASS_INTERNAL)
        put_pull(node_of(to_of(p, t), word), m.force * sum.x, m.force * sum.y, m.force * sum.z, u.w);
    if (bits != 7) {
        if (bits >> MARCH_APART & 1) {
            put_pull(node_of(to_of(p, t), word), m.force * sum.x, m.force * sum.y, m.force * sum.z, u.w);
            return;
        }
#pragma unroll 1
        for (int a = 0; bits && a < 3; a++) /* of what is held and not displaced, all stays */
            move_held<STEP>(m, p, t, speed, word, node, bits, a, a == 0 ? sum.x : a == 1 ? sum.y : sum.z, weight);
        put_node<STEP>(p, t, word, shared_load(node), shared_load(speed));
    } else {
        const float pull = k.pull * u.w;
        v.x = (k.keep * v.x + gravity.x) - pull * sum.x;
        v.y = (k.keep * v.y + gravity.y) - pull * sum.y;
        v.z = (k.keep * v.z + gravity.z) - pull * sum.z;
        u.x += k.dt * v.x;
        u.y += k.dt * v.y;
        u.z += k.dt * v.z;
        put_node<STEP>(p, t, word, u, v);
    }
}

#endif
