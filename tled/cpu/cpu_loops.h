/* The CPU executors, for boxes of a lattice in rows and for meshes of any hexahedra: memory around cpu_pass.h, and the
 * passes in their order. Compiled twice, by cpu_double.c and cpu_single.c, which choose the precision and name the
 * tables of functions. All else that is here is static.
 *
 * Of `count` steps, the first pass begins one, each after it ends one and begins the next, the last ends one and leaves
 * the internal forces where displacements go else. A pass is a loop over slabs, one a thread; no sum depends on how
 * they are cut: the same bytes for any number of threads, and in any of the processor's instruction sets.
 */
#include "base/mem.h"
#include "tled/contact/self_contact.h"
#include "tled/contact/sliding.h"
#include "tled/cpu/cpu_pass.h"
#include "tled/problem/collider.h"
#include "tled/problem/conforming.h"
#include "tled/problem/films.h"
#include "tled/problem/followers.h"

#include <stdlib.h>
#include <string.h>

enum { CONTACT_CHUNK = 4096, FOLLOWERS_CHUNK = 512 };

#ifdef ELEMENT_SINGLE
typedef float number;
#else
typedef double number;
#endif

typedef struct tled_state cpu_state;

/* How one of the executors goes over elements and nodes. */
typedef struct cpu_method {
    /* Where nodes and elements lie, into s->rows, and what it has of its own. -1 with e filled. */
    int (*make)(cpu_state *s, err *e);
    void (*pass)(cpu_state *s);
} cpu_method;

struct tled_state {
    const tled_problem *p;
    pool *threads;
    const cpu_method *method;
    const cpu_pass *pass;
    rows rows;
    double *kind;                     /* cpu_work's */
    number *field[FIELDS_MOST];       /* of the problem's table: a column after the other (layout_of) */
    number *spare;                    /* 3 x rows.nodes, as displacements are */
    number *sum;                      /* likewise: zeros between passes */
    number *mass_inverse;             /* rows.nodes */
    uint8_t *flags;                   /* rows.nodes: NODE_* */
    number *fibre, *fraction;         /* cells, with padding: 3 x and 1 x; or NULL */
    number *cut, *weight;             /* cpu_work's (cpu_cut.h) */
    number *border;                   /* likewise (cpu_border.h) */
    number *mixfibre, *mixture, *law; /* likewise; law: a law's numbers x */
    number *family, *mixfamily;       /* likewise, of families at an angle to the fibre: 6 x */
    number *force;                    /* cpu_work's; of boxes from the first whole line of the cache on (seats_at) */
    number *shape;                    /* a mesh's: cpu_work's, as is: */
    int32_t *group_node;
    int64_t mesh_bytes; /* of these, and of a mesh's forces */
    number *saved;      /* all fields, one after the other; made when first wanted, as are, of the fields of frames: */
    number *slot[TLED_SLOTS];
    bool spare_is_internal;
    double time;               /* where the state stands */
    double *past, *now, *next; /* the curves' values: a step before now, now, and at the step's end */
    followers_work followers;
    films_work films;
    self_contact_work *skin; /* NULL: no skin touches itself */
    cpu_work work;
};

#include "tled/cpu/cpu_boxes.h"
#include "tled/cpu/cpu_mesh.h"

static void followers_in(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    const followers_work *w = &s->followers;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        for (int a = 0; a < 3; a++)
            w->moved[3 * i + a] = (double)s->field[TLED_DISPLACEMENT][a * s->rows.nodes + s->rows.place[w->f->node[i]]];
}

static void followers_out(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        double push[3];
        followers_pull(&s->followers, i, push);
        for (int a = 0; a < 3; a++)
            s->sum[a * s->rows.nodes + s->rows.place[s->followers.f->node[i]]] -= (number)push[a];
    }
}

