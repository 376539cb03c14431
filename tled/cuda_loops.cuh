/* The CUDA back end: memory, and the passes in their order, around the kernels. Compiled twice, by cuda_double.cu and
 * cuda_single.cu, which choose `real` and name the table of functions. All that is here is static.
 *
 * Of `count` steps, the first pass begins one, each after it ends one and begins the next, the last ends one and leaves the
 * internal forces where displacements go else. All of a step's data stays on the card; the curves' values of some steps at
 * a time go there.
 */
#include "tled/cuda_resident.cuh"

enum {
    TABLE_STEPS = 256,
    TABLES = 2,
    COPY_CHUNK = 4096,
    FRAME_DIRECT = 2 << 20 /* bytes: a frame that is copied sooner than it is worth its own memory on the card */
};

typedef struct cuda_frame { /* results on their way to the host; made when first wanted */
    real *host;             /* pinned: displacement, then velocity */
    cudaEvent_t arrived;
    int64_t step; /* that it was taken at, for messages: the state's own goes on meanwhile */
} cuda_frame;

typedef struct cuda_state {
    const tled_problem *p;
    pool *threads;
    tiles tiles;
    cuda_size size; /* of its bricks */
    cuda_view<real> view;
    element_shape shape;
    char *memory;               /* of the card: all arrays below but for `frame` and `kept_internal` */
    int64_t bytes, used;        /* of memory */
    real *displacement, *spare; /* each 3 x stride, as is velocity */
    real *velocity;
    uint64_t *message;       /* between tiles that are resident */
    uint32_t messages;       /* passes that they have sent them for */
    real *kept_displacement; /* and velocity after it */
    real *kept_internal;     /* made when first wanted */
    real *frame;             /* a copy of displacement to send; likewise, unless that is: one of the two */
    bool spare_is_internal, has_kept_internal;
    bool resident;              /* all tiles have a place on the card at once */
    bool frame_direct;          /* there is no room for `frame` */
    double *table[TABLES];      /* on the card: TABLE_STEPS + 1 rows of the curves' values */
    double *table_host[TABLES]; /* pinned */
    cudaEvent_t table_free[TABLES], frame_free, frame_ready;
    int64_t tables; /* filled so far */
    void *look_parts;
    tled_sums *sums, *sums_host;
    real *staging; /* pinned: 3 x stride */
    cuda_frame taken[TLED_TAKEN];
    int64_t step, kept_step; /* for messages */
    double time, kept_time;  /* where the state stands */
    cudaStream_t stream, sending;
} cuda_state;

/* What went wrong in steps before may come out of any call. Not for taken(), which another thread calls. */
#define CUDA_TRY(call) card_check(call, #call, s->step, e)

/* Room in the card's memory; with none yet, counts only. */
static void *room(cuda_state *s, int64_t count, size_t size)
{
    void *at = s->memory ? s->memory + s->used : NULL;
    s->used += (count * (int64_t)size + 255) / 256 * 256;
    return at;
}

template <class T> static int put(cuda_state *s, const T **to, const T *from, int64_t count, err *e)
{
    T *at = (T *)room(s, count, sizeof(T));
    *to = at;
    return at ? CUDA_TRY(cudaMemcpy(at, from, (size_t)count * sizeof(T), cudaMemcpyHostToDevice)) : 0;
}

/* What the card gets of the problem's numbers. */
typedef struct cuda_numbers {
    real *mass_inverse, *law;
    cuda_kind *kind;
    cuda_mixed *mixture;
} cuda_numbers;

