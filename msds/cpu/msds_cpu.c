/* The state of a run, and which solver takes a frame: springs (lanes.h), conjugate gradients (cg.h), exactly
 * (exact.h). All share the displacement, in single precision and the slices' order; exact frames keep their own in
 * double while they follow each other.
 */
#include "msds/cpu/msds_cpu.h"

#include "base/mem.h"
#include "msds/cpu/cg.h"
#include "msds/cpu/exact.h"
#include "msds/cpu/exact_making.h"
#include "msds/cpu/grips.h"
#include "msds/cpu/tissue.h"
#include "msds/problem/newton.h"

#include <stdlib.h>
#include <string.h>

enum { FIELDS = 6, ROUNDS = 4 /* of an exact frame, each with the nodes that the last one pushed into the probe */ };

/* With friction, rounds of a frame of conjugate gradients, and iterations of each at least. */
enum { TURNS = 4, TURN = 3 };

/* An exact frame is in equilibrium to this share of its load; a node may be missed in the probe by this share of
 * its size. */
static const double exact_tolerance = 1e-6, missed = 1e-6;

typedef struct msds_state cpu_state;

/* What finite elements take; each is made when it is first wanted. The stiffness of warped elements changes with their
 * turns, so each solver has its own. */
typedef struct fem {
    stiffness k, exact_k;
    cg *cg;
    exact *exact;
    exact_making *making; /* of exact, by a thread */
} fem;

struct msds_state {
    const msds_problem *p;
    pool *threads;
    const lanes *loops;
    sell order;
    lanes_springs w;
    float *stiffness, *damper, *rest; /* slots x LANES: of w */
    float *inertia;                   /* nodes: 1 / kg, 0 where fixed */
    float *inverse;                   /* nodes: dt / inertia; of w */
    float *repulsion;                 /* nodes: of w */
    contacts contacts;
    grips grips;
    fem fem[2];     /* of linear elements, and of warped ones */
    tissue *tissue; /* made when it is first wanted */
    double *place;  /* the model's nodes x 3, m: where exact frames stand */
    msds_plan plan;
    bool precise; /* place is the state; else w.u */
    bool met;     /* as the reading's */
    int solves;
};

static void spread(const cpu_state *s, const double *from, lanes_field *to)
{
    for (int64_t n = 0; n < s->p->nodes; n++)
        for (int a = 0; a < 3; a++)
            to->x[a][s->order.own_node[n]] = (float)from[3 * n + a];
}

static void collect(const cpu_state *s, const lanes_field *from, double *to)
{
    for (int64_t n = 0; n < s->p->nodes; n++)
        for (int a = 0; a < 3; a++)
            to[3 * n + a] = (double)from->x[a][s->order.own_node[n]];
}

static int cpu_change(cpu_state *s, err *e)
{
    const msds_problem *p = s->p;
    (void)e;
    s->w.damping = p->options.damping;
    sell_springs(&s->order, p, s->stiffness, s->damper, s->rest);
    for (int64_t n = 0; n < p->nodes; n++) {
        int32_t own = s->order.own_node[n];
        s->repulsion[own] = (float)p->repulsion[n];
        s->inertia[own] = p->fixed[n] ? 0 : (float)(1 / (p->weight[n] * p->mass_factor));
        for (int a = 0; a < 3; a++)
            s->w.weight.x[a][own] = p->fixed[n] ? 0 : (float)(p->weight[n] * p->options.gravity[a]);
    }
    return 0;
}

static int allocate(cpu_state *s, err *e)
{
    const sell *o = &s->order;
    s->stiffness = mem_array(o->slots * LANES, sizeof *s->stiffness, "the solver", e);
    s->damper = mem_array(o->slots * LANES, sizeof *s->damper, "the solver", e);
    s->rest = mem_array(o->slots * LANES, sizeof *s->rest, "the solver", e);
    s->inertia = mem_array(o->nodes, sizeof *s->inertia, "the solver", e);
    s->inverse = mem_array(o->nodes, sizeof *s->inverse, "the solver", e);
    s->repulsion = mem_array(o->nodes, sizeof *s->repulsion, "the solver", e);
    s->place = mem_array(s->p->nodes, 3 * sizeof *s->place, "the solver", e);
    lanes_field *fields[FIELDS] = {&s->w.place, &s->w.u, &s->w.v, &s->w.next_u, &s->w.next_v, &s->w.weight};
    for (int i = 0; i < FIELDS; i++)
        if (lanes_field_make(fields[i], o->nodes, e))
            return -1;
    if (contacts_make(&s->contacts, o, s->p->nodes, e) || grips_make(&s->grips, s->p->nodes, e))
        return -1;
    return s->stiffness && s->damper && s->rest && s->inertia && s->inverse && s->repulsion && s->place ? 0 : -1;
}

