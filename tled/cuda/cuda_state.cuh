/* What a CUDA executor has of a problem: cut into tiles that the card has a place for, and laid out in its memory.
 * Included by cuda_frame.cuh and cuda_methods.cuh alone.
 */
#ifndef SINEW_CUDA_STATE_CUH
#define SINEW_CUDA_STATE_CUH

#include "solve/card_layout.cuh"

extern "C" {
#include "tled/tiles/tile_parts.h"
}

#include "tled/cuda/cuda_press.cuh"
#include "tled/cuda/cuda_resident.cuh"
#include "tled/cuda/cuda_skin_make.cuh"
#include "tled/cuda/cuda_sliding.cuh"

#include "tled/cuda/cuda_march.cuh" /* wants element.h before it */

enum { TABLE_STEPS = 256, TABLE_ROWS = TABLE_STEPS + 2, TABLES = 2, COPY_CHUNK = 4096, WIDENERS = 4 };
enum { FIRST_OF_ALL = -100 }; /* a priority: the card takes its nearest */

/* Bytes: a frame that is copied sooner than it is worth its own memory on the card. */
#ifndef FRAME_DIRECT
#define FRAME_DIRECT (2 << 20)
#endif

typedef struct cuda_frame { /* results on their way to the host; made when first wanted */
    real *host;             /* pinned: what `frame` has; without one, the fields of frames as they stand */
    cudaEvent_t arrived;
    int64_t step; /* that it was taken at, for messages: the state's own goes on meanwhile */
} cuda_frame;

typedef struct tled_state cuda_state;

/* What the card gets of the problem's numbers. */
typedef struct cuda_numbers {
    real *mass_inverse, *weight, *law; /* weight: or NULL */
    cuda_kind *kind;
    cuda_mixed *mixture;
    cuda_fibres<real> *fibres; /* as, until the struct ends, of models with fibres or cut elements; else NULL */
    cuda_fibres<double> *fibres_looked_at;
    real *family, *mixfamily;          /* or NULL */
    cuda_slider *slider;               /* or NULL, as is: */
    double *position;                  /* of nodes, for a probe */
    cuda_march_cell<real> *march_cell; /* the march's; or NULL */
} cuda_numbers;

/* Passes that follow each other, of those of `count` steps: what_of says what each does. */
typedef struct cuda_batch {
    const tled_plan *plan;
    const double *rows; /* on the card: the curves' values where the state stands, then after each step; and before it,
                           unless nothing is */
    int64_t first, passes, count;
} cuda_batch;

/* A way in which the card takes steps: a row of the table in cuda_methods.cuh. Its functions are called once for a
 * state, or for a batch of passes, and never within a step. They return -1 with e filled. */
typedef struct cuda_method {
    uint32_t forms; /* that it is compiled for: bit i for form i */
    bool parts;     /* whether some tiles may take a pass before others */
    /* Whether it takes the problem, which is cut in tiles. */
    int (*take)(cuda_state *s, bool *takes, err *e);
    /* How the arrays of the state stand: s->numbers, and in the view. */
    void (*arrange)(cuda_state *s);
    /* Lists the arrays that it has of its own; they stand on the card behind the velocities. */
    void (*list)(cuda_state *s, const cuda_numbers *numbers, card_layout *l);
    /* Makes what it has of its own ready, once all is on the card. */
    int (*begin)(cuda_state *s, err *e);
    int (*passes)(cuda_state *s, const cuda_batch *b, err *e);
    /* Finds the internal forces, into `spare`; now: the curves' values where the state stands, on the card. */
    int (*internal)(cuda_state *s, const tled_plan *here, const double *now, err *e);
    /* From what is saved, in rows, to an array of the state that steps move. */
    int (*from_rows)(cuda_state *s, real *to, const real *from, err *e);
    int64_t (*computed)(const cuda_state *s); /* tled_executor's */
    /* Undoes what it set for the process; NULL: nothing. */
    void (*end)(cuda_state *s);
} cuda_method;