/* Lays out what is in s->memory, and fills what does not change. Called twice: to count, and to do. */
static int lay_out(cuda_state *s, const cuda_numbers *numbers, err *e)
{
    const tiles *t = &s->tiles;
    const tled_problem *p = s->p;
    cuda_view<real> *v = &s->view;
    const int64_t rows = 3 * v->stride;
    s->used = 0;
    if (put(s, &v->tiles, t->tile, t->count, e) || put(s, &v->node_info, t->node_info, t->nodes, e) ||
        put(s, &v->cell, t->cell, t->cells, e) || put(s, &v->halo_node, t->halo_node, t->halos, e) ||
        put(s, &v->halo_place, t->halo_place, t->halos, e) || put(s, &v->fibre, t->fibre, 3 * t->directions, e) ||
        (t->share && put(s, &v->share, t->share, t->cells, e)) ||
        (t->mixed && put(s, &v->mixed, t->mixed, t->cells, e)) ||
        (t->mixed && put(s, &v->mixture, numbers->mixture, p->laws, e)) ||
        (t->mixfibre && put(s, &v->mixfibre, t->mixfibre, 3 * t->directions, e)) ||
        put(s, &v->extra, t->extra, t->extras, e) ||
        put(s, &v->force_curve, p->force_curve, p->force_start[p->nodes], e) ||
        put(s, &v->force_share, p->force_share, p->force_start[p->nodes], e) ||
        put(s, &v->mass_inverse, numbers->mass_inverse, t->nodes, e) ||
        put(s, &v->kind, numbers->kind, p->volumes, e) || put(s, &v->law, numbers->law, LAW_NUMBERS * p->volumes, e))
        return -1;
    s->displacement = (real *)room(s, rows, sizeof(real));
    s->spare = (real *)room(s, rows, sizeof(real));
    s->velocity = (real *)room(s, rows, sizeof(real));
    s->kept_displacement = (real *)room(s, 2 * rows, sizeof(real));
    if (s->resident)
        s->message = (uint64_t *)room(s, MESSAGES * MESSAGE_WORDS * v->stride, sizeof *s->message);
    for (int i = 0; i < TABLES; i++)
        s->table[i] = (double *)room(s, (TABLE_STEPS + 1) * 3 * p->script->curves, sizeof(double));
    s->look_parts = room(s, (int64_t)cuda_look_bytes(t->count, t->nodes), 1);
    s->sums = (tled_sums *)room(s, 1, sizeof *s->sums);
    return 0;
}

static int make_events(cuda_state *s, err *e)
{
    const size_t row = 3 * (size_t)(s->p->script->curves ? s->p->script->curves : 1) * sizeof(double);
    if (CUDA_TRY(cudaStreamCreateWithFlags(&s->stream, cudaStreamNonBlocking)) ||
        CUDA_TRY(cudaStreamCreateWithFlags(&s->sending, cudaStreamNonBlocking)) ||
        CUDA_TRY(cudaEventCreateWithFlags(&s->frame_free, cudaEventDisableTiming)) ||
        CUDA_TRY(cudaEventCreateWithFlags(&s->frame_ready, cudaEventDisableTiming)) ||
        CUDA_TRY(cudaMallocHost((void **)&s->sums_host, sizeof *s->sums_host)) ||
        CUDA_TRY(cudaMallocHost((void **)&s->staging, 3 * (size_t)s->view.stride * sizeof(real))))
        return -1;
    for (int i = 0; i < TABLES; i++)
        if (CUDA_TRY(cudaMallocHost((void **)&s->table_host[i], (TABLE_STEPS + 1) * row)) ||
            CUDA_TRY(cudaEventCreateWithFlags(&s->table_free[i], cudaEventDisableTiming)))
            return -1;
    return 0;
}

static void put_mixtures(const tled_problem *p, cuda_mixed *to)
{
    for (int64_t i = 0; p->mixed && i < p->elements; i++)
        if (p->mixed[i] >= 0) {
            const tled_law law = tled_law_of(p, i);
            to[p->mixed[i]] = {law.mu, law.bulk, law.density, law.hourglass, tled_mixture(p, i), p->mix[i]};
        }
}

