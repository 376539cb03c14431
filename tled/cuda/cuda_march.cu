/* The step by a march: see march.h. Compiled twice, in single precision and, with MARCH_DOUBLE, in double: its blocks
 * have as many threads then, of twice the registers, and a multiprocessor has one where it has two in single. A thread
 * keeps what the face between two elements has of modes (the mean, x, y and xy of each component, sums and differences
 * over four corners) and of forces on them; so an element takes one new face, and a node the sums of one. Compiled with
 * fused multiplications and additions: its bytes are not the processor's.
 *
 * Layer c of cells lies between layers c and c + 1 of nodes. At its end a thread sends for displacements of layer c + 7
 * and velocities of layer c + 3, as one group of copies to shared memory. It waits for that group in layer c + 4, after
 * the cells of that are computed: so copies have the time of four layers of cells, as memory takes longer than two when
 * all blocks ask it. Displacements are there a layer before others read them, velocities just before they are wanted.
 * In units with special cells it waits in layer c + 2 already: what these are made of comes with the same groups, but
 * is sent for three layers ahead.
 *
 * Forces on neighbours' nodes go to shared memory too, in buffers that take turns. A layer's nodes move after the cells
 * of the next one are computed: a warp says that it is done with a layer, and only after it has computed the next one
 * does it wait until all have said so, so that those with fewer cells seldom keep others waiting.
 */
#ifndef MARCH_DOUBLE
#define ELEMENT_SINGLE
#endif
extern "C" {
#include "physics/element.h"
}
#include "tled/cuda/cuda_cells.cuh"
#include "tled/cuda/cuda_march_room.cuh"

#include <limits.h>

enum {
    TAKEN = 4,                 /* layers before its last, a block takes its next unit */
    TOGETHER = SINGLE ? 2 : 1, /* blocks of a multiprocessor */
    ZEROS = 3,                 /* layers after its last with cells, a warp has left zeros in both buffers of forces */
    SPEEDS_AHEAD = SPEEDS - 1, /* layers that velocities are ahead */
    UNDERWAY = 3,              /* groups of copies that a layer does not wait for: of so many layers before it */
    UNDERWAY_SPECIAL = 1       /* of a unit with special cells */
};
static_assert((int)TAKEN < (int)MARCH_AHEAD, "in the layers that send for no displacements");
static_assert((int)MARCH_AHEAD - UNDERWAY == 4 && SPEEDS_AHEAD - UNDERWAY == 0, "what wait_before says is there");

/* What goes from layer to layer. */
template <march_control K> struct flow {
    const uint32_t *word;     /* of the layer that the loop is at, this thread's */
    uint32_t speed;           /* word of layer c + SPEEDS_AHEAD */
    uint32_t far, more;       /* words of layer c + MARCH_AHEAD, and there of the place beyond */
    int32_t which, detail;    /* march's: which, of layer c + 3; detail, of layer c + 4 */
    uint32_t last, now, then; /* words of layers c - 1, c, c + 1 */
    uint32_t pair;            /* where places c % SPEEDS of velocities begin, of c - c % 2 */
    int32_t empty;            /* layers since this warp's last with cells */
    uint32_t ticket;          /* thread 0's, of the unit that the block takes next */
    push<K> below;
    uint2 along, along_then; /* directions of layers c and c + 1 */
};

/* What a block is at: pass `pass` of a launch, of a unit. memory: where its shared memory stands. */
typedef struct turn {
    uint32_t pass;
    int32_t kind; /* of the pass */
    int32_t base, cells;
    uint32_t memory;
} turn;

static __device__ __forceinline__ const float4 *from_of(const cuda_march_pass<real> &p, const turn &t)
{
    return p.state[t.pass % 2];
}

static __device__ __forceinline__ float4 *to_of(const cuda_march_pass<real> &p, const turn &t)
{
    return p.state[1 - t.pass % 2];
}

/* What the pass does; STEP: it is one of those that end a step and begin the next. */
template <bool STEP>
static __device__ __forceinline__ const cuda_march_kind<real> &kind_of(const cuda_march_pass<real> &p, const turn &t)
{
    return p.kind[STEP ? (int)MARCH_STEP : t.kind];
}

