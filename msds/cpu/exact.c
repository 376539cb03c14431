#include "msds/cpu/exact.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum {
    PATHS_MOST = 2048, /* kept; past that all are forgotten */
    BATCH = 16,        /* paths made side by side */
    ROWS = 64,         /* of the Schur complement, likewise */
    STALE = 20,        /* solves of one frame by one factor at most, where elements turn */
    SWEEPS = 2000      /* of the complementarity problem; the next solve takes over what is left */
};

int exact_make(exact *x, const msds_problem *p, stiffness *k, contacts *c, const lanes *loops, pool *threads, err *e)
{
    x->p = p;
    x->k = k;
    x->c = c;
    x->threads = threads;
    x->factor.listener = x->listener;
    if (factor_make(&x->factor, p, k, loops, threads, e))
        return -1;
    x->left = mem_array(p->nodes, 3 * sizeof *x->left, "the solver", e);
    x->inner = mem_array(p->nodes, 3 * sizeof *x->inner, "the solver", e);
    x->step = mem_array(p->nodes, 3 * sizeof *x->step, "the solver", e);
    x->cached = mem_array(p->nodes, sizeof *x->cached, "the solver", e);
    x->work = mem_array((int64_t)BATCH * 3 * x->factor.largest, sizeof *x->work, "the solver", e);
    if (!x->left || !x->inner || !x->step || !x->cached || !x->work)
        return -1;
    for (int64_t n = 0; n < p->nodes; n++)
        x->cached[n] = -1;
    if (!k->turn)
        return 0;
    x->slight = p->slight;
    x->state = mem_array(p->nodes, 4 * sizeof *x->state, "the solver", e);
    x->by = mem_array(p->nodes, 4 * sizeof *x->by, "the solver", e);
    return x->state && x->by ? mixing_make(&x->mixing, 4 * p->nodes, 3 * p->nodes, e) : -1;
}

void exact_free(exact *x)
{
    factor_free(&x->factor);
    free(x->left);
    free(x->inner);
    free(x->step);
    free(x->cached);
    free(x->whose);
    free(x->path);
    free(x->work);
    free(x->normal);
    free(x->schur);
    free(x->want);
    free(x->force);
    free(x->state);
    free(x->by);
    mixing_free(&x->mixing);
    *x = (exact){0};
}

static void tell(const exact *x, const char *what, int64_t done, int64_t all)
{
    const msds_progress now = {what, all ? (double)done / (double)all : 0, x->solves + 1, x->residual, x->c->count};
    if (x->listener)
        x->listener->at(x->listener->context, &now);
}

static float *path_at(const exact *x, int64_t i)
{
    return x->path + 3 * i * x->factor.path;
}

static void path_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    exact *x = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        factor_path(&x->factor, x->whose[x->fresh + i], x->work + 3 * i * x->factor.largest, path_at(x, x->fresh + i),
                    x->factor.path);
}

static int make_batch(exact *x, const int32_t *node, int64_t count, err *e)
{
    if (MEM_ROOM(&x->path, &x->room, (x->paths + count) * 3 * x->factor.path, "contact", e) ||
        MEM_ROOM(&x->whose, &x->whose_room, x->paths + count, "contact", e))
        return -1;
    x->fresh = x->paths;
    for (int64_t i = 0; i < count; i++) {
        x->whose[x->fresh + i] = node[i];
        x->cached[node[i]] = (int32_t)(x->fresh + i);
    }
    pool_run(x->threads, count, 1, path_work, x);
    x->paths += count;
    return 0;
}

static void forget_paths(exact *x)
{
    for (int64_t i = 0; i < x->paths; i++)
        x->cached[x->whose[i]] = -1;
    x->paths = 0;
}

/* Paths of all contacts, of which most are known from the frame before. */
static int make_paths(exact *x, err *e)
{
    int32_t batch[BATCH];
    int64_t count = 0, missing = 0;
    for (int64_t i = 0; i < x->c->count; i++)
        missing += x->cached[x->c->list[i].node] < 0;
    if (missing && x->paths + missing > PATHS_MOST) {
        forget_paths(x);
    }
    for (int64_t i = 0; i < x->c->count; i++) {
        if (x->cached[x->c->list[i].node] < 0)
            batch[count++] = x->c->list[i].node;
        if (count == BATCH || (count && i == x->c->count - 1)) {
            tell(x, "solving for unit loads on them", i, x->c->count);
            if (make_batch(x, batch, count, e))
                return -1;
            count = 0;
        }
    }
    return 0;
}

