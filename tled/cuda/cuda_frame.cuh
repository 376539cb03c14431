/* What leaves the card for the model's arrays: the state, which stands in the tiles' order or the march's, in single
 * precision perhaps. A frame is put into the model's order on the card, between two steps, and goes to the host in a
 * stream of its own while the steps go on. Included by cuda_loops.cuh alone.
 */
#ifndef SINEW_CUDA_FRAME_CUH
#define SINEW_CUDA_FRAME_CUH

#include "tled/cuda/cuda_state.cuh"

/* ---- by the host */

typedef struct permutation { /* of a field as the state has it, to the model's order */
    const field_layout *layout;
    const real *from;
    double *to;
} permutation;

static void permute_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const permutation *m = (const permutation *)context;
    const field_layout *l = m->layout;
    (void)chunk;
    for (int64_t k = from; k < to; k++)
        for (int a = 0; a < l->columns && (!l->cell || l->cell[k] >> TILE_OWN & 1); a++)
            m->to[l->columns * (int64_t)l->row[k] + a] = m->from[layout_at(l, a, k)];
}

/* threads: or NULL. */
static void permute(const field_layout *l, const real *from, double *to, pool *threads)
{
    permutation m = {l, from, to};
    if (threads)
        pool_run(threads, l->places, COPY_CHUNK, permute_work, &m);
    else
        permute_work(&m, 0, 0, l->places);
}

/* ---- by the card. A frame: the fields that steps move, 3 numbers a node in the model's order; then those others that
 * frames have, as they stand; after them, for the kernel, where each node stands in the state. */

static int copy_on_card(cuda_state *s, real *to, const real *from, int64_t numbers, err *e)
{
    return CUDA_TRY(cudaMemcpyAsync(to, from, (size_t)numbers * sizeof(real), cudaMemcpyDeviceToDevice, s->stream));
}

enum { FRAME_THREADS = 256, FRAME_EACH = 3 /* numbers, of displacement and of velocity: as many nodes as threads */ };

/* A thread has one component of three nodes: what is written follows each other, and what a node has side by side is
 * read by threads side by side. velocity: NULL where frames have none. */
static __global__ void frame_kernel(const __grid_constant__ cuda_view<real> v, const int32_t *__restrict__ place,
                                    const real *__restrict__ u, const real *__restrict__ velocity,
                                    real *__restrict__ to)
{
    const int32_t first = (int32_t)(blockIdx.x * FRAME_THREADS);
    real *const to_velocity = to + 3 * (int64_t)v.nodes;
#pragma unroll
    for (int k = 0; k < FRAME_EACH; k++) {
        const int32_t i = k * FRAME_THREADS + (int32_t)threadIdx.x, n = first + i / 3;
        if (n < v.nodes) {
            const int64_t from = v.offset[i % 3] + place[n] * v.along, at = 3 * (int64_t)first + i;
            to[at] = u[from];
            if (velocity)
                to_velocity[at] = velocity[from];
        }
    }
}

/* How many numbers field i takes in a frame; in_order: that the card has put in order. */
static int64_t sent_numbers(const cuda_state *s, int i, bool in_order)
{
    if (!fields_is_in(&s->p->fields, i, FIELD_IN_FRAMES))
        return 0;
    return in_order && i < CUDA_STEPPED ? 3 * s->tiles.nodes : layout_of(s, i).numbers;
}

static int64_t frame_numbers(const cuda_state *s, bool in_order)
{
    int64_t numbers = 0;
    for (int i = 0; i < s->p->fields.count; i++)
        numbers += sent_numbers(s, i, in_order);
    return numbers;
}

static int64_t frame_bytes(const cuda_state *s)
{
    return frame_numbers(s, true) * (int64_t)sizeof(real) + s->tiles.nodes * (int64_t)sizeof(int32_t);
}

static int32_t *frame_place(const cuda_state *s)
{
    return (int32_t *)(s->frame + frame_numbers(s, true));
}

/* Puts on the card where each of the model's nodes stands; by way of `staging`,
 * which only the stream writes from now on. */
static int put_place(cuda_state *s, err *e)
{
    int32_t *place = (int32_t *)s->staging;
    for (int64_t k = 0; k < s->tiles.nodes; k++)
        place[s->tiles.node[k]] = (int32_t)k;
    return CUDA_TRY(cudaMemcpyAsync(frame_place(s), place, (size_t)s->tiles.nodes * sizeof *place,
                                    cudaMemcpyHostToDevice, s->stream));
}

/* What a frame goes by, where there is room for it on the card. */
static int make_way(cuda_state *s, err *e)
{
    err full = {0};
    s->frame = (real *)card_take(frame_bytes(s), "a frame", &full);
    s->frame_direct = !s->frame;
    if (s->frame_direct)
        return 0;
    const int threads = pool_threads(s->threads);
    s->wideners = pool_create(threads < WIDENERS ? threads : WIDENERS, &full); /* or the caller does without */
    return put_place(s, e);
}

