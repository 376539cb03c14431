/* Nodes that slide on bone, on a card: a pass leaves these nodes alone, and their elements' pulls where their next
 * displacements go; the kernel here then takes their steps, by sliding_node.h. A look at the state leaves them out of
 * what it asks of free nodes; a kernel here adds them. Included by cuda_state.cuh, and
 * by cuda_skin_room.cuh, as the kernel of skin takes these steps first.
 */
#ifndef SINEW_CUDA_SLIDING_CUH
#define SINEW_CUDA_SLIDING_CUH

#include "solve/card_layout.cuh"
#include "tled/cuda/cuda_view.cuh"

extern "C" {
#include "tled/contact/sliding.h"
}

enum { SLIDE_THREADS = 64, SLIDE_LOOK_THREADS = 256 };

/* A node, as the card has it. */
typedef struct cuda_slider {
    sliding_node node;
    double mass, weight;   /* kg; weight: of that, what gravity acts on */
    int32_t stand;         /* where it stands */
    int32_t force, forces; /* in force_curve and so on */
} cuda_slider;

/* What the kernels see of them. */
typedef struct cuda_sliders {
    sliding_ground ground;
    const cuda_slider *slider;
    int32_t count; /* 0: none */
} cuda_sliders;

typedef struct cuda_slide {
    cuda_view<real> view;
    cuda_sliders of;
    const real *from;
    real *to, *velocity;             /* to: pulls, and then the next displacements */
    const double *past, *now, *next; /* the curves' values: a step before now, now, at the step's end */
    sliding_step step;
} cuda_slide;

/* An acceleration by all forces but the bone's; pull: of elements, N. */
static __device__ void slider_acceleration(const cuda_view<real> &v, const cuda_slider &s, const double *now,
                                           const double *u, const real *pull, double *to)
{
    for (int a = 0; a < 3; a++) {
        double force = v.gravity < 0 ? 0 : s.weight * now[3 * v.gravity + a];
        for (int32_t k = s.force; k < s.force + s.forces; k++)
            force += cuda_force(v, k, now, a, u[a]);
        to[a] = (force - (double)pull[a]) / s.mass;
    }
}

static __device__ void slide_node(const cuda_slide &c, int32_t i)
{
    const cuda_slider &s = c.of.slider[i];
    const sliding_field *field = &c.of.ground.field[s.node.of];
    real at[3], speed[3], pull[3];
    double u[3], v[3], acceleration[3];
    sliding_bones bones;
    sliding_step step = c.step;
    cuda_three<false>(c.view, c.from, s.stand, at);
    cuda_three<false>(c.view, c.velocity, s.stand, speed);
    cuda_three<false>(c.view, c.to, s.stand, pull);
    for (int a = 0; a < 3; a++)
        u[a] = (double)at[a], v[a] = (double)speed[a];
    step.next = c.next;
    bones.was = sliding_bone_of(field, c.now);
    bones.past = step.finishes ? sliding_bone_of(field, c.past) : bones.was;
    bones.is = step.begins ? sliding_bone_of(field, c.next) : bones.was;
    slider_acceleration(c.view, s, c.now, u, pull, acceleration);
    sliding_go(&c.of.ground, &s.node, &bones, &step, acceleration, u, v);
    for (int a = 0; a < 3; a++) {
        const int64_t to = c.view.offset[a] + s.stand * c.view.along;
        c.velocity[to] = (real)v[a];
        if (step.begins)
            c.to[to] = (real)u[a];
    }
}

static __global__ void __launch_bounds__(SLIDE_THREADS) slide_kernel(const __grid_constant__ cuda_slide c)
{
    const int32_t i = (int32_t)(blockIdx.x * SLIDE_THREADS + threadIdx.x);
    if (i < c.of.count)
        slide_node(c, i);
}

/* What monitor() asks of them. */
typedef struct cuda_slide_look {
    cuda_view<real> view;
    cuda_sliders of;
    const real *displacement, *velocity, *internal;
    const real *saved_displacement, *saved_internal; /* in rows; or NULL */
    const double *now;
    tled_sums *sums;
} cuda_slide_look;