static void normal_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    exact *x = context;
    const int64_t stride = x->factor.path;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const contact *c = &x->c->list[i];
        const float *path = path_at(x, x->cached[c->node]);
        const float way[3] = {(float)c->way[0], (float)c->way[1], (float)c->way[2]};
        float *to_normal = x->normal + i * stride;
        for (int64_t k = 0; k < factor_path_length(&x->factor, c->node); k++)
            to_normal[k] = way[0] * path[k] + way[1] * path[stride + k] + way[2] * path[2 * stride + k];
    }
}

/* Eight sums side by side: the order is fixed, and compilers make vectors of it. */
static double product(const float *a, const float *b, int64_t count)
{
    double sum[8] = {0}, rest = 0;
    int64_t i = 0;
    for (; i + 8 <= count; i += 8)
        for (int l = 0; l < 8; l++)
            sum[l] += (double)(a[i + l] * b[i + l]);
    for (; i < count; i++)
        rest += (double)(a[i] * b[i]);
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7])) + rest;
}

static void schur_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    exact *x = context;
    const int64_t count = x->c->count, stride = x->factor.path;
    (void)chunk;
    for (int64_t i = x->row + from; i < x->row + to; i++)
        for (int64_t j = 0; j <= i; j++) {
            int64_t shared = factor_shared(&x->factor, x->c->list[i].node, x->c->list[j].node);
            x->schur[i * count + j] = x->schur[j * count + i] =
                product(x->normal + i * stride, x->normal + j * stride, shared);
        }
}

static int make_schur(exact *x, err *e)
{
    const int64_t count = x->c->count;
    if (!count)
        return 0;
    if (make_paths(x, e) || MEM_ROOM(&x->normal, &x->normal_room, count * x->factor.path, "contact", e) ||
        MEM_ROOM(&x->schur, &x->schur_room, count * count, "contact", e) ||
        MEM_ROOM(&x->want, &x->want_room, count, "contact", e) ||
        MEM_ROOM(&x->force, &x->force_room, count, "contact", e))
        return -1;
    pool_run(x->threads, count, 1, normal_work, x);
    for (x->row = 0; x->row < count; x->row += ROWS) {
        tell(x, "compliances between them", x->row * x->row, count * count);
        pool_run(x->threads, count - x->row < ROWS ? count - x->row : ROWS, 1, schur_work, x);
    }
    for (int64_t i = 0; i < count && x->p->options.penalty; i++)
        x->schur[i * count + i] += 1 / x->p->repulsion[x->c->list[i].node];
    return 0;
}

/* Finds f >= 0 with S f - want >= 0 and one of the two 0, by Gauss and Seidel's sweeps, from the forces of now. */
static void solve_forces(exact *x)
{
    const int64_t count = x->c->count;
    double scale = 0;
    for (int64_t i = 0; i < count; i++) {
        x->force[i] = x->c->list[i].force;
        scale = fmax(scale, fabs(x->want[i]));
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double moved = 0;
        tell(x, "sweeps over contact, of 2000 at most", sweep, SWEEPS);
        for (int64_t i = 0; i < count; i++) {
            const double *row = x->schur + i * count;
            double sum = x->want[i];
            for (int64_t j = 0; j < count; j++)
                sum -= row[j] * x->force[j];
            double to = fmax(0, x->force[i] + sum / row[i]);
            moved = fmax(moved, fabs(to - x->force[i]) * row[i]);
            x->force[i] = to;
        }
        if (moved <= 1e-9 * scale)
            break;
    }
}

/* How far contact i still has to go: m. */
static double still_to_go(const exact *x, const double *u, int64_t i)
{
    const contact *c = &x->c->list[i];
    double gone = 0;
    for (int a = 0; a < 3; a++)
        gone += c->way[a] * (u[3 * (int64_t)c->node + a] - c->from[a]);
    return c->depth - gone - (x->p->options.penalty ? c->force / x->p->repulsion[c->node] : 0);
}

/* Fills x->left: gravity, contact and minus the elements' pulls. Returns its norm over that of the load or the pull,
 * whichever is more: now, or where the frame begins, which tells of tissue that the probe has just left. */