/* What pressures push with, beside contact. */
static void press_followers(cpu_state *s)
{
    pool_run(s->threads, s->p->followers->nodes, FOLLOWERS_CHUNK, followers_in, s);
    followers_press(&s->followers, s->threads, s->now);
    pool_run(s->threads, s->p->followers->nodes, FOLLOWERS_CHUNK, followers_out, s);
}

#include "tled/cpu/cpu_contact.h"
#include "tled/cpu/cpu_films.h"
#include "tled/cpu/cpu_self_contact.h"
#include "tled/cpu/cpu_sliding.h"

/* One pass at the displacements of now, with the curves' values of now and of the step's end. */
static void run_pass(cpu_state *s, const tled_plan *plan, double time, int what)
{
    cpu_work *w = &s->work;
    const int numbers = cpu_kind_numbers(s->p->form);
    for (int32_t i = 0; i < s->p->volumes; i++)
        s->kind[numbers * i + numbers - 1] = (double)(number)tled_tension(s->p, i, s->now);
    for (int a = 0; a < 3; a++) {
        w->from[a] = s->field[TLED_DISPLACEMENT] + a * s->rows.nodes;
        w->to[a] = s->spare + a * s->rows.nodes;
    }
    w->now = s->now;
    w->next = s->next;
    w->dt = 1 / plan->rate;
    w->damping = plan->damping;
    w->what = what;
    if (s->p->collider && !s->p->collider->is_away) {
        cpu_contact contact = {s, collider_at(s->p->collider, time), collider_up(s->p->collider, time)};
        pool_run(s->threads, s->p->nodes, CONTACT_CHUNK, contact_work, &contact);
    }
    if (s->p->followers)
        press_followers(s);
    if (s->p->films)
        strain_films(s);
    s->method->pass(s);
    if (s->p->sliding)
        move_sliding(s);
    if (s->skin && what & PASS_BEGIN)
        touch_skin(s);
    s->spare_is_internal = (what & PASS_INTERNAL) != 0;
    if (what & PASS_BEGIN) {
        number *swap = s->field[TLED_DISPLACEMENT];
        s->field[TLED_DISPLACEMENT] = s->spare;
        s->spare = swap;
    }
}

static int cpu_step(cpu_state *s, const tled_plan *plan, int64_t count, err *e)
{
    (void)e;
    if (count < 1)
        return 0;
    tled_curves(s->p, tled_time(plan, 0), s->now);
    for (int64_t i = 0; i <= count; i++) {
        if (i < count)
            tled_curves(s->p, tled_time(plan, i + 1), s->next);
        run_pass(s, plan, tled_time(plan, i), (i > 0 ? PASS_FINISH : 0) | (i < count ? PASS_BEGIN : PASS_INTERNAL));
        if (i < count) {
            double *swap = s->past;
            s->past = s->now;
            s->now = s->next;
            s->next = swap;
        }
    }
    s->time = tled_time(plan, count);
    return 0;
}

/* ---- in and out */

/* How the numbers of a field lie: `stride` from a column to the next; number `at` of a column belongs to row `row` of
 * the model, where an array that is NULL counts. */
typedef struct cpu_layout {
    int columns;
    int64_t count, stride;
    const int32_t *row, *at;
} cpu_layout;

static cpu_layout layout_of(const cpu_state *s, int i)
{
    const field *f = &s->p->fields.field[i];
    const rows *r = &s->rows;
    if (f->axis == FIELD_ELEMENT)
        return (cpu_layout){f->columns, r->cells, r->cells + ROWS_PAD, r->cell_element, NULL};
    return (cpu_layout){f->columns, s->p->nodes, r->nodes, NULL, r->place};
}

/* How many numbers the fields of some places take here. */
static int64_t numbers_of(const cpu_state *s, int where)
{
    int64_t numbers = 0;
    for (int i = 0; i < s->p->fields.count; i++) {
        const cpu_layout l = layout_of(s, i);
        numbers += fields_is_in(&s->p->fields, i, where) ? l.columns * l.stride : 0;
    }
    return numbers;
}

