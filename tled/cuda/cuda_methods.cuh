/* The ways in which a card takes steps, as rows of a table (cuda_method), of which one is chosen for a problem when its
 * state is made: tiles that are all resident, a march through the lattice, tiles by a launch a pass. Here is what the
 * host does for each: the arrays that it has of its own, and its launches. Included by cuda_loops.cuh alone.
 */
#ifndef SINEW_CUDA_METHODS_CUH
#define SINEW_CUDA_METHODS_CUH

#include "tled/cuda/cuda_state.cuh"

/* ---- tiles */

/* Cuts the problem in bricks of a size. -1: it cannot be cut so, or the card has too little shared memory for them. */
static int cut_in(cuda_state *s, cuda_size size, err *e)
{
    s->size = size;
    tiles_free(&s->tiles);
    return with_brick(size, [&](auto g) {
        typedef decltype(g) G;
        static const int brick[3] = {G::BX, G::BY, G::BZ};
        const cudaError_t allowed =
            with_stepper<CUDA_TILES>(wants_of(s->p), [](auto l) { return pass_allow<G, decltype(l)>(); });
        return CUDA_TRY(allowed) ? -1 : tiles_make(&s->tiles, s->p, brick, e);
    });
}

/* How many bricks of a size are resident at once, by the kernel that the tiles so far take, and how many nodes they
 * have at most. */
static int64_t places_of(const cuda_state *s, cuda_size size, int64_t *nodes)
{
    return with_brick(size, [&](auto g) {
        typedef decltype(g) G;
        const int64_t curves = s->curves;
        const int64_t places = with_stepper<CUDA_RESIDENT>(wants_of(s->p), [&](auto l) {
            typedef decltype(l) L;
            return with_tiles<L>(s->p->mix, s->tiles.list,
                                 [&](auto t) { return resident_places<G, L, decltype(t)>(curves); });
        });
        *nodes = places * G::NODES;
        return places;
    });
}

/* The smallest bricks that are all resident: the more there are, the less each has to do. Else the largest that the
 * card has shared memory for. So measured on an H200. */
static int cut_tiles(cuda_state *s, err *e)
{
    for (int size = CUDA_SMALL; size < CUDA_SIZES; size++) {
        int64_t nodes;
        err here = {0};
        s->places = places_of(s, (cuda_size)size, &nodes);
        if (size < CUDA_LARGE && s->p->nodes > nodes)
            continue;
        if (cut_in(s, (cuda_size)size, &here)) {
            cudaGetLastError(); /* it has said so */
            s->places = 0;
            return cut_in(s, size == CUDA_SMALL ? CUDA_SMALL : (cuda_size)(size - 1), e);
        }
        if (s->tiles.list) /* whose kernel may take more registers */
            s->places = places_of(s, (cuda_size)size, &nodes);
        if (s->tiles.count <= s->places)
            return 0;
    }
    return 0;
}

/* Whatever the card has room for. */
static int tiles_take(cuda_state *s, bool *takes, err *e)
{
    (void)s, (void)e;
    *takes = true;
    return 0;
}

/* The state in rows, a component after the other. */
static void rows_arrange(cuda_state *s)
{
    s->numbers = 3 * s->view.stride;
    s->view.along = s->view.mass_along = 1;
    for (int a = 0; a < 3; a++)
        s->view.offset[a] = a * s->view.stride;
}

static void tiles_list(cuda_state *s, const cuda_numbers *numbers, card_layout *l)
{
    card_layout_copy(l, &s->view.mass_inverse, numbers->mass_inverse, s->tiles.nodes);
}

static int tiles_begin(cuda_state *s, err *e)
{
    (void)s, (void)e;
    return 0;
}

/* A pass of `count` tiles, from `first` on. */
static int start_tiles(cuda_state *s, const cuda_pass *p, int64_t first, int64_t count, cudaStream_t stream, err *e)
{
    cuda_view<real> v = s->view;
    v.tiles += first;
    v.list = v.list ? v.list + first : NULL;
    const cudaError_t started = with_brick(s->size, [&](auto g) {
        return with_stepper<CUDA_TILES>(wants_of(s->p),
                                        [&](auto l) { return pass_start<decltype(g)>(l, v, *p, count, stream); });
    });
    return card_check(started, "the start of a pass", s->step, e);
}