/* Where the card has no room for it, a frame holds up the steps: better than a run that ends at its
 * first frame, which may be its last state. */
static int make_frame(cuda_state *s, cuda_frame *f, err *e)
{
    const int64_t bytes = CUDA_STEPPED * 3 * s->view.stride * (int64_t)sizeof(real);
    if (bytes > FRAME_DIRECT && !s->saved_internal && !s->frame && !s->frame_direct && make_way(s, e))
        return -1;
    if (f->host)
        return 0;
    const int64_t numbers = frame_numbers(s, s->frame != NULL);
    return CUDA_TRY(cudaEventCreateWithFlags(&f->arrived, cudaEventDisableTiming)) ||
                   !(f->host = (real *)card_host_take(numbers * (int64_t)sizeof(real), e))
               ? -1
               : 0;
}

/* As it stands, between two steps. */
static int send_directly(cuda_state *s, const cuda_frame *f, err *e)
{
    real *at = f->host;
    for (int i = 0; i < s->p->fields.count; i++) {
        const int64_t numbers = sent_numbers(s, i, false);
        if (numbers && CUDA_TRY(cudaMemcpyAsync(at, s->field[i], (size_t)numbers * sizeof(real), cudaMemcpyDeviceToHost,
                                                s->stream)))
            return -1;
        at += numbers;
    }
    return CUDA_TRY(cudaEventRecord(f->arrived, s->stream));
}

/* Fills `frame` between two steps. */
static int fill_frame(cuda_state *s, err *e)
{
    const card_blocks blocks = {(s->tiles.nodes + FRAME_THREADS - 1) / FRAME_THREADS, FRAME_THREADS, 0, s->stream};
    real *at = s->frame;
    const real *velocity = sent_numbers(s, TLED_VELOCITY, true) ? s->field[TLED_VELOCITY] : NULL;
    for (int i = 0; i < CUDA_STEPPED; i++)
        at += sent_numbers(s, i, true);
    if (card_check(
            card_start(frame_kernel, blocks, s->view, frame_place(s), s->field[TLED_DISPLACEMENT], velocity, s->frame),
            "the start of a frame", s->step, e))
        return -1;
    for (int i = CUDA_STEPPED; i < s->p->fields.count; i++) {
        const int64_t numbers = sent_numbers(s, i, true);
        if (numbers && copy_on_card(s, at, s->field[i], numbers, e))
            return -1;
        at += numbers;
    }
    return 0;
}

/* The steps wait where the frame before is not yet sent: far less time passes between two that anyone would see. */
static int send_frame(cuda_state *s, const cuda_frame *f, err *e)
{
    if (!s->frame)
        return send_directly(s, f, e);
    return CUDA_TRY(cudaStreamWaitEvent(s->stream, s->frame_free, 0)) || fill_frame(s, e) ||
                   CUDA_TRY(cudaEventRecord(s->frame_ready, s->stream)) ||
                   CUDA_TRY(cudaStreamWaitEvent(s->sending, s->frame_ready, 0)) ||
                   CUDA_TRY(cudaMemcpyAsync(f->host, s->frame, (size_t)frame_numbers(s, true) * sizeof(real),
                                            cudaMemcpyDeviceToHost, s->sending)) ||
                   CUDA_TRY(cudaEventRecord(s->frame_free, s->sending)) ||
                   CUDA_TRY(cudaEventRecord(f->arrived, s->sending))
               ? -1
               : 0;
}

static int cuda_snapshot(cuda_state *s, int slot, err *e)
{
    cuda_frame *f = &s->slot[slot];
    if (make_frame(s, f, e))
        return -1;
    f->step = s->step;
    return send_frame(s, f, e);
}

typedef struct widening { /* of a field that the card has put in order */
    const real *from;
    double *to;
} widening;

static void widen_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const widening *w = (const widening *)context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        w->to[i] = w->from[i];
}

static void widen(const real *from, double *to, int64_t numbers, pool *threads)
{
    widening w = {from, to};
    if (threads)
        pool_run(threads, numbers, COPY_CHUNK, widen_work, &w);
    else
        widen_work(&w, 0, 0, numbers);
}

static int cuda_fetch(cuda_state *s, int slot, const field_values *to, err *e)
{
    const cuda_frame *f = &s->slot[slot];
    const bool in_order = s->frame != NULL;
    const real *at = f->host;
    if (card_check(cudaEventSynchronize(f->arrived), "the wait for a frame", f->step, e))
        return -1;
    for (int i = 0; i < s->p->fields.count; i++) {
        const field_layout l = layout_of(s, i);
        const int64_t numbers = sent_numbers(s, i, in_order);
        if (numbers && in_order && i < CUDA_STEPPED)
            widen(at, to->of[i], numbers, s->wideners);
        else if (numbers)
            permute(&l, at, to->of[i], s->wideners);
        at += numbers;
    }
    return 0;
}

#endif