/* `columns` are the layout's: a constant where the compiler is to unroll them. */
static inline void put_rows_out(cpu_layout l, int columns, const number *from, double *to)
{
    for (int64_t k = 0; k < l.count; k++) {
        const int64_t row = l.row ? l.row[k] : k, at = l.at ? l.at[k] : k;
        for (int a = 0; a < columns; a++)
            to[columns * row + a] = from[a * l.stride + at];
    }
}

static inline void put_rows_in(cpu_layout l, int columns, const double *from, number *to)
{
    for (int64_t k = 0; k < l.count; k++) {
        const int64_t row = l.row ? l.row[k] : k, at = l.at ? l.at[k] : k;
        for (int a = 0; a < columns; a++)
            to[a * l.stride + at] = (number)from[columns * row + a];
    }
}

static void put_out(cpu_layout l, const number *from, double *to)
{
    if (l.columns == 3)
        put_rows_out(l, 3, from, to);
    else
        put_rows_out(l, l.columns, from, to);
}

static void put_in(cpu_layout l, const double *from, number *to)
{
    if (l.columns == 3)
        put_rows_in(l, 3, from, to);
    else
        put_rows_in(l, l.columns, from, to);
}

static int cpu_get(cpu_state *s, int what, double *to, err *e)
{
    (void)e;
    if (what == TLED_INTERNAL && !s->spare_is_internal) {
        const tled_plan here = {.rate = 1};
        tled_curves(s->p, s->time, s->now);
        run_pass(s, &here, s->time, PASS_INTERNAL);
    }
    if (what == TLED_INTERNAL)
        put_out(layout_of(s, TLED_DISPLACEMENT), s->spare, to);
    else
        put_out(layout_of(s, what), s->field[what], to);
    return 0;
}

/* The fields of some places, one after the other. */
static int copy_out(const cpu_state *s, int where, number **to, err *e)
{
    if (!*to)
        *to = mem_array(numbers_of(s, where), sizeof **to, "the solver", e);
    number *at = *to;
    for (int i = 0; at && i < s->p->fields.count; i++) {
        const cpu_layout l = layout_of(s, i);
        if (!fields_is_in(&s->p->fields, i, where))
            continue;
        memcpy(at, s->field[i], (size_t)(l.columns * l.stride) * sizeof *at);
        at += l.columns * l.stride;
    }
    return *to ? 0 : -1;
}

#include "tled/cpu/cpu_saved.h"

static int cpu_snapshot(cpu_state *s, int slot, err *e)
{
    return copy_out(s, FIELD_IN_FRAMES, &s->slot[slot], e);
}

static int cpu_fetch(cpu_state *s, int slot, const field_values *to, err *e)
{
    const number *at = s->slot[slot];
    (void)e;
    for (int i = 0; i < s->p->fields.count; i++) {
        const cpu_layout l = layout_of(s, i);
        if (!fields_is_in(&s->p->fields, i, FIELD_IN_FRAMES))
            continue;
        put_out(l, at, to->of[i]);
        at += l.columns * l.stride;
    }
    return 0;
}

static int make_numbers(number **to, int64_t count, int columns, err *e)
{
    *to = mem_array(count, (size_t)columns * sizeof **to, "the solver", e);
    return *to ? 0 : -1;
}

#include "tled/cpu/cpu_border.h"
#include "tled/cpu/cpu_cut.h"