/* But for what is being made, which does not depend on the state. */
static void fem_clear(fem *f)
{
    if (f->cg)
        cg_free(f->cg);
    if (f->exact)
        exact_free(f->exact);
    free(f->cg);
    free(f->exact);
    stiffness_free(&f->k);
    stiffness_free(&f->exact_k);
    *f = (fem){.making = f->making};
}

static void fem_free(fem *f)
{
    exact_making_free(f->making);
    f->making = NULL;
    fem_clear(f);
}

static void cpu_destroy(cpu_state *s)
{
    if (!s)
        return;
    for (int warped = 0; warped < 2; warped++)
        fem_free(&s->fem[warped]);
    if (s->tissue)
        tissue_free(s->tissue);
    free(s->tissue);
    contacts_free(&s->contacts);
    grips_free(&s->grips);
    lanes_field *fields[FIELDS] = {&s->w.place, &s->w.u, &s->w.v, &s->w.next_u, &s->w.next_v, &s->w.weight};
    for (int i = 0; i < FIELDS; i++)
        lanes_field_free(fields[i]);
    free(s->stiffness);
    free(s->damper);
    free(s->rest);
    free(s->inertia);
    free(s->inverse);
    free(s->repulsion);
    free(s->place);
    sell_free(&s->order);
    free(s);
}

static cpu_state *cpu_create(const msds_problem *problem, pool *threads, err *e)
{
    cpu_state *s = mem_array(1, sizeof *s, "the solver", e);
    if (!s)
        return NULL;
    s->p = problem;
    s->threads = threads;
    s->loops = lanes_choose(e);
    if (!s->loops || sell_make(&s->order, s->p, e) || allocate(s, e)) {
        cpu_destroy(s);
        return NULL;
    }
    s->w.s = &s->order;
    s->w.stiffness = s->stiffness;
    s->w.damper = s->damper;
    s->w.rest = s->rest;
    s->w.inverse = s->inverse;
    s->w.repulsion = s->repulsion;
    s->w.met = &s->met;
    cpu_change(s, e);
    spread(s, s->p->position, &s->w.place);
    spread(s, s->p->displacement, &s->w.u);
    spread(s, s->p->velocity, &s->w.v);
    memcpy(s->place, s->p->displacement, 3 * (size_t)s->p->nodes * sizeof *s->place);
    s->precise = true;
    return s;
}

static void place_probe(cpu_state *s, const msds_plan *plan)
{
    s->plan = *plan;
    s->w.touched = plan->touched;
    s->w.probe = &s->plan.probe;
    s->w.reach = (float)(plan->probe.reach * (1 + 1e-6));
    for (int a = 0; a < 3; a++)
        s->w.centre[a] = (float)plan->probe.centre[a];
}

static void spring_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    (void)chunk;
    s->loops->step(&s->w, from, to);
}

static void swap_fields(lanes_field *a, lanes_field *b)
{
    lanes_field spare = *a;
    *a = *b;
    *b = spare;
}

static void step_springs(cpu_state *s, int64_t count)
{
    s->w.dt = (float)s->plan.dt;
    for (int64_t i = 0; i < s->order.nodes; i++)
        s->inverse[i] = s->w.dt * s->inertia[i];
    for (int64_t i = 0; i < count; i++) {
        pool_run(s->threads, s->order.count, SELL_CHUNK, spring_work, s);
        swap_fields(&s->w.u, &s->w.next_u);
        swap_fields(&s->w.v, &s->w.next_v);
    }
}

/* How fast a contact's node leaves the probe: m/s. */
static double leaving(const cpu_state *s, const contact *c)
{
    const int32_t own = s->order.own_node[c->node];
    double speed = 0;
    for (int a = 0; a < 3; a++)
        speed += c->way[a] * (double)s->w.v.x[a][own];
    return speed;
}

