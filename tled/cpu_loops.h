/* The CPU back end: loops and memory around element.h. Compiled twice, by cpu_double.c and cpu_single.c, which choose
 * `real` and name the table of functions. All that is here is static.
 *
 * A step is two loops: over elements, each to its own place in `force`; over nodes, each gathering from its
 * elements. No two threads write to one place and no sum depends on who computes it: the same bytes for any number of threads.
 */
#include "base/mem.h"
#include "tled/node.h"
#include "tled/state.h"

#include <stdlib.h>
#include <string.h>

enum {
    LANES = 4, /* elements side by side: gcc 12 and clang 14 turn such a loop into vectors, with 8 gcc does not */
    ELEMENT_CHUNK = 64 * LANES,
    NODE_CHUNK = 512
};

typedef struct cpu_kind { /* what a volume's elements need */
    element_law law;
    real tension; /* now */
} cpu_kind;

/* A copy of what a state is, or, without acceleration and curves, of its results. */
typedef struct cpu_copy {
    real *displacement, *velocity, *acceleration;
    double *now;
} cpu_copy;

typedef struct cpu_state {
    const tled_problem *p;
    pool *threads;
    element_shape shape;
    cpu_kind *kind;                               /* volumes */
    real *displacement, *velocity, *acceleration; /* nodes x 3: all at one time, after each step */
    cpu_copy kept, taken[TLED_TAKEN];             /* made when first wanted */
    real *force;                                  /* elements x 8 x 3: what elements pull with; then zeros */
    real *mass_inverse;                           /* nodes */
    double *now, *next;                           /* the curves' values, 3 a curve */
    double dt, damping;
    real gravity[3];    /* now */
    bool finish, begin; /* what the loop over nodes does */
} cpu_state;

/* A few elements side by side. */
typedef struct cpu_batch {
    real displacement[24][LANES], force[24][LANES]; /* 8 x, 8 y, 8 z */
    real mu[LANES], bulk[LANES], hourglass[LANES], tension[LANES], x[LANES], y[LANES], z[LANES];
    bool active;
} cpu_batch;

static void batch_load(cpu_batch *b, const cpu_state *s, int64_t from, int count)
{
    const tled_problem *p = s->p;
    b->active = false;
    for (int l = 0; l < LANES; l++) {
        int64_t at = from + (l < count ? l : 0); /* past the end: the first again, not stored */
        const cpu_kind *kind = &s->kind[p->element_volume[at]];
        for (int c = 0; c < 8; c++) {
            const real *u = s->displacement + 3 * (int64_t)p->element_node[8 * at + c];
            b->displacement[c][l] = u[0];
            b->displacement[8 + c][l] = u[1];
            b->displacement[16 + c][l] = u[2];
        }
        const real share = p->fraction ? (real)p->fraction[at] : 1; /* forces are linear in all of these */
        b->mu[l] = share * kind->law.mu;
        b->bulk[l] = share * kind->law.bulk;
        b->hourglass[l] = share * kind->law.hourglass;
        b->tension[l] = share * kind->tension;
        b->active |= kind->tension != 0;
        b->x[l] = p->fibre ? (real)p->fibre[3 * at] : 0;
        b->y[l] = p->fibre ? (real)p->fibre[3 * at + 1] : 0;
        b->z[l] = p->fibre ? (real)p->fibre[3 * at + 2] : 0;
    }
}

static void batch_store(const cpu_batch *b, cpu_state *s, int64_t from, int count)
{
    for (int l = 0; l < count; l++)
        for (int c = 0; c < 8; c++)
            for (int a = 0; a < 3; a++)
                s->force[(from + l) * 24 + 3 * c + a] = b->force[8 * a + c][l];
}

ELEMENT_FUNCTION element_corners lane_corners(const cpu_batch *b, int row, int l)
{
    element_corners c = {{b->displacement[row][l], b->displacement[row + 1][l], b->displacement[row + 2][l],
                          b->displacement[row + 3][l], b->displacement[row + 4][l], b->displacement[row + 5][l],
                          b->displacement[row + 6][l], b->displacement[row + 7][l]}};
    return c;
}

