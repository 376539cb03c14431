#include "msds/cpu/tissue.h"

#include "base/mem.h"
#include "msds/cpu/sums.h"
#include "msds/cpu/tissue_rest.h"
#include "msds/cpu/tissue_walls.h"
#include "msds/cpu/tissue_work.h"
#include "msds/problem/line_search.h"
#include "msds/problem/newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIELDS = 6 };

/* The share of a step that is always tried. */
static const double yielding = .02;

/* What of all nodes' sums are told. */
enum { SUM_LEFT, SUM_LOAD, SUM_PULL, SUMS };

static void left_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    double sum[SUMS] = {0};
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++) {
            const double weight = (double)t->weight->x[a][i], pulled = (double)t->left.x[a][i], left = weight - pulled;
            t->left.x[a][i] = (float)left;
            sum[SUM_LEFT] += left * left;
            sum[SUM_LOAD] += weight * weight;
            sum[SUM_PULL] += pulled * pulled;
        }
    memcpy(t->sums + SUMS * chunk, sum, sizeof sum);
}

/* left = gravity, less what the elements pull with at u; with the squares of their norms. */
static void find_left(tissue *t)
{
    tissue_pull(t, &t->left);
    tissue_nodes(t, left_work);
    for (int k = 0; k < SUMS; k++) {
        const int64_t chunks = pool_chunks(t->pressed.s->count, SELL_CHUNK);
        for (int64_t i = 0; i < chunks; i++)
            t->sum[i] = t->sums[SUMS * i + k];
        t->square[k] = sums_of(t->sum, chunks);
    }
}

static void most_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    double most = 0;
    for (int64_t i = from * LANES; i < to * LANES; i++) {
        double square = 0;
        for (int a = 0; a < 3; a++)
            square += (double)t->step.x[a][i] * (double)t->step.x[a][i];
        most = fmax(most, square);
    }
    t->sum[chunk] = most;
}

/* The most that a node goes in the step, m. */
static double longest(tissue *t)
{
    const int64_t count = t->pressed.s->count;
    double most = 0;
    tissue_nodes(t, most_work);
    for (int64_t i = 0; i < pool_chunks(count, SELL_CHUNK); i++)
        most = fmax(most, t->sum[i]);
    return sqrt(most);
}

static void go_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++)
            t->u->x[a][i] = t->started.x[a][i] + t->alpha * t->step.x[a][i];
}

/* u = started + share step. */
static void go(tissue *t, double share)
{
    t->alpha = (float)share;
    tissue_nodes(t, go_work);
}

/* ---- contact */

static int32_t own_of(const tissue *t, const contact *c)
{
    return t->pressed.s->own_node[c->node];
}

/* How far a contact's node may still go toward the probe in the step, m; below 0: it has to come out by that. */
static double room_of(const tissue *t, const contact *c)
{
    return pressed_along(&t->step, own_of(t, c), c) - c->depth;
}

/* Those inside the probe have to come out in the step; those that it pressed before stay at its surface. Returns
 * whether there are any. */
static bool begin_contacts(tissue *t)
{
    bool any = false;
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        contact *c = &t->pressed.c->list[i];
        c->active = !t->pressed.p->options.penalty && (c->depth > 0 || c->force > 0);
        c->pull = 0;
        if (c->active)
            pressed_add(&t->step, own_of(t, c), c, c->depth);
        any |= c->active;
    }
    return any;
}

/* Removes from f, at nodes that are held, its component along the normal of their plane, and adds share times that
 * component to what pulls the node. */
static void keep_out(const tissue *t, lanes_field *f, double share)
{
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        contact *c = &t->pressed.c->list[i];
        if (!c->active)
            continue;
        const double along = pressed_along(f, own_of(t, c), c);
        c->pull += share * along;
        pressed_add(f, own_of(t, c), c, -along);
    }
}

