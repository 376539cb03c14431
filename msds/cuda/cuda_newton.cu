/* Frames of the method tissue on the card: tissue.c's, phase for phase, all of a frame in one launch. Contacts are not
 * listed one after the other but marked, so that a node sees its own wherever it takes part in a loop. Each phase ends
 * with a barrier, after which every block sums the parts of all, in the same order: so all take the same branches. A
 * part is a span of nodes, which a block sums, each thread its own nodes first.
 */
#include "msds/cuda/cuda_contact.cuh"
#include "msds/cuda/cuda_newton_elements.cuh"
#include "msds/problem/line_search.h"

/* What a phase works on. */
typedef struct newton {
    const tissue *t;
    const tissue_frame *f;
    const tissue_newton *x;
    grid_scratch *s;
} newton;

/* ---- loops and sums */

/* work(i) for each i below count, a thread each. */
template <class WORK> static __device__ inline void each(int32_t count, WORK work)
{
    for (int32_t i = blockIdx.x * GRID_THREADS + threadIdx.x; i < count; i += gridDim.x * GRID_THREADS)
        work(i);
}

/* work(i, its group) for each element. */
template <class WORK> static __device__ inline void each_element(const newton *k, WORK work)
{
    const int32_t count = k->x->lanes, step = gridDim.x * GRID_THREADS;
    int32_t i = blockIdx.x * GRID_THREADS + threadIdx.x;
    newton_group next = take_group(k->x, min(i, count - 1));
    for (; i < count; i += step) {
        const newton_group now = next;
        next = take_group(k->x, min(i + step, count - 1));
        work(i, now);
    }
}

/* work(span) for each span of nodes, a block each. */
template <class WORK> static __device__ inline void each_span(const newton *k, WORK work)
{
    for (int32_t span = blockIdx.x; span < k->x->spans; span += gridDim.x)
        work(span);
}

template <class WORK> static __device__ inline void each_node(const newton *k, int32_t span, WORK work)
{
    const int32_t wide = k->x->span * GRID_THREADS, end = min(k->t->nodes, (span + 1) * wide);
    for (int32_t n = span * wide + threadIdx.x; n < end; n += GRID_THREADS)
        work(n);
}

static __device__ void end_phase(const newton *k)
{
    grid_barrier(k->t->arrived);
}

static __device__ inline double *parts_of(const newton *k, int which)
{
    return k->t->part + (int64_t)which * k->t->chunks;
}

static __device__ inline void put_part(const newton *k, int which, int32_t span, double x)
{
    x = grid_block_sum(x, k->s);
    if (threadIdx.x == 0)
        parts_of(k, which)[span] = x;
}

static __device__ inline void put_most(const newton *k, int which, int32_t span, double x)
{
    x = grid_block_most(x, k->s);
    if (threadIdx.x == 0)
        parts_of(k, which)[span] = x;
}

/* The same of what only few spans have: others do without the sum. */
static __device__ inline void put_rare(const newton *k, int which, int32_t span, double x)
{
    if (__syncthreads_or(x != 0))
        put_part(k, which, span, x);
    else if (threadIdx.x == 0)
        parts_of(k, which)[span] = 0;
}

static __device__ inline void put_rare_most(const newton *k, int which, int32_t span, double x)
{
    if (__syncthreads_or(x != 0))
        put_most(k, which, span, x);
    else if (threadIdx.x == 0)
        parts_of(k, which)[span] = 0;
}

static __device__ double total(const newton *k, int which)
{
    return grid_total(parts_of(k, which), k->x->spans, k->s);
}

static __device__ double most_of(const newton *k, int which)
{
    return grid_most(parts_of(k, which), k->x->spans, k->s);
}

static __device__ inline double dot_of(float4 a, float4 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y + (double)a.z * (double)b.z;
}

/* ---- contact */

static __device__ inline bool is_free_contact(const newton *k, int32_t n)
{
    return k->t->listed[n] && !k->x->active[n];
}