static int64_t cpu_bytes(const cpu_state *s)
{
    const rows *r = &s->rows;
    int64_t numbers = numbers_of(s, FIELDS_ALL) * (s->saved ? 2 : 1),
            cells = (s->fibre ? 3 : 0) + (s->fraction ? 1 : 0);
    cells += (s->family ? 6 : 0) + (s->mixfamily ? 6 : 0);
    cells += (s->mixfibre ? 3 : 0) + (s->mixture ? 1 + cpu_law_numbers(s->p->form) : 0);
    for (int i = 0; i < TLED_SLOTS; i++)
        numbers += s->slot[i] ? numbers_of(s, FIELD_IN_FRAMES) : 0;
    return numbers * (int64_t)sizeof(number) + r->nodes * (7 * (int64_t)sizeof(number) + 1 + 4) + boxes_bytes(s) +
           r->cells * (cells * (int64_t)sizeof(number) + 4) + s->mesh_bytes + cut_bytes(s) + border_bytes(s) +
           followers_bytes(s->p->followers) + films_bytes(s->p->films) + self_contact_bytes(s->skin);
}

/* ---- life */

static void cpu_destroy(cpu_state *s)
{
    if (!s)
        return;
    rows_free(&s->rows);
    free(s->kind);
    for (int i = 0; i < FIELDS_MOST; i++)
        free(s->field[i]);
    free(s->spare);
    free(s->sum);
    free(s->mass_inverse);
    free(s->flags);
    free(s->fibre);
    free(s->fraction);
    free(s->cut);
    free(s->border);
    free(s->weight);
    free(s->mixfibre);
    free(s->family);
    free(s->mixfamily);
    free(s->mixture);
    free(s->law);
    free(s->shape);
    free(s->force);
    free(s->group_node);
    free(s->saved);
    for (int i = 0; i < TLED_SLOTS; i++)
        free(s->slot[i]);
    free(s->past);
    free(s->now);
    free(s->next);
    followers_room_free(&s->followers);
    films_room_free(&s->films);
    self_contact_room_free(s->skin);
    free(s);
}

/* Those arrays over cells that the problem has. */
static int allocate_cells(cpu_state *s, err *e)
{
    const tled_problem *p = s->p;
    const int64_t cells = s->rows.cells + ROWS_PAD;
    const int directions = 3 * FIBRE_FAMILIES;
    const bool angled = fibres_angled(&p->fibres);
    return (angled && make_numbers(&s->family, cells, directions, e)) ||
                   (angled && p->mix && make_numbers(&s->mixfamily, cells, directions, e)) ||
                   (p->fibre && make_numbers(&s->fibre, cells, 3, e)) ||
                   (p->fraction && make_numbers(&s->fraction, cells, 1, e)) ||
                   (p->mix && make_numbers(&s->mixture, cells, 1, e)) ||
                   (p->mix && make_numbers(&s->law, cells, cpu_law_numbers(p->form), e)) ||
                   (p->mixfibre && make_numbers(&s->mixfibre, cells, 3, e))
               ? -1
               : 0;
}

static int allocate_fields(cpu_state *s, err *e)
{
    for (int i = 0; i < s->p->fields.count; i++) {
        const cpu_layout l = layout_of(s, i);
        if (make_numbers(&s->field[i], l.stride, l.columns, e))
            return -1;
    }
    return 0;
}

/* What of the script has room of its own. */
static int allocate_script(cpu_state *s, err *e)
{
    const int64_t curves = s->p->script->curves;
    s->now = mem_array(curves, 3 * sizeof *s->now, "the solver", e);
    s->next = mem_array(curves, 3 * sizeof *s->next, "the solver", e);
    s->past = mem_array(curves, 3 * sizeof *s->past, "the solver", e);
    return s->now && s->next && s->past ? followers_room(&s->followers, s->p->followers, e) : -1;
}

