#include "msds/cpu/exact.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum {
    STALE = 20,     /* solves of one frame by one factor at most, where elements turn */
    PRODUCTS = 2000 /* for the forces of a solve; the next one takes over what is left */
};

/* Forces are found so well that no node is off by more than this share of how far the farthest is moved, nor by more
 * than the second of what a frame may leave. */
static const double fine = 1e-7, finest = .1;

/* But where elements turn, and other solves follow, this share of what is left is enough. */
static const double forcing = 1e-3;

static void tell(exact *x, const char *what, double share)
{
    compliance *s = &x->compliance;
    s->now.solve = x->solves + 1;
    s->now.residual = x->residual;
    compliance_tell(s, what, share);
}

static void multiply(void *context, const double *force, double *product)
{
    exact *x = context;
    compliance_multiply(&x->compliance, force, product);
}

static void tell_forces(void *context, double share)
{
    tell(context, "forces on them", share);
}

int exact_make(exact *x, const msds_problem *p, stiffness *k, contacts *c, const lanes *loops, pool *threads, err *e)
{
    x->p = p;
    x->k = k;
    x->c = c;
    x->threads = threads;
    x->factor.listener = x->compliance.listener = x->listener;
    if (factor_make(&x->factor, p, k, loops, threads, e))
        return -1;
    x->left = mem_array(p->nodes, 3 * sizeof *x->left, "the solver", e);
    x->inner = mem_array(p->nodes, 3 * sizeof *x->inner, "the solver", e);
    x->step = mem_array(p->nodes, 3 * sizeof *x->step, "the solver", e);
    if (!x->left || !x->inner || !x->step || compliance_make(&x->compliance, p, &x->factor, c, threads, e) ||
        mprgp_make(&x->forces, p->nodes, e))
        return -1;
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
    compliance_free(&x->compliance);
    mprgp_free(&x->forces);
    free(x->state);
    free(x->by);
    mixing_free(&x->mixing);
    *x = (exact){0};
}

void exact_moved(exact *x, stiffness *k, pool *threads)
{
    x->k = k;
    x->threads = x->factor.threads = x->compliance.threads = threads;
    x->factor.k = k;
    x->compliance.factor = &x->factor;
}

/* How far contact i still has to go: m. */
static double still_to_go(const exact *x, const double *u, int64_t i)
{
    const contact *c = &x->c->list[i];
    double moved = 0;
    for (int a = 0; a < 3; a++)
        moved += c->way[a] * (u[3 * (int64_t)c->node + a] - c->from[a]);
    return c->depth - moved - (x->p->options.penalty ? c->force / x->p->repulsion[c->node] : 0);
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

/* Finds f >= 0 with S f - want >= 0 and one of the two 0, from the forces of now, with which what is left leads
 * contacts on by m->product; place: m, what a frame may leave. */
static void solve_forces(exact *x, const double *u, double place)
{
    mprgp *m = &x->forces;
    double far = 0; /* m: how far the farthest is moved, or has to go */
    m->count = x->c->count;
    for (int64_t i = 0; i < m->count; i++) {
        const contact *c = &x->c->list[i];
        m->x[i] = c->force;
        m->g[i] = m->product[i] - still_to_go(x, u, i);
        m->inverse[i] = compliance_inverse(&x->compliance, c);
        far = fmax(far, fmax(fabs(contacts_along(c, u) + m->product[i]), -m->g[i]));
    }
    if (x->solves == 0)
        mprgp_scale(m);
    const double rough = x->k->turn ? forcing * fmin(1, x->residual) * far : 0;
    mprgp_solve(m, fmax(rough, fmin(fine * far, finest * place)), PRODUCTS);
}

/* One solve: u and the contact forces. */
static void improve(exact *x, double *u, double place)
{
    mprgp *m = &x->forces;
    m->context = x;
    m->multiply = multiply;
    m->tell = tell_forces;
    compliance_lead(&x->compliance, x->left, m->product);
    solve_forces(x, u, place);
    for (int64_t i = 0; i < m->count; i++) {
        const double force = m->x[i];
        m->x[i] -= x->c->list[i].force;
        x->c->list[i].force = force;
    }
    compliance_follow(&x->compliance, m->x, x->step);
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
static void improve_turned(exact *x, double *u, double place)
{
    const int64_t nodes = x->p->nodes;
    gather_state(x, u, x->state);
    improve(x, u, place);
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
    compliance_forget(&x->compliance);
    return factor_again(&x->factor, e) || compliance_begin(&x->compliance, e) ? -1 : 0;
}

int exact_solve(exact *x, double *u, bool first, double tolerance, double reach, err *e)
{
    x->solves = 0;
    x->residual = NAN;
    const double place = tolerance * reach;
    tell(x, "solving", 0);
    if (compliance_begin(&x->compliance, e))
        return -1;
    mixing_begin(&x->mixing);
    int fresh = 0; /* the solve that the factor was made for */
    x->residual = find_left(x, u, first);
    while (x->residual > tolerance || !in_place(x, u, place)) {
        tell(x, "solving", 0);
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
            improve_turned(x, u, place);
        else
            improve(x, u, place);
        x->residual = find_left(x, u, false);
    }
    return 0;
}
