/* Impulses of skin that touches, on a card (cuda_skin.cuh). Included by that alone.
 */
#ifndef SINEW_CUDA_SKIN_SOLVE_CUH
#define SINEW_CUDA_SKIN_SOLVE_CUH

#include "tled/cuda/cuda_skin_room.cuh"

/* ---- impulses: a warp has a contact */

/* What the sample moves by relative to the place, of ways that nodes have: the same in all threads. */
static __device__ void warp_relative(const cuda_skin &s, const skin_lever &l, const skin_whole *way, double *to)
{
    const double unit = way_unit(s);
    to[0] = to[1] = to[2] = 0;
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++)
        for (int a = 0; a < 3; a++)
            to[a] += l.share[j] * of_whole(way[3 * (int64_t)l.node[j] + a], unit);
    warp_sums(to, 3);
}

/* And of velocities. */
static __device__ void warp_speed(const cuda_touch &k, const skin_lever &l, double *to)
{
    to[0] = to[1] = to[2] = 0;
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++) {
        real v[3];
        cuda_three<false>(k.view, k.velocity, k.skin.node[l.node[j]].stand, v);
        for (int a = 0; a < 3; a++)
            to[a] += l.share[j] * (double)v[a];
    }
    warp_sums(to, 3);
}

/* Adds to ways what `way` moves both sides by: each node by its share and its side's part. */
static __device__ void warp_push(const cuda_skin &s, const touch &t, const skin_lever &l, const double *way,
                                 skin_whole *to)
{
    const double per_unit = 1 / way_unit(s);
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++)
        for (int a = 0; a < 3; a++)
            if (l.free >> (3 * j + a) & 1)
                atomicAdd(&to[3 * (int64_t)l.node[j] + a],
                          whole_of(t.part[l.place >> j & 1] * l.share[j] * way[a], per_unit));
}

static __device__ double warp_width(const cuda_skin &s, const touch &t, const skin_lever &l)
{
    double width = 0;
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++) {
        double square = 0;
        for (int a = 0; a < 3; a++)
            square += l.free >> (3 * j + a) & 1 ? t.normal[a] * t.normal[a] : 0;
        width += fabs(l.share[j]) * of_whole(s.sum[l.node[j]], SKIN_SHARE_UNIT) * square;
    }
    return warp_sum(width);
}

static __device__ void along_normal(const touch &t, double size, double *to)
{
    for (int a = 0; a < 3; a++)
        to[a] = size * t.normal[a];
}

/* A pass of Jacobi's iteration, from the ways of the pass before, or at first of none, to those of this one. */
static __device__ void press(const cuda_touch &k, touch *t, const skin_lever &l, int pass)
{
    const cuda_skin &s = k.skin;
    double way[3] = {0, 0, 0};
    if (pass) {
        warp_relative(s, l, s.change[(pass - 1) % SKIN_CHANGES], way);
    } else {
        double speed[3];
        t->width = warp_width(s, *t, l);
        warp_speed(k, l, speed);
        contact_begin(&s.c, t, speed, k.dt);
    }
    contact_press(t, way);
    along_normal(*t, t->lambda, way);
    warp_push(s, *t, l, way, s.change[pass % SKIN_CHANGES]);
    if (pass == CONTACT_PASSES - 1) {
        along_normal(*t, t->fresh * t->lambda, way);
        warp_push(s, *t, l, way, s.fresh);
    }
}

/* And of friction: ways are dt times what it takes of velocities. */
static __device__ void rub(const cuda_touch &k, touch *t, const skin_lever &l, int pass)
{
    const cuda_skin &s = k.skin;
    double speed[3], came[3], rubbed[3] = {0, 0, 0}, way[3];
    warp_speed(k, l, speed);
    warp_relative(s, l, s.fresh, came);
    if (pass > CONTACT_PASSES)
        warp_relative(s, l, s.change[(pass - 1) % SKIN_CHANGES], rubbed);
    for (int a = 0; a < 3; a++)
        speed[a] += (came[a] + rubbed[a]) / k.dt;
    contact_rub(&s.c, t, speed, k.dt);
    for (int a = 0; a < 3; a++)
        way[a] = k.dt * t->rubbed[a];
    warp_push(s, *t, l, way, s.change[pass % SKIN_CHANGES]);
}