static int make_numbers(cuda_numbers *n, const cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    n->mass_inverse = (real *)mem_array(p->nodes, sizeof *n->mass_inverse, "the solver", e);
    n->law = (real *)mem_array(p->volumes, LAW_NUMBERS * sizeof *n->law, "the solver", e);
    n->kind = (cuda_kind *)mem_array(p->volumes, sizeof *n->kind, "the solver", e);
    n->mixture = (cuda_mixed *)mem_array(p->laws, sizeof *n->mixture, "the solver", e);
    if (!n->mass_inverse || !n->law || !n->kind || !n->mixture)
        return -1;
    for (int64_t k = 0; k < p->nodes; k++)
        n->mass_inverse[k] = (real)(1 / p->mass[s->tiles.node[k]]);
    for (int32_t i = 0; i < p->volumes; i++) {
        const tled_volume *v = &p->volume[i];
        real *law = n->law + LAW_NUMBERS * i;
        n->kind[i] = {v->mu, v->bulk, v->density, v->hourglass, v->peak, (int32_t)v->contract};
        law[0] = (real)v->mu, law[1] = (real)v->bulk, law[2] = (real)v->hourglass;
    }
    put_mixtures(p, n->mixture);
    return 0;
}

/* Takes the card's memory and puts the problem there. */
static int put_problem(cuda_state *s, err *e)
{
    char what[80];
    int result = -1;
    cuda_numbers numbers = {0};
    if (make_numbers(&numbers, s, e))
        goto out;
    lay_out(s, &numbers, e);
    s->bytes = s->used;
    snprintf(what, sizeof what, "the solver of %lld elements", (long long)s->p->elements);
    s->memory = (char *)card_take(s->bytes, what, e);
    if (s->memory && !lay_out(s, &numbers, e))
        result = 0;
out:
    free(numbers.mass_inverse);
    free(numbers.law);
    free(numbers.kind);
    free(numbers.mixture);
    return result;
}

/* ---- passes */

static int begin_pass(cuda_state *s, const cuda_pass *p, err *e)
{
    with_brick(s->size, [&](auto g) { pass_start<decltype(g)>(s->view, *p, s->tiles.count, s->stream); });
    return card_check(cudaGetLastError(), "the start of a pass", s->step, e);
}

/* Puts the curves' values of steps `first` to first + count of a plan on the card; *rows gets where. */
static int put_table(cuda_state *s, const tled_plan *plan, int64_t first, int64_t count, const double **rows, err *e)
{
    const int which = (int)(s->tables++ % TABLES);
    const int64_t row = 3 * s->p->script->curves;
    *rows = s->table[which];
    if (!row)
        return 0;
    if (CUDA_TRY(cudaEventSynchronize(s->table_free[which])))
        return -1;
    for (int64_t i = 0; i <= count; i++)
        tled_curves(s->p, tled_time(plan, first + i), s->table_host[which] + i * row);
    return CUDA_TRY(cudaMemcpyAsync(s->table[which], s->table_host[which], (size_t)((count + 1) * row) * sizeof(double),
                                    cudaMemcpyHostToDevice, s->stream)) ||
                   CUDA_TRY(cudaEventRecord(s->table_free[which], s->stream))
               ? -1
               : 0;
}

static void swap_displacements(cuda_state *s)
{
    real *to = s->displacement;
    s->displacement = s->spare;
    s->spare = to;
}

/* One pass; now: the row of the curves' values where the state stands. */
static int pass(cuda_state *s, const tled_plan *plan, const double *now, int what, err *e)
{
    cuda_pass p = {s->displacement,
                   s->spare,
                   s->velocity,
                   now,
                   now + 3 * s->p->script->curves,
                   NULL,
                   NULL,
                   s->shape,
                   node_factors_of(1 / plan->rate, plan->damping),
                   what};
    s->spare_is_internal = (what & PASS_INTERNAL) != 0;
    if (begin_pass(s, &p, e))
        return -1;
    if (what & PASS_BEGIN)
        swap_displacements(s);
    return 0;
}

