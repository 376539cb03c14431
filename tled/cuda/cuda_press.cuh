/* Contact with a probe (tled/problem/collider.h), on a card: after a pass, a kernel adds what the probe pushes nodes
 * with. A pass is linear in the forces on a node: with it, v' is further by s push/m, u by dt times that, where s is dt
 * or dt/2, and its part by damping (node.h). Nodes that slide get it with their elements' pulls. The sum is another
 * than the processor's, where the push comes first: bytes differ. Included by cuda_state.cuh alone.
 */
#ifndef SINEW_CUDA_PRESS_CUH
#define SINEW_CUDA_PRESS_CUH

#include "tled/cuda/cuda_view.cuh"

extern "C" {
#include "tled/problem/collider.h"
#include "tled/problem/node.h"
}

enum { PRESS_THREADS = 128 };

typedef struct cuda_press {
    cuda_view<real> view;
    const double *position; /* nodes x 3, m: at rest, by where they stand */
    probe_placed at;
    double stiffness;    /* 1/s2: as much of the collider's as it has come up to */
    const real *from;    /* displacements */
    real *to, *velocity; /* to: the next displacements, or internal forces */
    double further, dt;  /* s: s; dt, 0 where no step begins */
} cuda_press;

/* One component; push: N, where it is at, of its arrays. */
static __device__ void press_on(const cuda_press &c, double push, double mass_inverse, int64_t at)
{
    const double more = c.further * push * mass_inverse;
    c.velocity[at] = (real)((double)c.velocity[at] + more);
    if (c.dt > 0)
        c.to[at] = (real)((double)c.to[at] + c.dt * more);
}

static __global__ void __launch_bounds__(PRESS_THREADS) press_kernel(const __grid_constant__ cuda_press c)
{
    const int64_t n = (int64_t)blockIdx.x * PRESS_THREADS + threadIdx.x;
    const cuda_view<real> &v = c.view;
    real u[3];
    double x[3], away = 0;
    if (n >= v.nodes)
        return;
    cuda_three<false>(v, c.from, n, u);
    for (int a = 0; a < 3; a++) {
        x[a] = c.position[3 * n + a] + (double)u[a];
        away += (x[a] - c.at.centre[a]) * (x[a] - c.at.centre[a]);
    }
    if (away >= c.at.reach * c.at.reach)
        return;
    const probe_touch t = probe_at(&c.at, x);
    if (!(t.depth > 0))
        return;
    const uint32_t info = v.node_info[n];
    const bool is_apart = info >> TILE_APART & 1;
    const double inverse = (double)v.mass_inverse[n * v.mass_along];
    for (int a = 0; a < 3; a++) {
        const int64_t at = v.offset[a] + n * v.along;
        const double push = c.stiffness * t.depth * t.way[a] / inverse;
        if (is_apart || !(c.dt > 0))
            c.to[at] = (real)((double)c.to[at] - push);
        if (!is_apart && info >> (TILE_FREE + a) & 1)
            press_on(c, push, inverse, at);
    }
}

static cudaError_t press_start(const cuda_press &c, cudaStream_t stream)
{
    return card_start(press_kernel, {(c.view.nodes + PRESS_THREADS - 1) / PRESS_THREADS, PRESS_THREADS, 0, stream}, c);
}

/* What a pass of this step adds to v by an acceleration, s. */
static double press_further(double dt, double damping, bool finishes, bool begins)
{
    const double slow = 1 / (1 + damping * dt / 2);
    return ((finishes ? dt / 2 : 0) + (begins ? dt / 2 : 0)) * (begins ? slow : 1);
}

/* The host's list of places, the caller's to free. node: which of the model's stands where. NULL with e filled. */
static double *press_positions(const tled_problem *p, const int32_t *node, err *e)
{
    double *to = (double *)mem_array(p->nodes, 3 * sizeof *to, "the probe", e);
    for (int64_t i = 0; to && i < 3 * p->nodes; i++)
        to[i] = p->position[3 * (int64_t)node[i / 3] + i % 3];
    return to;
}

#endif
