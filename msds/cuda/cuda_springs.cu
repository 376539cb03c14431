/* Frames of springs on the card: PST equations 3 to 5, all steps of a frame in one launch, a barrier each.
 */
#include "msds/cuda/cuda_contact.cuh"

typedef float real;
extern "C" {
#include "msds/problem/spring.h"
}

/* A spring and its other end. */
typedef struct spring_end {
    float4 spring, place, u, v;
} spring_end;

static __device__ inline spring_end load_end(const tissue *t, int32_t at)
{
    const float4 spring = t->spring[at];
    const int32_t other = __float_as_int(spring.w);
    return {spring, t->place[other], t->u[other], t->v[other]};
}

/* What a spring pulls its first end with: x, u and v are that end's. */
static __device__ inline void pull(const spring_end *o, float4 x, float4 u, float4 v, float force[3])
{
    const float du[3] = {o->u.x - u.x, o->u.y - u.y, o->u.z - u.z}, dv[3] = {o->v.x - v.x, o->v.y - v.y, o->v.z - v.z};
    const float at_rest[3] = {o->place.x - x.x, o->place.y - x.y, o->place.z - x.z}, rest = o->spring.x;
    float d[3], stretch = 0, speed = 0;
    for (int a = 0; a < 3; a++) {
        d[a] = at_rest[a] + du[a];
        stretch += du[a] * (at_rest[a] + d[a]);
        speed += dv[a] * d[a];
    }
    const float square = fmaxf(rest * rest + stretch, rest * rest * SPRING_LEAST), length = sqrtf(square);
    const float scale = SPRING_FORCE(o->spring.y, o->spring.z, rest, square, speed, stretch, length);
    for (int a = 0; a < 3; a++)
        force[a] += scale * d[a];
}

/* What the probe pushes a node with: a spring and damper, which does not pull. */
static __device__ void push(const tissue *t, const tissue_frame *f, int32_t n, float4 u, float4 v, float force[3])
{
    const float4 place = t->place[n];
    const double x[3] = {(double)place.x + (double)u.x, (double)place.y + (double)u.y, (double)place.z + (double)u.z};
    const probe_touch at = probe_at(&f->probe, x);
    const double speed = at.way[0] * (double)v.x + at.way[1] * (double)v.y + at.way[2] * (double)v.z;
    const double pushed = (double)t->weight[n].w * (at.depth - f->damping * speed);
    if (!(at.depth > 0 && pushed > 0))
        return;
    for (int a = 0; a < 3; a++)
        force[a] += (float)(pushed * at.way[a]);
    if (place.w > 0)
        t->outcome->reading.met = true;
}

/* AHEAD springs are loaded before the first of them is computed, each whole with its neighbour's
 * number: what is computed has branches (of division and root), past which no compiler moves loads, and
 * a small mesh waits for nothing but loads. */
template <int AHEAD> static __device__ inline void move_node(const tissue *t, const tissue_frame *f, int32_t n)
{
    const float4 x = t->place[n], u = t->u[n], v = t->v[n], weight = t->weight[n];
    const int32_t slice = n / LANES, lane = n % LANES, last = t->start[slice + 1];
    float force[3] = {weight.x, weight.y, weight.z};
    int32_t slot = t->start[slice];
    for (; slot + AHEAD <= last; slot += AHEAD) {
        spring_end end[AHEAD];
#pragma unroll
        for (int i = 0; i < AHEAD; i++)
            end[i] = load_end(t, (slot + i) * LANES + lane);
#pragma unroll
        for (int i = 0; i < AHEAD; i++)
            pull(&end[i], x, u, v, force);
    }
    for (; slot < last; slot++) {
        const spring_end end = load_end(t, slot * LANES + lane);
        pull(&end, x, u, v, force);
    }
    if (f->touched && square_away(f, x, u) < f->reach * f->reach)
        push(t, f, n, u, v, force);
    const float inverse = f->dt * x.w;
    const float4 speed = {v.x + inverse * force[0], v.y + inverse * force[1], v.z + inverse * force[2], 0};
    t->next_v[n] = speed;
    t->next_u[n] = {u.x + f->dt * speed.x, u.y + f->dt * speed.y, u.z + f->dt * speed.z, 0};
}

/* The contacts where springs stand now, and what the next step would push them with. */
static __device__ void note_contact(const tissue *t, const tissue_frame *f, int32_t n)
{
    const float4 u = t->u[n], v = t->v[n];
    t->listed[n] = 0;
    if (contact_candidate(t, f, n, u)) {
        const double from[3] = {(double)u.x, (double)u.y, (double)u.z};
        contact_consider(t, f, n, from, CONTACT_CLINGING, 0, false);
    }
    if (t->listed[n]) {
        tissue_contact *c = &t->contact[n];
        const double speed = c->way[0] * (double)v.x + c->way[1] * (double)v.y + c->way[2] * (double)v.z;
        c->force = c->depth > 0 ? fmax(0., t->repulsion[n] * (c->depth - f->damping * speed)) : 0;
    }
    contact_hold(t, n);
}

template <int AHEAD, int BLOCKS>
static __global__ void __launch_bounds__(GRID_THREADS, BLOCKS) springs_kernel(tissue t, tissue_frame f)
{
    __shared__ grid_scratch scratch;
    for (int32_t i = 0; i < f.count; i++) {
        for (int32_t chunk = blockIdx.x; chunk < t.chunks; chunk += gridDim.x)
            if (CHUNK_NODE(chunk) < t.nodes)
                move_node<AHEAD>(&t, &f, CHUNK_NODE(chunk));
        float4 *u = t.u, *v = t.v;
        t.u = t.next_u, t.v = t.next_v;
        t.next_u = u, t.next_v = v;
        if (i < f.count - 1)
            grid_barrier(t.arrived);
    }
    for (int32_t chunk = blockIdx.x; chunk < t.chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        if (n < t.nodes)
            note_contact(&t, &f, n);
        sight_parts(&t, &f, chunk, n < t.nodes ? t.u[n] : float4{0, 0, 0, 0}, &scratch);
    }
    grid_barrier(t.arrived);
    if (blockIdx.x == 0)
        sight_sum(&t, NAN, 0, &scratch);
}

/* Few blocks wait for loads; many hide them behind each other. */
static const void *kernel_of(const tissue *t, int processors)
{
    return t->chunks <= 2 * processors ? (const void *)springs_kernel<6, 2> : (const void *)springs_kernel<2, 6>;
}

cudaError_t tissue_springs_start(const tissue *t, const tissue_frame *f, cudaStream_t stream)
{
    return tissue_start(TISSUE_SPRINGS, kernel_of, t, f, NULL, t->chunks, stream);
}