/* The curves' values at the state that the pass reads. */
static __device__ __forceinline__ const double *now_of(const cuda_march_pass<real> &p, const turn &t)
{
    return p.now + (int64_t)t.pass * p.row;
}

static __device__ __forceinline__ void send_extra(const cuda_march<real> &m, const float4 *from, uint32_t at,
                                                  uint32_t stage, uint32_t extra)
{
    if (has_extra())
        send_node(m, extra_at(at) + stage, node_of(from, extra), extra & MARCH_THERE);
}

static __device__ __forceinline__ void send_layer(const cuda_march<real> &m, const float4 *from, uint32_t at,
                                                  uint32_t stage, uint32_t word, uint32_t extra)
{
    send_node(m, at + stage, node_of(from, word), word & MARCH_THERE);
    send_extra(m, from, at, stage, extra);
}

static __device__ __forceinline__ face face_at(uint32_t node)
{
    return face_between(node_load(node), node_load(node + NODE), node_load(node + GRID * NODE),
                        node_load(node + GRID * NODE + NODE));
}

static_assert(offsetof(cuda_march_cell<real>, muscle) == sizeof(real4) && sizeof(cuda_march_cell<real>) % 16 == 0,
              "read 16 bytes at a time");

/* Which special cell is this thread's, by a layer's detail; 0: none. */
static __device__ __forceinline__ int32_t which_of(const cuda_march<real> &m, int32_t detail)
{
    return detail < 0 ? 0 : m.which[MARCH_THREADS * (int64_t)detail + threadIdx.x];
}

/* Where what this thread's special cell of layer c is made of stands. */
static __device__ __forceinline__ uint32_t record_of(uint32_t memory, int c)
{
    return memory + RECORDS + (uint32_t)(c % 3) * RECORDS_EACH + threadIdx.x * NODE;
}

/* The first parts of layer c's special cells are on their way. They are the thread's own: nobody else reads them. */
static __device__ __forceinline__ void send_special(const cuda_march<real> &m, uint32_t memory, int c, int32_t which)
{
    const float4 *cell = (const float4 *)(m.cell + which - 1);
    const uint32_t to = record_of(memory, c);
    if (!which)
        return;
#pragma unroll
    for (uint32_t i = 0; i < RECORDS_EACH / RECORD; i++)
        send(to + i * RECORD, cell + i, true);
}

/* What this thread's special cell of a layer has if it is cut; else NULL. */
template <bool CUTS>
static __device__ __forceinline__ const march_cut *cut_of(const cuda_march<real> &m, bool special, int32_t layer)
{
    const int32_t which = CUTS && special ? which_of(m, m.detail[layer]) : 0;
    return which && which <= m.cuts ? m.cut + which - 1 : NULL;
}

/* Adds those of a special cell's muscles. The gradient is found once more, so that other cells need not keep
 * theirs; here, next: where the displacements of the cell's layers stand; layer: of all; few cells have a
 * second muscle, which is looked for there. cut: cut_of. */
template <march_control K>
static __device__ __forceinline__ void muscle_forces(const cuda_march<real> &m, const double *now, uint32_t record,
                                                     int32_t layer, uint32_t here, uint32_t next, const march_cut *cut,
                                                     face *sum, push<K> *below)
{
    const float4 first = shared_load(record + MUSCLES);
    const int32_t curve = (int32_t)__float_as_uint(first.w);
    if (curve < 0)
        return;
    const element_tensor h = gradient_by(m, cut, face_at(here), face_at(next));
    const real peak = record_peak(record);
    add_tension(m, h, {{first.x, first.y, first.z}, peak * (real)now[3 * (curve & ~MARCH_SECOND)]}, cut, sum, below);
    if (!(curve & MARCH_SECOND))
        return;
    const cuda_march_cell<real> *cell = m.cell + which_of(m, m.detail[layer]) - 1;
    const march_muscle &second = cell->muscle[1];
    add_tension(m, h,
                {{second.fibre[0], second.fibre[1], second.fibre[2]}, cell->second_peak * (real)now[3 * second.curve]},
                cut, sum, below);
}