/* How far a contact's node may still go toward the probe in the step, m; below 0: it has to come out by that. */
static __device__ inline double room_of(const newton *k, int32_t n)
{
    const tissue_contact *c = &k->t->contact[n];
    return contact_along(c, k->x->step[n]) - c->depth;
}

/* How deep a node still is, at u. */
static __device__ inline double depth_of(const newton *k, int32_t n)
{
    const tissue_contact *c = &k->t->contact[n];
    const float4 u = k->t->u[n];
    return c->depth - (c->way[0] * ((double)u.x - c->from[0]) + c->way[1] * ((double)u.y - c->from[1]) +
                       c->way[2] * ((double)u.z - c->from[2]));
}

/* Marks a node near the probe, or, for a penalty, in it. */
static __device__ inline void mark_contact(const newton *k, int32_t n, float4 u)
{
    const double from[3] = {(double)u.x, (double)u.y, (double)u.z};
    k->t->listed[n] = 0;
    if (!contact_candidate(k->t, k->f, n, u))
        return;
    if (k->f->penalty)
        contact_consider(k->t, k->f, n, from, CONTACT_CLINGING, 0, false);
    else
        contact_consider(k->t, k->f, n, from, CONTACT_NEAR_BY, CONTACT_NEAR_BY, true);
}

/* ---- products with the elements */

/* What the points' pressures are, or change by, to `to`. */
static __device__ void over_points(const newton *k, float *to)
{
    if (!k->x->points)
        return;
    each(k->x->points, [&](int32_t i) {
        const float sum = point_sum(k->x, i);
        to[i] = to == k->x->pressure ? sum + k->x->held[i] : sum;
    });
    end_phase(k);
}

typedef struct changed { /* what the way changes */
    double curvature;    /* way . pulled of the elements */
    double stiffer;      /* and of penalties */
    double steep;        /* how fast a free node comes to the probe, over its room; the most of any */
    double gain;         /* what is left times the way */
} changed;

static __device__ inline void change_node(const newton *k, int32_t n, bool gains, changed *sum)
{
    const float4 p = k->x->way[n];
    float4 y = node_sum(k->x, n);
    sum->curvature += (double)(p.x * y.x + p.y * y.y + p.z * y.z);
    sum->gain += gains ? dot_of(k->x->left[n], p) : 0;
    if (is_free_contact(k, n)) {
        const tissue_contact *c = &k->t->contact[n];
        const double by = contact_along(c, p);
        if (k->f->penalty) {
            y = contact_add(c, y, k->t->repulsion[n] * by);
            sum->stiffer += k->t->repulsion[n] * by * by;
        } else if (by < 0) {
            sum->steep = fmax(sum->steep, -by / fmax(room_of(k, n), 0.));
        }
    }
    k->x->pulled[n] = y;
}

/* pulled: what the elements, and penalties, change by along the way. Returns way . pulled. */
static __device__ double change_along(const newton *k, bool gains)
{
    if (k->x->points) {
        each_element(k, [&](int32_t i, newton_group group) { swell_element(k->t, k->x, i, group); });
        end_phase(k);
        over_points(k, k->x->pressed);
    }
    each_element(k, [&](int32_t i, newton_group group) { tangent_element(k->t, k->x, i, group); });
    end_phase(k);
    each_span(k, [&](int32_t span) {
        changed sum = {0, 0, 0, 0};
        each_node(k, span, [&](int32_t n) { change_node(k, n, gains, &sum); });
        put_part(k, PART_CURVATURE, span, sum.curvature);
        put_rare(k, PART_STIFFER, span, sum.stiffer);
        put_rare_most(k, PART_STEEPEST, span, sum.steep);
        if (gains)
            put_part(k, PART_ALONG, span, sum.gain);
    });
    end_phase(k);
    return total(k, PART_CURVATURE) + (k->f->penalty ? total(k, PART_STIFFER) : 0);
}