/* The contacts where springs stand now, and what the next step would push them with: spring and damper, that do
 * not pull. */
static void note_repulsion(cpu_state *s)
{
    s->contacts.count = 0;
    if (s->plan.touched)
        contacts_find(&s->contacts, s->loops, &s->w, s->p, NULL, s->threads, CONTACTS_PRESSED);
    for (int64_t i = 0; i < s->contacts.count; i++) {
        contact *c = &s->contacts.list[i];
        const double pushed = s->p->repulsion[c->node] * (c->depth - s->p->options.damping * leaving(s, c));
        c->force = c->depth > 0 ? fmax(0, pushed) : 0;
    }
}

/* Of the plan that is being computed. */
static fem *fem_of(cpu_state *s)
{
    return &s->fem[s->plan.warp];
}

static int make_cg(cpu_state *s, bool warped, err *e)
{
    fem *f = &s->fem[warped];
    cg *made = mem_array(1, sizeof *made, "the solver", e);
    f->cg = made;
    return made && !stiffness_make(&f->k, s->p, warped, s->threads, e)
               ? cg_make(made, s->p, &s->order, &f->k, &s->contacts, s->loops, s->threads, &s->w.u, &s->w.weight, e)
               : -1;
}

/* 1: it is made; 0: not yet; -1. */
static int take_made(cpu_state *s, fem *f, bool wait, err *e)
{
    const int done = exact_making_look(f->making, wait, e);
    if (done > 0)
        f->exact = mem_array(1, sizeof *f->exact, "the solver", e);
    if (done > 0 && f->exact) {
        exact_making_take(f->making, &f->exact_k, f->exact, s->threads);
        f->making = NULL;
        return 1;
    }
    if (!done)
        return 0;
    exact_making_free(f->making);
    f->making = NULL;
    return -1;
}

static int make_exact(cpu_state *s, err *e)
{
    fem *f = fem_of(s);
    if (f->making)
        return take_made(s, f, true, e) > 0 ? 0 : -1;
    f->exact = mem_array(1, sizeof *f->exact, "the solver", e);
    if (!f->exact)
        return -1;
    f->exact->listener = s->plan.listener;
    return stiffness_make(&f->exact_k, s->p, s->plan.warp, s->threads, e)
               ? -1
               : exact_make(f->exact, s->p, &f->exact_k, &s->contacts, s->loops, s->threads, e);
}

static void find_contacts(cpu_state *s, const double *u, contacts_rule rule)
{
    s->contacts.count = 0;
    if (s->plan.touched)
        contacts_find(&s->contacts, s->loops, &s->w, s->p, u, s->threads, rule);
    if (u || !s->plan.touched) /* exact frames slide */
        grips_clear(&s->grips);
    else
        grips_take(&s->grips, &s->contacts, s->p, &s->plan.probe);
}

/* Notes forces, and places held by friction, for the next step. */
static void hold_contacts(cpu_state *s)
{
    contacts_hold(&s->contacts, s->p);
    if (s->plan.touched && (s->plan.method == MSDS_FEM || s->plan.method == MSDS_TISSUE))
        grips_keep(&s->grips, &s->contacts, s->p, &s->w);
    else
        grips_clear(&s->grips);
}

/* In how many rounds so many iterations find which nodes slip. */
static int64_t turns_of(const cpu_state *s, int64_t count)
{
    if (!s->grips.count)
        return 1;
    return count < TURNS * TURN ? count / TURN : TURNS;
}

static int step_cg(cpu_state *s, int64_t count, err *e)
{
    double force[3];
    if (!fem_of(s)->cg && make_cg(s, s->plan.warp, e))
        return -1;
    cg *solver = fem_of(s)->cg;
    int64_t before = contacts_held(&s->contacts, s->p);
    find_contacts(s, NULL, CONTACTS_PRESSED);
    if (contacts_sum(&s->contacts, force) < before && count > 1) { /* let go of: tissue may come after the probe */
        cg_solve(solver, count / 2);
        contacts_hold(&s->contacts, s->p);
        find_contacts(s, NULL, CONTACTS_PRESSED);
        count -= count / 2;
    }
    for (int64_t turns = turns_of(s, count); turns > 1; turns--) {
        const int64_t now = count / turns;
        cg_solve(solver, now);
        contacts_hold(&s->contacts, s->p);
        find_contacts(s, NULL, CONTACTS_PRESSED);
        count -= now;
    }
    cg_solve(solver, count);
    return 0;
}