/* The sum of the squares of what pulls nodes off their planes, times inverse: as squares of what is left are summed. */
static double sum_off(const tissue *t)
{
    double off = 0;
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        const contact *c = &t->pressed.c->list[i];
        const double pull = c->active ? fmax(c->pull, 0) : 0;
        off += pull * pull * (double)t->m.inverse[own_of(t, c)];
    }
    return off;
}

/* How far the step may go along the way until a node that is free comes to the probe. */
static double feasible(const tissue *t)
{
    double most = INFINITY;
    for (int64_t i = 0; i < t->pressed.c->count && !t->pressed.p->options.penalty; i++) {
        const contact *c = &t->pressed.c->list[i];
        const double along = c->active ? 0 : pressed_along(&t->way, own_of(t, c), c);
        if (along < 0)
            most = fmin(most, fmax(room_of(t, c), 0) / -along);
    }
    return most;
}

/* ---- Newton */

/* step += alpha way, with what that leaves. Returns r . r inverse. */
static double advance(tissue *t, double alpha)
{
    keep_out(t, &t->pulled, -alpha);
    return tissue_advance(t, alpha);
}

static double change_along(tissue *t)
{
    return tissue_change(t, &t->way) + pressed_stiffen(&t->pressed, &t->way, &t->pulled);
}

/* Lets nodes go that are pulled off their planes: a step along their normals. off: of sum_off. */
static double let_go(tissue *t, double off)
{
    tissue_clear(t, &t->way);
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        contact *c = &t->pressed.c->list[i];
        const int32_t own = own_of(t, c);
        if (!c->active || !(c->pull > 0))
            continue;
        c->active = false;
        pressed_add(&t->left, own, c, c->pull);
        pressed_add(&t->way, own, c, c->pull * (double)t->m.inverse[own]);
    }
    const double curvature = change_along(t);
    return advance(t, curvature > 0 ? off / curvature : NEWTON_FIXED);
}

/* Holds a node on its plane. */
static void hold(tissue *t, contact *c)
{
    const int32_t own = own_of(t, c);
    c->active = true;
    c->pull = pressed_along(&t->left, own, c);
    pressed_add(&t->left, own, c, -c->pull);
}

/* Holds nodes that came to the probe so far along the way. */
static void meet(tissue *t, double may)
{
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        contact *c = &t->pressed.c->list[i];
        const double along = c->active ? 0 : pressed_along(&t->way, own_of(t, c), c);
        if (along < 0 && room_of(t, c) <= -along * may * 1e-6)
            hold(t, c);
    }
}

/* A step of fixed length along what is left, of which nodes that would go into the probe come to its surface, and are
 * held there; or a shorter one, where what is stiff asks for that. */
static double expand(tissue *t)
{
    tissue_turn(t, 0);
    keep_out(t, &t->way, 0);
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        contact *c = &t->pressed.c->list[i];
        const double along = pressed_along(&t->way, own_of(t, c), c), most = -room_of(t, c) / NEWTON_FIXED;
        c->meets = !c->active && along < most;
        if (c->meets)
            pressed_add(&t->way, own_of(t, c), c, most - along);
    }
    const double curvature = change_along(t), along = tissue_dot(t, &t->left, &t->way);
    const bool is_whole = !(curvature > 0) || NEWTON_FIXED * curvature <= along;
    const double free = advance(t, is_whole ? NEWTON_FIXED : fmax(along, 0) / curvature);
    for (int64_t i = 0; i < t->pressed.c->count && is_whole; i++)
        if (t->pressed.c->list[i].meets)
            hold(t, &t->pressed.c->list[i]);
    return free;
}

/* The nodes that a probe moves go their way in the step; what that pulls leaves what is left. Returns r . r inverse. */
static double begin_step(tissue *t)
{
    tissue_clear(t, &t->step);
    const bool moves = begin_contacts(t);
    keep_out(t, &t->left, 1);
    tissue_copy(t, &t->way, &t->step);
    tissue_clear(t, &t->pulled);
    if (moves)
        change_along(t);
    tissue_clear(t, &t->step);
    return advance(t, 1);
}