/* How far the step may go along the way until a node that is free comes to the probe. */
static __device__ double feasible(const newton *k)
{
    return k->f->touched ? 1 / most_of(k, PART_STEEPEST) : INFINITY;
}

typedef struct rest {  /* what is left at u */
    double squares[3]; /* of that, of the load and of the pulls */
    double slope;      /* that times the step, but for what presses nodes on their planes, with what penalties push */
} rest;

static __device__ inline void left_node(const newton *k, int32_t n, rest *sum)
{
    const float4 y = node_sum(k->x, n), w = k->t->weight[n], step = k->x->step[n];
    const double left[3] = {(double)w.x - (double)y.x, (double)w.y - (double)y.y, (double)w.z - (double)y.z};
    const float4 single = {(float)left[0], (float)left[1], (float)left[2], 0};
    k->x->left[n] = single;
    sum->squares[0] += left[0] * left[0] + left[1] * left[1] + left[2] * left[2];
    sum->squares[1] += dot_of(w, w);
    sum->squares[2] += dot_of(y, y);
    sum->slope += dot_of(single, step);
    if (k->t->listed[n]) {
        const tissue_contact *c = &k->t->contact[n];
        if (k->x->active[n])
            sum->slope -= contact_along(c, single) * contact_along(c, step);
        else if (k->f->penalty)
            sum->slope += k->t->repulsion[n] * depth_of(k, n) * contact_along(c, step);
    }
}

static __device__ void find_left(const newton *k)
{
    each_element(k, [&](int32_t i, newton_group group) { measure_element(k->t, k->x, i, group); });
    end_phase(k);
    over_points(k, k->x->pressure);
    each_element(k, [&](int32_t i, newton_group group) { stress_element(k->t, k->x, i, group); });
    end_phase(k);
    each_span(k, [&](int32_t span) {
        rest sum = {{0, 0, 0}, 0};
        each_node(k, span, [&](int32_t n) { left_node(k, n, &sum); });
        for (int a = 0; a < 3; a++)
            put_part(k, PART_LEFT + a, span, sum.squares[a]);
        put_part(k, PART_SLOPE, span, sum.slope);
    });
    end_phase(k);
}

/* ---- a step */

/* The residuals of a step: sums of squares over the diagonal. */
typedef struct balance {
    double free; /* of nodes along what they may */
    double off;  /* of what would pull nodes off their planes */
} balance;

/* What comes after a move along the way: nodes that came to the probe within alpha are held there, or those that were
 * to come. */
typedef enum after { AFTER_NOTHING, AFTER_BEGIN, AFTER_MEET, AFTER_HOLD } after;

/* Holds a node on its plane. Returns what is left there. */
static __device__ inline float4 hold(const newton *k, int32_t n, float4 left)
{
    const tissue_contact *c = &k->t->contact[n];
    const double along = contact_along(c, left);
    k->x->active[n] = 1;
    k->x->pull[n] = along;
    return contact_add(c, left, -along);
}

/* Returns whether a free node has reached the probe. */
static __device__ inline bool has_come(const newton *k, int32_t n, after then, double may)
{
    if (then == AFTER_HOLD)
        return k->x->meets[n];
    const double along = contact_along(&k->t->contact[n], k->x->way[n]);
    return then == AFTER_MEET && along < 0 && room_of(k, n) <= -along * may * 1e-6;
}

typedef struct moved {
    double free, off; /* balance's */
    double work;      /* of what would pull nodes off their planes, in the way that they were moved, J */
} moved;

