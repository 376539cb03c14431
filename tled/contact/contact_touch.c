#include "tled/contact/contact_touch.h"

#include "tled/contact/contact_blend.h"
#include "tled/contact/contact_near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES_CHUNK = 32 };

/* A candidate, and how far its middle is from a sample, squared. */
typedef struct nearness {
    double square;
    int32_t element;
} nearness;

/* The candidates whose boxes hold x, the nearest middle first. */
static int sort_candidates(const self_contact_work *w, int64_t sample, const double x[3], nearness *to)
{
    const int32_t element = w->c->sample_element[sample];
    const int32_t *list = w->table.candidate + CONTACT_CANDIDATES * (int64_t)element;
    int count = 0;
    for (int32_t k = 0; k < w->table.count[element]; k++) {
        if (!contact_in_box(&w->table, list[k], x, w->spare))
            continue;
        const deformed_map d = contact_map(w->c, w->x, list[k]);
        const double square = deformed_from_middle(&d, x);
        int at = count++;
        for (; at > 0 && to[at - 1].square > square; at--)
            to[at] = to[at - 1];
        to[at] = (nearness){square, list[k]};
    }
    return count;
}

/* Where skin is blended: from the place in an element whose own motion goes to x to the one whose blended motion does,
 * to second order in what the two differ by. */
static bool blend_place(const self_contact_work *w, int32_t element, const double x[3], double xi[3])
{
    const contact_blend *b = w->c->blend;
    const int32_t *node = b->node + BLEND_MOST * (int64_t)element;
    const deformed_map d = contact_map(w->c, w->x, element);
    for (int turn = 0; turn < CONTACT_TURNS; turn++) {
        double share[BLEND_MOST], way[3] = {x[0], x[1], x[2]};
        contact_blend_shares(b, element, xi, share);
        for (int k = 0; k < b->count[element]; k++)
            for (int a = 0; a < 3; a++)
                way[a] -= share[k] * w->x[3 * (int64_t)node[k] + a];
        if (!deformed_go(&d, way, xi))
            return false;
    }
    return deformed_outside(xi) < CONTACT_BEYOND;
}

/* The nodes that move a place in an element, and their shares. */
static void take_shares(const self_contact_work *w, const double place[3], touch *t)
{
    if (w->c->blend) {
        t->count = contact_blend_lever(w->c->blend, t->element, place, t->node, t->share);
        return;
    }
    t->count = 8;
    memcpy(t->node, w->c->element + 8 * (int64_t)t->element, 8 * sizeof *t->node);
    deformed_shares(place, t->share);
}

/* The element that holds a sample, or else the one that it is least outside of; -1: none within CONTACT_BEYOND. */
static int32_t find_element(const self_contact_work *w, int64_t sample, const double x[3], double place[3])
{
    nearness list[CONTACT_CANDIDATES];
    const int count = sort_candidates(w, sample, x, list);
    double least = CONTACT_BEYOND;
    int32_t found = -1;
    for (int k = 0; k < count && least > 0; k++) {
        double xi[3];
        const deformed_map d = contact_map(w->c, w->x, list[k].element);
        if (!deformed_place(&d, x, xi))
            continue;
        const double outside = deformed_outside(xi);
        if (outside < least) {
            least = outside;
            found = list[k].element;
            memcpy(place, xi, sizeof xi);
        }
    }
    return found;
}

/* Tells whether some element has a node of each of the two. */
static bool have_neighbour(const self_contact *c, int32_t one, int32_t other)
{
    const int32_t from = c->ring_start[one], count = c->ring_start[one + 1] - from;
    for (int k = 0; k < 8; k++)
        if (bsearch(&c->element[8 * (int64_t)other + k], c->ring + from, (size_t)count, sizeof *c->ring,
                    contact_by_number))
            return true;
    return false;
}

/* Tells whether a sample is nearer to other skin than at rest. If it is not, `clear` gets how far it may still go, m.
 */
static bool find_touch(const self_contact_work *w, int64_t sample, touch *t, double *clear)
{
    double x[3], place[3];
    contact_place(w->c, w->x, sample, x);
    t->sample = (int32_t)sample;
    t->sides = 2;
    t->carried[0] = t->carried[1] = t->carried[2] = 0;
    t->element = find_element(w, sample, x, place);
    *clear = CONTACT_MARGIN * w->c->shortest;
    if (t->element < 0 || (w->c->blend && !blend_place(w, t->element, x, place)) ||
        !contact_is_in(w->c, w->x, place, t, clear) ||
        !contact_faces(w->c, w->x, place, have_neighbour(w->c, w->c->sample_element[sample], t->element), t))
        return false;
    take_shares(w, place, t);
    return true;
}

static void touch_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const self_contact_work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const int32_t sample = w->near[i];
        double clear = 0;
        w->touch[i].node = w->place_node + i * w->place_most;
        w->touch[i].share = w->place_share + i * w->place_most;
        if (w->drift < w->until[sample] || !find_touch(w, sample, &w->touch[i], &clear))
            w->touch[i].element = -1;
        if (clear > 0)
            w->until[sample] = w->drift + CONTACT_SPARE * clear;
    }
}

void contact_touches(self_contact_work *w, pool *threads)
{
    contact_near_list(w, threads);
    pool_run(threads, w->nears, SAMPLES_CHUNK, touch_work, w);
    w->touches = 0;
    for (int64_t i = 0; i < w->nears; i++)
        if (w->touch[i].element >= 0)
            w->touch[w->touches++] = w->touch[i];
}
