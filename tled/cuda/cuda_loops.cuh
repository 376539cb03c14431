/* The CUDA executor: memory, and the passes in their order, around the kernels. Compiled twice, by cuda_double.cu and
 * cuda_single.cu, which choose `real` and name the table of functions. All that is here is static.
 *
 * Of `count` steps, the first pass begins one, each after it ends one and begins the next, the last ends one and
 * leaves the internal forces where displacements go else. All of a step's data stays on the card; the curves'
 * values of some steps at a time go there.
 */
#include "tled/cuda/cuda_frame.cuh"

/* ---- passes */

static int begin_pass(cuda_state *s, const cuda_pass *p, err *e)
{
    const cudaError_t started = with_brick(s->size, [&](auto g) {
        return with_form(s->p->form, [&](auto l) {
            return pass_start<decltype(g), decltype(l)>(s->view, *p, s->tiles.count, s->stream);
        });
    });
    return card_check(started, "the start of a pass", s->step, e);
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

/* What a march does in a pass: v = (keep v + half a) slow where a step begins, and so on. */
static cuda_march_kind kind_of(const tled_plan *plan, int what)
{
    const node_factors f = node_factors_of(1 / plan->rate, plan->damping);
    const bool begins = what & PASS_BEGIN, ends = what & PASS_FINISH;
    const real keep = (begins ? f.slow : 1) * (ends ? f.keep : 1);
    const real push = begins && ends ? f.dt * f.slow : begins ? f.half * f.slow : ends ? f.half : 0;
    return {(float)keep, (float)push, begins ? (float)f.dt : 0, what};
}

/* `passes` passes of a march in one launch. first: what the first does; ends: the last leaves the internal forces. */
static int march_on(cuda_state *s, const tled_plan *plan, const double *now, int64_t passes, int first, bool ends,
                    err *e)
{
    const cuda_march_pass p = {
        {(float4 *)s->displacement, (float4 *)s->spare},
        (float4 *)s->velocity,
        now,
        {kind_of(plan, first), kind_of(plan, PASS_BEGIN | PASS_FINISH), kind_of(plan, PASS_FINISH | PASS_INTERNAL)},
        3 * (int32_t)s->p->script->curves,
        (int32_t)passes,
        ends,
        s->walked + 1,
        s->tickets};
    if (card_check(cuda_march_start(&s->walk, &p, s->walkers, s->stream), "the start of passes", s->step, e))
        return -1;
    s->walked += (uint32_t)passes;
    s->tickets += (uint32_t)(passes * s->march.units + s->walkers);
    s->spare_is_internal = ends;
    if ((passes - ends) % 2)
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
        return with_form(s->p->form, [&](auto l) {
            typedef decltype(g) G;
            typedef decltype(l) L;
            return s->view.mixed ? resident_start<G, L, true>(s->view, r, s->tiles.count, s->stream)
                                 : resident_start<G, L, false>(s->view, r, s->tiles.count, s->stream);
        });
    });
    s->spare_is_internal = ends;
    if (card_check(started, "the start of passes", s->step, e))
        return -1;
    if (moves)
        swap_displacements(s);
    return 0;
}

/* What pass i of `count` steps does: all but the first end one, all but the last begin one. */
static int what_of(int64_t i, int64_t count)
{
    return (i > 0 ? PASS_FINISH : 0) | (i < count ? PASS_BEGIN : PASS_INTERNAL);
}

/* Passes from pass `first` of `count` steps on. */
static int make_passes(cuda_state *s, const tled_plan *plan, const double *rows, int64_t first, int64_t passes,
                       int64_t count, err *e)
{
    if (s->resident)
        return stay(s, plan, rows, first, passes, count, e);
    if (s->marches)
        return march_on(s, plan, rows, passes, what_of(first, count), first + passes > count, e);
    for (int64_t i = first; i < first + passes; i++)
        if (pass(s, plan, rows + (i - first) * 3 * s->p->script->curves, what_of(i, count), e))
            return -1;
    return 0;
}

static int cuda_step(cuda_state *s, const tled_plan *plan, int64_t count, err *e)
{
    const double *rows = NULL;
    for (int64_t first = 0; count > 0 && first <= count; first += TABLE_STEPS) {
        const int64_t passes = count + 1 - first < TABLE_STEPS ? count + 1 - first : TABLE_STEPS;
        if (put_table(s, plan, first, first + passes > count ? passes - 1 : passes, &rows, e) ||
            make_passes(s, plan, rows, first, passes, count, e))
            return -1;
        s->step += passes - (first == 0);
    }
    s->time = count > 0 ? tled_time(plan, count) : s->time;
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
    if (put_table(s, &here, 0, 0, &rows, e))
        return -1;
    return s->marches ? march_on(s, &here, rows, 1, PASS_INTERNAL, true, e) : pass(s, &here, rows, PASS_INTERNAL, e);
}

/* ---- in and out */