/* step += alpha way, with what that leaves; y: what the way changes the node's pull by. */
static __device__ inline void advance_node(const newton *k, int32_t n, double alpha, float4 y, after then, moved *sum)
{
    const tissue_contact *c = &k->t->contact[n];
    const float by = (float)alpha, inverse = k->x->inverse[n];
    const float4 before = then == AFTER_BEGIN ? float4{0, 0, 0, 0} : k->x->step[n];
    if (k->x->active[n]) {
        const double along = contact_along(c, y);
        k->x->pull[n] += -alpha * along;
        y = contact_add(c, y, -along);
    }
    const float4 step = plus_times(before, by, k->x->way[n]), l = k->x->left[n];
    float4 left = {l.x - by * y.x, l.y - by * y.y, l.z - by * y.z, 0};
    k->x->step[n] = step;
    sum->free += (double)((left.x * left.x + left.y * left.y + left.z * left.z) * inverse);
    if (is_free_contact(k, n) && has_come(k, n, then, alpha))
        left = hold(k, n, left);
    k->x->left[n] = left;
    const double pull = k->x->active[n] ? fmax(k->x->pull[n], 0.) : 0;
    sum->off += pull * pull * (double)inverse;
    if (then == AFTER_BEGIN) {
        k->x->gone[n] = pull > 0 ? contact_add(c, left, pull) : left;
        sum->work += pull > 0 ? pull * contact_along(c, step) : 0;
    }
}

/* pulls: whether the way changes any pull. */
static __device__ balance advance(const newton *k, double alpha, bool pulls, after then)
{
    each_span(k, [&](int32_t span) {
        moved sum = {0, 0, 0};
        each_node(k, span, [&](int32_t n) {
            advance_node(k, n, alpha, pulls ? k->x->pulled[n] : float4{0, 0, 0, 0}, then, &sum);
        });
        put_part(k, PART_FREE, span, sum.free);
        put_rare(k, PART_OFF, span, sum.off);
        if (then == AFTER_BEGIN)
            put_rare(k, PART_WORK, span, sum.work);
    });
    end_phase(k);
    return {total(k, PART_FREE), k->f->touched ? total(k, PART_OFF) : 0};
}

/* A node where a step begins: one that is inside the probe has to come out, one that it pressed before stays at its
 * surface. Returns whether it is either. */
static __device__ inline bool begin_node(const newton *k, int32_t n)
{
    const tissue_contact *c = &k->t->contact[n];
    const float4 u = k->t->u[n];
    float4 way = {0, 0, 0, 0};
    mark_contact(k, n, u);
    k->x->started[n] = u;
    const bool listed = k->t->listed[n], active = listed && !k->f->penalty && (c->depth > 0 || c->force > 0);
    if (listed) {
        const float4 left = k->x->left[n];
        const double along = active ? contact_along(c, left) : 0;
        if (active)
            way = contact_add(c, way, c->depth);
        k->x->pull[n] = along;
        k->x->left[n] = contact_add(c, left, k->f->penalty ? k->t->repulsion[n] * c->depth : -along);
    }
    k->x->active[n] = active;
    k->x->way[n] = way;
    return active;
}

/* The nodes that a probe moves go their way in the step; what that pulls leaves what is left. */
static __device__ balance begin_step(const newton *k)
{
    each_span(k, [&](int32_t span) {
        double count = 0;
        each_node(k, span, [&](int32_t n) { count += begin_node(k, n); });
        put_rare(k, PART_FIRST, span, count);
    });
    end_phase(k);
    const bool moves = k->f->touched && total(k, PART_FIRST) > 0;
    if (moves)
        change_along(k, false);
    return advance(k, 1, moves, AFTER_BEGIN);
}

/* The way of a node: along what is left, and the one before; expands: so that a node that would go into the probe in a
 * step of fixed length comes to its surface. */
static __device__ inline void turn_node(const newton *k, int32_t n, float beta, bool expands)
{
    const tissue_contact *c = &k->t->contact[n];
    const float inverse = k->x->inverse[n];
    const float4 left = k->x->left[n], before = k->x->way[n];
    float4 way = {inverse * left.x + beta * before.x, inverse * left.y + beta * before.y,
                  inverse * left.z + beta * before.z, 0};
    bool meets = false;
    if (k->x->active[n])
        way = contact_add(c, way, -contact_along(c, way));
    if (expands && is_free_contact(k, n)) {
        const double along = contact_along(c, way), most = -room_of(k, n) / NEWTON_FIXED;
        meets = along < most;
        if (meets)
            way = contact_add(c, way, most - along);
    }
    k->x->way[n] = way;
    if (expands)
        k->x->meets[n] = meets;
}