/* Component by component, nodes about contacts, by the first so many blocks. */
template <class F> static __device__ void for_abouts(const cuda_skin &s, int32_t count, unsigned blocks, F f)
{
    for (int32_t i = (int32_t)(blockIdx.x * SKIN_THREADS + threadIdx.x); i < 3 * count; i += blocks * SKIN_THREADS)
        f(3 * (int64_t)s.about[i / 3] + i % 3);
}

/* Before a pass: what it will add to in the one after it, 0. Pass CONTACT_PASSES is the first of friction, before which
 * what presses is put by. */
static __device__ void make_way(const cuda_skin &s, int32_t abouts, unsigned blocks, int pass)
{
    skin_whole *pressed = s.change[(CONTACT_PASSES - 1) % SKIN_CHANGES], *after = s.change[(pass + 1) % SKIN_CHANGES];
    for_abouts(s, abouts, blocks, [&](int64_t i) {
        if (pass == CONTACT_PASSES)
            s.moved[i] = of_whole(pressed[i], way_unit(s));
        after[i] = 0;
    });
}

/* Displacements and velocities of a component; last: the pass that ended this. */
static __device__ void end_component(const cuda_touch &k, int64_t i, int last)
{
    const cuda_skin &s = k.skin;
    const cuda_skin_node &n = s.node[i / 3];
    const double unit = way_unit(s), came = of_whole(s.fresh[i], unit);
    const double pushed = of_whole(s.change[last % SKIN_CHANGES][i], unit);
    const bool is_rubbed = last >= CONTACT_PASSES;
    const double moved = (is_rubbed ? s.moved[i] : 0) + pushed, speed = (came + (is_rubbed ? pushed : 0)) / k.dt;
    if (n.free >> i % 3 & 1) {
        const int64_t at = k.view.offset[i % 3] + n.stand * k.view.along;
        k.to[at] = (real)((double)k.to[at] + moved);
        k.velocity[at] = (real)((double)k.velocity[at] + speed);
    }
    for (int c = 0; c < SKIN_CHANGES; c++)
        s.change[c][i] = 0;
    s.fresh[i] = 0;
}

/* How many blocks it takes. They have few contacts each: to read and add up the nodes of many takes one multiprocessor
 * longer than more blocks wait for each other. */
static __device__ unsigned solving(int32_t touches)
{
    const unsigned blocks = (unsigned)(touches + SKIN_TOUCHES - 1) / SKIN_TOUCHES;
    return blocks < gridDim.x ? blocks : gridDim.x;
}

/* A warp keeps its contact, and that one's nodes, from pass to pass; only where there are more contacts than warps does
 * it take them anew. */
static __device__ void solve(const cuda_touch &k, int odd, uint32_t *phase)
{
    const cuda_skin &s = k.skin;
    const int32_t touches = s.all->touches[odd], abouts = s.all->abouts[odd];
    const int lane = (int)threadIdx.x % 32, passes = (s.c.friction > 0 ? 2 : 1) * CONTACT_PASSES;
    const unsigned blocks = solving(touches);
    const int32_t warp = warp_number(blocks), warps = blocks * SKIN_WARPS;
    touch t;
    skin_lever l;
    for (int pass = 0; pass < passes; pass++) {
        if (pass > 1)
            make_way(s, abouts, blocks, pass);
        for (int32_t i = warp; i < touches; i += warps) {
            if (!pass || touches > warps) {
                t = s.found[i];
                l = lever_of(s, t, lane);
            }
            if (pass < CONTACT_PASSES)
                press(k, &t, l, pass);
            else
                rub(k, &t, l, pass);
            __syncwarp();
            if (lane == 0 && touches > warps)
                s.found[i] = t;
            __syncwarp();
        }
        all_wait(k, phase, blocks);
    }
    for_abouts(s, abouts, blocks, [&](int64_t i) {
        end_component(k, i, passes - 1);
        if (i % 3 == 0)
            s.sum[i / 3] = 0;
    });
}

#endif