ELEMENT_FUNCTION void lane_put(cpu_batch *b, int row, int l, element_corners c)
{
    b->force[row][l] = c.at[0], b->force[row + 1][l] = c.at[1], b->force[row + 2][l] = c.at[2];
    b->force[row + 3][l] = c.at[3], b->force[row + 4][l] = c.at[4], b->force[row + 5][l] = c.at[5];
    b->force[row + 6][l] = c.at[6], b->force[row + 7][l] = c.at[7];
}

ELEMENT_FUNCTION void batch_force(cpu_batch *b, element_shape shape, bool active)
{
    for (int l = 0; l < LANES; l++) {
        element_field u = {lane_corners(b, 0, l), lane_corners(b, 8, l), lane_corners(b, 16, l)};
        element_law law = {b->mu[l], b->bulk[l], b->hourglass[l]};
        element_fibre fibre = {{b->x[l], b->y[l], b->z[l]}, b->tension[l]};
        element_field f = element_force(u, shape, law, fibre, active);
        lane_put(b, 0, l, f.x);
        lane_put(b, 8, l, f.y);
        lane_put(b, 16, l, f.z);
    }
}

static void element_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cpu_state *s = context;
    cpu_batch b;
    (void)chunk;
    for (int64_t at = from; at < to; at += LANES) {
        int count = to - at < LANES ? (int)(to - at) : LANES;
        batch_load(&b, s, at, count);
        if (b.active)
            batch_force(&b, s->shape, true);
        else
            batch_force(&b, s->shape, false);
        batch_store(&b, s, at, count);
    }
}

/* The sum of the pulls at node n, elements in ascending order. */
static inline void internal_force(const cpu_state *s, int64_t n, real sum[3])
{
    const int32_t *corner = s->p->corner + 8 * n;
    real x = 0, y = 0, z = 0;
    for (int i = 0; i < 8; i++) {
        const real *f = s->force + 3 * (int64_t)corner[i];
        x += f[0];
        y += f[1];
        z += f[2];
    }
    sum[0] = x, sum[1] = y, sum[2] = z;
}

/* a = (external - internal) / m at the displacement of now; 0 where held. */
static inline void accelerate(cpu_state *s, int64_t n)
{
    const tled_problem *p = s->p;
    const int32_t *hold = p->hold + 3 * n;
    real net[3], *to = s->acceleration + 3 * n, inverse = s->mass_inverse[n];
    internal_force(s, n, net);
    for (int a = 0; a < 3; a++)
        net[a] = -net[a];
    for (int32_t i = p->force_start[n]; i < p->force_start[n + 1]; i++)
        for (int a = 0; a < 3; a++)
            net[a] += (real)(p->force_share[i] * s->now[3 * (int64_t)p->force_curve[i] + a]);
    for (int a = 0; a < 3; a++)
        to[a] = hold[a] == HOLD_FREE ? s->gravity[a] + net[a] * inverse : 0;
}

/* Starts a step for component i, of axis a. What a curve displaces goes where the curve is at the step's end. */
static inline void begin_step(cpu_state *s, int64_t i, int a, node_factors k)
{
    int32_t hold = s->p->hold[i];
    if (hold == HOLD_FREE) {
        s->velocity[i] = node_begin(s->velocity[i], s->acceleration[i], k);
        s->displacement[i] += k.dt * s->velocity[i];
    } else if (hold >= 0) {
        real to = (real)s->next[3 * (int64_t)hold + a];
        s->velocity[i] = (to - s->displacement[i]) / k.dt;
        s->displacement[i] = to;
    }
}

/* Ends a step, begins the next, or both: node.h. */
static void node_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cpu_state *s = context;
    const node_factors k = node_factors_of(s->dt, s->damping);
    const bool finish = s->finish, begin = s->begin;
    (void)chunk;
    for (int64_t n = from; n < to; n++) {
        if (finish)
            accelerate(s, n);
        for (int a = 0; a < 3; a++) {
            int64_t i = 3 * n + a;
            if (finish && s->p->hold[i] == HOLD_FREE)
                s->velocity[i] = node_finish(s->velocity[i], s->acceleration[i], k);
            if (begin)
                begin_step(s, i, a, k);
        }
    }
}

static void initial_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    for (int64_t n = from; n < to; n++)
        accelerate(context, n);
}