/* `passes` passes from pass `first` of count steps on, in one launch. */
static int stay(cuda_state *s, const tled_plan *plan, const double *now, int64_t first, int64_t passes, int64_t count,
                err *e)
{
    const bool ends = first + passes > count, moves = !ends || passes > 1;
    const cuda_pass p = {s->displacement,
                         moves ? s->spare : s->displacement,
                         s->velocity,
                         now,
                         NULL,
                         NULL,
                         NULL,
                         s->shape,
                         node_factors_of(1 / plan->rate, plan->damping),
                         0};
    const cuda_resident r = {p,
                             moves ? s->displacement : s->spare,
                             s->message,
                             s->messages + 1,
                             (int32_t)passes,
                             (int32_t)s->p->script->curves,
                             first == 0,
                             ends};
    s->messages += (uint32_t)passes;
    const cudaError_t started = with_brick(s->size, [&](auto g) {
        return s->view.mixed ? resident_start<decltype(g), true>(s->view, r, s->tiles.count, s->stream)
                             : resident_start<decltype(g), false>(s->view, r, s->tiles.count, s->stream);
    });
    s->spare_is_internal = ends;
    if (card_check(started, "the start of passes", s->step, e))
        return -1;
    if (moves)
        swap_displacements(s);
    return 0;
}

static int cuda_step(void *state, const void *plan, int64_t count, err *e)
{
    cuda_state *s = (cuda_state *)state;
    const tled_plan *t = (const tled_plan *)plan;
    const double *rows = NULL;
    for (int64_t first = 0; count > 0 && first <= count; first += TABLE_STEPS) {
        const int64_t passes = count + 1 - first < TABLE_STEPS ? count + 1 - first : TABLE_STEPS;
        if (put_table(s, t, first, first + passes > count ? passes - 1 : passes, &rows, e))
            return -1;
        if (s->resident && stay(s, t, rows, first, passes, count, e))
            return -1;
        for (int64_t i = first; i < first + passes; i++) {
            int what = (i > 0 ? PASS_FINISH : 0) | (i < count ? PASS_BEGIN : PASS_INTERNAL);
            if (!s->resident && pass(s, t, rows + (i - first) * 3 * s->p->script->curves, what, e))
                return -1;
            s->step += i > 0;
        }
    }
    s->time = count > 0 ? tled_time(t, count) : s->time;
    return 0;
}

/* The internal forces into `spare`, if they are not there. */
static int find_internal(cuda_state *s, err *e)
{
    const tled_plan still = {0, 1, 0, 0};
    const double *rows = NULL;
    tled_plan here = still;
    if (s->spare_is_internal)
        return 0;
    here.origin = s->time;
    return put_table(s, &here, 0, 0, &rows, e) ? -1 : pass(s, &here, rows, PASS_INTERNAL, e);
}

/* ---- in and out */

typedef struct permutation { /* of arrays of 3 x stride in the tiles' order, to nodes x 3 in the model's */
    const cuda_state *s;
    const real *from;
    double *to;
} permutation;

static void permute_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const permutation *m = (const permutation *)context;
    (void)chunk;
    for (int64_t k = from; k < to; k++)
        for (int a = 0; a < 3; a++)
            m->to[3 * (int64_t)m->s->tiles.node[k] + a] = m->from[a * m->s->view.stride + k];
}

static void permute(const cuda_state *s, const real *from, double *to)
{
    permutation m = {s, from, to};
    pool_run(s->threads, s->tiles.nodes, COPY_CHUNK, permute_work, &m);
}

static int set(cuda_state *s, real *to, const double *from, err *e)
{
    const int64_t stride = s->view.stride;
    for (int64_t k = 0; k < s->tiles.nodes; k++)
        for (int a = 0; a < 3; a++)
            s->staging[a * stride + k] = (real)from[3 * (int64_t)s->tiles.node[k] + a];
    return CUDA_TRY(cudaMemcpy(to, s->staging, 3 * (size_t)stride * sizeof(real), cudaMemcpyHostToDevice));
}

