/* The CUDA executor of msds-run: memory, and which kernel takes a frame. All of a frame is one launch.
 */
#include "solve/card_layout.cuh"

#include "msds/cuda/cuda_exact.cuh"
#include "msds/cuda/cuda_frames.cuh"
#include "msds/cuda/cuda_newton.cuh"
#include "msds/cuda/cuda_planes.cuh"
#include "msds/problem/newton.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern "C" {
#include "base/mem.h"
#include "msds/cpu/cg.h"
#include "msds/cuda/msds_cuda.h"
#include "msds/cuda/parts.h"
}

typedef struct msds_state cuda_state;

struct msds_state {
    const msds_problem *p;
    pool *threads;
    sell order;
    tissue t;
    tissue_exact x;
    tissue_newton newton;
    char *memory, *fem, *exact, *tets; /* of the card; tets: of the method tissue */
    card_planes planes;
    int64_t bytes, fem_bytes, exact_bytes, tets_bytes;
    card_frames frames;
    bool framed;             /* these are ready */
    void *staging;           /* pinned: nodes x float4, or x 3 doubles; made when first wanted */
    tissue_outcome *outcome; /* pinned */
    bool precise;            /* t.precise is the state; else t.u */
    int64_t step;
    cudaStream_t stream;
};

/* What went wrong in steps before may come out of any call. */
#define CUDA_TRY(call) card_check(call, #call, s->step, e)

/* ---- springs, and what every method needs */

typedef struct host_nodes { /* what create fills and sends */
    float4 *place, *weight, *u, *v, *spring;
    double *position, *repulsion, *precise;
    uint8_t *kind;
    int32_t *start;
    float *stiffness, *damper, *rest;
} host_nodes;

static void host_free(host_nodes *h)
{
    void *all[] = {h->place,   h->weight, h->u,     h->v,         h->spring, h->position, h->repulsion,
                   h->precise, h->kind,   h->start, h->stiffness, h->damper, h->rest};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
}

static int host_make(const cuda_state *s, host_nodes *h, err *e)
{
    const int64_t nodes = s->order.nodes, slots = s->order.slots * LANES;
    h->place = (float4 *)mem_array(nodes, sizeof *h->place, "the solver", e);
    h->weight = (float4 *)mem_array(nodes, sizeof *h->weight, "the solver", e);
    h->u = (float4 *)mem_array(nodes, sizeof *h->u, "the solver", e);
    h->v = (float4 *)mem_array(nodes, sizeof *h->v, "the solver", e);
    h->spring = (float4 *)mem_array(slots, sizeof *h->spring, "the solver", e);
    h->position = (double *)mem_array(nodes, 3 * sizeof *h->position, "the solver", e);
    h->repulsion = (double *)mem_array(nodes, sizeof *h->repulsion, "the solver", e);
    h->precise = (double *)mem_array(nodes, 3 * sizeof *h->precise, "the solver", e);
    h->kind = (uint8_t *)mem_array(nodes, sizeof *h->kind, "the solver", e);
    h->start = (int32_t *)mem_array(s->order.count + 1, sizeof *h->start, "the solver", e);
    h->stiffness = (float *)mem_array(slots, sizeof *h->stiffness, "the solver", e);
    h->damper = (float *)mem_array(slots, sizeof *h->damper, "the solver", e);
    h->rest = (float *)mem_array(slots, sizeof *h->rest, "the solver", e);
    return h->place && h->weight && h->u && h->v && h->spring && h->position && h->repulsion && h->precise && h->kind &&
                   h->start && h->stiffness && h->damper && h->rest
               ? 0
               : -1;
}

static float4 three(const double *x)
{
    return {(float)x[0], (float)x[1], (float)x[2], 0};
}