/* The fourth number of a node where it marches: of a displacement, or else of a velocity. */
static float fourth(const cuda_state *s, bool is_displacement, int64_t k)
{
    const uint32_t info = s->tiles.node_info[k];
    uint32_t bits = (info >> TILE_EXTRA & 1) << MARCH_EXTRA;
    float number;
    if (is_displacement)
        return (float)(1 / s->p->mass[s->tiles.node[k]]);
    for (int a = 0; a < 3; a++)
        bits |= (info >> (TILE_FREE + s->march.axis[a]) & 1) << (MARCH_FREE + a);
    memcpy(&number, &bits, sizeof number);
    return number;
}

static int set(cuda_state *s, real *to, const double *from, err *e)
{
    const cuda_view<real> *v = &s->view;
    for (int64_t k = 0; k < s->tiles.nodes; k++) {
        for (int a = 0; a < 3; a++)
            s->staging[v->offset[a] + k * v->along] = (real)from[3 * (int64_t)s->tiles.node[k] + a];
        if (s->marches) {
            const float number = fourth(s, to == s->displacement, k);
            memcpy(&s->staging[4 * k + 3], &number, sizeof number);
        }
    }
    return CUDA_TRY(cudaMemcpy(to, s->staging, (size_t)s->numbers * sizeof(real), cudaMemcpyHostToDevice));
}

static int cuda_get(cuda_state *s, int what, double *to, err *e)
{
    if (what == TLED_INTERNAL && find_internal(s, e))
        return -1;
    const real *from = what == TLED_DISPLACEMENT ? s->displacement : what == TLED_VELOCITY ? s->velocity : s->spare;
    if (CUDA_TRY(
            cudaMemcpyAsync(s->staging, from, (size_t)s->numbers * sizeof(real), cudaMemcpyDeviceToHost, s->stream)) ||
        CUDA_TRY(cudaStreamSynchronize(s->stream)))
        return -1;
    permute(s, s->staging, to);
    return 0;
}

/* What is kept, in rows, into the state again. */
static int from_rows(cuda_state *s, real *to, const real *from, err *e)
{
    return s->marches ? CUDA_TRY(cuda_march_unpack(&s->walk, (const float *)from, (float4 *)to, s->stream))
                      : CUDA_TRY(cudaMemcpyAsync(to, from, (size_t)s->numbers * sizeof(real), cudaMemcpyDeviceToDevice,
                                                 s->stream));
}

static int cuda_save(cuda_state *s, err *e)
{
    if (s->kept_internal && find_internal(s, e))
        return -1;
    const cuda_kept<real> kept = {{s->displacement, s->velocity, s->kept_internal ? s->spare : NULL},
                                  {s->kept_displacement, s->kept_displacement + 3 * s->view.stride, s->kept_internal}};
    s->has_kept_internal = s->kept_internal != NULL;
    s->kept_step = s->step;
    s->kept_time = s->time;
    return card_check(cuda_keep_start(&s->view, &kept, s->stream), "the start of a copy", s->step, e);
}

static int cuda_restore(cuda_state *s, err *e)
{
    const int64_t n = 3 * s->view.stride;
    s->spare_is_internal = false;
    s->step = s->kept_step;
    s->time = s->kept_time;
    return from_rows(s, s->displacement, s->kept_displacement, e) ||
                   from_rows(s, s->velocity, s->kept_displacement + n, e)
               ? -1
               : 0;
}

static int64_t cuda_bytes(const cuda_state *s)
{
    const int64_t rows = 3 * s->view.stride * (int64_t)sizeof(real);
    return s->bytes + (s->kept_internal ? rows : 0) + (s->frame ? frame_bytes(s) : 0);
}

static int cuda_monitor(cuda_state *s, const tled_question *q, tled_sums *sums, err *e)
{
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
    if (card_check(cuda_look_start(&l, s->p->form, s->sums, s->stream), "the start of a look", s->step, e) ||
        CUDA_TRY(cudaMemcpyAsync(s->sums_host, s->sums, sizeof *s->sums, cudaMemcpyDeviceToHost, s->stream)) ||
        CUDA_TRY(cudaStreamSynchronize(s->stream)))
        return -1;
    *sums = *s->sums_host;
    if (sums->frequency_element >= 0)
        sums->frequency_element = s->tiles.cell_element[sums->frequency_element];
    if (sums->broken >= 0)
        sums->broken = s->tiles.cell_element[sums->broken];
    return 0;
}

/* ---- life */