static int cuda_get(void *state, int what, double *to, err *e)
{
    cuda_state *s = (cuda_state *)state;
    if (what == TLED_INTERNAL && find_internal(s, e))
        return -1;
    const real *from = what == TLED_DISPLACEMENT ? s->displacement : what == TLED_VELOCITY ? s->velocity : s->spare;
    if (CUDA_TRY(cudaMemcpyAsync(s->staging, from, 3 * (size_t)s->view.stride * sizeof(real), cudaMemcpyDeviceToHost,
                                 s->stream)) ||
        CUDA_TRY(cudaStreamSynchronize(s->stream)))
        return -1;
    permute(s, s->staging, to);
    return 0;
}

/* Copies n real numbers on the card. */
static int copy(cuda_state *s, real *to, const real *from, int64_t n, err *e)
{
    return CUDA_TRY(cudaMemcpyAsync(to, from, (size_t)n * sizeof(real), cudaMemcpyDeviceToDevice, s->stream));
}

static int cuda_keep(void *state, err *e)
{
    cuda_state *s = (cuda_state *)state;
    const int64_t n = 3 * s->view.stride;
    if (s->kept_internal && (find_internal(s, e) || copy(s, s->kept_internal, s->spare, n, e)))
        return -1;
    s->has_kept_internal = s->kept_internal != NULL;
    s->kept_step = s->step;
    s->kept_time = s->time;
    return copy(s, s->kept_displacement, s->displacement, n, e) || copy(s, s->kept_displacement + n, s->velocity, n, e)
               ? -1
               : 0;
}

static int cuda_back(void *state, err *e)
{
    cuda_state *s = (cuda_state *)state;
    const int64_t n = 3 * s->view.stride;
    s->spare_is_internal = false;
    s->step = s->kept_step;
    s->time = s->kept_time;
    return copy(s, s->displacement, s->kept_displacement, n, e) || copy(s, s->velocity, s->kept_displacement + n, n, e)
               ? -1
               : 0;
}

/* Where the card has no room for the copy, a frame holds up the steps: better than a run that ends at its first frame, which may be
 * its last state. */
static int make_frame(cuda_state *s, cuda_frame *f, err *e)
{
    const int64_t bytes = 6 * s->view.stride * (int64_t)sizeof(real);
    if (bytes > FRAME_DIRECT && !s->kept_internal && !s->frame && !s->frame_direct) {
        err full = {0};
        s->frame = (real *)card_take(bytes / 2, "a frame", &full);
        s->frame_direct = !s->frame;
    }
    if (f->host)
        return 0;
    return CUDA_TRY(cudaEventCreateWithFlags(&f->arrived, cudaEventDisableTiming)) ||
                   CUDA_TRY(cudaMallocHost((void **)&f->host, (size_t)bytes))
               ? -1
               : 0;
}

/* The velocity goes to the host between two steps; so does the displacement, or it is copied on the card, and from there
 * goes in a stream of its own while the steps go on. */
static int send_frame(cuda_state *s, const cuda_frame *f, err *e)
{
    const int64_t n = 3 * s->view.stride;
    const size_t bytes = (size_t)n * sizeof(real);
    if (CUDA_TRY(cudaMemcpyAsync(f->host + n, s->velocity, bytes, cudaMemcpyDeviceToHost, s->stream)))
        return -1;
    if (!s->frame)
        return CUDA_TRY(cudaMemcpyAsync(f->host, s->displacement, bytes, cudaMemcpyDeviceToHost, s->stream)) ||
                       CUDA_TRY(cudaEventRecord(f->arrived, s->stream))
                   ? -1
                   : 0;
    return CUDA_TRY(cudaStreamWaitEvent(s->stream, s->frame_free, 0)) || copy(s, s->frame, s->displacement, n, e) ||
                   CUDA_TRY(cudaEventRecord(s->frame_ready, s->stream)) ||
                   CUDA_TRY(cudaStreamWaitEvent(s->sending, s->frame_ready, 0)) ||
                   CUDA_TRY(cudaMemcpyAsync(f->host, s->frame, bytes, cudaMemcpyDeviceToHost, s->sending)) ||
                   CUDA_TRY(cudaEventRecord(s->frame_free, s->sending)) ||
                   CUDA_TRY(cudaEventRecord(f->arrived, s->sending))
               ? -1
               : 0;
}