struct tled_state {
    const tled_problem *p;
    pool *threads;
    const cuda_method *method; /* chosen when the problem was cut */
    struct tiles tiles;
    cuda_size size; /* of its bricks */
    int64_t places; /* how many of them the card has at once */
    cuda_view<real> view;
    const cuda_fibres<double> *fibres; /* of looks */
    element_shape shape;
    struct march march;       /* where the method is that: */
    cuda_march<real> walk;    /* what its kernels see */
    int64_t walkers;          /* blocks of it */
    uint32_t walked, tickets; /* passes of it, and units of all of them, and one more a block */
    char *memory;             /* of the card: all arrays below but for `frame` and `saved_internal` */
    int64_t bytes;            /* of memory */
    int64_t curves;           /* that there is room for, as for these, with those of the problem to begin with: */
    int64_t extras, forces;
    real *field[FIELDS_MOST]; /* of the problem's table, as layout_of says */
    real *spare;              /* as displacements are */
    cuda_sliders sliders;     /* on the card, as are: */
    const double *position;   /* for a probe, or NULL */
    const double *plane;      /* of a convex one */
    cuda_skin skin;           /* that touches itself; in memory of its own: */
    char *skin_memory;        /* or NULL: none does */
    int64_t skin_bytes, skin_blocks;
    uint32_t skin_launches;
    bool skin_is_known; /* from the launch before; else it is found anew */
    int64_t late_tiles; /* the last ones, which have nodes about skin or that slide; 0: all wait for these */
    bool beside_due;    /* these go on beside, and the next pass of the late tiles comes after them: */
    cudaStream_t beside;
    cudaEvent_t before_beside, after_beside;
    int64_t numbers;      /* of each of those that steps move: 3 x stride, or, where it marches, 4 x stride */
    uint64_t *message;    /* between tiles that are resident */
    uint32_t messages;    /* passes that they have sent them for */
    real *saved;          /* all fields, one after the other, those that steps move in rows: 3 x stride */
    real *saved_internal; /* in rows; made when first wanted */
    real *frame;          /* to send (cuda_frame.cuh); likewise, unless that is: one of the two */
    pool *wideners;       /* make doubles of it on the host, beside those of the run: made with it */
    bool spare_is_internal, has_saved_internal;
    bool frame_direct;          /* there is no room for `frame` */
    double *table[TABLES];      /* on the card: TABLE_ROWS rows of the curves' values */
    double *table_host[TABLES]; /* pinned */
    cudaEvent_t table_free[TABLES], frame_free, frame_ready;
    int64_t tables; /* filled so far */
    char *look_parts;
    tled_sums *sums, *sums_host;
    real *staging; /* pinned: the largest field */
    cuda_frame slot[TLED_SLOTS];
    int64_t step, saved_step; /* for messages */
    double time, saved_time;  /* where the state stands */
    cudaStream_t stream, sending;
};

/* What went wrong in steps before may come out of any call. Not for fetch(), which another thread calls. */
#define CUDA_TRY(call) card_check(call, #call, s->step, e)

/* ---- fields */

/* How the numbers of a field lie: place k of column a at offset[a] + k * along, where an offset that is NULL counts as
 * a * stride. Place k belongs to row[k] of the model. Places of a field on elements are the tiles' cells: an element
 * that several tiles compute has as many places, with the same numbers, and is read from the tile that owns it. */
typedef struct field_layout {
    int columns;
    int64_t numbers, places, stride, along; /* numbers: with padding */
    const int64_t *offset;
    const int32_t *row;
    const uint32_t *cell; /* places: TILE_OWN where they are read; NULL: all are */
} field_layout;