static void host_fill(const cuda_state *s, host_nodes *h)
{
    const msds_problem *p = s->p;
    const double *g = p->options.gravity;
    for (int64_t n = 0; n < p->nodes; n++) {
        const int32_t own = s->order.own_node[n];
        const double weight[3] = {p->weight[n] * g[0], p->weight[n] * g[1], p->weight[n] * g[2]};
        h->kind[own] = p->fixed[n] ? TISSUE_FIXED : TISSUE_FREE;
        h->place[own] = three(p->position + 3 * n);
        h->place[own].w = p->fixed[n] ? 0 : (float)(1 / (p->weight[n] * p->mass_factor));
        if (!p->fixed[n])
            h->weight[own] = three(weight);
        h->weight[own].w = (float)p->repulsion[n];
        h->repulsion[own] = p->repulsion[n];
        h->u[own] = three(p->displacement + 3 * n);
        h->v[own] = three(p->velocity + 3 * n);
        memcpy(h->position + 3 * (int64_t)own, p->position + 3 * n, 3 * sizeof *h->position);
        memcpy(h->precise + 3 * (int64_t)own, p->displacement + 3 * n, 3 * sizeof *h->precise);
    }
    for (int64_t i = 0; i <= s->order.count; i++)
        h->start[i] = (int32_t)s->order.start[i];
    sell_springs(&s->order, p, h->stiffness, h->damper, h->rest);
    for (int64_t i = 0; i < s->order.slots * LANES; i++) {
        h->spring[i] = {h->rest[i], h->stiffness[i], h->damper[i], 0};
        memcpy(&h->spring[i].w, &s->order.neighbour[i], sizeof h->spring[i].w);
    }
}

static void list_problem(cuda_state *s, const host_nodes *h, card_layout *l)
{
    tissue *t = &s->t;
    const int64_t nodes = s->order.nodes, slots = s->order.slots * LANES;
    card_layout_copy(l, &t->start, h->start, s->order.count + 1);
    card_layout_copy(l, &t->neighbour, s->order.neighbour, slots);
    card_layout_copy(l, &t->spring, h->spring, slots);
    card_layout_copy(l, &t->kind, h->kind, nodes);
    card_layout_copy(l, &t->place, h->place, nodes);
    card_layout_copy(l, &t->weight, h->weight, nodes);
    card_layout_copy(l, &t->position, h->position, 3 * nodes);
    card_layout_copy(l, &t->repulsion, h->repulsion, nodes);
    card_layout_copy(l, &t->u, h->u, nodes);
    card_layout_copy(l, &t->v, h->v, nodes);
    card_layout_copy(l, &t->precise, h->precise, 3 * nodes);
    card_layout_add(l, &t->next_u, nodes);
    card_layout_add(l, &t->next_v, nodes);
    card_layout_add(l, &t->contact, nodes);
    card_layout_add(l, &t->listed, nodes);
    card_layout_add(l, &t->held, nodes);
    card_layout_add(l, &t->part, (int64_t)PARTS * t->chunks);
    card_layout_add(l, &t->outcome, 1);
    card_layout_add(l, &t->arrived, TISSUE_KERNELS);
}

static int put_problem(cuda_state *s, err *e)
{
    host_nodes h = {0};
    card_layout layout = {0};
    char what[80];
    int result = -1;
    if (host_make(s, &h, e))
        goto out;
    host_fill(s, &h);
    list_problem(s, &h, &layout);
    s->bytes = layout.bytes;
    snprintf(what, sizeof what, "the solver of %lld elements", (long long)s->p->elements);
    result = card_layout_place(&layout, true, what, &s->memory, e);
out:
    host_free(&h);
    return result;
}

static int fill(cuda_state *s, err *e)
{
    if (sell_make(&s->order, s->p, e))
        return -1;
    s->t.nodes = (int32_t)s->order.nodes;
    s->t.chunks = (int32_t)pool_chunks(s->order.count, SELL_CHUNK);
    s->t.slight = s->p->slight;
    s->precise = true;
    return put_problem(s, e) || CUDA_TRY(cudaStreamCreateWithFlags(&s->stream, cudaStreamNonBlocking)) ||
                   CUDA_TRY(cudaMallocHost((void **)&s->outcome, sizeof *s->outcome)) ||
                   CUDA_TRY(cudaDeviceSynchronize())
               ? -1
               : 0;
}

static void cuda_destroy(cuda_state *s)
{
    if (!s)
        return;
    if (s->stream)
        cudaStreamSynchronize(s->stream);
    card_frames_free(&s->frames);
    cudaFreeHost(s->staging);
    cudaFreeHost(s->outcome);
    card_give(s->memory);
    card_give(s->fem);
    card_give(s->exact);
    card_give(s->tets);
    card_planes_free(&s->planes);
    if (s->stream)
        cudaStreamDestroy(s->stream);
    sell_free(&s->order);
    free(s);
}

static cuda_state *cuda_create(const msds_problem *problem, pool *threads, err *e)
{
    cuda_state *s = (cuda_state *)mem_array(1, sizeof *s, "the solver", e);
    if (!s)
        return NULL;
    s->p = problem;
    s->threads = threads;
    if (fill(s, e)) {
        cuda_destroy(s);
        return NULL;
    }
    return s;
}

