#include "tled/problem/support.h"

#include "base/mem.h"
#include "tled/problem/films.h"
#include "tled/problem/followers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 256, NODES = 4096 }; /* nodes of a queue, which have elements each; nodes */

/* A search outwards: nodes step by step. Steps do not depend on the order of nodes within one, which threads share. */
typedef struct search {
    const tled_problem *p;
    int32_t *steps, *queue; /* nodes: from where it began, or -1; nodes */
    uint8_t *spread;        /* elements: whether all of its nodes were reached from one of them */
    int64_t count;          /* of the queue */
    int64_t from;           /* of the queue: those that are as far as is gone on from */
    unsigned components;    /* that it begins from nodes held in, as bits */
    bool is_shared;         /* by threads */
} search;

/* Nodes that a thread reached, on their way to the queue. */
typedef struct reached {
    search *s;
    int count;
    int32_t node[CHUNK];
} reached;

static void flush(reached *r)
{
    const int64_t at = __atomic_fetch_add(&r->s->count, r->count, __ATOMIC_RELAXED);
    memcpy(r->s->queue + at, r->node, (size_t)r->count * sizeof *r->node);
    r->count = 0;
}

/* Whether this thread is the first to reach a node. One that is alone spares the lock, which holds up all its reads. */
static bool is_first(const search *s, int32_t node, int32_t step)
{
    int32_t none = -1, *at = &s->steps[node];
    if (__atomic_load_n(at, __ATOMIC_RELAXED) >= 0)
        return false;
    if (s->is_shared)
        return __atomic_compare_exchange_n(at, &none, step, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
    *at = step;
    return true;
}

static void reach_node(reached *r, int32_t node, int32_t step)
{
    if (!is_first(r->s, node, step))
        return;
    if (r->count == CHUNK)
        flush(r);
    r->node[r->count++] = node;
}

/* Goes on from a node: another is one step farther than the nearest node of an element that it is in. The first of an
 * element's nodes is its nearest, so that the others reach nothing through it. */
static void spread_from(reached *r, int64_t node)
{
    const tled_problem *p = r->s->p;
    const int32_t step = __atomic_load_n(&r->s->steps[node], __ATOMIC_RELAXED) + 1;
    const int64_t first = p->corner_start ? p->corner_start[node] : 8 * node;
    const int64_t end = p->corner_start ? p->corner_start[node + 1] : first + 8;
    for (int64_t i = first; i < end && p->corner[i] < p->elements * 8; i++) {
        uint8_t *spread = &r->s->spread[p->corner[i] / 8];
        if (__atomic_load_n(spread, __ATOMIC_RELAXED))
            continue;
        __atomic_store_n(spread, 1, __ATOMIC_RELAXED);
        for (int c = 0; c < 8; c++)
            reach_node(r, p->element_node[p->corner[i] / 8 * 8 + c], step);
    }
}

static void spread_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    reached r = {.s = context};
    (void)chunk;
    for (int64_t at = from; at < to; at++)
        spread_from(&r, r.s->queue[r.s->from + at]);
    flush(&r);
}

/* Goes on from node `at` of the queue and those behind it, which are equally far. Returns how many steps away the
 * farthest is from where it began; 0: there are none. */
static int32_t spread(search *s, int64_t at)
{
    for (s->from = at; s->from < s->count;) {
        const int64_t end = s->count;
        pool_run(s->p->threads, end - s->from, CHUNK, spread_work, s);
        if (s->count == end)
            return s->steps[s->queue[end - 1]];
        s->from = end;
    }
    return 0;
}

static double diagonal(const tled_problem *p)
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        double low = INFINITY, high = -INFINITY;
        for (int64_t n = 0; n < p->nodes; n++) {
            low = fmin(low, p->position[3 * n + a]);
            high = fmax(high, p->position[3 * n + a]);
        }
        square += (high - low) * (high - low);
    }
    return sqrt(square);
}

static bool is_pushed(const tled_problem *p, int64_t node)
{
    return p->gravity >= 0 || p->force_start[node + 1] > p->force_start[node] || followers_push(p->followers, node);
}

/* What the search from held nodes did not reach, part by part. */
static void find_loose(search *s, support *of)
{
    const tled_problem *p = s->p;
    of->first = -1;
    if (s->count == p->nodes)
        return;
    for (int64_t i = 0; i < p->elements; i++)
        if (s->steps[p->element_node[8 * i]] < 0) {
            of->first = of->first < 0 ? i : of->first;
            of->in_them++;
        }
    for (int64_t n = 0; n < p->nodes; n++)
        if (s->steps[n] < 0) {
            int64_t at = s->count;
            reached r = {.s = s};
            of->loose++;
            reach_node(&r, (int32_t)n, 0);
            flush(&r);
            spread(s, at);
            for (; at < s->count; at++)
                of->pushed |= is_pushed(p, s->queue[at]);
        }
}

static bool is_held(const tled_problem *p, int64_t node, unsigned components)
{
    bool held = false;
    for (int a = 0; a < 3; a++)
        held |= (components >> a & 1) && p->hold[3 * node + a] != HOLD_FREE;
    return held;
}

typedef struct comparison {
    const tled_problem *p;
    bool differs;
} comparison;

static void compare_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    comparison *c = context;
    bool differs = false;
    (void)chunk;
    for (const int32_t *hold = c->p->hold + 3 * from; hold < c->p->hold + 3 * to; hold += 3)
        for (int a = 1; a < 3; a++)
            differs |= (hold[a] != HOLD_FREE) != (hold[0] != HOLD_FREE);
    if (differs)
        __atomic_store_n(&c->differs, true, __ATOMIC_RELAXED);
}

