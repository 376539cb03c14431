/* The CUDA executor: memory, and the passes in their order, around the kernels. Compiled twice, by cuda_double.cu and
 * cuda_single.cu, which choose `real` and name the table of functions. All that is here is static.
 *
 * Of `count` steps, the first pass begins one, each after it ends one and begins the next, the last ends one and
 * leaves the internal forces where displacements go else. All of a step's data stays on the card; the curves'
 * values of some steps at a time go there.
 */
#include "tled/cuda/cuda_frame.cuh"
#include "tled/cuda/cuda_methods.cuh"

/* ---- passes */

/* What a probe pushes with at a time, after a pass of so long a step that damps so much. */
static int press(cuda_state *s, double time, double dt, double damping, bool finishes, bool begins, err *e)
{
    const collider *of = s->p->collider;
    if (!of || of->is_away)
        return 0;
    cuda_press c = {s->view,
                    s->position,
                    collider_at(of, time),
                    of->stiffness * collider_up(of, time),
                    begins ? s->spare : s->field[TLED_DISPLACEMENT],
                    begins ? s->field[TLED_DISPLACEMENT] : s->spare,
                    s->field[TLED_VELOCITY],
                    press_further(dt, damping, finishes, begins),
                    begins ? dt : 0};
    c.at.shape.plane = (double *)s->plane;
    return card_check(press_start(c, s->stream), "the start of contact", s->step, e);
}

/* Puts the curves' values of steps `first` to first + count of a plan on the card, after those of the step before;
 * *rows gets where. */
static int put_table(cuda_state *s, const tled_plan *plan, int64_t first, int64_t count, const double **rows, err *e)
{
    const int which = (int)(s->tables++ % TABLES);
    const int64_t row = 3 * s->p->script->curves;
    *rows = s->table[which] + row;
    if (!row)
        return 0;
    if (CUDA_TRY(cudaEventSynchronize(s->table_free[which])))
        return -1;
    for (int64_t i = 0; i < count + 2; i++)
        tled_curves(s->p, tled_time(plan, first - 1 + i), s->table_host[which] + i * row);
    return CUDA_TRY(cudaMemcpyAsync(s->table[which], s->table_host[which], (size_t)((count + 2) * row) * sizeof(double),
                                    cudaMemcpyHostToDevice, s->stream)) ||
                   CUDA_TRY(cudaEventRecord(s->table_free[which], s->stream))
               ? -1
               : 0;
}

/* What follows a pass that begins a step goes on beside the next pass, of which only the late tiles wait for it. */
static int go_beside(cuda_state *s, const cuda_batch *b, err *e)
{
    s->beside_due = s->late_tiles > 0 && b->first < b->count;
    if (!s->beside_due)
        return 0;
    return CUDA_TRY(cudaEventRecord(s->before_beside, s->stream)) ||
                   CUDA_TRY(cudaStreamWaitEvent(s->beside, s->before_beside))
               ? -1
               : 0;
}

/* The steps of nodes that slide, after a pass that left them where they were. */
static cuda_slide sliding_of(const cuda_state *s, const cuda_batch *b)
{
    const int64_t row = 3 * s->p->script->curves;
    const bool begins = b->first < b->count;
    return {s->view,
            s->sliders,
            begins ? s->spare : s->field[TLED_DISPLACEMENT],
            begins ? s->field[TLED_DISPLACEMENT] : s->spare,
            s->field[TLED_VELOCITY],
            b->rows - row,
            b->rows,
            b->rows + row,
            {1 / b->plan->rate, b->plan->damping, b->first > 0, begins, NULL}};
}

/* After a pass that begins a step, skin that touches is put back, and nodes slide before; after others these alone. */
static int slide_and_touch(cuda_state *s, const cuda_batch *b, err *e)
{
    cudaStream_t following = s->beside_due ? s->beside : s->stream;
    const cuda_slide slide = sliding_of(s, b);
    if (!s->p->self_contact || b->first >= b->count)
        return s->p->sliding ? card_check(slide_start(slide, following), "the start of sliding", s->step, e) : 0;
    const cuda_touch k = {s->view,
                          s->skin,
                          slide,
                          s->field[TLED_DISPLACEMENT],
                          s->field[TLED_VELOCITY],
                          b->rows,
                          b->rows + 3 * s->p->script->curves,
                          1 / b->plan->rate,
                          s->skin_launches++,
                          !s->skin_is_known};
    s->skin_is_known = true;
    return card_check(skin_start(k, s->skin_blocks, following), "the start of skin contact", s->step, e);
}