/* ---- the FEM */

static void list_stiffness(cuda_state *s, const lanes_matrix *m, card_layout *l)
{
    tissue *t = &s->t;
    const int64_t nodes = s->order.nodes;
    card_layout_copy(l, &t->diagonal, m->diagonal, s->order.count * 9 * LANES);
    card_layout_copy(l, &t->block, m->block, s->order.slots * 9 * LANES);
    card_layout_add(l, &t->left, nodes);
    card_layout_add(l, &t->pulled, nodes);
    card_layout_add(l, &t->way[0], nodes);
    card_layout_add(l, &t->way[1], nodes);
}

/* The stiffness on the host, in the order of sell.h; diagonal and block are the caller's to free. */
static int make_matrix(cuda_state *s, lanes_matrix *m, err *e)
{
    stiffness k = {0};
    int result = -1;
    m->s = &s->order;
    m->diagonal = (float *)mem_array(s->order.count, 9 * LANES * sizeof(float), "the solver", e);
    m->block = (float *)mem_array(s->order.slots, 9 * LANES * sizeof(float), "the solver", e);
    if (m->diagonal && m->block && !stiffness_make(&k, s->p, false, s->threads, e)) {
        cg_fill(m, s->p, &k, s->threads);
        result = 0;
    }
    stiffness_free(&k);
    return result;
}

static void matrix_free(lanes_matrix *m)
{
    free(m->diagonal);
    free(m->block);
}

/* The stiffness on the card, and in m (zeroed) on the host, which is the caller's to free in every case. */
static int put_stiffness(cuda_state *s, lanes_matrix *m, err *e)
{
    card_layout layout = {0};
    if (make_matrix(s, m, e))
        return -1;
    if (s->fem)
        return 0;
    list_stiffness(s, m, &layout);
    s->fem_bytes = layout.bytes;
    if (card_layout_place(&layout, true, "the stiffness", &s->fem, e))
        return -1;
    return CUDA_TRY(cudaDeviceSynchronize());
}

static int make_fem(cuda_state *s, err *e)
{
    lanes_matrix m = {};
    int result = s->fem ? 0 : put_stiffness(s, &m, e);
    matrix_free(&m);
    return result;
}

/* ---- exact frames */

static int make_exact(cuda_state *s, err *e)
{
    lanes_matrix m = {};
    int result = s->exact ? 0 : -1;
    if (!s->exact && !parts_held(s->p, e) && !put_stiffness(s, &m, e))
        result = tissue_exact_make(&s->x, &s->t, s->p, &s->order, &m, s->threads, &s->exact, &s->exact_bytes, e);
    matrix_free(&m);
    return result;
}

/* ---- the method tissue */

static int make_newton(cuda_state *s, err *e)
{
    if (s->tets)
        return 0;
    return tissue_newton_make(&s->newton, s->p, &s->order, &s->tets, &s->tets_bytes, e);
}

/* ---- frames */

cudaError_t tissue_start(tissue_kernel which, const void *(*of)(const tissue *t, int processors), const tissue *t,
                         const tissue_frame *f, void *more, int32_t chunks, cudaStream_t stream)
{
    int processors = 0, device = 0, fit = 0;
    tissue view = *t;
    tissue_frame frame = *f;
    void *with[] = {&view, &frame, more};
    view.arrived += which;
    cudaError_t code = cudaGetDevice(&device);
    if (code == cudaSuccess)
        code = cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device);
    const void *kernel = of(t, processors);
    if (code == cudaSuccess)
        code = cudaOccupancyMaxActiveBlocksPerMultiprocessor(&fit, kernel, GRID_THREADS, 0);
    const int blocks = fit * processors < chunks ? fit * processors : chunks;
    return code != cudaSuccess
               ? code
               : cudaLaunchCooperativeKernel(kernel, dim3((unsigned)blocks), dim3(GRID_THREADS), with, 0, stream);
}