/* Those that the kernels know stand as their view says, all others column after column. */
static field_layout layout_of(const cuda_state *s, int i)
{
    const field *f = &s->p->fields.field[i];
    const tiles *t = &s->tiles;
    const cuda_view<real> *v = &s->view;
    const int64_t cells = (t->cells + 31) / 32 * 32;
    if (i < CUDA_STEPPED)
        return {f->columns, s->numbers, t->nodes, v->stride, v->along, v->offset, t->node, NULL};
    if (f->axis == FIELD_ELEMENT)
        return {f->columns, f->columns * cells, t->cells, cells, 1, NULL, t->cell_element, t->cell};
    return {f->columns, f->columns * v->stride, t->nodes, v->stride, 1, NULL, t->node, NULL};
}

static int64_t layout_at(const field_layout *l, int a, int64_t k)
{
    return (l->offset ? l->offset[a] : a * l->stride) + k * l->along;
}

/* How many numbers a field takes where it is saved. */
static int64_t saved_numbers(const cuda_state *s, int i)
{
    return i < CUDA_STEPPED ? 3 * s->view.stride : layout_of(s, i).numbers;
}

static int64_t saved_numbers_of_all(const cuda_state *s)
{
    int64_t numbers = 0;
    for (int i = 0; i < s->p->fields.count; i++)
        numbers += saved_numbers(s, i);
    return numbers;
}

static int64_t largest_field(const cuda_state *s)
{
    int64_t most = s->numbers;
    for (int i = 0; i < s->p->fields.count; i++) {
        const int64_t numbers = layout_of(s, i).numbers;
        most = numbers > most ? numbers : most;
    }
    return most;
}

/* ---- memory */

/* What kernels are chosen by. */
static cuda_wants wants_of(const tled_problem *p)
{
    const bool fibred = p->curved || p->fibres.of;
    if (p->cut.count)
        return {p->form, p->control.kind, fibred ? CUDA_CUT_FIBRED : CUDA_CUT};
    return {p->form, p->control.kind, fibred ? CUDA_FIBRED : CUDA_USUAL};
}

/* Of a law, as kernels read it (cuda_form). */
static int law_numbers(const tled_problem *p)
{
    return form_numbers(p->form) + cuda_held(p->control.kind);
}

/* The bones that nodes slide on, or that skin may not enter; NULL: there are none. */
static const sliding *bones_of(const tled_problem *p)
{
    if (p->sliding)
        return p->sliding;
    return p->self_contact && p->self_contact->solids ? p->self_contact->bones : NULL;
}

/* What does not change while the run goes on. */
static void list_problem(cuda_state *s, const cuda_numbers *numbers, card_layout *l)
{
    const tiles *t = &s->tiles;
    const tled_problem *p = s->p;
    cuda_view<real> *v = &s->view;
    card_layout_copy(l, &v->tiles, t->tile, t->count);
    card_layout_copy(l, &v->list, t->list, t->count);
    card_layout_copy(l, &v->pull, (const uint4 *)t->pull, t->listed);
    card_layout_copy(l, &v->node_info, t->node_info, t->nodes);
    card_layout_copy(l, &v->order, t->order, t->nodes);
    card_layout_copy(l, &v->cell, t->cell, t->cells);
    card_layout_copy(l, &v->halo_node, t->halo_node, t->halos);
    card_layout_copy(l, &v->halo_place, t->halo_place, t->halos);
    card_layout_copy(l, &v->fibre, t->fibre, 3 * t->directions);
    card_layout_copy(l, &v->share, t->share, t->cells);
    card_layout_copy(l, &v->mixed, t->mixed, t->cells);
    card_layout_copy(l, &v->mixture, t->mixed ? numbers->mixture : NULL, p->laws);
    card_layout_copy(l, &v->mixfibre, t->mixfibre, 3 * t->directions);
    card_layout_copy(l, &v->fibres, numbers->fibres, p->volumes);
    card_layout_copy(l, &s->fibres, numbers->fibres_looked_at, p->volumes);
    card_layout_copy(l, &v->family, numbers->family, 3 * FIBRE_FAMILIES * t->directions);
    card_layout_copy(l, &v->mixfamily, numbers->mixfamily, 3 * FIBRE_FAMILIES * t->directions);
    card_layout_copy(l, &v->cut, t->cut, t->cells);
    card_layout_copy(l, &v->moments, p->cut.of, CUT_MOMENTS * p->cut.count);
    card_layout_copy(l, &v->weight, numbers->weight, t->nodes);
    v->directions = t->directions;
    const sliding *bones = bones_of(p);
    if (bones) {
        s->sliders.ground = bones->ground;
        card_layout_copy(l, &s->sliders.ground.field, bones->field, bones->fields);
        card_layout_copy(l, &s->sliders.ground.value, bones->ground.value, sliding_samples(bones));
    }
    if (p->sliding) {
        s->sliders.count = (int32_t)p->sliding->count;
        card_layout_copy(l, &s->sliders.slider, numbers->slider, p->sliding->count);
    }
    if (p->collider) {
        card_layout_copy(l, &s->position, numbers->position, 3 * p->nodes);
        card_layout_copy(l, &s->plane, p->collider->shape.plane, 4 * (int64_t)p->collider->shape.planes);
    }
    card_layout_add(l, &v->extra, s->extras);
    card_layout_add(l, &v->force_curve, s->forces);
    card_layout_add(l, &v->force_spring, s->forces);
    card_layout_add(l, &v->force_share, s->forces);
    card_layout_copy(l, &v->kind, numbers->kind, p->volumes);
    card_layout_copy(l, &v->law, numbers->law, law_numbers(p) * p->volumes);
}