/* Late tiles follow what goes on beside. */
static int begin_pass(cuda_state *s, const cuda_pass *p, err *e)
{
    const int64_t last = s->beside_due ? s->late_tiles : 0, first = s->tiles.count - last;
    if (start_tiles(s, p, 0, first, s->stream, e) || (last && start_tiles(s, p, first, last, s->beside, e)))
        return -1;
    s->beside_due = false;
    return last && (CUDA_TRY(cudaEventRecord(s->after_beside, s->beside)) ||
                    CUDA_TRY(cudaStreamWaitEvent(s->stream, s->after_beside)))
               ? -1
               : 0;
}

static void swap_displacements(cuda_state *s)
{
    real *to = s->field[TLED_DISPLACEMENT];
    s->field[TLED_DISPLACEMENT] = s->spare;
    s->spare = to;
}

/* One pass; now: the row of the curves' values where the state stands. */
static int pass(cuda_state *s, const tled_plan *plan, const double *now, int what, err *e)
{
    cuda_pass p = {s->field[TLED_DISPLACEMENT],
                   s->spare,
                   s->field[TLED_VELOCITY],
                   now,
                   now + 3 * s->p->script->curves,
                   NULL,
                   NULL,
                   s->shape,
                   node_factors_of(1 / plan->rate, plan->damping),
                   what,
                   1 / plan->rate};
    s->spare_is_internal = (what & PASS_INTERNAL) != 0;
    if (begin_pass(s, &p, e))
        return -1;
    if (what & PASS_BEGIN)
        swap_displacements(s);
    return 0;
}

/* What pass i of `count` steps does: all but the first end one, all but the last begin one. */
static int what_of(int64_t i, int64_t count)
{
    return (i > 0 ? PASS_FINISH : 0) | (i < count ? PASS_BEGIN : PASS_INTERNAL);
}

/* A launch each. */
static int tiles_passes(cuda_state *s, const cuda_batch *b, err *e)
{
    for (int64_t i = b->first; i < b->first + b->passes; i++)
        if (pass(s, b->plan, b->rows + (i - b->first) * 3 * s->p->script->curves, what_of(i, b->count), e))
            return -1;
    return 0;
}

static int tiles_internal(cuda_state *s, const tled_plan *here, const double *now, err *e)
{
    return pass(s, here, now, PASS_INTERNAL, e);
}

static int rows_from_rows(cuda_state *s, real *to, const real *from, err *e)
{
    return CUDA_TRY(cudaMemcpyAsync(to, from, (size_t)s->numbers * sizeof(real), cudaMemcpyDeviceToDevice, s->stream));
}

static int64_t tiles_computed(const cuda_state *s)
{
    return s->tiles.cells;
}

/* ---- resident tiles */

/* Tells whether the card has more to do after each pass (take_passes). */
static bool has_more(const tled_problem *p)
{
    return p->sliding || p->collider || p->self_contact;
}

static int resident_take(cuda_state *s, bool *takes, err *e)
{
    (void)e;
    *takes = s->tiles.count <= s->places && !has_more(s->p);
    return 0;
}

static void resident_list(cuda_state *s, const cuda_numbers *numbers, card_layout *l)
{
    tiles_list(s, numbers, l);
    card_layout_add(l, &s->message, MESSAGES * MESSAGE_WORDS * s->view.stride);
}

static int resident_begin(cuda_state *s, err *e)
{
    return CUDA_TRY(cudaMemset(s->message, 0, MESSAGES * MESSAGE_WORDS * (size_t)s->view.stride * sizeof *s->message));
}

/* All in one launch. */
static int resident_passes(cuda_state *s, const cuda_batch *b, err *e)
{
    const bool ends = b->first + b->passes > b->count, moves = !ends || b->passes > 1;
    const cuda_pass p = {s->field[TLED_DISPLACEMENT],
                         moves ? s->spare : s->field[TLED_DISPLACEMENT],
                         s->field[TLED_VELOCITY],
                         b->rows,
                         NULL,
                         NULL,
                         NULL,
                         s->shape,
                         node_factors_of(1 / b->plan->rate, b->plan->damping),
                         0,
                         1 / b->plan->rate};
    const cuda_resident r = {p,
                             moves ? s->field[TLED_DISPLACEMENT] : s->spare,
                             s->message,
                             s->messages + 1,
                             (int32_t)b->passes,
                             (int32_t)s->p->script->curves,
                             b->first == 0,
                             ends};
    s->messages += (uint32_t)b->passes;
    const cudaError_t started = with_brick(s->size, [&](auto g) {
        return with_stepper<CUDA_RESIDENT>(wants_of(s->p), [&](auto l) {
            typedef decltype(g) G;
            typedef decltype(l) L;
            return with_tiles<L>(s->view.mixed, s->view.list, [&](auto t) {
                return resident_start<G, decltype(t)>(l, s->view, r, s->tiles.count, s->stream);
            });
        });
    });
    s->spare_is_internal = ends;
    if (card_check(started, "the start of passes", s->step, e))
        return -1;
    if (moves)
        swap_displacements(s);
    return 0;
}