static tissue_frame frame_of(const cuda_state *s, const msds_plan *plan, int64_t count)
{
    tissue_frame f = {};
    f.probe = card_planes_placed(&s->planes, &plan->probe);
    for (int a = 0; a < 3; a++)
        f.centre[a] = (float)plan->probe.centre[a];
    f.reach = (float)(plan->probe.reach * (1 + 1e-6));
    f.wide = (float)(plan->probe.reach + 1.01 * CONTACT_NEAR_BY * plan->probe.shape.size);
    f.dt = (float)plan->dt;
    f.damping = s->p->options.damping;
    f.count = (int32_t)count;
    f.touched = plan->touched;
    f.penalty = s->p->options.penalty;
    return f;
}

static int step_springs(cuda_state *s, const tissue_frame *f, err *e)
{
    if (card_check(tissue_springs_start(&s->t, f, s->stream), "the start of a frame", s->step, e))
        return -1;
    if (f->count % 2) {
        float4 *u = s->t.u, *v = s->t.v;
        s->t.u = s->t.next_u, s->t.v = s->t.next_v;
        s->t.next_u = u, s->t.next_v = v;
    }
    return 0;
}

static int step_fem(cuda_state *s, const tissue_frame *f, err *e)
{
    return make_fem(s, e) || card_check(tissue_fem_start(&s->t, f, s->stream), "the start of a frame", s->step, e) ? -1
                                                                                                                   : 0;
}

static int step_newton(cuda_state *s, const tissue_frame *f, err *e)
{
    return make_newton(s, e) ||
                   card_check(tissue_newton_start(&s->t, f, &s->newton, s->stream), "the start of a frame", s->step, e)
               ? -1
               : 0;
}

static int step_exact(cuda_state *s, const tissue_frame *f, err *e)
{
    if (make_exact(s, e))
        return -1;
    if (!s->precise) /* exact frames go on from what the others left */
        tissue_widen(&s->t, s->stream);
    return card_check(tissue_exact_start(&s->t, f, &s->x, s->stream), "the start of a frame", s->step, e);
}

static int cuda_step(cuda_state *s, const msds_plan *p, int64_t count, err *e)
{
    static int (*const steps[])(cuda_state *, const tissue_frame *, err *) = {step_springs, step_fem, step_exact,
                                                                              step_newton};
    if (p->warp && p->method != MSDS_SPRINGS)
        return err_set(e, NULL, 0, "--warp is not done on a card; expected -d cpu");
    if (p->touched && card_planes_put(&s->planes, &p->probe.shape, s->stream, s->step, e))
        return -1;
    const tissue_frame f = frame_of(s, p, count);
    const int result = steps[p->method](s, &f, e);
    s->precise = p->method == MSDS_EXACT;
    s->step++;
    return result;
}

/* Over an array of the card that kernels only read; no kernel runs. */
template <typename T> static int send(cuda_state *s, const T *to, const T *from, int64_t count, err *e)
{
    return CUDA_TRY(cudaMemcpy(const_cast<T *>(to), from, (size_t)count * sizeof(T), cudaMemcpyHostToDevice));
}

static int cuda_change(cuda_state *s, err *e)
{
    const int64_t nodes = s->order.nodes;
    host_nodes h = {};
    int result = -1;
    if (!host_make(s, &h, e) && !CUDA_TRY(cudaStreamSynchronize(s->stream))) {
        host_fill(s, &h);
        result = send(s, s->t.spring, h.spring, s->order.slots * LANES, e) || send(s, s->t.place, h.place, nodes, e) ||
                         send(s, s->t.weight, h.weight, nodes, e) || send(s, s->t.repulsion, h.repulsion, nodes, e)
                     ? -1
                     : 0;
    }
    host_free(&h);
    return result;
}

static int clear(cuda_state *s, void *what, size_t bytes, err *e)
{
    return what ? CUDA_TRY(cudaMemsetAsync(what, 0, bytes, s->stream)) : 0;
}

static int cuda_reset(cuda_state *s, err *e)
{
    const tissue *t = &s->t;
    const size_t nodes = (size_t)s->order.nodes;
    float4 *const fields[] = {t->u, t->v, t->next_u, t->next_v, t->left, t->pulled, t->way[0], t->way[1]};
    for (float4 *field : fields)
        if (clear(s, field, nodes * sizeof *field, e))
            return -1;
    s->precise = true;
    return clear(s, t->precise, 3 * nodes * sizeof *t->precise, e) || clear(s, t->held, nodes * sizeof *t->held, e) ||
                   clear(s, t->listed, nodes, e) || clear(s, t->outcome, sizeof *t->outcome, e) ||
                   (s->tets && CUDA_TRY(tissue_newton_reset(&s->newton, s->stream)))
               ? -1
               : 0;
}