/* The state, and what a step or a look at it needs. */
static void list_state(cuda_state *s, const cuda_numbers *numbers, card_layout *l)
{
    card_layout_add(l, &s->field[TLED_DISPLACEMENT], s->numbers);
    card_layout_add(l, &s->spare, s->numbers);
    card_layout_add(l, &s->field[TLED_VELOCITY], s->numbers);
    s->method->list(s, numbers, l);
    card_layout_add(l, &s->saved, saved_numbers_of_all(s));
    for (int i = CUDA_STEPPED; i < s->p->fields.count; i++)
        card_layout_add(l, &s->field[i], layout_of(s, i).numbers);
    for (int i = 0; i < TABLES; i++)
        card_layout_add(l, &s->table[i], TABLE_ROWS * 3 * s->curves);
    card_layout_add(l, &s->look_parts, (int64_t)cuda_look_bytes(s->tiles.count));
    card_layout_add(l, &s->sums, 1);
}

static int make_events(cuda_state *s, err *e)
{
    const size_t row = 3 * (size_t)(s->curves ? s->curves : 1) * sizeof(double);
    if (CUDA_TRY(cudaStreamCreateWithFlags(&s->stream, cudaStreamNonBlocking)) ||
        CUDA_TRY(cudaStreamCreateWithFlags(&s->sending, cudaStreamNonBlocking)) ||
        CUDA_TRY(cudaStreamCreateWithPriority(&s->beside, cudaStreamNonBlocking, FIRST_OF_ALL)) ||
        CUDA_TRY(cudaEventCreateWithFlags(&s->before_beside, cudaEventDisableTiming)) ||
        CUDA_TRY(cudaEventCreateWithFlags(&s->after_beside, cudaEventDisableTiming)) ||
        CUDA_TRY(cudaEventCreateWithFlags(&s->frame_free, cudaEventDisableTiming)) ||
        CUDA_TRY(cudaEventCreateWithFlags(&s->frame_ready, cudaEventDisableTiming)) ||
        !(s->sums_host = (tled_sums *)card_host_take((int64_t)sizeof *s->sums_host, e)) ||
        !(s->staging = (real *)card_host_take(largest_field(s) * (int64_t)sizeof(real), e)))
        return -1;
    for (int i = 0; i < TABLES; i++)
        if (!(s->table_host[i] = (double *)card_host_take(TABLE_ROWS * (int64_t)row, e)) ||
            CUDA_TRY(cudaEventCreateWithFlags(&s->table_free[i], cudaEventDisableTiming)))
            return -1;
    return 0;
}