/* ---- the march */

/* The kernels that the model takes; families: of the most fibres. */
static march_control march_control_for(const tled_problem *p, int families)
{
    return march_control_of(p->form, p->control.kind, p->side, families, p->cut.count > 0);
}

/* On a card that can, where the model is suited. */
static int march_take(cuda_state *s, bool *takes, err *e)
{
    int64_t slots = 0;
    const march_control control = march_control_for(s->p, march_families_of(s->p));
    if (control == MARCH_CONTROLS)
        return 0;
    if (CUDA_TRY(cuda_march_slots<real>(control, s->p->cut.count > 0, &slots)))
        return -1;
    if (!slots)
        return 0;
    if (march_make(&s->march, s->p, slots, e))
        return -1;
    *takes = s->march.units > 0 && s->march.units < UINT32_MAX / (TABLE_STEPS + 1); /* units of a launch are counted */
    *takes = *takes && (SINGLE || march_pays(&s->march, s->tiles.cells, slots));
    s->walkers = s->march.units < slots ? s->march.units : slots;
    return *takes ? tiles_reorder(&s->tiles, s->march.order, s->threads, e) : 0;
}

/* The state node by node, a node's components along the march's axes. */
static void march_arrange(cuda_state *s)
{
    s->numbers = 4 * s->view.stride;
    s->view.along = s->view.mass_along = MARCH_ALONG;
    for (int a = 0; a < 3; a++)
        s->view.offset[s->march.axis[a]] = march_offset(a, s->view.stride);
}

/* Words next to the velocities, for keep_near; its nodes have their masses themselves. */
static void march_list(cuda_state *s, const cuda_numbers *numbers, card_layout *l)
{
    const march *m = &s->march;
    cuda_march<real> *w = &s->walk;
    card_layout_copy(l, &w->word, m->word, (m->layers + MARCH_AHEAD) * MARCH_WORDS);
    card_layout_add(l, &w->done, m->units + 1);
    card_layout_copy(l, &w->unit, m->unit, m->units);
    card_layout_copy(l, &w->near, m->near, m->units * m->nears);
    card_layout_copy(l, &w->detail, m->detail, m->layers + MARCH_AHEAD);
    card_layout_copy(l, &w->which, m->which, m->details * MARCH_THREADS);
    card_layout_copy(l, &w->cell, numbers->march_cell, m->cells);
    card_layout_copy(l, &w->cut, m->cuts ? m->cut : NULL, m->cuts);
    card_layout_copy(l, &w->tip, m->tip, 8 * m->tips);
    card_layout_copy(l, &w->along, (const uint2 *)m->along, m->families ? march_along_tips(m) + 8 * m->tips : 0);
}

/* What a law has beside the neo-Hookean one. Returns the mu that goes with J^-5/3. */
static double more_plain(const tled_problem *p, const tled_law *law, double weight, march_more<real> *to)
{
    if (p->form == FORM_MOONEY_RIVLIN) {
        to->slope[0] = (real)(2 * weight * law->c[1]);
        return 2 * law->c[0];
    }
    double three = 1, density = 1 / (64 * p->side[0] * p->side[1] * p->side[2]);
    for (int k = 0; p->form == FORM_FIRST && k < MARCH_POWERS; three *= 3, k++) {
        to->slope[k] = (real)(2 * (k + 1) * weight * law->c[k] * three);
        if (k == 0)
            continue;
        const double shear = (k + 1) * (2 * k + 1) * law->c[k] / law->c[0] * three;
        to->shear[k - 1] = (real)shear;
        to->rise[k - 1] = (real)(k * shear / 3 * density);
    }
    return law->mu;
}