static int cuda_take(void *state, int slot, err *e)
{
    cuda_state *s = (cuda_state *)state;
    cuda_frame *f = &s->taken[slot];
    if (make_frame(s, f, e))
        return -1;
    f->step = s->step;
    return send_frame(s, f, e);
}

static int cuda_taken(void *state, int slot, void *to, err *e)
{
    cuda_state *s = (cuda_state *)state;
    const tled_taken *out = (const tled_taken *)to;
    const cuda_frame *f = &s->taken[slot];
    const permutation u = {s, f->host, out->displacement}, v = {s, f->host + 3 * s->view.stride, out->velocity};
    if (card_check(cudaEventSynchronize(f->arrived), "the wait for a frame", f->step, e))
        return -1;
    permute_work((void *)&u, 0, 0, s->tiles.nodes);
    permute_work((void *)&v, 0, 0, s->tiles.nodes);
    return 0;
}

static int64_t cuda_bytes(const void *state)
{
    const cuda_state *s = (const cuda_state *)state;
    const int64_t rows = 3 * s->view.stride * (int64_t)sizeof(real);
    return s->bytes + (s->kept_internal ? rows : 0) + (s->frame ? rows : 0);
}

static int cuda_look_at(void *state, const void *question, void *answer, err *e)
{
    cuda_state *s = (cuda_state *)state;
    const tled_question *q = (const tled_question *)question;
    tled_plan here = {q->time, 1, 0, 0};
    const double *rows = NULL;
    if (q->differences && !s->kept_internal)
        s->kept_internal = (real *)card_take(3 * s->view.stride * (int64_t)sizeof(real), "the look at forces", e);
    if ((q->differences && !s->kept_internal) || find_internal(s, e) || put_table(s, &here, 0, 0, &rows, e))
        return -1;
    const real *kept = q->differences && s->has_kept_internal ? s->kept_displacement : NULL;
    cuda_look<real> l = {s->view,     s->size,  s->tiles.count, s->displacement,
                         s->velocity, s->spare, kept,           s->kept_internal,
                         rows,        *q,       s->look_parts};
    if (card_check(cuda_look_start(&l, s->sums, s->stream), "the start of a look", s->step, e) ||
        CUDA_TRY(cudaMemcpyAsync(s->sums_host, s->sums, sizeof *s->sums, cudaMemcpyDeviceToHost, s->stream)) ||
        CUDA_TRY(cudaStreamSynchronize(s->stream)))
        return -1;
    tled_sums *sums = (tled_sums *)answer;
    *sums = *s->sums_host;
    if (sums->frequency_element >= 0)
        sums->frequency_element = s->tiles.cell_element[sums->frequency_element];
    if (sums->broken >= 0)
        sums->broken = s->tiles.cell_element[sums->broken];
    return 0;
}

/* ---- life */

static void cuda_destroy(void *state)
{
    cuda_state *s = (cuda_state *)state;
    if (!s)
        return;
    if (s->stream)
        cudaStreamSynchronize(s->stream);
    if (s->sending)
        cudaStreamSynchronize(s->sending);
    for (int i = 0; i < TLED_TAKEN; i++) {
        if (s->taken[i].arrived)
            cudaEventDestroy(s->taken[i].arrived);
        cudaFreeHost(s->taken[i].host);
    }
    for (int i = 0; i < TABLES; i++) {
        if (s->table_free[i])
            cudaEventDestroy(s->table_free[i]);
        cudaFreeHost(s->table_host[i]);
    }
    cudaFreeHost(s->staging);
    cudaFreeHost(s->sums_host);
    card_give(s->memory);
    card_give(s->kept_internal);
    card_give(s->frame);
    if (s->frame_free)
        cudaEventDestroy(s->frame_free);
    if (s->frame_ready)
        cudaEventDestroy(s->frame_ready);
    if (s->stream)
        cudaStreamDestroy(s->stream);
    if (s->sending)
        cudaStreamDestroy(s->sending);
    tiles_free(&s->tiles);
    free(s);
}