static void put_mixtures(const tled_problem *p, cuda_mixed *to)
{
    for (int64_t i = 0; p->mixed && i < p->elements; i++)
        if (p->mixed[i] >= 0) {
            const tled_law law = tled_law_of(p, i);
            cuda_mixed *m = &to[p->mixed[i]];
            memcpy(m->c, law.c, sizeof m->c);
            m->density = law.density, m->twists = law.twists;
            memcpy(m->hourglass, law.hourglass, sizeof m->hourglass);
            m->share = tled_mixture(p, i), m->mix = p->mix[i];
        }
}

/* Of a volume: numbers of the problem, rounded where they go to steps in single precision. */
template <class R> static cuda_fibres<R> fibres_of_volume(const tled_problem *p, int32_t i)
{
    static const fibre_numbers none = {};
    const tled_volume *v = &p->volume[i];
    const fibre_numbers *n = p->fibres.of ? &p->fibres.of[i] : &none;
    return {(R)n->k1,
            (R)n->k2,
            (R)n->kappa,
            (R)n->c,
            (R)n->bt,
            (R)(n->bfs - n->bt),
            (R)(n->bf + n->bt - 2 * n->bfs),
            (R)v->muscle[MUSCLE_LESS],
            (R)v->muscle[MUSCLE_PASSIVE],
            (R)v->muscle[MUSCLE_STIFFENING],
            (R)v->muscle[MUSCLE_STRAIGHT],
            (R)v->muscle[MUSCLE_SPRING],
            v->peak,
            v->optimum,
            v->muscle[MUSCLE_FASTEST],
            (int32_t)v->contract,
            fibre_numbers_families(n),
            n->c > 0,
            v->curved,
            v->serial};
}

/* The directions of families in a row of the tiles' fibres. */
static void put_families(const cuda_numbers *n, const cuda_state *s, int64_t row, int64_t element)
{
    fibre_local at[2];
    const int count = fibres_at(&s->p->fibres, element, at);
    for (int i = 0; i < count; i++) {
        real *to = at[i].is_second ? n->mixfamily : n->family;
        for (int k = 0; k < 3 * FIBRE_FAMILIES; k++)
            to[k * s->tiles.directions + row] = (real)at[i].family[k / 3][k % 3];
    }
}

/* Where families are at an angle to fibres: the others have these. */
static int make_families(cuda_numbers *n, const cuda_state *s, err *e)
{
    const tiles *t = &s->tiles;
    const size_t size = 3 * FIBRE_FAMILIES * sizeof(real);
    if (!fibres_angled(&s->p->fibres))
        return 0;
    n->family = (real *)mem_array(t->directions, size, "the solver", e);
    n->mixfamily = s->p->mix && n->family ? (real *)mem_array(t->directions, size, "the solver", e) : NULL;
    if (!n->family || (s->p->mix && !n->mixfamily))
        return -1;
    for (const tile *to = t->tile; to < t->tile + t->count; to++)
        for (int32_t k = 0; k < to->fibred; k++)
            put_families(n, s, to->direction + k, t->cell_element[to->cell + k]);
    return 0;
}

static int make_fibres(cuda_numbers *n, const cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    if (wants_of(p).elements == CUDA_USUAL)
        return 0;
    n->fibres = (cuda_fibres<real> *)mem_array(p->volumes, sizeof *n->fibres, "the solver", e);
    n->fibres_looked_at = (cuda_fibres<double> *)mem_array(p->volumes, sizeof *n->fibres_looked_at, "the solver", e);
    if (!n->fibres || !n->fibres_looked_at)
        return -1;
    for (int32_t i = 0; i < p->volumes; i++) {
        n->fibres[i] = fibres_of_volume<real>(p, i);
        n->fibres_looked_at[i] = fibres_of_volume<double>(p, i);
    }
    return make_families(n, s, e);
}