/* The directions of row `at`, if there are families. */
template <march_control K> static __device__ __forceinline__ void fetch_along(const uint2 *along, int64_t at, uint2 *to)
{
    if constexpr (march_kind<K>::FAMILIES > 0)
        *to = load_once(along + at);
}

/* What a cell is made of. record: where its first half stands, if it is `special`. */
template <march_control K>
static __device__ __forceinline__ tissue<K> tissue_of(const cuda_march<real> &m, uint2 along, bool special,
                                                      int32_t layer, uint32_t record)
{
    tissue<K> of = plain_tissue<K>(m);
    if (special) {
        const bool asks = march_kind<K>::FORM == FORM_FIRST || march_kind<K>::FAMILIES > 0;
        special_tissue(m, m.cell[asks ? which_of(m, m.detail[layer]) - 1 : 0], record_law(record), &of);
    }
    of.along = along;
    return of;
}

/* As cell_forces, of any cell of layer c. */
template <march_control K, bool SPECIAL, bool CUTS>
static __device__ __forceinline__ void forces_of(const cuda_march<real> &m, const double *now, const turn &t,
                                                 flow<K> *f, int c, const face &low, const face &high, uint32_t here,
                                                 uint32_t next, face *sum)
{
    const bool is = f->now & MARCH_CELL, special = SPECIAL && f->now & MARCH_SPECIAL;
    const uint32_t record = record_of(t.memory, c);
    const march_cut *cut = cut_of<CUTS>(m, special, t.base + c);
    if constexpr (K == MARCH_ISOTROPIC) {
        real mu = is ? m.law[0] : 0, bulk = is ? m.law[1] : 0, hourglass = is ? m.law[2] : 0;
        if (special) {
            const real4 law = record_law(record);
            mu = law.x, bulk = law.y, hourglass = law.z;
        }
        cell_forces(m, mu, bulk, hourglass, is, low, high, sum, &f->below);
    } else {
        const tissue<K> of = tissue_of<K>(m, f->along, special, t.base + c, record);
        cell_forces<K, !SPECIAL>(m, of, is, low, high, cut, sum, &f->below);
    }
    if (special)
        muscle_forces(m, now, record, t.base + c, here, next, cut, sum, &f->below);
}

/* The forces on the corners of a face go to shared memory. */
static __device__ __forceinline__ void share_forces(const face &sum, uint32_t to)
{
    real own[3], x[3], y[3], xy[3];
#pragma unroll
    for (int a = 0; a < 3; a++) {
        const real low = sum.mean[a] - sum.y[a], high = sum.mean[a] + sum.y[a];
        const real low_x = sum.x[a] - sum.xy[a], high_x = sum.x[a] + sum.xy[a];
        own[a] = low - low_x;
        x[a] = low + low_x;
        y[a] = high - high_x;
        xy[a] = high + high_x;
    }
    node_store(to, x[0], x[1], x[2]);
    node_store(to + FORCE, y[0], y[1], y[2]);
    node_store(to + 2 * FORCE, xy[0], xy[1], xy[2]);
    node_store(to + 3 * FORCE, own[0], own[1], own[2]);
}

#include "tled/cuda/cuda_march_nodes.cuh"

/* Says that this warp is done with a layer: its forces are there, and displacements of layers up to c + 3. */
static __device__ __forceinline__ void say_done(const turn &t)
{
    __syncwarp();
    barrier_arrive_warp(t.memory + SAID);
}

/* Words by which a layer sends at its end, and the next one's directions: they are on their way while it is worked
 * on. */
template <march_control K>
static __device__ __forceinline__ void fetch_words(const cuda_march<real> &m, int32_t layer, flow<K> *f)
{
    fetch_along<K>(m.along, MARCH_THREADS * ((int64_t)layer + 1) + threadIdx.x, &f->along_then);
    f->then = f->word[MARCH_WORDS];
    f->speed = f->word[SPEEDS_AHEAD * MARCH_WORDS];
    f->far = f->word[MARCH_AHEAD * MARCH_WORDS];
    f->more = has_extra() ? f->word[MARCH_AHEAD * MARCH_WORDS + MARCH_THREADS] : 0;
    f->word += MARCH_WORDS;
}