static int make_tissue(cpu_state *s, err *e)
{
    tissue *made = mem_array(1, sizeof *made, "the solver", e);
    s->tissue = made;
    return made ? tissue_make(made, s->p, &s->order, &s->contacts, s->loops, s->threads, &s->w.u, &s->w.weight, e) : -1;
}

static int step_tissue(cpu_state *s, int64_t count, err *e)
{
    if (!s->tissue && make_tissue(s, e))
        return -1;
    tissue_begin(s->tissue, s->plan.elapsed);
    while (count > 0) {
        find_contacts(s, NULL, s->p->options.penalty ? CONTACTS_PRESSED : CONTACTS_NEAR);
        count -= tissue_step(s->tissue, count);
        contacts_hold(&s->contacts, s->p);
        if (s->tissue->residual < NEWTON_TOLERANCE)
            break;
    }
    return 0;
}

static int step_exact(cpu_state *s, err *e)
{
    if (!fem_of(s)->exact && make_exact(s, e))
        return -1;
    exact *solver = fem_of(s)->exact;
    if (!s->precise)
        collect(s, &s->w.u, s->place);
    s->solves = 0;
    find_contacts(s, s->place, CONTACTS_NEAR);
    for (int turn = 0; turn < ROUNDS; turn++) {
        if (exact_solve(solver, s->place, turn == 0, exact_tolerance, s->plan.touched ? s->plan.probe.shape.size : 1,
                        e))
            return -1;
        s->solves += solver->solves;
        spread(s, s->place, &s->w.u);
        if (!s->plan.touched || turn == ROUNDS - 1 ||
            !contacts_missed(&s->contacts, s->loops, &s->w, s->p, s->place, s->threads,
                             missed * s->plan.probe.shape.size))
            break;
        find_contacts(s, s->place, CONTACTS_NEAR);
    }
    return 0;
}

static void clear_field(const cpu_state *s, lanes_field *f)
{
    memset(f->memory, 0, 3 * (size_t)(s->order.nodes + 2 * LANES) * sizeof *f->memory);
}

static int step_elements(cpu_state *s, int64_t count, err *e)
{
    if (s->plan.method == MSDS_FEM)
        return step_cg(s, count, e);
    return s->plan.method == MSDS_TISSUE ? step_tissue(s, count, e) : step_exact(s, e);
}

static int cpu_step(cpu_state *s, const msds_plan *plan, int64_t count, err *e)
{
    int result = 0;
    place_probe(s, plan);
    s->solves = 0;
    if (s->plan.method == MSDS_SPRINGS) {
        step_springs(s, count);
        note_repulsion(s);
    } else {
        result = step_elements(s, count, e);
        clear_field(s, &s->w.v);
    }
    s->precise = s->plan.method == MSDS_EXACT;
    hold_contacts(s);
    s->met = s->met || contacts_held(&s->contacts, s->p) > 0;
    return result;
}

/* Turns of elements begin with those of the frame before, so what has them is made again. */
static int cpu_reset(cpu_state *s, err *e)
{
    (void)e;
    clear_field(s, &s->w.u);
    clear_field(s, &s->w.v);
    memset(s->place, 0, 3 * (size_t)s->p->nodes * sizeof *s->place);
    memset(s->contacts.held, 0, (size_t)s->p->nodes * sizeof *s->contacts.held);
    s->contacts.count = 0;
    grips_clear(&s->grips);
    s->precise = true;
    s->solves = 0;
    fem_clear(&s->fem[true]);
    if (s->tissue)
        tissue_reset(s->tissue);
    return 0;
}

/* Conjugate gradients are what goes on meanwhile, so these are made at once. */
static int cpu_ready(cpu_state *s, const msds_plan *plan, err *e)
{
    fem *f = &s->fem[plan->warp];
    const int threads = pool_threads(s->threads) / 2;
    if (plan->method == MSDS_TISSUE && !s->tissue)
        return make_tissue(s, e) ? -1 : 1;
    if (plan->method != MSDS_EXACT || f->exact)
        return 1;
    if (!f->making)
        f->making = exact_making_start(s->p, plan->warp, &s->contacts, s->loops, threads > 1 ? threads : 1, e);
    if (!f->making || (!f->cg && make_cg(s, plan->warp, e)))
        return -1;
    return take_made(s, f, false, e);
}