static int take_passes(cuda_state *s, const cuda_batch *b, err *e)
{
    if (!has_more(s->p))
        return s->method->passes(s, b, e);
    for (int64_t i = 0; i < b->passes; i++) {
        const cuda_batch one = {b->plan, b->rows + 3 * i * s->p->script->curves, b->first + i, 1, b->count};
        if (s->method->passes(s, &one, e) ||
            press(s, tled_time(b->plan, one.first), 1 / b->plan->rate, b->plan->damping, one.first > 0,
                  one.first < b->count, e) ||
            go_beside(s, &one, e) || slide_and_touch(s, &one, e))
            return -1;
    }
    return 0;
}

static int cuda_step(cuda_state *s, const tled_plan *plan, int64_t count, err *e)
{
    const double *rows = NULL;
    for (int64_t first = 0; count > 0 && first <= count; first += TABLE_STEPS) {
        const int64_t passes = count + 1 - first < TABLE_STEPS ? count + 1 - first : TABLE_STEPS;
        if (put_table(s, plan, first, first + passes > count ? passes - 1 : passes, &rows, e))
            return -1;
        const cuda_batch batch = {plan, rows, first, passes, count};
        if (take_passes(s, &batch, e))
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
    return s->method->internal(s, &here, rows, e) ? -1 : press(s, s->time, 0, 0, false, false, e);
}

/* ---- in and out */

/* A number whose last bits have room for MARCH_BITS: in single precision to 2e-6 of it, in double to 4e-15. */
static march_word weight_bits(double weight)
{
    const real number = (real)weight;
    march_word bits;
    memcpy(&bits, &number, sizeof bits);
    return (bits + (MARCH_BITS + 1) / 2) & ~(march_word)MARCH_BITS;
}

/* The fourth number of a node where it marches: of a displacement, or else of a velocity. */
static real fourth(const cuda_state *s, bool is_displacement, int64_t k)
{
    const uint32_t info = s->tiles.node_info[k];
    march_word bits = (info >> TILE_EXTRA & 1) << MARCH_EXTRA | (info >> TILE_APART & 1) << MARCH_APART;
    real number;
    if (is_displacement)
        return (real)(1 / s->p->mass[s->tiles.node[k]]);
    for (int a = 0; a < 3; a++)
        bits |= (info >> (TILE_FREE + s->march.axis[a]) & 1) << (MARCH_FREE + a);
    if (s->p->weight)
        bits |= weight_bits(tled_weight_part(s->p, s->tiles.node[k]));
    memcpy(&number, &bits, sizeof number);
    return number;
}

typedef struct setting { /* of a field, from the model's order */
    const cuda_state *s;
    const field_layout *layout;
    int field;
    const double *from;
} setting;

static void set_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const setting *m = (const setting *)context;
    const field_layout *l = m->layout;
    const bool has_fourth = m->field < CUDA_STEPPED && l->along == MARCH_ALONG;
    real *staging = m->s->staging;
    (void)chunk;
    for (int64_t k = from; k < to; k++) {
        for (int a = 0; a < l->columns; a++)
            staging[layout_at(l, a, k)] = (real)m->from[l->columns * (int64_t)l->row[k] + a];
        if (has_fourth) {
            const real number = fourth(m->s, m->field == TLED_DISPLACEMENT, k);
            memcpy(&staging[march_offset(3, l->stride) + MARCH_ALONG * k], &number, sizeof number);
        }
    }
}

