#include "msds/cpu/tissue.h"

#include "base/mem.h"
#include "msds/cpu/sums.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIELDS = 5, SEARCHES = 6 /* steps that a line search tries at most */ };

/* Conjugate gradients stop at this share of the square of what was left, so that Newton's next step begins from a new
 * tangent; a line search at this share of the slope. */
static const double forcing = .01, enough = .5;

/* A residual below which pressures are held for the next frame. */
static const double balanced = .5;

/* ---- loops */

static void measure_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_measure(&t->m, t->u, from, to);
}

static void stress_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_stress(&t->m, from, to);
}

static void swell_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_swell(&t->m, t->along, from, to);
}

static void tangent_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_tangent(&t->m, t->along, from, to);
}

static void points_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_points(&t->m, t->points, from, to);
}

static void gather_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    t->sum[chunk] = t->loops->tissue_gather(&t->m, t->along, t->to, from, to);
}

static void advance_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    t->sum[chunk] = t->loops->tissue_advance(&t->m, &t->step, &t->left, &t->way, &t->pulled, t->alpha, from, to);
}

static void turn_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    (void)chunk;
    t->loops->tissue_turn(&t->m, &t->way, &t->left, t->beta, from, to);
}

static void over_groups(tissue *t, pool_work *work)
{
    pool_run(t->threads, t->m.groups, TISSUE_CHUNK, work, t);
}

static double over_nodes(tissue *t, pool_work *work)
{
    const int64_t count = t->pressed.s->count;
    pool_run(t->threads, count, SELL_CHUNK, work, t);
    return sums_of(t->sum, pool_chunks(count, SELL_CHUNK));
}

static void over_points(tissue *t, float *to)
{
    t->points = to;
    pool_run(t->threads, t->m.points / LANES, SELL_CHUNK, points_work, t);
}

/* to: what the elements pull with at u. */
static void find_pulled(tissue *t, lanes_field *to)
{
    over_groups(t, measure_work);
    over_points(t, t->m.pressure);
    over_groups(t, stress_work);
    t->along = NULL;
    t->to = to;
    over_nodes(t, gather_work);
}

/* pulled: what that changes by along a way from there. Returns way . pulled. */
static double find_change(tissue *t, const lanes_field *way)
{
    t->along = way;
    t->to = &t->pulled;
    if (t->m.points)
        over_groups(t, swell_work);
    over_points(t, t->m.pressed);
    over_groups(t, tangent_work);
    return over_nodes(t, gather_work);
}

/* ---- fields */

static void clear(const tissue *t, lanes_field *f)
{
    memset(f->memory, 0, 3 * (size_t)(t->pressed.s->nodes + 2 * LANES) * sizeof *f->memory);
}

static double dot(const tissue *t, const lanes_field *a, const lanes_field *b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        for (int64_t i = 0; i < t->pressed.s->nodes; i++)
            sum += (double)a->x[k][i] * (double)b->x[k][i];
    return sum;
}

/* left = gravity, less what the elements pull with at u. Returns the square of its norm; *load: of gravity's. */
static double find_left(tissue *t, double *load)
{
    double square = 0;
    find_pulled(t, &t->left);
    *load = t->pull = 0;
    for (int a = 0; a < 3; a++)
        for (int64_t i = 0; i < t->pressed.s->nodes; i++) {
            const double weight = (double)t->weight->x[a][i], pulled = (double)t->left.x[a][i];
            const double left = weight - pulled;
            t->left.x[a][i] = (float)left;
            square += left * left;
            t->pull += pulled * pulled;
            *load += weight * weight;
        }
    return square;
}

/* The same with what presses, where a search may go. */
static void find_search(tissue *t)
{
    double load;
    find_left(t, &load);
    pressed_push(&t->pressed, t->u, &t->left);
    pressed_keep_out(&t->pressed, &t->left);
}

static void subtract(const tissue *t, lanes_field *from, const lanes_field *what)
{
    for (int a = 0; a < 3; a++)
        for (int64_t i = 0; i < t->pressed.s->nodes; i++)
            from->x[a][i] -= what->x[a][i];
}

/* u = started + share * step. */
static void go(tissue *t, double share)
{
    for (int a = 0; a < 3; a++)
        for (int64_t i = 0; i < t->pressed.s->nodes; i++)
            t->u->x[a][i] = t->started.x[a][i] + (float)share * t->step.x[a][i];
}

/* ---- Newton */

/* Conjugate gradients for the step, from what contact moves; left: what a search may go along. Returns how many
 * iterations it took; *gain: left at the beginning times what was added to the step, above 0. Where the tangent is not
 * positive along a way, it stops, with that way if it is the first. */