/* Special cells of layer c + 3 are sent for, into the place of those of layer c; what later ones are is on its way. */
template <march_control K>
static __device__ __forceinline__ void go_on_special(const cuda_march<real> &m, const turn &t, flow<K> *f, int c)
{
    if (c + 3 < t.cells)
        send_special(m, t.memory, c + 3, f->which);
    f->which = which_of(m, f->detail);
    f->detail = m.detail[t.base + c + 5];
}

template <march_control K>
static __device__ __forceinline__ void begin_special(const cuda_march<real> &m, const turn &t, flow<K> *f)
{
#pragma unroll
    for (int k = 0; k < 3; k++)
        if (k < t.cells)
            send_special(m, t.memory, k, which_of(m, m.detail[t.base + k]));
    f->which = which_of(m, m.detail[t.base + 3]);
    f->detail = m.detail[t.base + 4];
}

/* Thread 0's work: says which unit the block takes next, and in which pass. What that is, is on its way. */
static __device__ __forceinline__ void note_next(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                 uint32_t memory, uint32_t ticket)
{
    const uint32_t next = ticket - p.ticket, units = (uint32_t)m.units;
    const bool is = next < units * (uint32_t)p.passes;
    shared_number_store(memory + TURN, __uint_as_float(next));
    send(memory + NEXT, (const float4 *)&m.unit[is ? next % units : 0], is);
}

/* Takes a ticket in one of the last layers, and looks at it a layer later, when it is there. left: layers. */
template <march_control K>
static __device__ __forceinline__ void take_next(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                 const turn &t, int left, flow<K> *f)
{
    const int ago = (t.cells < TAKEN ? t.cells : TAKEN) - left;
    if (ago == 0 && threadIdx.x == 0)
        f->ticket = take_ticket(m.ticket);
    if (ago == 1 && threadIdx.x == 0)
        note_next(m, p, t.memory, f->ticket);
}

/* All warps are done with the layer before. What was sent UNDERWAY + 1 layers ago is there: displacements up to layer
 * c + 3, and velocities of c - 1. Where there are special cells, so are those of layer c + 1. */
template <bool SPECIAL, int ODD> static __device__ __forceinline__ void wait_before(const turn &t)
{
    barrier_wait(t.memory + SAID, 1 - ODD); /* first: a wait for copies alone is placed before the arithmetic */
    arrived<SPECIAL ? UNDERWAY_SPECIAL : UNDERWAY>();
}

/* Layer c of cells of a unit, whose lower face is `low`, and layer c - 1 of nodes; odd: c is. left: layers from c on.
 * next: where the displacements of layer c + 1 stand; old: those of c - 1, and those of c + 7 from here on. Who has no
 * cells finds the face of those that the next layer has. */
template <march_control K, bool SPECIAL, bool STEP, bool CUTS, int ODD>
static __device__ __forceinline__ void layer(const cuda_march<real> &m, const cuda_march_pass<real> &p, const turn &t,
                                             uint32_t at, flow<K> *f, int left, uint32_t next, uint32_t old,
                                             const face &low, face *high)
{
    const uint32_t forces = at + FORCES + ODD * FORCES_EACH, before = at + FORCES + (1 - ODD) * FORCES_EACH;
    const uint32_t speed = at + VELOCITIES + ODD * FORCE + f->pair; /* of layer c - 1, and of c + 3 from here on */
    const uint32_t here = at + (next ? next - STAGE : (STAGES - 1) * STAGE);
    const int c = t.cells - left;
    fetch_words(m, t.base + c, f);
    if (__any_sync(~0u, f->now & MARCH_CELL)) {
        face sum;
        *high = face_at(at + next);
        forces_of<K, SPECIAL, CUTS>(m, now_of(p, t), t, f, c, low, *high, here, at + next, &sum);
        f->empty = 0;
        wait_before<SPECIAL, ODD>(t);
        share_forces(sum, forces);
    } else {
        if (__any_sync(~0u, f->then & MARCH_CELL))
            *high = face_at(at + next);
        wait_before<SPECIAL, ODD>(t);
        if (f->empty < ZEROS)
            share_forces(f->empty ? face{} : face_of(f->below, low), forces);
        f->below = {};
        f->empty++;
    }
    move_node<STEP, CUTS>(m, p, t, f->last, before, at + old, speed);
    if (left >= MARCH_AHEAD) {
        send_nodes(m, speed, node_of(p.velocity, f->speed), f->speed & MARCH_OWN, at + old,
                   node_of(from_of(p, t), f->far), f->far & MARCH_THERE);
        send_extra(m, from_of(p, t), at, old, f->more);
    } else {
        send_node(m, speed, node_of(p.velocity, f->speed), left > SPEEDS_AHEAD ? f->speed & MARCH_OWN : 0);
        take_next(m, p, t, left, f);
    }
    if (SPECIAL)
        go_on_special(m, t, f, c);
    sent();
    say_done(t);
    f->last = f->now;
    f->now = f->then;
    f->along = f->along_then;
    if (ODD)
        f->pair ^= 2 * FORCE;
}