/* Cuts the problem in bricks of a size. -1: it cannot be cut so, or the card has too little shared memory for them. */
static int cut_in(cuda_state *s, cuda_size size, err *e)
{
    s->size = size;
    tiles_free(&s->tiles);
    return with_brick(size, [&](auto g) {
        typedef decltype(g) G;
        static const int brick[3] = {G::BX, G::BY, G::BZ};
        return CUDA_TRY(pass_allow<G>()) ? -1 : tiles_make(&s->tiles, s->p, brick, e);
    });
}

/* How many bricks of a size are resident at once, and how many nodes they have at most. */
static int64_t places_of(const cuda_state *s, cuda_size size, int64_t *nodes)
{
    return with_brick(size, [&](auto g) {
        typedef decltype(g) G;
        const int64_t curves = s->p->script->curves;
        const int64_t places = s->p->mix ? resident_places<G, true>(curves) : resident_places<G, false>(curves);
        *nodes = places * G::NODES;
        return places;
    });
}

/* The smallest bricks that are all resident: the more there are, the less each has to do. Else the largest that the card has shared
 * memory for. So measured on an H200. */
static int cut(cuda_state *s, err *e)
{
    for (int size = CUDA_SMALL; size < CUDA_SIZES; size++) {
        int64_t nodes, places = places_of(s, (cuda_size)size, &nodes);
        err here = {0};
        if (size < CUDA_LARGE && s->p->nodes > nodes)
            continue;
        if (cut_in(s, (cuda_size)size, &here)) {
            cudaGetLastError(); /* it has said so */
            return cut_in(s, size == CUDA_SMALL ? CUDA_SMALL : (cuda_size)(size - 1), e);
        }
        s->resident = s->tiles.count <= places;
        if (s->resident)
            return 0;
    }
    return 0;
}

static int fill(cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    if (cut(s, e))
        return -1;
    s->view.stride = (p->nodes + 31) / 32 * 32;
    s->view.nodes = (int32_t)p->nodes;
    s->view.volumes = p->volumes;
    s->view.extras = (int32_t)s->tiles.extras;
    s->view.gravity = (int32_t)p->gravity;
    memcpy(s->view.side, p->side, sizeof p->side);
    s->shape = element_box(p->side[0], p->side[1], p->side[2]);
    s->time = p->start;
    if (put_problem(s, e) || make_events(s, e) || set(s, s->displacement, p->displacement, e) ||
        set(s, s->velocity, p->velocity, e) || CUDA_TRY(cudaDeviceSynchronize()))
        return -1;
    if (s->resident &&
        CUDA_TRY(cudaMemset(s->message, 0, MESSAGES * MESSAGE_WORDS * (size_t)s->view.stride * sizeof *s->message)))
        return -1;
    return find_internal(s, e);
}

static void *cuda_create(const void *problem, pool *threads, err *e)
{
    cuda_state *s = (cuda_state *)mem_array(1, sizeof *s, "the solver", e);
    if (!s)
        return NULL;
    s->p = (const tled_problem *)problem;
    s->threads = threads;
    if (fill(s, e)) {
        cuda_destroy(s);
        return NULL;
    }
    return s;
}

const backend CUDA_BACKEND = {"cuda",    card_unusable, cuda_create, cuda_step,    cuda_get,   cuda_keep,
                              cuda_back, cuda_take,     cuda_taken,  cuda_look_at, cuda_bytes, cuda_destroy};