static void cuda_destroy(cuda_state *s)
{
    if (!s)
        return;
    if (s->stream)
        cudaStreamSynchronize(s->stream);
    if (s->sending)
        cudaStreamSynchronize(s->sending);
    for (int i = 0; i < TLED_SLOTS; i++) {
        if (s->slot[i].arrived)
            cudaEventDestroy(s->slot[i].arrived);
        cudaFreeHost(s->slot[i].host);
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
    pool_destroy(s->wideners);
    if (s->frame_free)
        cudaEventDestroy(s->frame_free);
    if (s->frame_ready)
        cudaEventDestroy(s->frame_ready);
    if (s->stream)
        cudaStreamDestroy(s->stream);
    if (s->sending)
        cudaStreamDestroy(s->sending);
    if (s->marches)
        cudaCtxResetPersistingL2Cache();
    tiles_free(&s->tiles);
    march_free(&s->march);
    free(s);
}

/* Velocities, which a pass reads and writes, and words, which stand after them, are what the cache is to keep while the
 * rest goes through it: three fifths of what it could; with more, models many times its size had too little left.
 * Nothing is lost where it cannot. The limit is the process's, and is left. */
static int keep_near(cuda_state *s, err *e)
{
    int device = 0, most = 0;
    if (CUDA_TRY(cudaGetDevice(&device)) ||
        CUDA_TRY(cudaDeviceGetAttribute(&most, cudaDevAttrMaxPersistingL2CacheSize, device)))
        return -1;
    const char *end = (const char *)(s->walk.word + s->march.layers * MARCH_WORDS);
    const size_t bytes = (size_t)(end - (const char *)s->velocity), room = (size_t)most / 5 * 3;
    cudaStreamAttrValue value = {};
    value.accessPolicyWindow.base_ptr = s->velocity;
    value.accessPolicyWindow.num_bytes = bytes < room ? bytes : room;
    value.accessPolicyWindow.hitRatio = 1;
    value.accessPolicyWindow.hitProp = cudaAccessPropertyPersisting;
    value.accessPolicyWindow.missProp = cudaAccessPropertyStreaming;
    if (!most ||
        cudaDeviceSetLimit(cudaLimitPersistingL2CacheSize, value.accessPolicyWindow.num_bytes) != cudaSuccess ||
        cudaStreamSetAttribute(s->stream, cudaStreamAttributeAccessPolicyWindow, &value) != cudaSuccess)
        cudaGetLastError(); /* it has said so */
    return 0;
}

/* What a march's kernels see beside its lists. */
static void begin_march(cuda_state *s)
{
    const tled_problem *p = s->p;
    const tled_volume *plain = &p->volume[s->march.plain];
    const int *axis = s->march.axis;
    cuda_march *w = &s->walk;
    const double law[3] = {plain->law.c[0], plain->law.c[1], plain->law.hourglass}; /* of the neo-Hookean form */
    w->nears = (int32_t)s->march.nears;
    w->units = (int32_t)s->march.units;
    static_assert(sizeof w->v == sizeof s->view, "views differ by what they point to alone");
    memcpy(&w->v, &s->view, sizeof w->v);
    for (int a = 0; a < 3; a++) {
        const double side = p->side[axis[a]];
        w->axis[a] = axis[a];
        w->law[a] = (float)law[a];
        w->slope[a] = (float)(1 / (4 * side));
        w->area[a] = (float)(p->side[0] * p->side[1] * p->side[2] / (4 * side));
    }
}

static int fill(cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    if (cut(s, e))
        return -1;
    s->view.stride = (p->nodes + 31) / 32 * 32;
    s->view.nodes = (int32_t)p->nodes;
    s->numbers = (s->marches ? 4 : 3) * s->view.stride;
    s->view.along = s->view.mass_along = s->marches ? 4 : 1;
    for (int a = 0; a < 3; a++)
        s->view.offset[s->marches ? s->march.axis[a] : a] = s->marches ? a : a * s->view.stride;
    s->view.volumes = p->volumes;
    s->view.extras = (int32_t)s->tiles.extras;
    s->view.gravity = (int32_t)p->gravity;
    memcpy(s->view.side, p->side, sizeof p->side);
    s->shape = element_box(p->side[0], p->side[1], p->side[2]);
    s->time = p->start;
    if (put_problem(s, e))
        return -1;
    if (s->marches)
        begin_march(s);
    if (make_events(s, e) || set(s, s->displacement, p->at_start.of[TLED_DISPLACEMENT], e) ||
        set(s, s->velocity, p->at_start.of[TLED_VELOCITY], e))
        return -1;
    if (s->resident &&
        CUDA_TRY(cudaMemset(s->message, 0, MESSAGES * MESSAGE_WORDS * (size_t)s->view.stride * sizeof *s->message)))
        return -1;
    if (s->marches && CUDA_TRY(cudaMemset(s->walk.done, 0, ((size_t)s->march.units + 1) * sizeof *s->walk.done)))
        return -1;
    if (s->marches && keep_near(s, e))
        return -1;
    /* Streams that do not block wait for none of it by themselves. */
    return CUDA_TRY(cudaDeviceSynchronize()) ? -1 : find_internal(s, e);
}

static cuda_state *cuda_create(const tled_problem *problem, pool *threads, err *e)
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

static int64_t cuda_computed(const cuda_state *s)
{
    return s->marches ? (int64_t)(s->march.computed * (double)s->p->elements) : s->tiles.cells;
}

const tled_executor CUDA_EXECUTOR = {
    .is = {.device = "cuda", .features = 0, .forms = (1U << FORM_STEPPED) - 1, .unusable = card_unusable},
    .create = cuda_create,
    .destroy = cuda_destroy,
    .step = cuda_step,
    .get = cuda_get,
    .save = cuda_save,
    .restore = cuda_restore,
    .snapshot = cuda_snapshot,
    .fetch = cuda_fetch,
    .monitor = cuda_monitor,
    .bytes = cuda_bytes,
    .computed = cuda_computed};
