#include "tled/problem/support.h"

#include "base/mem.h"
#include "tled/problem/films.h"
#include "tled/problem/followers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A search outwards: nodes in the order in which they were reached. */
typedef struct search {
    int32_t *steps, *queue; /* nodes: from where it began, or -1; nodes */
    uint8_t *spread;        /* elements: whether all of its nodes were reached from one of them */
    int64_t count;
} search;

static void reach_node(search *s, int32_t node, int32_t step)
{
    if (s->steps[node] >= 0)
        return;
    s->steps[node] = step;
    s->queue[s->count++] = node;
}

/* Goes on from node `at` of the queue: a node is one step farther than the nearest node of an element that it is in.
 * The first of an element's nodes is its nearest, so that the others reach nothing through it. */
static void spread(const tled_problem *p, search *s, int64_t at)
{
    for (; at < s->count; at++) {
        int64_t node = s->queue[at];
        const int64_t first = p->corner_start ? p->corner_start[node] : 8 * node;
        const int64_t end = p->corner_start ? p->corner_start[node + 1] : first + 8;
        for (int64_t i = first; i < end && p->corner[i] < p->elements * 8; i++) {
            const int64_t element = p->corner[i] / 8;
            if (s->spread[element])
                continue;
            s->spread[element] = 1;
            for (int c = 0; c < 8; c++)
                reach_node(s, p->element_node[8 * element + c], s->steps[node] + 1);
        }
    }
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
static void find_loose(const tled_problem *p, search *s, support *of)
{
    of->first = -1;
    for (int64_t i = 0; i < p->elements; i++)
        if (s->steps[p->element_node[8 * i]] < 0) {
            of->first = of->first < 0 ? i : of->first;
            of->in_them++;
        }
    for (int64_t n = 0; n < p->nodes; n++)
        if (s->steps[n] < 0) {
            int64_t at = s->count;
            of->loose++;
            reach_node(s, (int32_t)n, 0);
            spread(p, s, at);
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

/* Whether each node is held in all components or in none. */
static bool is_held_alike(const tled_problem *p)
{
    bool alike = true;
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        alike &= (p->hold[i] != HOLD_FREE) == (p->hold[i / 3 * 3] != HOLD_FREE);
    return alike;
}

/* A search from the nodes that are held in any of these components (bits). Returns how many steps away the farthest
 * is. */
static int32_t search_from_held(const tled_problem *p, search *s, unsigned components)
{
    s->count = 0;
    for (int64_t n = 0; n < p->nodes; n++)
        s->steps[n] = -1;
    memset(s->spread, 0, (size_t)p->elements);
    for (int64_t n = 0; n < p->nodes; n++)
        if (is_held(p, n, components))
            reach_node(s, (int32_t)n, 0);
    for (int64_t i = 0; i < p->slides; i++) /* bone holds them along its normal, which is of any component */
        if (!p->slide_lifts || !p->slide_lifts[i])
            reach_node(s, p->slide[i], 0);
    for (int64_t i = 0; p->films && i < p->films->nodes; i++) /* films hold all components */
        reach_node(s, p->films->node[i], 0);
    spread(p, s, 0);
    return s->count ? s->steps[s->queue[s->count - 1]] : 0;
}

/* Of gravity's largest component: what is no more has come of turning it. */
static const double rounding = 1e-9;

/* The first element that gravity pulls along an axis, and that the search from nodes held along that axis did not
 * reach; or -1. */
static int64_t find_falling(const tled_problem *p, const search *s, int axis)
{
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
static int32_t search_components(const tled_problem *p, search *s, support *of)
{
    int32_t farthest = 0;
    for (int a = 0; a < 3; a++) {
        const int32_t steps = search_from_held(p, s, 1u << a);
        const int64_t falling = find_falling(p, s, a);
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
    search s = {mem_array(p->nodes, sizeof *s.steps, "what is held", e),
                mem_array(p->nodes, sizeof *s.queue, "what is held", e),
                mem_array(p->elements, sizeof *s.spread, "what is held", e), 0};
    const bool done = s.steps && s.queue && s.spread;
    *of = (support){.falling = -1};
    if (done) {
        const bool alike = is_held_alike(p);
        const int32_t apart = alike ? 0 : search_components(p, &s, of), whole = search_from_held(p, &s, 7);
        const int32_t farthest = alike && s.count ? whole + !whole : apart; /* where all is held, one */
        of->reach = farthest ? farthest * fmax(p->side[0], fmax(p->side[1], p->side[2])) : diagonal(p);
        find_loose(p, &s, of);
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