static int cpu_get(cpu_state *s, int what, double *to, err *e)
{
    (void)e;
    if (what == MSDS_DISPLACEMENT && s->precise)
        memcpy(to, s->place, 3 * (size_t)s->p->nodes * sizeof *to);
    else
        collect(s, what == MSDS_DISPLACEMENT ? &s->w.u : &s->w.v, to);
    return 0;
}

static int cpu_monitor(cpu_state *s, msds_reading *reading, err *e)
{
    double square = 0;
    (void)e;
    *reading = (msds_reading){.residual = NAN, .solves = s->solves, .finite = true, .met = s->met, .inverted = -1};
    reading->contacts = contacts_sum(&s->contacts, reading->force);
    if (s->plan.touched)
        contacts_twist(&s->contacts, &s->w, s->p, s->precise ? s->place : NULL, reading->torque);
    const fem *f = fem_of(s);
    if (s->plan.method == MSDS_FEM && f->cg)
        reading->residual = f->cg->residual;
    if (s->plan.method == MSDS_EXACT && f->exact)
        reading->residual = f->exact->residual;
    if (s->plan.method == MSDS_TISSUE && s->tissue)
        reading->residual = s->tissue->residual;
    for (int64_t own = 0; own < s->order.nodes; own++) {
        double x = (double)s->w.u.x[0][own], y = (double)s->w.u.x[1][own], z = (double)s->w.u.x[2][own];
        double here = x * x + y * y + z * z;
        reading->finite = reading->finite && isfinite(here);
        square = here > square ? here : square;
    }
    reading->largest = sqrt(square);
    return 0;
}

/* Exact frames have a factor; the matrix is that of conjugate gradients. */
static int cpu_parts(cpu_state *s, msds_parts *to, err *e)
{
    const msds_method method = s->plan.method;
    const bool linear = method == MSDS_FEM || method == MSDS_EXACT;
    if (linear && !fem_of(s)->cg && make_cg(s, s->plan.warp, e))
        return -1;
    *to = (msds_parts){.p = s->p,
                       .threads = s->threads,
                       .loops = s->loops,
                       .order = &s->order,
                       .springs = &s->w,
                       .place = s->precise ? s->place : NULL,
                       .contacts = &s->contacts,
                       .probe = s->plan.touched ? &s->plan.probe : NULL,
                       .method = method,
                       .cg = linear ? fem_of(s)->cg : NULL,
                       .tissue = method == MSDS_TISSUE ? s->tissue : NULL};
    return 0;
}

static int64_t cpu_bytes(const cpu_state *s)
{
    int64_t bytes = s->order.slots * LANES * 20 + s->order.nodes * 90 + s->p->nodes * 24;
    for (const fem *f = s->fem; f < s->fem + 2; f++) {
        const int64_t matrix = s->p->elements * 136 + s->p->springs * 72 + s->p->nodes * 80;
        if (f->cg)
            bytes += matrix + s->order.slots * LANES * 36;
        if (f->exact)
            bytes +=
                matrix + s->p->nodes * 196 + f->exact->factor.numbers * 4 + compliance_bytes(&f->exact->compliance);
    }
    return bytes + (s->tissue ? tissue_bytes(s->tissue) : 0);
}

static const char *cpu_unusable(void)
{
    return NULL;
}

void msds_cpu_touch(msds_state *s, const msds_plan *plan)
{
    place_probe(s, plan);
    find_contacts(s, NULL, s->plan.method == MSDS_EXACT ? CONTACTS_NEAR : CONTACTS_PRESSED);
}

const msds_executor msds_cpu = {.is = {.device = "cpu",
                                       .features = EXECUTOR_CONTACT | EXECUTOR_WARP | EXECUTOR_TISSUE |
                                                   EXECUTOR_CAVITIES | EXECUTOR_FRICTION | EXECUTOR_TANGENT,
                                       .unusable = cpu_unusable},
                                .create = cpu_create,
                                .destroy = cpu_destroy,
                                .step = cpu_step,
                                .ready = cpu_ready,
                                .change = cpu_change,
                                .reset = cpu_reset,
                                .get = cpu_get,
                                .monitor = cpu_monitor,
                                .parts = cpu_parts,
                                .bytes = cpu_bytes};