/* The lattices of a mesh are made in milliseconds; what the method tissue needs takes longer, so it is made here. */
static int cuda_ready(cuda_state *s, const msds_plan *plan, err *e)
{
    return plan->method == MSDS_TISSUE && make_newton(s, e) ? -1 : 1;
}

/* ---- what comes out of it */

static card_fields fields_of(const cuda_state *s)
{
    return {s->t.u, s->t.v, s->precise ? s->t.precise : NULL, s->t.position};
}

static int cuda_monitor(cuda_state *s, msds_reading *reading, err *e)
{
    const card_fields now = fields_of(s);
    if ((s->framed && card_frames_count(&s->frames, &now, s->stream, s->step, e)) ||
        CUDA_TRY(cudaMemcpyAsync(s->outcome, s->t.outcome, sizeof *s->outcome, cudaMemcpyDeviceToHost, s->stream)) ||
        CUDA_TRY(cudaStreamSynchronize(s->stream)))
        return -1;
    *reading = s->outcome->reading;
    reading->inverted = s->framed ? (int64_t)*s->frames.told : -1;
    if (s->outcome->failed)
        return err_set(e, NULL, 0, "after %d solves the residual is still %.3g, or contact not settled; expected %.3g",
                       s->outcome->reading.solves, s->outcome->reading.residual, exact_tolerance);
    return 0;
}

static int cuda_frames(cuda_state *s, const msds_frames *of, err *e)
{
    s->framed = !card_frames_make(&s->frames, of, s->p, &s->order, e);
    return s->framed ? 0 : -1;
}

static int cuda_snapshot(cuda_state *s, int slot, err *e)
{
    const card_fields now = fields_of(s);
    return card_frames_send(&s->frames, &now, slot, s->stream, s->step, e);
}

static int cuda_fetch(cuda_state *s, int slot, msds_values *to, err *e)
{
    return card_frames_wait(&s->frames, slot, to, e);
}

static int bring(cuda_state *s, const void *from, size_t bytes, err *e)
{
    if (!s->staging && CUDA_TRY(cudaMallocHost(&s->staging, (size_t)s->order.nodes * 3 * sizeof(double))))
        return -1;
    return CUDA_TRY(cudaMemcpyAsync(s->staging, from, bytes, cudaMemcpyDeviceToHost, s->stream)) ||
                   CUDA_TRY(cudaStreamSynchronize(s->stream))
               ? -1
               : 0;
}

static int cuda_get(cuda_state *s, int what, double *to, err *e)
{
    const size_t nodes = (size_t)s->order.nodes;
    const bool precise = what == MSDS_DISPLACEMENT && s->precise;
    const float4 *single = what == MSDS_DISPLACEMENT ? s->t.u : s->t.v;
    if (precise ? bring(s, s->t.precise, 3 * nodes * sizeof(double), e) : bring(s, single, nodes * sizeof(float4), e))
        return -1;
    for (int64_t n = 0; n < s->p->nodes; n++) {
        const int32_t own = s->order.own_node[n];
        const float4 x = precise ? float4{} : ((const float4 *)s->staging)[own];
        if (precise)
            memcpy(to + 3 * n, (const double *)s->staging + 3 * (int64_t)own, 3 * sizeof *to);
        else
            to[3 * n] = (double)x.x, to[3 * n + 1] = (double)x.y, to[3 * n + 2] = (double)x.z;
    }
    return 0;
}

static int64_t cuda_bytes(const cuda_state *s)
{
    int64_t bytes = s->bytes + card_frames_bytes(&s->frames);
    if (s->fem)
        bytes += s->fem_bytes;
    if (s->exact)
        bytes += s->exact_bytes;
    if (s->tets)
        bytes += s->tets_bytes;
    return bytes;
}

const msds_executor msds_cuda = {
    .is = {.device = "cuda", .features = EXECUTOR_CONTACT | EXECUTOR_TISSUE, .forms = 0, .unusable = card_unusable},
    .skin = &msds_cuda_skin,
    .create = cuda_create,
    .destroy = cuda_destroy,
    .step = cuda_step,
    .ready = cuda_ready,
    .change = cuda_change,
    .reset = cuda_reset,
    .get = cuda_get,
    .frames = cuda_frames,
    .snapshot = cuda_snapshot,
    .fetch = cuda_fetch,
    .monitor = cuda_monitor,
    .bytes = cuda_bytes};