static __device__ void turn(const newton *k, float beta, bool expands)
{
    each(k->t->nodes, [&](int32_t n) { turn_node(k, n, beta, expands); });
    end_phase(k);
}

static __device__ inline void let_go_node(const newton *k, int32_t n)
{
    float4 way = {0, 0, 0, 0};
    const double pull = k->x->active[n] ? k->x->pull[n] : 0;
    if (pull > 0) {
        const tissue_contact *c = &k->t->contact[n];
        k->x->active[n] = 0;
        k->x->left[n] = contact_add(c, k->x->left[n], pull);
        way = contact_add(c, way, pull * (double)k->x->inverse[n]);
    }
    k->x->way[n] = way;
}

/* Lets nodes go that are pulled off their planes: a step along their normals. */
static __device__ balance let_go(const newton *k, double off)
{
    each(k->t->nodes, [&](int32_t n) { let_go_node(k, n); });
    end_phase(k);
    const double curvature = change_along(k, false);
    return advance(k, curvature > 0 ? off / curvature : NEWTON_FIXED, true, AFTER_NOTHING);
}

/* A step of fixed length along what is left, of which nodes that would go into the probe come to its surface, and are
 * held there; or a shorter one, where what is stiff asks for that. */
static __device__ balance expand(const newton *k)
{
    turn(k, 0, true);
    const double curvature = change_along(k, true), along = total(k, PART_ALONG);
    const bool is_whole = !(curvature > 0) || NEWTON_FIXED * curvature <= along;
    const double alpha = is_whole ? NEWTON_FIXED : fmax(along, 0.) / curvature;
    return advance(k, alpha, true, is_whole ? AFTER_HOLD : AFTER_NOTHING);
}

/* tissue.c's find_step; *work: moved's. */
static __device__ int32_t find_step(const newton *k, int32_t most, double *work)
{
    balance b = begin_step(k);
    const double least = NEWTON_FORCING * (b.free + b.off);
    float beta = 0;
    int32_t count = 1;
    *work = k->f->touched ? total(k, PART_WORK) : 0;
    for (; count < most && b.free + b.off > least; count++) {
        if (b.off > b.free) {
            b = let_go(k, b.off);
            beta = 0;
            continue;
        }
        turn(k, beta, false);
        const double curvature = change_along(k, false), may = feasible(k);
        if (!(curvature > 0) && count > 1)
            break;
        const double want = curvature > 0 ? b.free / curvature : NEWTON_FIXED, before = b.free;
        b = advance(k, fmin(want, may), true, want > may ? AFTER_MEET : AFTER_NOTHING);
        beta = (float)(b.free / before);
        if (!(curvature > 0))
            break;
        if (want > may) {
            b = expand(k);
            beta = 0;
            count++;
        }
    }
    return count;
}

/* ---- a frame */

/* What conjugate gradients gain along the step, and the most that a node goes in it. */
static __device__ double gain_of(const newton *k, double *longest)
{
    each_span(k, [&](int32_t span) {
        double gain = 0, most = 0;
        each_node(k, span, [&](int32_t n) {
            const float4 step = k->x->step[n];
            gain += dot_of(k->x->gone[n], step);
            most = fmax(most, dot_of(step, step));
        });
        put_part(k, PART_SECOND, span, gain);
        put_most(k, PART_THIRD, span, most);
    });
    end_phase(k);
    *longest = sqrt(most_of(k, PART_THIRD));
    return total(k, PART_SECOND);
}

/* tissue.c's search. */
static __device__ void search(const newton *k, double work)
{
    double longest;
    const double gain = gain_of(k, &longest) - work;
    line_search s = line_search_begin(gain, fmin(1., NEWTON_STRIDE * k->x->side / longest));
    do {
        const float share = (float)s.share;
        each(k->t->nodes, [&](int32_t n) { k->t->u[n] = plus_times(k->x->started[n], share, k->x->step[n]); });
        end_phase(k);
        find_left(k);
    } while (line_search_next(&s, total(k, PART_SLOPE)));
}