static int allocate(cpu_state *s, err *e)
{
    const int64_t nodes = s->rows.nodes;
    if (allocate_fields(s, e) || make_numbers(&s->spare, nodes, 3, e) || make_numbers(&s->sum, nodes, 3, e) ||
        make_numbers(&s->mass_inverse, nodes, 1, e) || allocate_cells(s, e) || cut_allocate(s, e) ||
        border_allocate(s, e) || films_room(&s->films, s->p, e) ||
        (s->p->self_contact && !(s->skin = self_contact_room(s->p, e))))
        return -1;
    s->kind = mem_array(s->p->volumes, (size_t)cpu_kind_numbers(s->p->form) * sizeof *s->kind, "the solver", e);
    s->flags = mem_array(nodes, 1, "the solver", e);
    return s->kind && s->flags ? allocate_script(s, e) : -1;
}

static void fill_flags(cpu_state *s)
{
    const tled_problem *p = s->p;
    memset(s->flags, 0, (size_t)s->rows.nodes);
    for (int64_t n = 0; n < p->nodes; n++)
        for (int a = 0; a < 3; a++)
            s->flags[s->rows.place[n]] |= (uint8_t)((p->hold[3 * n + a] == HOLD_FREE) * (NODE_FREE << a));
    for (int32_t i = 0; i < s->rows.extras; i++)
        s->flags[s->rows.extra[i]] |= NODE_EXTRA;
    for (int64_t i = 0; p->sliding && i < p->sliding->count; i++)
        s->flags[s->rows.place[p->sliding->node[i]]] |= NODE_EXTRA; /* which the pass leaves, as none is listed */
}

static void fill_nodes(cpu_state *s)
{
    const tled_problem *p = s->p;
    for (int64_t n = 0; n < p->nodes; n++)
        s->mass_inverse[s->rows.place[n]] = (number)(1 / p->mass[n]);
    fill_flags(s);
    for (int i = 0; i < p->fields.count; i++)
        put_in(layout_of(s, i), p->at_start.of[i], s->field[i]);
}

#include "tled/cpu/cpu_families.h"

static void fill_cells(cpu_state *s)
{
    const tled_problem *p = s->p;
    const int64_t cells = s->rows.cells + ROWS_PAD;
    for (int64_t i = 0; i < s->rows.cells; i++) {
        const int64_t element = s->rows.cell_element[i];
        for (int a = 0; s->fibre && a < 3; a++)
            s->fibre[a * cells + i] = (number)p->fibre[3 * element + a];
        for (int a = 0; s->mixfibre && a < 3; a++)
            s->mixfibre[a * cells + i] = (number)p->mixfibre[3 * element + a];
        fill_families(s, i);
        if (s->fraction)
            s->fraction[i] = (number)p->fraction[element];
        if (s->mixture) {
            const tled_law law = tled_law_of(p, element);
            s->mixture[i] = (number)tled_mixture(p, element);
            for (int k = 0; k < form_numbers(p->form); k++)
                s->law[k * cells + i] = (number)law.c[k];
            for (int k = 0; k < HOURGLASS_NUMBERS; k++)
                s->law[(form_numbers(p->form) + k) * cells + i] = (number)law.hourglass[k];
        }
    }
    for (int32_t i = 0; i < p->volumes; i++) {
        double *kind = s->kind + cpu_kind_numbers(p->form) * i;
        memcpy(kind, p->volume[i].law.c, (size_t)form_numbers(p->form) * sizeof *kind);
        memcpy(kind + form_numbers(p->form), p->volume[i].law.hourglass, sizeof p->volume[i].law.hourglass);
    }
}