static void run_elements(cpu_state *s)
{
    for (int32_t i = 0; i < s->p->volumes; i++)
        s->kind[i].tension = (real)tled_tension(s->p, i, s->now);
    pool_run(s->threads, s->p->elements, ELEMENT_CHUNK, element_work, s);
}

static void take_gravity(cpu_state *s)
{
    for (int a = 0; a < 3; a++)
        s->gravity[a] = s->p->gravity < 0 ? 0 : (real)s->now[3 * s->p->gravity + a];
}

static void run_nodes(cpu_state *s, bool finish, bool begin)
{
    s->finish = finish;
    s->begin = begin;
    take_gravity(s);
    pool_run(s->threads, s->p->nodes, NODE_CHUNK, node_work, s);
}

static void advance_curves(cpu_state *s)
{
    double *swap = s->now;
    s->now = s->next;
    s->next = swap;
}

static int cpu_step(void *state, const void *plan, int64_t count, err *e)
{
    cpu_state *s = state;
    const tled_plan *t = plan;
    (void)e;
    s->dt = 1 / t->rate;
    s->damping = t->damping;
    if (count < 1)
        return 0;
    tled_curves(s->p, tled_time(t, 1), s->next);
    run_nodes(s, false, true);
    for (int64_t i = 1; i <= count; i++) {
        advance_curves(s);
        run_elements(s);
        if (i < count)
            tled_curves(s->p, tled_time(t, i + 1), s->next);
        run_nodes(s, true, i < count);
    }
    return 0;
}

static int cpu_get(void *state, int what, double *to, err *e)
{
    const cpu_state *s = state;
    real sum[3];
    (void)e;
    for (int64_t n = 0; n < s->p->nodes; n++) {
        const real *from = what == TLED_DISPLACEMENT ? s->displacement + 3 * n : s->velocity + 3 * n;
        if (what == TLED_INTERNAL) {
            internal_force(s, n, sum);
            from = sum;
        }
        for (int a = 0; a < 3; a++)
            to[3 * n + a] = from[a];
    }
    return 0;
}

static int copy_make(cpu_copy *c, const tled_problem *p, err *e)
{
    if (c->velocity)
        return 0;
    c->displacement = mem_array(p->nodes, 3 * sizeof *c->displacement, "the solver", e);
    c->velocity = c->displacement ? mem_array(p->nodes, 3 * sizeof *c->velocity, "the solver", e) : NULL;
    return c->velocity ? 0 : -1;
}

static void copy_free(cpu_copy *c)
{
    free(c->displacement);
    free(c->velocity);
    free(c->acceleration);
    free(c->now);
}

/* What a state is, from one set of arrays to another. */
static void copy_all(const tled_problem *p, const cpu_copy *from, const cpu_copy *to)
{
    size_t size = 3 * (size_t)p->nodes * sizeof *from->displacement;
    memcpy(to->displacement, from->displacement, size);
    memcpy(to->velocity, from->velocity, size);
    memcpy(to->acceleration, from->acceleration, size);
    memcpy(to->now, from->now, 3 * (size_t)p->script->curves * sizeof *from->now);
}

static cpu_copy of_now(const cpu_state *s)
{
    cpu_copy c = {s->displacement, s->velocity, s->acceleration, s->now};
    return c;
}

static int cpu_keep(void *state, err *e)
{
    cpu_state *s = state;
    cpu_copy now = of_now(s), *kept = &s->kept;
    if (copy_make(kept, s->p, e))
        return -1;
    if (!kept->acceleration)
        kept->acceleration = mem_array(s->p->nodes, 3 * sizeof *kept->acceleration, "the solver", e);
    if (!kept->now)
        kept->now = mem_array(s->p->script->curves, 3 * sizeof *kept->now, "the solver", e);
    if (!kept->acceleration || !kept->now)
        return -1;
    copy_all(s->p, &now, kept);
    return 0;
}

static int cpu_back(void *state, err *e)
{
    cpu_state *s = state;
    cpu_copy now = of_now(s);
    (void)e;
    copy_all(s->p, &s->kept, &now);
    return 0;
}

static int cpu_take(void *state, int slot, err *e)
{
    cpu_state *s = state;
    cpu_copy *to = &s->taken[slot];
    size_t size = 3 * (size_t)s->p->nodes * sizeof *s->displacement;
    if (copy_make(to, s->p, e))
        return -1;
    memcpy(to->displacement, s->displacement, size);
    memcpy(to->velocity, s->velocity, size);
    return 0;
}