static void family_plain(const march *m, const tled_problem *p, double weight, march_family<real> *to)
{
    const fibre_numbers *of = &p->fibres.of[m->plain];
    const double square = 16 * p->side[0] * p->side[0], along = 1 - 3 * of->kappa;
    *to = {(real)(2 * weight * march_stiffness(m, of)),
           (real)(of->k2 * M_LOG2E),
           (real)(FIBRE_CAP * M_LOG2E),
           (real)(3 * of->kappa),
           (real)(along / square),
           (real)of->kappa,
           (real)(along * sqrt(square)),
           (real)cos(of->angle),
           (real)sin(of->angle)};
}

/* Of plain cells, under physical control, in a unit of force by which their bending is 1. */
static void hold_plain(cuda_state *s)
{
    const tled_problem *p = s->p;
    const tled_volume *plain = &p->volume[s->march.plain];
    const double *held = plain->law.hourglass, volume = p->side[0] * p->side[1] * p->side[2];
    const double unit = volume * held[HOURGLASS_BENDING], weight = MARCH_LAW / unit, by = volume / unit;
    march_hold<real> *to = &s->walk.held;
    const double mu = weight * more_plain(p, &plain->law, weight, &s->walk.more);
    to->mu = (real)(SINGLE ? log2(mu) : mu);
    to->press = (real)(weight * plain->law.bulk / (64 * volume));
    if (p->fibres.of)
        family_plain(&s->march, p, weight, &s->walk.family);
    to->bending = 1;
    to->coupling = (real)(by * held[HOURGLASS_COUPLING]);
    to->torsion = (real)(by * held[HOURGLASS_TORSION]);
    to->corner = (real)(by * held[HOURGLASS_CORNER]);
    for (int a = 0; a < 3; a++) {
        to->own[a] = s->walk.side[a].own * to->torsion;
        s->walk.area[a] = (real)(volume / (4 * p->side[s->march.axis[a]]) / unit);
    }
    s->walk.force = (real)unit;
    s->walk.weight = (real)weight;
}