/* Thread 0's work. */
static __device__ void put_gravity(const cuda_march<real> &m, const cuda_march_pass<real> &p, const turn &t)
{
    const double *g = m.v.gravity < 0 ? NULL : now_of(p, t) + 3 * m.v.gravity;
    for (int a = 0; a < 3; a++)
        node_number_store(t.memory + GRAVITY, a, g ? p.kind[t.kind].push * (real)g[m.axis[a]] : 0);
    node_number_store(t.memory + GRAVITY, 3, 0);
}

/* Waits until the units that have to do with this one have made the pass before: what they wrote may be read, and what
 * they read written. Units are taken in turn, so that those of the first turn that is not done wait for none. */
static __device__ __forceinline__ void wait_for_near(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                     const turn &t, uint32_t unit)
{
    const int32_t *near = m.near + (int64_t)unit * m.nears;
    for (int32_t i = (int32_t)threadIdx.x; i < m.nears; i += MARCH_THREADS)
        while (near[i] >= 0 && (int32_t)(hear_done(&m.done[near[i]]) - (p.number + t.pass - 1)) < 0)
            ;
    __syncthreads();
}

/* The first layers of a unit are there. What the pass before wrote may be read from here on. */
template <march_control K, bool SPECIAL>
static __device__ __forceinline__ void begin(const cuda_march<real> &m, const cuda_march_pass<real> &p, const turn &t,
                                             uint32_t unit, uint32_t at, flow<K> *f)
{
    uint32_t word[MARCH_AHEAD], extra[MARCH_AHEAD];
    f->word = m.word + MARCH_WORDS * (int64_t)t.base + threadIdx.x;
#pragma unroll
    for (int k = 0; k < MARCH_AHEAD; k++) {
        word[k] = f->word[k * MARCH_WORDS];
        extra[k] = has_extra() ? f->word[k * MARCH_WORDS + MARCH_THREADS] : 0;
    }
    f->now = word[0] & ~MARCH_OWN; /* the first layer's nodes are another unit's */
    fetch_along<K>(m.along, MARCH_THREADS * (int64_t)t.base + threadIdx.x, &f->along);
    wait_for_near(m, p, t, unit);
#pragma unroll
    for (int k = 0; k < MARCH_AHEAD; k++)
        if (k <= t.cells)
            send_layer(m, from_of(p, t), at, k * STAGE, word[k], extra[k]);
#pragma unroll
    for (int k = 1; k < SPEEDS_AHEAD; k++)
        send_node(m, at + VELOCITIES + (k + 1) % SPEEDS * FORCE, node_of(p.velocity, word[k]),
                  k < t.cells ? word[k] & MARCH_OWN : 0);
    if (SPECIAL)
        begin_special(m, t, f);
    sent();
    if (threadIdx.x == 0)
        put_gravity(m, p, t);
    arrived<0>();
    __syncthreads();
    f->empty = 1; /* so that the first two layers leave zeros */
}

static __device__ __forceinline__ uint32_t after(uint32_t stage)
{
    return stage == (STAGES - 1) * STAGE ? 0 : stage + STAGE;
}