/* As monitor.c: what bone bears of the forces is left out. */
static __device__ void look_at_slider(const cuda_slide_look &l, const cuda_slider &s, double *to)
{
    const sliding_bone bone = sliding_bone_of(&l.of.ground.field[s.node.of], l.now);
    real at[3], speed[3], pull[3];
    double u[3], net[3];
    cuda_three<false>(l.view, l.displacement, s.stand, at);
    cuda_three<false>(l.view, l.velocity, s.stand, speed);
    cuda_three<false>(l.view, l.internal, s.stand, pull);
    for (int a = 0; a < 3; a++)
        u[a] = (double)at[a];
    slider_acceleration(l.view, s, l.now, u, pull, net);
    for (int a = 0; a < 3; a++)
        net[a] *= s.mass;
    const sliding_load load = sliding_load_of(&l.of.ground, &s.node, &bone, u, net);
    for (int a = 0; a < 3; a++) {
        if (s.node.hold[a] != SLIDING_FREE)
            continue;
        const double gap = net[a] + (load.normal[a] + load.stuck[a]);
        to[0] += gap * gap / s.mass;
        to[1] += s.mass * (double)speed[a] * (double)speed[a];
        if (l.saved_displacement) {
            const int64_t row = a * l.view.stride + s.stand;
            const double du = u[a] - (double)l.saved_displacement[row];
            to[2] += du * ((double)pull[a] - (double)l.saved_internal[row]);
            to[3] += s.mass * du * du;
        }
    }
}

/* One block, which adds up in one order. */
static __global__ void __launch_bounds__(SLIDE_LOOK_THREADS)
    slide_look_kernel(const __grid_constant__ cuda_slide_look l)
{
    enum { NUMBERS = 4 };
    __shared__ double part[NUMBERS * SLIDE_LOOK_THREADS];
    double mine[NUMBERS] = {0, 0, 0, 0};
    for (int32_t i = (int32_t)threadIdx.x; i < l.of.count; i += SLIDE_LOOK_THREADS)
        look_at_slider(l, l.of.slider[i], mine);
    for (int k = 0; k < NUMBERS; k++)
        part[k * SLIDE_LOOK_THREADS + threadIdx.x] = mine[k];
    for (unsigned with = SLIDE_LOOK_THREADS / 2; with; with /= 2) {
        __syncthreads();
        for (int k = 0; k < NUMBERS && threadIdx.x < with; k++)
            part[k * SLIDE_LOOK_THREADS + threadIdx.x] += part[k * SLIDE_LOOK_THREADS + threadIdx.x + with];
    }
    if (threadIdx.x)
        return;
    l.sums->acceleration += part[0];
    l.sums->speed += part[SLIDE_LOOK_THREADS];
    l.sums->stiffness += part[2 * SLIDE_LOOK_THREADS];
    l.sums->inertia += part[3 * SLIDE_LOOK_THREADS];
}

static cudaError_t slide_start(const cuda_slide &c, cudaStream_t stream)
{
    return card_start(slide_kernel, {(c.of.count + SLIDE_THREADS - 1) / SLIDE_THREADS, SLIDE_THREADS, 0, stream}, c);
}

static cudaError_t slide_look_start(const cuda_slide_look &l, cudaStream_t stream)
{
    return card_start(slide_look_kernel, {1, SLIDE_LOOK_THREADS, 0, stream}, l);
}

/* The host's list of them, the caller's to free. stand: of the model's nodes. NULL with e filled. */
static cuda_slider *slider_list(const tled_problem *p, const int32_t *stand, err *e)
{
    const sliding *s = p->sliding;
    cuda_slider *to = (cuda_slider *)mem_array(s->count, sizeof *to, "the sliding nodes", e);
    for (int64_t i = 0; to && i < s->count; i++) {
        const int32_t n = s->node[i], force = p->force_start[n];
        to[i] = {sliding_node_of(p, i), p->mass[n], tled_weight(p, n), stand[n], force, p->force_start[n + 1] - force};
    }
    return to;
}

#endif