/* Whether each node is held in all components or in none. */
static bool is_held_alike(const tled_problem *p)
{
    comparison c = {p, false};
    pool_run(p->threads, p->nodes, NODES, compare_work, &c);
    return !c.differs;
}

static void begin_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    reached r = {.s = context};
    (void)chunk;
    for (int64_t n = from; n < to; n++) {
        r.s->steps[n] = -1;
        if (is_held(r.s->p, n, r.s->components))
            reach_node(&r, (int32_t)n, 0);
    }
    flush(&r);
}

/* A search from the nodes that are held in any of these components (bits). Returns how many steps away the farthest
 * is. */
static int32_t search_from_held(search *s, unsigned components)
{
    const tled_problem *p = s->p;
    reached r = {.s = s};
    s->count = 0;
    s->components = components;
    memset(s->spread, 0, (size_t)p->elements);
    pool_run(p->threads, p->nodes, NODES, begin_work, s);
    for (int64_t i = 0; i < p->slides; i++) /* bone holds them along its normal, which is of any component */
        if (!p->slide_lifts || !p->slide_lifts[i])
            reach_node(&r, p->slide[i], 0);
    for (int64_t i = 0; p->films && i < p->films->nodes; i++) /* films hold all components */
        reach_node(&r, p->films->node[i], 0);
    flush(&r);
    return spread(s, 0);
}

/* Of gravity's largest component: what is no more has come of turning it. */
static const double rounding = 1e-9;

/* The first element that gravity pulls along an axis, and that the search from nodes held along that axis did not
 * reach; or -1. */
static int64_t find_falling(const search *s, int axis)
{
    const tled_problem *p = s->p;
    const script_curve *g = p->gravity < 0 ? NULL : &p->script->curve[p->gravity];
    double along = 0, largest = 0;
    for (int32_t i = 0; g && i < 3 * g->key_count; i++) {
        const double value = fabs(p->script->value[3 * (int64_t)g->key_first + i]);
        largest = fmax(largest, value);
        along = i % 3 == axis ? fmax(along, value) : along;
    }
    const bool pulls = along > rounding * largest;
    for (int64_t i = 0; pulls && i < p->elements; i++)
        if (s->steps[p->element_node[8 * i]] < 0)
            return i;
    return -1;
}

/* Components one by one: each has waves of its own between the nodes that are held in it. */
static int32_t search_components(search *s, support *of)
{
    int32_t farthest = 0;
    for (int a = 0; a < 3; a++) {
        const int32_t steps = search_from_held(s, 1u << a);
        const int64_t falling = find_falling(s, a);
        farthest = steps > farthest ? steps : farthest;
        if (of->falling < 0 && falling >= 0) {
            of->falling = falling;
            of->falls_along = a;
        }
    }
    return farthest;
}

int support_of(const tled_problem *p, support *of, err *e)
{
    search s = {.p = p,
                .steps = mem_array(p->nodes, sizeof *s.steps, "what is held", e),
                .queue = mem_array(p->nodes, sizeof *s.queue, "what is held", e),
                .spread = mem_array(p->elements, sizeof *s.spread, "what is held", e),
                .is_shared = p->threads && pool_threads(p->threads) > 1};
    const bool done = s.steps && s.queue && s.spread;
    *of = (support){.falling = -1};
    if (done) {
        const bool alike = is_held_alike(p);
        const int32_t apart = alike ? 0 : search_components(&s, of), whole = search_from_held(&s, 7);
        const int32_t farthest = alike && s.count ? whole + !whole : apart; /* where all is held, one */
        of->reach = farthest ? farthest * fmax(p->side[0], fmax(p->side[1], p->side[2])) : diagonal(p);
        find_loose(&s, of);
    }
    free(s.steps);
    free(s.queue);
    free(s.spread);
    return done ? 0 : -1;
}

/* ---- what is wrong with it */

static int check_loose(const support *of, const tled_problem *p, bool to_rest, notes *warnings, err *e)
{
    char what[200] = "the model: no node is rigid or displaced";
    if ((p->held || p->films) && of->loose)
        snprintf(what, sizeof what, "%lld %s of the model, %lld elements, the first of them %lld (volume '%.100s')",
                 (long long)of->loose, of->loose == 1 ? "part" : "parts", (long long)of->in_them, (long long)of->first,
                 p->volume[p->element_volume[of->first]].name);
    if (of->pushed && to_rest)
        return err_set(e, NULL, 0,
                       "nothing holds %s, so that it never comes to rest under a load; expected rigid nodes (attach "
                       "makes them), or -t or -n to end",
                       what);
    if (of->loose)
        notes_add(warnings, "nothing holds %s", what);
    return 0;
}

int support_check(const support *of, const tled_problem *p, bool to_rest, bool pressed, notes *warnings, err *e)
{
    char what[300];
    if (of->loose || of->falling < 0)
        return check_loose(of, p, to_rest, warnings, e);
    snprintf(what, sizeof what, "the part of element %lld (volume '%.100s') along %c, where gravity pulls it",
             (long long)of->falling, p->volume[p->element_volume[of->falling]].name, "xyz"[of->falls_along]);
    if (to_rest && !pressed && !p->force_start[p->nodes] && !p->followers)
        return err_set(e, NULL, 0,
                       "nothing holds %s, so that it never comes to rest; expected nodes that are held in that "
                       "component, or -t or -n to end",
                       what);
    notes_add(warnings, "nothing holds %s", what);
    return 0;
}