static int make_weight(cuda_numbers *n, const cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    if (!p->weight)
        return 0;
    n->weight = (real *)mem_array(p->nodes, sizeof *n->weight, "the solver", e);
    for (int64_t k = 0; n->weight && k < p->nodes; k++)
        n->weight[k] = (real)tled_weight_part(p, s->tiles.node[k]);
    return n->weight ? 0 : -1;
}

/* Where the model's nodes stand, the caller's to free. NULL with e filled. */
static int32_t *make_stand(const cuda_state *s, err *e)
{
    int32_t *stand = (int32_t *)mem_array(s->p->nodes, sizeof *stand, "the solver", e);
    for (int64_t k = 0; stand && k < s->p->nodes; k++)
        stand[s->tiles.node[k]] = (int32_t)k;
    return stand;
}

/* The caller's to free. NULL with e filled. */
static cuda_slider *make_sliders(const cuda_state *s, err *e)
{
    int32_t *stand = make_stand(s, e);
    cuda_slider *made = stand ? slider_list(s->p, stand, e) : NULL;
    free(stand);
    return made;
}

/* The march's special cells, rounded where they go to steps in single precision. */
static int make_march_cells(cuda_numbers *n, const march *m, err *e)
{
    n->march_cell = (cuda_march_cell<real> *)mem_array(m->cells, sizeof *n->march_cell, "the march", e);
    for (int64_t i = 0; n->march_cell && i < m->cells; i++) {
        const march_cell *c = &m->cell[i];
        n->march_cell[i] = {(real)c->mu,
                            (real)c->bulk,
                            (real)c->second,
                            (real)c->peak,
                            {c->muscle[0], c->muscle[1]},
                            (real)c->second_peak,
                            {(real)c->more[0], (real)c->more[1], (real)c->more[2]},
                            {(real)c->family[0], (real)c->family[1], (real)c->family[2], (real)c->family[3]}};
    }
    return n->march_cell ? 0 : -1;
}

static int make_numbers(cuda_numbers *n, const cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    const int coefficients = form_numbers(p->form), numbers = law_numbers(p);
    n->mass_inverse = (real *)mem_array(p->nodes, sizeof *n->mass_inverse, "the solver", e);
    n->law = (real *)mem_array(p->volumes, (size_t)numbers * sizeof *n->law, "the solver", e);
    n->kind = (cuda_kind *)mem_array(p->volumes, sizeof *n->kind, "the solver", e);
    n->mixture = (cuda_mixed *)mem_array(p->laws, sizeof *n->mixture, "the solver", e);
    if (!n->mass_inverse || !n->law || !n->kind || !n->mixture)
        return -1;
    for (int64_t k = 0; k < p->nodes; k++)
        n->mass_inverse[k] = (real)(1 / p->mass[s->tiles.node[k]]);
    if (make_weight(n, s, e) || make_march_cells(n, &s->march, e))
        return -1;
    for (int32_t i = 0; i < p->volumes; i++) {
        const tled_volume *v = &p->volume[i];
        real *law = n->law + (int64_t)numbers * i;
        cuda_kind *kind = &n->kind[i];
        memcpy(kind->c, v->law.c, sizeof kind->c);
        memcpy(kind->hourglass, v->law.hourglass, sizeof kind->hourglass);
        kind->density = v->law.density, kind->twists = v->law.twists;
        kind->peak = v->peak, kind->contract = (int32_t)v->contract;
        for (int k = 0; k < coefficients; k++)
            law[k] = (real)v->law.c[k];
        for (int k = coefficients; k < numbers; k++)
            law[k] = (real)v->law.hourglass[k - coefficients];
    }
    put_mixtures(p, n->mixture);
    if ((p->sliding && !(n->slider = make_sliders(s, e))) ||
        (p->collider && !(n->position = press_positions(p, s->tiles.node, e))))
        return -1;
    return make_fibres(n, s, e);
}