static int set(cuda_state *s, int i, const double *from, err *e)
{
    const field_layout l = layout_of(s, i);
    setting m = {s, &l, i, from};
    pool_run(s->threads, l.places, COPY_CHUNK, set_work, &m);
    return CUDA_TRY(cudaMemcpy(s->field[i], s->staging, (size_t)l.numbers * sizeof(real), cudaMemcpyHostToDevice));
}

/* What a run begins with. */
static int set_all(cuda_state *s, err *e)
{
    for (int i = 0; i < s->p->fields.count; i++)
        if (set(s, i, s->p->at_start.of[i], e))
            return -1;
    return 0;
}

static int cuda_get(cuda_state *s, int what, double *to, err *e)
{
    if (what == TLED_INTERNAL && find_internal(s, e))
        return -1;
    const bool is_internal = what == TLED_INTERNAL;
    const field_layout l = layout_of(s, is_internal ? TLED_DISPLACEMENT : what);
    const real *from = is_internal ? s->spare : s->field[what];
    if (CUDA_TRY(
            cudaMemcpyAsync(s->staging, from, (size_t)l.numbers * sizeof(real), cudaMemcpyDeviceToHost, s->stream)) ||
        CUDA_TRY(cudaStreamSynchronize(s->stream)))
        return -1;
    permute(&l, s->staging, to, s->threads);
    return 0;
}

/* Saves those that steps move by one kernel, in rows; the internal forces too, once the monitor has asked for
 * differences. */
static int save_stepped(cuda_state *s, err *e)
{
    cuda_saved<real> saved = {};
    for (int i = 0; i < CUDA_STEPPED; i++)
        saved.from[i] = s->field[i], saved.to[i] = s->saved + i * 3 * s->view.stride;
    saved.from[CUDA_STEPPED] = s->saved_internal ? s->spare : NULL;
    saved.to[CUDA_STEPPED] = s->saved_internal;
    return card_check(cuda_save_start(&s->view, &saved, s->stream), "the start of a copy", s->step, e);
}

static int cuda_save(cuda_state *s, err *e)
{
    if (s->saved_internal && find_internal(s, e))
        return -1;
    s->has_saved_internal = s->saved_internal != NULL;
    s->skin_is_known = false;
    s->saved_step = s->step;
    s->saved_time = s->time;
    real *at = s->saved + CUDA_STEPPED * 3 * s->view.stride;
    for (int i = CUDA_STEPPED; i < s->p->fields.count; i++) {
        if (copy_on_card(s, at, s->field[i], saved_numbers(s, i), e))
            return -1;
        at += saved_numbers(s, i);
    }
    return save_stepped(s, e);
}

static int cuda_restore(cuda_state *s, err *e)
{
    const real *at = s->saved;
    s->spare_is_internal = s->skin_is_known = false;
    s->step = s->saved_step;
    s->time = s->saved_time;
    for (int i = 0; i < s->p->fields.count; i++) {
        const int bad = i < CUDA_STEPPED ? s->method->from_rows(s, s->field[i], at, e)
                                         : copy_on_card(s, s->field[i], at, saved_numbers(s, i), e);
        if (bad)
            return -1;
        at += saved_numbers(s, i);
    }
    return 0;
}

static int64_t cuda_bytes(const cuda_state *s)
{
    const int64_t rows = 3 * s->view.stride * (int64_t)sizeof(real);
    return s->bytes + s->skin_bytes + (s->saved_internal ? rows : 0) + (s->frame ? frame_bytes(s) : 0);
}

static int look_at_sliders(cuda_state *s, const cuda_look<real> *of, err *e)
{
    const cuda_slide_look l = {
        s->view, s->sliders, of->displacement, of->velocity, of->internal, of->saved_displacement, of->saved_internal,
        of->now, s->sums};
    return card_check(slide_look_start(l, s->stream), "the start of a look at sliding", s->step, e);
}