static void make_work(cpu_state *s)
{
    cpu_work *w = &s->work;
    w->r = &s->rows;
    w->p = s->p;
    w->kind = s->kind;
    w->mass_inverse = s->mass_inverse;
    w->flags = s->flags;
    w->fraction = s->fraction;
    w->cut = s->cut;
    w->border = s->border;
    w->weight = s->weight;
    w->mixture = s->mixture;
    w->shape = s->shape;
    w->group_node = s->group_node;
    w->force = s->rows.seats ? seats_at(s) : s->force;
    for (int a = 0; a < 3; a++) {
        w->velocity[a] = s->field[TLED_VELOCITY] + a * s->rows.nodes;
        w->sum[a] = s->sum + a * s->rows.nodes;
        w->fibre[a] = s->fibre ? s->fibre + a * (s->rows.cells + ROWS_PAD) : NULL;
        w->mixfibre[a] = s->mixfibre ? s->mixfibre + a * (s->rows.cells + ROWS_PAD) : NULL;
    }
    find_families(s);
    w->contractile = s->field[TLED_CONTRACTILE];
    w->mixcontractile = s->field[TLED_MIXCONTRACTILE];
    for (int k = 0; k < cpu_law_numbers(s->p->form); k++)
        w->law[k] = s->law ? s->law + k * (s->rows.cells + ROWS_PAD) : NULL;
}

static int cpu_reload(cpu_state *s, err *e)
{
    free(s->past);
    free(s->now);
    free(s->next);
    followers_room_free(&s->followers);
    s->spare_is_internal = false;
    if (allocate_script(s, e) || rows_list_extras(&s->rows, s->p, e))
        return -1;
    fill_flags(s);
    return 0;
}

static cpu_state *create_by(const cpu_method *method, const tled_problem *problem, pool *threads, err *e)
{
    cpu_state *s = mem_array(1, sizeof *s, "the solver", e);
    if (!s)
        return NULL;
    s->p = problem;
    s->threads = threads;
    s->method = method;
    s->pass = cpu_pass_choose(CPU_PASSES, s->p->form, e);
    s->time = s->p->start;
    if (!s->pass || method->make(s, e) || allocate(s, e)) {
        cpu_destroy(s);
        return NULL;
    }
    fill_nodes(s);
    fill_cells(s);
    cut_fill(s);
    border_fill(s);
    make_work(s);
    return s;
}

static cpu_state *boxes_create(const tled_problem *problem, pool *threads, err *e)
{
    static const cpu_method by_boxes = {boxes_make, boxes_pass};
    return create_by(&by_boxes, problem, threads, e);
}

static cpu_state *mesh_create(const tled_problem *problem, pool *threads, err *e)
{
    static const cpu_method by_mesh = {mesh_make, mesh_pass};
    return create_by(&by_mesh, problem, threads, e);
}

static const char *cpu_unusable(void)
{
    return NULL;
}

static int64_t cpu_computed(const cpu_state *s)
{
    return s->rows.cells;
}

static int cpu_crowded(cpu_state *s, int64_t *count, err *e)
{
    (void)e;
    *count = self_contact_crowded(s->skin);
    return 0;
}

/* What both have. */
#define CPU_FUNCTIONS                                                                                                  \
    .destroy = cpu_destroy, .step = cpu_step, .get = cpu_get, .save = cpu_save, .restore = cpu_restore,                \
    .put = cpu_put, .snapshot = cpu_snapshot, .fetch = cpu_fetch, .reload = cpu_reload, .bytes = cpu_bytes,            \
    .crowded = cpu_crowded, .computed = cpu_computed

enum { CPU_FEATURES = EXECUTOR_USUAL | EXECUTOR_CONTACT | EXECUTOR_FOLLOWERS };

const tled_executor CPU_EXECUTOR = {
    .is = {.device = "cpu",
           .features = CPU_FEATURES | EXECUTOR_BORDERS | EXECUTOR_FILMS | EXECUTOR_SLIDING | EXECUTOR_SELF_CONTACT,
           .forms = (1U << FORM_STEPPED) - 1,
           .unusable = cpu_unusable},
    .create = boxes_create,
    CPU_FUNCTIONS};

const tled_executor CPU_EXECUTOR_OF_MESHES = {.is = {.device = "cpu",
                                                     .features = EXECUTOR_MESHES | CPU_FEATURES,
                                                     .forms = (1U << FORM_STEPPED) - 1,
                                                     .unusable = cpu_unusable},
                                              .create = mesh_create,
                                              CPU_FUNCTIONS};