static int put_array(cuda_state *s, const void *to, const void *from, int64_t bytes, err *e)
{
    return bytes ? CUDA_TRY(cudaMemcpy((void *)(uintptr_t)to, from, (size_t)bytes, cudaMemcpyHostToDevice)) : 0;
}

/* What the script does to nodes. */
static int put_script(cuda_state *s, err *e)
{
    const tled_problem *p = s->p;
    const cuda_view<real> *v = &s->view;
    const int64_t forces = p->force_start[p->nodes];
    s->view.extras = (int32_t)s->tiles.extras;
    s->view.gravity = (int32_t)p->gravity;
    return put_array(s, v->extra, s->tiles.extra, s->tiles.extras * (int64_t)sizeof *v->extra, e) ||
                   put_array(s, v->force_curve, p->force_curve, forces * (int64_t)sizeof *v->force_curve, e) ||
                   put_array(s, v->force_spring, p->force_spring, forces * (int64_t)sizeof *v->force_spring, e) ||
                   put_array(s, v->force_share, p->force_share, forces * (int64_t)sizeof *v->force_share, e)
               ? -1
               : 0;
}

/* Takes the card's memory and puts the problem there. */
static int put_problem(cuda_state *s, err *e)
{
    char what[80];
    int result = -1;
    cuda_numbers numbers = {0};
    card_layout layout = {0};
    if (make_numbers(&numbers, s, e))
        goto out;
    list_problem(s, &numbers, &layout);
    list_state(s, &numbers, &layout);
    s->bytes = layout.bytes;
    snprintf(what, sizeof what, "the solver of %lld elements", (long long)s->p->elements);
    result = card_layout_place(&layout, false, what, &s->memory, e) || put_script(s, e) ? -1 : 0;
    s->view.contractile = s->field[TLED_CONTRACTILE];
    s->view.mixcontractile = s->field[TLED_MIXCONTRACTILE];
out:
    free(numbers.mass_inverse);
    free(numbers.weight);
    free(numbers.law);
    free(numbers.kind);
    free(numbers.mixture);
    free(numbers.fibres);
    free(numbers.fibres_looked_at);
    free(numbers.family);
    free(numbers.mixfamily);
    free(numbers.slider);
    free(numbers.position);
    free(numbers.march_cell);
    return result;
}

/* Skin that touches itself, if any does. */
static int put_skin(cuda_state *s, err *e)
{
    if (!s->p->self_contact)
        return 0;
    int32_t *stand = make_stand(s, e);
    s->skin_bytes = stand ? skin_make(&s->skin, s->p, stand, &s->sliders.ground, &s->skin_memory, e) : -1;
    free(stand);
    s->skin_blocks = skin_blocks(s->p->self_contact);
    return s->skin_bytes < 0 ? -1 : 0;
}

/* Marks the model's nodes that slide, or that skin moves. */
static void mark_late(const tled_problem *p, uint8_t *is)
{
    const self_contact *skin = p->self_contact;
    const sliding *slides = p->sliding;
    for (int64_t i = 0; skin && i < skin->nodes; i++)
        is[skin->node[i]] = 1;
    for (int64_t i = 0; slides && i < slides->count; i++)
        is[slides->node[i]] = 1;
}

/* Puts tiles that have such nodes behind all others, which need not wait for them. */
static int part_tiles(cuda_state *s, err *e)
{
    if (!s->method->parts)
        return 0;
    uint8_t *late = (uint8_t *)mem_array(s->p->nodes, sizeof *late, "the solver", e);
    if (late)
        mark_late(s->p, late);
    const int64_t last = late ? tiles_part(&s->tiles, late, e) : -1;
    free(late);
    s->late_tiles = last < s->tiles.count ? last : 0;
    return last < 0 ? -1 : 0;
}

#endif