static int cuda_monitor(cuda_state *s, const tled_question *q, tled_sums *sums, err *e)
{
    tled_plan here = {q->time, 1, 0, 0};
    const double *rows = NULL;
    if (q->differences && !s->saved_internal)
        s->saved_internal = (real *)card_take(3 * s->view.stride * (int64_t)sizeof(real), "the look at forces", e);
    if ((q->differences && !s->saved_internal) || find_internal(s, e) || put_table(s, &here, 0, 0, &rows, e))
        return -1;
    const real *saved = q->differences && s->has_saved_internal ? s->saved : NULL; /* displacements */
    cuda_look<real> l = {s->view,
                         s->size,
                         s->tiles.count,
                         s->field[TLED_DISPLACEMENT],
                         s->field[TLED_VELOCITY],
                         s->spare,
                         saved,
                         s->saved_internal,
                         rows,
                         *q,
                         s->look_parts,
                         s->p->form,
                         s->p->control.kind,
                         s->fibres};
    if (card_check(cuda_look_start(&l, s->sums, s->stream), "the start of a look", s->step, e) ||
        (s->p->sliding && look_at_sliders(s, &l, e)) ||
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
    const cudaStream_t streams[] = {s->stream, s->sending, s->beside};
    const cudaEvent_t events[] = {s->frame_free, s->frame_ready, s->before_beside, s->after_beside};
    for (cudaStream_t of : streams)
        if (of)
            cudaStreamSynchronize(of);
    for (int i = 0; i < TLED_SLOTS; i++) {
        if (s->slot[i].arrived)
            cudaEventDestroy(s->slot[i].arrived);
        card_host_give(s->slot[i].host);
    }
    for (int i = 0; i < TABLES; i++) {
        if (s->table_free[i])
            cudaEventDestroy(s->table_free[i]);
        card_host_give(s->table_host[i]);
    }
    card_host_give(s->staging);
    card_host_give(s->sums_host);
    card_give(s->memory);
    card_give(s->skin_memory);
    card_give(s->saved_internal);
    card_give(s->frame);
    pool_destroy(s->wideners);
    for (cudaEvent_t of : events)
        if (of)
            cudaEventDestroy(of);
    for (cudaStream_t of : streams)
        if (of)
            cudaStreamDestroy(of);
    if (s->method && s->method->end)
        s->method->end(s);
    tiles_free(&s->tiles);
    march_free(&s->march);
    free(s);
}

/* As much as the problem has, and may get. */
static void choose_room(cuda_state *s)
{
    const tled_problem *p = s->p;
    s->extras = s->tiles.extras + p->spare_nodes;
    s->forces = p->force_start[p->nodes] + 2 * (int64_t)p->spare_nodes;
}

static int fill(cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    s->curves = p->script->curves + p->spare_curves;
    if (cut_tiles(s, e) || choose_method(s, e) || part_tiles(s, e))
        return -1;
    s->view.stride = (p->nodes + 31) / 32 * 32;
    s->view.nodes = (int32_t)p->nodes;
    s->method->arrange(s);
    s->view.volumes = p->volumes;
    choose_room(s);
    memcpy(s->view.side, p->side, sizeof p->side);
    s->shape = element_box(p->side[0], p->side[1], p->side[2]);
    s->time = p->start;
    if (put_problem(s, e) || put_skin(s, e) || make_events(s, e) || set_all(s, e) || s->method->begin(s, e))
        return -1;
    /* Streams that do not block wait for none of it by themselves. Other states' streams are not waited for. */
    return CUDA_TRY(cudaStreamSynchronize(NULL)) ? -1 : find_internal(s, e);
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

/* Where nodes stand one by one, what their steps need to know stands beside their velocities. */
static int put_flags(cuda_state *s, err *e)
{
    if (s->view.along != 4)
        return 0;
    memcpy(&s->walk.v, &s->view, sizeof s->walk.v);
    double *velocity = (double *)mem_array(s->p->nodes, 3 * sizeof *velocity, "the solver", e);
    const int failed = velocity ? cuda_get(s, TLED_VELOCITY, velocity, e) || set(s, TLED_VELOCITY, velocity, e) : 1;
    free(velocity);
    return failed ? -1 : 0;
}

/* Puts anew what the script does to bones. */
static int put_bones(cuda_state *s, err *e)
{
    const sliding *of = bones_of(s->p);
    return of ? put_array(s, s->sliders.ground.field, of->field, of->fields * (int64_t)sizeof *of->field, e) : 0;
}

/* Puts anew what it does to nodes that slide. */
static int put_sliders(cuda_state *s, err *e)
{
    const sliding *of = s->p->sliding;
    cuda_slider *made = of ? make_sliders(s, e) : NULL;
    const int failed = of && (!made || put_array(s, s->sliders.slider, made, of->count * (int64_t)sizeof *made, e));
    free(made);
    return failed ? -1 : 0;
}

/* Puts anew which nodes about skin it holds. */
static int put_skin_nodes(cuda_state *s, err *e)
{
    const self_contact *of = s->p->self_contact;
    int32_t *stand = of ? make_stand(s, e) : NULL;
    cuda_skin_node *made = stand ? skin_nodes(s->p, stand, e) : NULL;
    const int failed = of && (!made || put_array(s, s->skin.node, made, of->nodes * (int64_t)sizeof *made, e));
    free(stand);
    free(made);
    return failed ? -1 : 0;
}

/* Curves that contract muscles stay where they are: lines of that kind change values alone. */
static int cuda_reload(cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    if (CUDA_TRY(cudaDeviceSynchronize()) || tiles_reload(&s->tiles, p, e))
        return -1;
    if (p->script->curves > s->curves || s->tiles.extras > s->extras || p->force_start[p->nodes] > s->forces)
        return 1;
    s->spare_is_internal = false;
    const int64_t infos = s->tiles.nodes * (int64_t)sizeof *s->tiles.node_info;
    if (put_script(s, e) || put_array(s, s->view.node_info, s->tiles.node_info, infos, e) || put_flags(s, e) ||
        put_bones(s, e) || put_sliders(s, e) || put_skin_nodes(s, e))
        return -1;
    return CUDA_TRY(cudaDeviceSynchronize());
}

static int cuda_crowded(cuda_state *s, int64_t *count, err *e)
{
    const int64_t elements = s->skin_memory ? s->p->self_contact->elements : 0;
    int32_t *is = (int32_t *)mem_array(elements, sizeof *is, "the skin", e);
    const int failed =
        !is ||
        (elements &&
         (CUDA_TRY(cudaDeviceSynchronize()) ||
          CUDA_TRY(cudaMemcpy(is, s->skin.table.crowded, (size_t)elements * sizeof *is, cudaMemcpyDeviceToHost))));
    *count = 0;
    for (int64_t i = 0; i < elements && !failed; i++)
        *count += is[i];
    free(is);
    return failed ? -1 : 0;
}

static int64_t cuda_computed(const cuda_state *s)
{
    return s->method->computed(s);
}

/* A card loads a module's code when the first of its kernels is asked for. The march's is not loaded by cards that have
 * no kernels of it. */
static void cuda_load(void)
{
    int each = 0;
    int64_t slots = 0;
    cudaOccupancyMaxActiveBlocksPerMultiprocessor(&each, frame_kernel, FRAME_THREADS, 0);
    cuda_look_load();
    cuda_march_slots<real>(MARCH_CUBES, false, &slots);
    cudaGetLastError(); /* what fails is said where it is used */
}

enum { CUDA_FEATURES = EXECUTOR_USUAL | EXECUTOR_SLIDING | EXECUTOR_CONTACT | EXECUTOR_SELF_CONTACT };

const tled_executor CUDA_EXECUTOR = {.is = {.device = "cuda",
                                            .features = CUDA_FEATURES,
                                            .forms = TILES_FORMS,
                                            .unusable = card_unusable,
                                            .load = cuda_load,
                                            .share = card_share},
                                     .create = cuda_create,
                                     .destroy = cuda_destroy,
                                     .step = cuda_step,
                                     .get = cuda_get,
                                     .save = cuda_save,
                                     .restore = cuda_restore,
                                     .put = NULL,
                                     .reload = cuda_reload,
                                     .snapshot = cuda_snapshot,
                                     .fetch = cuda_fetch,
                                     .monitor = cuda_monitor,
                                     .bytes = cuda_bytes,
                                     .crowded = cuda_crowded,
                                     .computed = cuda_computed};