/* What a march's kernels see beside its lists. */
static void march_fill(cuda_state *s)
{
    const tled_problem *p = s->p;
    const tled_volume *plain = &p->volume[s->march.plain];
    const int *axis = s->march.axis;
    cuda_march<real> *w = &s->walk;
    const double law[3] = {plain->law.c[0], plain->law.c[1], plain->law.hourglass[HOURGLASS_K]};
    const double volume = p->side[0] * p->side[1] * p->side[2];
    s->view.mass_inverse = s->field[TLED_DISPLACEMENT] + march_offset(3, s->view.stride);
    w->ticket = w->done + s->march.units;
    w->nears = (int32_t)s->march.nears;
    w->units = (int32_t)s->march.units;
    w->tip_first = s->march.tip_first;
    w->specials = s->march.cells;
    w->cuts = (int32_t)s->march.cuts;
    w->tip_along = w->along ? w->along + march_along_tips(&s->march) : NULL;
    w->v = s->view;
    for (int a = 0; a < 3; a++) {
        const double side = p->side[axis[a]], width = 4 * side;
        const double beside = 4 * p->side[axis[(a + 1) % 3]], across = 4 * p->side[axis[(a + 2) % 3]];
        w->axis[a] = axis[a];
        w->law[a] = (real)law[a];
        w->slope[a] = (real)(1 / (4 * side));
        w->area[a] = (real)(volume / (4 * side));
        w->side[a].width = (real)width;
        w->side[a].face = (real)(beside * across);
        w->side[a].thirds = (real)(1 / (3 * width * width));
        w->side[a].density = (real)(1 / (64 * volume));
        w->side[a].squares = (real)(64 * volume / (width * width));
        w->side[a].own = (real)(width * width * (1 / (beside * beside) + 1 / (across * across)) - 1);
    }
    w->force = 1;
    w->volume = (real)(64 * volume);
    if (p->control.kind == HOURGLASS_PHYSICAL)
        hold_plain(s);
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
    const size_t bytes = (size_t)(end - (const char *)s->field[TLED_VELOCITY]), room = (size_t)most / 5 * 3;
    cudaStreamAttrValue value = {};
    value.accessPolicyWindow.base_ptr = s->field[TLED_VELOCITY];
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

static int march_begin(cuda_state *s, err *e)
{
    march_fill(s);
    return CUDA_TRY(cudaMemset(s->walk.done, 0, ((size_t)s->march.units + 1) * sizeof *s->walk.done)) || keep_near(s, e)
               ? -1
               : 0;
}

/* What a march does in a pass: v = (keep v + half a) slow where a step begins, and so on. */
static cuda_march_kind<real> kind_of(const cuda_state *s, const tled_plan *plan, int what)
{
    const node_factors f = node_factors_of(1 / plan->rate, plan->damping);
    const bool begins = what & PASS_BEGIN, ends = what & PASS_FINISH;
    const real keep = (begins ? f.slow : 1) * (ends ? f.keep : 1);
    const real push = begins && ends ? f.dt * f.slow : begins ? f.half * f.slow : ends ? f.half : 0;
    return {(real)keep, (real)(push * s->walk.force), begins ? (real)f.dt : 0, (real)push, what};
}

/* `passes` passes in one launch. first: what the first does; ends: the last leaves the internal forces. */
static int march_on(cuda_state *s, const tled_plan *plan, const double *now, int64_t passes, int first, bool ends,
                    err *e)
{
    const cuda_march_pass<real> p = {{(float4 *)s->field[TLED_DISPLACEMENT], (float4 *)s->spare},
                                     (float4 *)s->field[TLED_VELOCITY],
                                     now,
                                     {kind_of(s, plan, first), kind_of(s, plan, PASS_BEGIN | PASS_FINISH),
                                      kind_of(s, plan, PASS_FINISH | PASS_INTERNAL)},
                                     3 * (int32_t)s->p->script->curves,
                                     (int32_t)passes,
                                     ends,
                                     first == (PASS_BEGIN | PASS_FINISH),
                                     s->walked + 1,
                                     s->tickets};
    const march_control control = march_control_for(s->p, s->march.families);
    if (card_check(cuda_march_start(control, &s->walk, &p, s->walkers, s->stream), "the start of passes", s->step, e))
        return -1;
    s->walked += (uint32_t)passes;
    s->tickets += (uint32_t)(passes * s->march.units + s->walkers);
    s->spare_is_internal = ends;
    if ((passes - ends) % 2)
        swap_displacements(s);
    return 0;
}

static int march_passes(cuda_state *s, const cuda_batch *b, err *e)
{
    return march_on(s, b->plan, b->rows, b->passes, what_of(b->first, b->count), b->first + b->passes > b->count, e);
}

static int march_internal(cuda_state *s, const tled_plan *here, const double *now, err *e)
{
    return march_on(s, here, now, 1, PASS_INTERNAL, true, e);
}

static int march_from_rows(cuda_state *s, real *to, const real *from, err *e)
{
    return CUDA_TRY(cuda_march_unpack(&s->walk, from, (float4 *)to, s->stream));
}

static int64_t march_computed(const cuda_state *s)
{
    return (int64_t)(s->march.computed * (double)s->p->elements);
}

static void march_end(cuda_state *s)
{
    (void)s;
    cudaCtxResetPersistingL2Cache();
}

/* ---- the table, and the choice */

enum { TILES_FORMS = (1 << FORM_STEPPED) - 1, MARCH_FORMS = march_forms() };

/* The preferred first. What is left takes the last. */
static const cuda_method cuda_methods[] = {
    {.forms = TILES_FORMS,
     .take = resident_take,
     .arrange = rows_arrange,
     .list = resident_list,
     .begin = resident_begin,
     .passes = resident_passes,
     .internal = tiles_internal,
     .from_rows = rows_from_rows,
     .computed = tiles_computed,
     .end = NULL},
    {.forms = MARCH_FORMS,
     .take = march_take,
     .arrange = march_arrange,
     .list = march_list,
     .begin = march_begin,
     .passes = march_passes,
     .internal = march_internal,
     .from_rows = march_from_rows,
     .computed = march_computed,
     .end = march_end},
    {.forms = TILES_FORMS,
     .parts = true,
     .take = tiles_take,
     .arrange = rows_arrange,
     .list = tiles_list,
     .begin = tiles_begin,
     .passes = tiles_passes,
     .internal = tiles_internal,
     .from_rows = rows_from_rows,
     .computed = tiles_computed,
     .end = NULL},
};

/* The first method that has kernels for the problem and takes it, cut in tiles as it is. */
static int choose_method(cuda_state *s, err *e)
{
    for (const cuda_method *m = cuda_methods; !s->method; m++) {
        bool takes = false;
        if (m->forms >> s->p->form & 1 && m->take(s, &takes, e))
            return -1;
        s->method = takes ? m : NULL;
    }
    return 0;
}

#endif