/* A node's force of contact, and what that adds to the squares of what is left and of the load. */
static __device__ inline void conclude_node(const newton *k, int32_t n, double more[2])
{
    tissue_contact *c = &k->t->contact[n];
    if (k->t->listed[n]) {
        const float4 left = k->x->left[n], w = k->t->weight[n];
        const double rest[3] = {(double)left.x, (double)left.y, (double)left.z};
        const double heavy[3] = {(double)w.x, (double)w.y, (double)w.z};
        const double held = k->x->active[n] ? fmax(-contact_along(c, left), 0.) : 0;
        c->force = k->f->penalty ? k->t->repulsion[n] * depth_of(k, n) : held;
        for (int a = 0; a < 3; a++) {
            const double by = c->force * c->way[a];
            more[0] += (rest[a] + by) * (rest[a] + by) - rest[a] * rest[a];
            more[1] += (heavy[a] + by) * (heavy[a] + by) - heavy[a] * heavy[a];
        }
    }
    contact_hold(k->t, n);
    k->t->v[n] = {0, 0, 0, 0};
}

/* The forces of contact. Returns what is left, over the load. */
static __device__ double conclude(const newton *k)
{
    each_span(k, [&](int32_t span) {
        double more[2] = {0, 0};
        each_node(k, span, [&](int32_t n) { conclude_node(k, n, more); });
        put_rare(k, PART_MORE_LEFT, span, more[0]);
        put_rare(k, PART_MORE_LOAD, span, more[1]);
    });
    end_phase(k);
    double square = total(k, PART_LEFT), load = total(k, PART_LOAD);
    if (k->f->touched) {
        square += total(k, PART_MORE_LEFT);
        load += total(k, PART_MORE_LOAD);
    }
    load = fmax(fmax(load, total(k, PART_PULLS)), k->t->slight);
    return load > 0 ? sqrt(fmax(0., square) / load) : 0;
}

/* What the frame leaves to look at. */
static __device__ void look(const newton *k, double residual)
{
    for (int32_t chunk = blockIdx.x; chunk < k->t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        sight_parts(k->t, k->f, chunk, n < k->t->nodes ? k->t->u[n] : float4{0, 0, 0, 0}, k->s);
    }
    end_phase(k);
    if (blockIdx.x > 0)
        return;
    sight_sum(k->t, residual, 0, k->s);
    if (threadIdx.x == 0)
        *k->x->residual = residual;
}

template <int BLOCKS>
static __global__ void __launch_bounds__(GRID_THREADS, BLOCKS) newton_kernel(tissue t, tissue_frame f, tissue_newton x)
{
    __shared__ grid_scratch scratch;
    const newton k = {&t, &f, &x, &scratch};
    double residual = *x.residual;
    if (residual < NEWTON_BALANCED) /* pressures of a state far from balance mean nothing */
        each(x.points, [&](int32_t i) { x.held[i] = x.keep[i] * x.pressure[i]; });
    find_left(&k);
    for (int32_t count = f.count; count > 0;) {
        double work;
        count -= find_step(&k, count, &work) + 1;
        search(&k, work);
        residual = conclude(&k);
        if (residual < NEWTON_TOLERANCE)
            break;
    }
    look(&k, residual);
}

static const void *kernel_of(const tissue *t, int processors)
{
    return t->chunks <= 2 * processors ? (const void *)newton_kernel<2> : (const void *)newton_kernel<5>;
}

cudaError_t tissue_newton_start(const tissue *t, const tissue_frame *f, const tissue_newton *x, cudaStream_t stream)
{
    tissue_newton view = *x;
    return tissue_start(TISSUE_NEWTON, kernel_of, t, f, &view, (x->lanes + GRID_THREADS - 1) / GRID_THREADS, stream);
}