template <march_control K, bool SPECIAL, bool STEP, bool CUTS>
static __device__ __forceinline__ void march_unit_of(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                     const turn &t, uint32_t unit)
{
    const uint32_t at = t.memory + (uint32_t)place_of((int)threadIdx.x) * NODE;
    flow<K> f = {};
    begin<K, SPECIAL>(m, p, t, unit, at, &f);
    face even = face_at(at), odd;
    const int last = t.cells;
    uint32_t next = STAGE, old = (STAGES - 1) * STAGE;
#pragma unroll 1
    for (int left = last;;) {
        layer<K, SPECIAL, STEP, CUTS, 0>(m, p, t, at, &f, left, next, old, even, &odd);
        next = after(next), old = after(old);
        if (--left == 0)
            break;
        layer<K, SPECIAL, STEP, CUTS, 1>(m, p, t, at, &f, left, next, old, odd, &even);
        next = after(next), old = after(old);
        if (--left == 0)
            break;
    }
    arrived<0>();
    barrier_wait(t.memory + SAID, (last - 1) % 2);
    move_node<STEP, CUTS>(m, p, t, f.last, at + FORCES + (uint32_t)(last - 1) % 2 * FORCES_EACH, at + old,
                          at + VELOCITIES + (uint32_t)last % SPEEDS * FORCE);
    if (last % 2) { /* the next unit's first phase is even again */
        say_done(t);
        barrier_wait(t.memory + SAID, 1);
    }
}

#include "tled/cuda/cuda_march_tips.cuh"

/* Thread 0's work: the first unit of a block, as its next. */
static __device__ __forceinline__ void take_first(const cuda_march<real> &m, const cuda_march_pass<real> &p,
                                                  const turn &t)
{
    barrier_make(t.memory + SAID, WARPS);
    note_next(m, p, t.memory, take_ticket(m.ticket));
    sent();
    arrived<0>();
}

/* Which of p.kind a pass is. */
static __device__ __forceinline__ int kind_at(const cuda_march_pass<real> &p, uint32_t pass)
{
    if (pass == 0 && !p.amid)
        return MARCH_FIRST;
    return p.ends && pass + 1 == (uint32_t)p.passes ? MARCH_LAST : MARCH_STEP;
}

/* Blocks take units in turn, pass after pass. What special cells take in registers, units without them do without; nor
 * do passes that end a step and begin the next ask what they are. SPECIALS: the model has special cells; CUTS: some of
 * them are cut. */
template <march_control K, bool TIPS, bool SPECIALS, bool CUTS>
static __global__ void __launch_bounds__(MARCH_THREADS, TOGETHER)
    march_kernel(const __grid_constant__ cuda_march<real> m, const __grid_constant__ cuda_march_pass<real> p)
{
    DYNAMIC_SHARED(float4, shared);
    turn t = {.memory = shared_at(shared)};
    if (threadIdx.x == 0)
        take_first(m, p, t);
    __syncthreads();
    for (;;) {
        const uint32_t units = (uint32_t)m.units, turn = __float_as_uint(shared_number(t.memory + TURN));
        const uint32_t unit = turn % units;
        const float4 next = shared_load(t.memory + NEXT);
        t.pass = turn / units;
        if (t.pass >= (uint32_t)p.passes)
            break;
        t.kind = kind_at(p, t.pass);
        t.base = (int32_t)__float_as_uint(next.x);
        t.cells = (int32_t)__float_as_uint(next.y);
        const bool special = __float_as_uint(next.z);
        if (TIPS && t.cells == 0)
            move_tips<K, CUTS>(m, p, t, unit, (int)__float_as_uint(next.w));
        else if (SPECIALS && t.kind == MARCH_STEP && special)
            march_unit_of<K, SPECIALS, true, CUTS>(m, p, t, unit);
        else if (t.kind == MARCH_STEP)
            march_unit_of<K, false, true, CUTS>(m, p, t, unit);
        else
            march_unit_of<K, SPECIALS, false, CUTS>(m, p, t, unit);
        __syncthreads();
        if (threadIdx.x == 0)
            tell_done(&m.done[unit], p.number + t.pass);
    }
}

/* ---- from rows */

enum { PACK_THREADS = 256 };