static int cpu_taken(void *state, int slot, void *to, err *e)
{
    const cpu_state *s = state;
    const tled_taken *out = to;
    const cpu_copy *from = &s->taken[slot];
    (void)e;
    for (int64_t i = 0; i < 3 * s->p->nodes; i++) {
        out->displacement[i] = from->displacement[i];
        out->velocity[i] = from->velocity[i];
    }
    return 0;
}

static int64_t cpu_bytes(const void *state)
{
    const cpu_state *s = state;
    int64_t bytes = (s->p->elements + 1) * 24 * (int64_t)sizeof(real) + s->p->nodes * 10 * (int64_t)sizeof(real);
    bytes += s->kept.acceleration ? s->p->nodes * 9 * (int64_t)sizeof(real) : 0;
    for (int i = 0; i < TLED_TAKEN; i++)
        bytes += s->taken[i].velocity ? s->p->nodes * 6 * (int64_t)sizeof(real) : 0;
    return bytes;
}

static void cpu_destroy(void *state)
{
    cpu_state *s = state;
    if (!s)
        return;
    copy_free(&s->kept);
    for (int i = 0; i < TLED_TAKEN; i++)
        copy_free(&s->taken[i]);
    free(s->kind);
    free(s->displacement);
    free(s->velocity);
    free(s->acceleration);
    free(s->force);
    free(s->mass_inverse);
    free(s->now);
    free(s->next);
    free(s);
}

static int allocate(cpu_state *s, err *e)
{
    const tled_problem *p = s->p;
    s->kind = mem_array(p->volumes, sizeof *s->kind, "the solver", e);
    s->displacement = mem_array(p->nodes, 3 * sizeof *s->displacement, "the solver", e);
    s->velocity = mem_array(p->nodes, 3 * sizeof *s->velocity, "the solver", e);
    s->acceleration = mem_array(p->nodes, 3 * sizeof *s->acceleration, "the solver", e);
    s->force = mem_array(p->elements + 1, 24 * sizeof *s->force, "the solver", e);
    s->mass_inverse = mem_array(p->nodes, sizeof *s->mass_inverse, "the solver", e);
    s->now = mem_array(p->script->curves, 3 * sizeof *s->now, "the solver", e);
    s->next = mem_array(p->script->curves, 3 * sizeof *s->next, "the solver", e);
    return s->kind && s->displacement && s->velocity && s->acceleration && s->force && s->mass_inverse && s->now &&
                   s->next
               ? 0
               : -1;
}

static void *cpu_create(const void *problem, pool *threads, err *e)
{
    cpu_state *s = mem_array(1, sizeof *s, "the solver", e);
    if (!s)
        return NULL;
    const tled_problem *p = s->p = problem;
    s->threads = threads;
    if (allocate(s, e)) {
        cpu_destroy(s);
        return NULL;
    }
    s->shape = element_box(p->side[0], p->side[1], p->side[2]);
    for (int32_t i = 0; i < p->volumes; i++)
        s->kind[i].law = (element_law){(real)p->volume[i].mu, (real)p->volume[i].bulk, (real)p->volume[i].hourglass};
    for (int64_t n = 0; n < p->nodes; n++)
        s->mass_inverse[n] = (real)(1 / p->mass[n]);
    for (int64_t i = 0; i < 3 * p->nodes; i++) {
        s->displacement[i] = (real)p->displacement[i];
        s->velocity[i] = (real)p->velocity[i];
    }
    tled_curves(p, p->start, s->now);
    run_elements(s);
    take_gravity(s);
    pool_run(threads, p->nodes, NODE_CHUNK, initial_work, s);
    return s;
}

static const char *cpu_unusable(void)
{
    return NULL;
}

const backend CPU_BACKEND = {.name = "cpu",
                             .unusable = cpu_unusable,
                             .create = cpu_create,
                             .step = cpu_step,
                             .get = cpu_get,
                             .keep = cpu_keep,
                             .back = cpu_back,
                             .take = cpu_take,
                             .taken = cpu_taken,
                             .bytes = cpu_bytes,
                             .destroy = cpu_destroy};