/* What is left where a Newton step begins, also of what would pull nodes off their planes, and what that did to those
 * that moved. */
static void note_first(tissue *t)
{
    tissue_copy(t, &t->first, &t->left);
    t->moved = 0;
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        const contact *c = &t->pressed.c->list[i];
        const double pull = c->active ? fmax(c->pull, 0) : 0;
        pressed_add(&t->first, own_of(t, c), c, pull);
        t->moved += pull * pressed_along(&t->step, own_of(t, c), c);
    }
}

/* The step that the tangent asks for, with bounds: nodes stay out of the probe (modified proportioning with reduced
 * gradient projections, MPRGP, Dostal & Schoberl 2005, Computational Optimization and Applications 30:23; Gamma = 1).
 * Returns how many products with the tangent it took. Where the tangent is not positive along a way, it stops, with
 * that way if it is the first. */
static int64_t find_step(tissue *t, int64_t most)
{
    double free = begin_step(t), off = sum_off(t), beta = 0;
    const double least = NEWTON_FORCING * (free + off);
    int64_t count = 1;
    note_first(t);
    for (; count < most && free + off > least; count++) {
        if (off > free) {
            free = let_go(t, off);
            beta = 0;
        } else {
            tissue_turn(t, beta);
            keep_out(t, &t->way, 0);
            const double curvature = change_along(t), may = feasible(t);
            if (!(curvature > 0) && count > 1)
                break;
            const double want = curvature > 0 ? free / curvature : NEWTON_FIXED, before = free;
            free = advance(t, fmin(want, may));
            beta = free / before;
            if (!(curvature > 0))
                break;
            if (want > may) {
                meet(t, may);
                free = expand(t);
                beta = 0;
                count++;
            }
        }
        off = sum_off(t);
    }
    return count;
}

/* What is left times the step, but for what presses nodes on their planes, with what penalties push. */
static double slope_of(tissue *t)
{
    double slope = tissue_dot(t, &t->left, &t->step);
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        const contact *c = &t->pressed.c->list[i];
        const double along = pressed_along(&t->step, own_of(t, c), c);
        double drag[3];
        pressed_friction(&t->pressed, c, t->u, drag);
        for (int a = 0; a < 3 && c->grip > 0; a++)
            slope += drag[a] * (double)t->step.x[a][own_of(t, c)];
        if (c->active)
            slope -= pressed_along(&t->left, own_of(t, c), c) * along;
        else if (t->pressed.p->options.penalty)
            slope += t->pressed.p->repulsion[c->node] * pressed_depth(&t->pressed, c, t->u) * along;
    }
    return slope;
}

static void shorten_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++)
            t->step.x[a][i] *= t->alpha;
}

static void shorten_by(tissue *t, double share)
{
    t->alpha = (float)share;
    tissue_nodes(t, shorten_work);
    t->moved *= share;
}

/* Shortens a step, by whose first share no node goes farther than it may, so that walls do not cross: at their nodes
 * alone, or where the tissue would not yield to what that leaves of it, at all. */
static void spare_walls(tissue *t, double first)
{
    shorten_by(t, first);
    tissue_copy(t, &t->way, &t->step);
    const double least = tissue_walls_spare(&t->m, &t->step, t->share);
    if (tissue_dot(t, &t->first, &t->step) > t->moved)
        return;
    tissue_copy(t, &t->step, &t->way);
    shorten_by(t, fmax(least, yielding));
}

/* Goes along the step as far as that does not overshoot by much. */
static void search(tissue *t)
{
    double share = fmin(1, NEWTON_STRIDE * t->pressed.p->side / longest(t));
    if (t->m.walls > t->m.lumens) {
        spare_walls(t, share);
        share = 1;
    }
    line_search s = line_search_begin(tissue_dot(t, &t->first, &t->step) - t->moved, share);
    do {
        go(t, s.share);
        find_left(t);
    } while (line_search_next(&s, slope_of(t)));
}