static __global__ void unpack_kernel(const __grid_constant__ cuda_march<real> m, const real *from, float4 *to)
{
    const int64_t n = (int64_t)blockIdx.x * PACK_THREADS + threadIdx.x;
    if (n >= m.v.nodes)
        return;
    for (int a = 0; a < 3; a++)
        ((real *)to)[march_offset(a, m.v.stride) + n * MARCH_ALONG] = from[m.axis[a] * m.v.stride + n];
}

static int64_t pack_blocks(const cuda_march<real> *m)
{
    return (m->v.nodes + PACK_THREADS - 1) / PACK_THREADS;
}

template <> cudaError_t cuda_march_unpack(const cuda_march<real> *m, const real *from, float4 *to, cudaStream_t stream)
{
    return card_start(unpack_kernel, {pack_blocks(m), PACK_THREADS, 0, stream}, *m, from, to);
}

/* ---- starting */

/* Whether there are kernels for models without special cells. With both, those of other forms and of fibres find no
 * registers for some numbers of plain cells, and wait a tenth of the time for these. */
static constexpr bool march_lean(march_control k)
{
    return march_form(k) == FORM_FIRST || march_families(k) > 0;
}

/* Calls f with the kernel. */
template <bool TIPS, bool SPECIALS, class F> static cudaError_t with_kernel(march_control control, F f)
{
#define MARCH_ROW(NAME, form, families, doubles)                                                                       \
    if constexpr (march_has(NAME))                                                                                     \
        if (control == NAME)                                                                                           \
            return f(march_kernel<NAME, TIPS, (SPECIALS || !march_lean(NAME)), false>);
    MARCHES(MARCH_ROW)
#undef MARCH_ROW
    return cudaErrorInvalidValue;
}

/* Likewise of models with cut cells: one for each control that has any, with all that others do without. */
template <class F> static cudaError_t with_cut_kernel(march_control control, F f)
{
#define MARCH_ROW(NAME, form, families, doubles)                                                                       \
    if constexpr (march_has(NAME) && NAME != MARCH_ISOTROPIC)                                                          \
        if (control == NAME)                                                                                           \
            return f(march_kernel<NAME, true, true, true>);
    MARCHES(MARCH_ROW)
#undef MARCH_ROW
    return cudaErrorInvalidValue;
}

template <class F> static cudaError_t with_march(march_control control, bool tips, bool specials, bool cut, F f)
{
    if (cut)
        return with_cut_kernel(control, f);
    if (tips)
        return specials ? with_kernel<true, true>(control, f) : with_kernel<true, false>(control, f);
    return specials ? with_kernel<false, true>(control, f) : with_kernel<false, false>(control, f);
}

template <> cudaError_t cuda_march_slots<real>(march_control control, bool cut, int64_t *slots)
{
    int device = 0, processors = 0, major = 0, room = 0, least = INT_MAX;
    *slots = 0;
    cudaError_t e = cudaGetDevice(&device);
    e = e == cudaSuccess ? cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device) : e;
    e = e == cudaSuccess ? cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device) : e;
    e = e == cudaSuccess ? cudaDeviceGetAttribute(&room, cudaDevAttrMaxSharedMemoryPerBlockOptin, device) : e;
    if (e != cudaSuccess || major < 9 || room < (int)SHARED)
        return e;
    for (int has = 0; e == cudaSuccess && has < 4;
         has++) /* whether there are tips, or special cells, is not known yet */
        e = with_march(control, has & 1, has & 2, cut, [&](auto kernel) {
            int each = 0;
            cudaError_t bad = cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, SHARED);
            bad = bad == cudaSuccess
                      ? cudaOccupancyMaxActiveBlocksPerMultiprocessor(&each, kernel, MARCH_THREADS, SHARED)
                      : bad;
            least = each < least ? each : least;
            return bad;
        });
    *slots = (int64_t)processors * least;
    return e;
}

template <>
cudaError_t cuda_march_start(march_control control, const cuda_march<real> *m, const cuda_march_pass<real> *p,
                             int64_t blocks, cudaStream_t stream)
{
    const card_blocks how = {blocks, MARCH_THREADS, SHARED, stream};
    return with_march(control, m->tip != NULL, m->specials > 0, m->cuts > 0,
                      [&](auto kernel) { return card_start(kernel, how, *m, *p); });
}