static double find_left(exact *x, const double *u, bool begins)
{
    const msds_problem *p = x->p;
    double left = 0, load = 0, inner = 0;
    stiffness_warp(x->k, u, false);
    stiffness_force(x->k, u, x->inner);
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        x->left[i] = p->weight[i / 3] * p->options.gravity[i % 3];
    for (int64_t i = 0; i < x->c->count; i++)
        for (int a = 0; a < 3; a++)
            x->left[3 * (int64_t)x->c->list[i].node + a] += x->c->list[i].force * x->c->list[i].way[a];
    for (int64_t i = 0; i < 3 * p->nodes; i++) {
        inner += x->inner[i] * x->inner[i];
        if (p->fixed[i / 3]) {
            x->left[i] = 0;
            continue;
        }
        load += x->left[i] * x->left[i];
        x->left[i] -= x->inner[i];
        left += x->left[i] * x->left[i];
    }
    load = fmax(fmax(load, inner), x->slight);
    if (begins)
        x->load = load;
    load = fmax(load, x->load);
    return load > 0 ? sqrt(left / load) : 0;
}

/* One solve: u and the contact forces. */
static void improve(exact *x, double *u)
{
    contacts *c = x->c;
    const int64_t count = c->count, stride = x->factor.path;
    factor_forward(&x->factor, x->left);
    for (int64_t i = 0; i < count; i++) {
        x->want[i] = still_to_go(x, u, i) - factor_dot(&x->factor, c->list[i].node, x->normal + i * stride);
        for (int64_t j = 0; j < count; j++)
            x->want[i] += x->schur[i * count + j] * c->list[j].force;
    }
    if (count)
        solve_forces(x);
    for (int64_t i = 0; i < count; i++) {
        factor_add(&x->factor, c->list[i].node, x->normal + i * stride, x->force[i] - c->list[i].force);
        c->list[i].force = x->force[i];
    }
    factor_backward(&x->factor, x->step);
    for (int64_t i = 0; i < 3 * x->p->nodes; i++)
        u[i] += x->step[i];
    x->solves++;
}

static void gather_state(const exact *x, const double *u, double *to)
{
    const int64_t nodes = x->p->nodes;
    memcpy(to, u, 3 * (size_t)nodes * sizeof *to);
    memset(to + 3 * nodes, 0, (size_t)nodes * sizeof *to);
    for (int64_t i = 0; i < x->c->count; i++)
        to[3 * nodes + x->c->list[i].node] = x->c->list[i].force;
}

/* One solve where elements turn, and what follows from those before. */
static void improve_turned(exact *x, double *u)
{
    const int64_t nodes = x->p->nodes;
    gather_state(x, u, x->state);
    improve(x, u);
    gather_state(x, u, x->by);
    for (int64_t i = 0; i < 4 * nodes; i++)
        x->by[i] -= x->state[i];
    mixing_next(&x->mixing, x->state, x->by);
    memcpy(u, x->state, 3 * (size_t)nodes * sizeof *u);
    for (int64_t i = 0; i < x->c->count; i++)
        x->c->list[i].force = fmax(0, x->state[3 * nodes + x->c->list[i].node]);
}

/* Whether each contact is where it should be. */
static bool in_place(const exact *x, const double *u, double tolerance)
{
    for (int64_t i = 0; i < x->c->count; i++) {
        double left = still_to_go(x, u, i);
        if (left > tolerance || (x->c->list[i].force > 0 && left < -tolerance))
            return false;
    }
    return true;
}

/* A factor of elements as they are turned now, where one of older turns no longer leads on. */
static int turn_again(exact *x, const double *u, err *e)
{
    stiffness_warp(x->k, u, true);
    forget_paths(x);
    return factor_again(&x->factor, e) || make_schur(x, e) ? -1 : 0;
}

int exact_solve(exact *x, double *u, bool first, double tolerance, double reach, err *e)
{
    x->solves = 0;
    x->residual = NAN;
    if (make_schur(x, e))
        return -1;
    mixing_begin(&x->mixing);
    int fresh = 0; /* the solve that the factor was made for */
    x->residual = find_left(x, u, first);
    while (x->residual > tolerance || !in_place(x, u, tolerance * reach)) {
        tell(x, "solving", 0, 0);
        if (x->solves == EXACT_SOLVES || !isfinite(x->residual))
            return err_set(e, NULL, 0, "after %d solves the residual is still %.3g; expected %.3g", x->solves,
                           x->residual, tolerance);
        if (x->k->turn && x->solves - fresh >= STALE) {
            if (turn_again(x, u, e))
                return -1;
            fresh = x->solves;
            mixing_begin(&x->mixing);
        }
        if (x->k->turn)
            improve_turned(x, u);
        else
            improve(x, u);
        x->residual = find_left(x, u, false);
    }
    return 0;
}