/* The forces of contact, and what is left then, over the load. */
static void conclude(tissue *t)
{
    double square = t->square[SUM_LEFT], load = t->square[SUM_LOAD];
    for (int64_t i = 0; i < t->pressed.c->count; i++) {
        contact *c = &t->pressed.c->list[i];
        const double held = c->active ? fmax(-pressed_along(&t->left, own_of(t, c), c), 0) : 0;
        c->force = t->pressed.p->options.penalty
                       ? t->pressed.p->repulsion[c->node] * pressed_depth(&t->pressed, c, t->u)
                       : held;
        pressed_drag(&t->pressed, c, t->u);
        pressed_count(&t->pressed, c, &t->left, t->weight, &square, &load);
    }
    for (int c = 0; c < t->pressed.p->cavities; c++)
        load += t->pressed.p->cavity[c].pressure * t->pressed.p->cavity[c].pressure * t->pushed[c];
    load = fmax(fmax(load, t->square[SUM_PULL]), t->pressed.p->slight);
    t->residual = load > 0 ? sqrt(fmax(0, square) / load) : 0;
}

/* Holds pressures, but not of a state that is far from balance, where they mean nothing. */
void tissue_begin(tissue *t, double elapsed)
{
    for (int64_t i = 0; i < t->m.points && t->residual < NEWTON_BALANCED; i++)
        t->m.held[i] = t->m.keep[i] * t->m.pressure[i];
    tissue_rest_fill(t, elapsed);
    find_left(t);
}

int64_t tissue_step(tissue *t, int64_t most)
{
    if (t->m.walls > t->m.lumens)
        tissue_walls_brace(&t->m);
    pressed_push(&t->pressed, t->u, &t->left);
    tissue_copy(t, &t->started, t->u);
    const int64_t took = find_step(t, most);
    search(t);
    conclude(t);
    return took + 1;
}

/* ---- life */

int tissue_make(tissue *t, const msds_problem *p, const sell *s, contacts *c, const lanes *loops, pool *threads,
                lanes_field *u, lanes_field *weight, err *e)
{
    *t = (tissue){.pressed = {p, s, c}, .loops = loops, .threads = threads, .u = u, .weight = weight};
    lanes_field *fields[FIELDS] = {&t->step, &t->left, &t->way, &t->pulled, &t->started, &t->first};
    t->share = mem_array(s->nodes, sizeof *t->share, "the solver", e);
    t->sum = mem_array(pool_chunks(s->count, SELL_CHUNK), sizeof *t->sum, "the solver", e);
    t->sums = mem_array(pool_chunks(s->count, SELL_CHUNK), SUMS * sizeof *t->sums, "the solver", e);
    for (int i = 0; t->share && t->sum && t->sums && i < FIELDS; i++)
        if (lanes_field_make(fields[i], s->nodes, e))
            return -1;
    return t->share && t->sum && t->sums && !tissue_mesh_make(&t->m, p, s, e) ? tissue_rest_make(t, e) : -1;
}

void tissue_reset(tissue *t)
{
    for (int64_t i = 0; i < t->m.points; i++)
        t->m.held[i] = t->m.pressure[i] = 0;
    t->residual = 0;
}

void tissue_free(tissue *t)
{
    lanes_field *fields[FIELDS] = {&t->step, &t->left, &t->way, &t->pulled, &t->started, &t->first};
    for (int i = 0; i < FIELDS; i++)
        lanes_field_free(fields[i]);
    free(t->sum);
    free(t->sums);
    free(t->pushed);
    free(t->share);
    tissue_mesh_free(&t->m);
    *t = (tissue){.alpha = 0};
}

int64_t tissue_bytes(const tissue *t)
{
    return tissue_mesh_bytes(&t->m) + FIELDS * 12 * (t->pressed.s->nodes + 2 * LANES);
}