static int64_t find_step(tissue *t, int64_t most, double *gain)
{
    clear(t, &t->way);
    clear(t, &t->pulled);
    t->alpha = t->beta = 0;
    double squared = over_nodes(t, advance_work);
    const double least = forcing * squared;
    int64_t i = 0;
    *gain = 0;
    for (; i < most && squared > least && squared > 0; i++) {
        over_nodes(t, turn_work);
        double curvature = find_change(t, &t->way) + pressed_stiffen(&t->pressed, &t->way, &t->pulled);
        const bool is_positive = curvature > 0;
        if (!is_positive && i)
            break;
        pressed_keep_out(&t->pressed, &t->pulled);
        t->alpha = is_positive ? (float)(squared / curvature) : 1;
        *gain += (double)t->alpha * squared;
        const double next = over_nodes(t, advance_work);
        if (!is_positive)
            return i + 1;
        t->beta = (float)(next / squared);
        squared = next;
    }
    return i;
}

/* The nodes that a probe moves go their way in the step; what is left then is what that pulls. */
static void begin_step(tissue *t)
{
    clear(t, &t->step);
    if (!pressed_move(&t->pressed, &t->step))
        return;
    find_change(t, &t->step);
    subtract(t, &t->left, &t->pulled);
    pressed_keep_out(&t->pressed, &t->left);
}

/* Goes along the step as far as that does not overshoot by much: what is left pulls back along it by at most half of
 * the gain that conjugate gradients saw in it. Contact's ways have no part in that. */
static void search(tissue *t, double gain)
{
    double share = 1;
    for (int i = 0;; i++) {
        go(t, share);
        find_search(t);
        const double slope = dot(t, &t->left, &t->step);
        if (i == SEARCHES - 1 || slope >= -enough * gain)
            return;
        share *= isfinite(slope) ? fmin(fmax(gain / (gain - slope), .1), .7) : .1;
    }
}

/* Contacts stand where the last step left them. */
static void move_contacts(tissue *t)
{
    contacts *c = t->pressed.c;
    for (int64_t i = 0; i < c->count; i++) {
        const int32_t own = t->pressed.s->own_node[c->list[i].node];
        c->list[i].depth = pressed_depth(&t->pressed, &c->list[i], t->u);
        for (int a = 0; a < 3; a++)
            c->list[i].from[a] = (double)t->u->x[a][own];
    }
}

/* The forces of contact, and what is left then, over the load. */
static void conclude(tissue *t)
{
    double load, square = find_left(t, &load);
    pressed_forces(&t->pressed, t->u, &t->left, t->weight, &square, &load);
    load = fmax(fmax(load, t->pull), t->pressed.p->slight);
    t->residual = load > 0 ? sqrt(fmax(0, square) / load) : 0;
}

static void copy(const tissue *t, lanes_field *to, const lanes_field *from)
{
    memcpy(to->memory, from->memory, 3 * (size_t)(t->pressed.s->nodes + 2 * LANES) * sizeof *to->memory);
}

/* Not of a state that is far from balance, whose pressures mean nothing. */
static void hold_pressure(tissue *t)
{
    for (int64_t i = 0; i < t->m.points && t->residual < balanced; i++)
        t->m.held[i] = t->m.keep[i] * t->m.pressure[i];
}

void tissue_solve(tissue *t, int64_t iterations)
{
    hold_pressure(t);
    find_search(t);
    while (iterations > 0) {
        double gain;
        copy(t, &t->started, t->u);
        begin_step(t);
        const int64_t took = find_step(t, iterations, &gain);
        search(t, gain);
        move_contacts(t);
        iterations -= took + 1; /* beginning a step and searching along it take as long as one */
        if (!took)
            break;
    }
    conclude(t);
}

/* ---- life */

int tissue_make(tissue *t, const msds_problem *p, const sell *s, contacts *c, const lanes *loops, pool *threads,
                lanes_field *u, lanes_field *weight, err *e)
{
    *t = (tissue){.pressed = {p, s, c}, .loops = loops, .threads = threads, .u = u, .weight = weight};
    lanes_field *fields[FIELDS] = {&t->step, &t->left, &t->way, &t->pulled, &t->started};
    t->sum = mem_array(pool_chunks(s->count, SELL_CHUNK), sizeof *t->sum, "the solver", e);
    for (int i = 0; t->sum && i < FIELDS; i++)
        if (lanes_field_make(fields[i], s->nodes, e))
            return -1;
    return t->sum ? tissue_mesh_make(&t->m, p, s, e) : -1;
}

void tissue_reset(tissue *t)
{
    for (int64_t i = 0; i < t->m.points; i++)
        t->m.held[i] = t->m.pressure[i] = 0;
    t->residual = 0;
}

void tissue_free(tissue *t)
{
    lanes_field *fields[FIELDS] = {&t->step, &t->left, &t->way, &t->pulled, &t->started};
    for (int i = 0; i < FIELDS; i++)
        lanes_field_free(fields[i]);
    free(t->sum);
    tissue_mesh_free(&t->m);
    *t = (tissue){.alpha = 0};
}

int64_t tissue_bytes(const tissue *t)
{
    return tissue_mesh_bytes(&t->m) + FIELDS * 12 * (t->pressed.s->nodes + 2 * LANES);
}
