#include "tled/contact/contact_near.h"

#include <math.h>
#include <string.h>

enum { ELEMENTS_CHUNK = 64, SAMPLES_CHUNK = 64 };

static void place_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const self_contact_work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        contact_place(w->c, w->x, i, w->table.at + 3 * i);
}

static void box_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const self_contact_work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        contact_box(w->c, w->x, &w->table, i);
}

/* The size of the largest element that is in a cell, and w->side. */
static double find_largest(self_contact_work *w)
{
    const contact_table *t = &w->table;
    int32_t longer[CONTACT_SIZES] = {0};
    double longest = 0, widest = 0;
    for (int64_t i = 0; i < w->c->elements; i++) {
        const double length = contact_longest(t->low + 3 * i, t->high + 3 * i);
        longest = fmax(longest, length);
        widest = fmax(widest, contact_longest(t->sampled + 6 * i, t->sampled + 6 * i + 3));
        for (int k = 0; k < CONTACT_SIZES; k++)
            longer[k] += length > contact_size(w->c, k);
    }
    const double largest = contact_largest(w->c, longest, longer);
    w->side = contact_side(w->c, largest, widest);
    return largest;
}

/* Elements by cells. */
static void table_elements(self_contact_work *w)
{
    const contact_table *t = &w->table;
    const int64_t elements = w->c->elements;
    const double largest = find_largest(w);
    w->large = 0;
    memset(t->filled, 0, (size_t)t->cells * sizeof *t->filled);
    for (int64_t i = 0; i < elements; i++) {
        const double *low = t->low + 3 * i, *high = t->high + 3 * i;
        t->cell[i] = contact_longest(low, high) > largest ? -1 : contact_cell(t, w->side, low, high, CONTACT_HERE);
        if (t->cell[i] >= 0)
            t->filled[t->cell[i]]++;
    }
    for (int64_t k = 0, start = 0; k < t->cells; start += t->filled[k++])
        t->start[k] = (int32_t)start;
    memset(t->filled, 0, (size_t)t->cells * sizeof *t->filled);
    for (int64_t i = 0; i < elements; i++)
        if (t->cell[i] >= 0)
            t->of[t->start[t->cell[i]] + t->filled[t->cell[i]]++] = (int32_t)i;
        else
            t->of[elements - ++w->large] = (int32_t)i;
}

static void list_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const self_contact_work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        contact_list(w->c, &w->table, w->side, w->large, i);
}

/* The most that a node has come since the list, m; infinite before the first, and where one is nowhere. */
static double come_since(const self_contact_work *w)
{
    double most = w->is_listed ? 0 : INFINITY;
    for (int64_t n = 0; n < w->c->nodes; n++) {
        double way = 0;
        for (int a = 0; a < 3; a++) {
            const double d = w->x[3 * n + a] - w->listed[3 * n + a];
            way += d * d;
        }
        if (!(way <= most))
            most = isnan(way) ? INFINITY : way;
    }
    return sqrt(most);
}

static void move_nodes(self_contact_work *w)
{
    double most = 0;
    for (int64_t n = 0; n < w->c->nodes; n++) {
        double square = 0;
        for (int a = 0; a < 3; a++) {
            const int64_t i = 3 * n + a;
            const double to = w->p->position[3 * (int64_t)w->c->node[n] + a] + w->u[i];
            square += (to - w->x[i]) * (to - w->x[i]);
            w->x[i] = to;
        }
        most = fmax(most, square);
    }
    w->drift = w->is_listed ? w->drift + sqrt(most) : 0;
}

void contact_near_list(self_contact_work *w, pool *threads)
{
    move_nodes(w);
    const double come = come_since(w);
    const bool lists = come > CONTACT_LISTED * w->c->shortest;
    w->spare = contact_spare(w->c, lists ? 0 : come);
    if (!lists)
        return;
    memcpy(w->listed, w->x, 3 * (size_t)w->c->nodes * sizeof *w->x);
    pool_run(threads, w->c->samples, SAMPLES_CHUNK, place_work, w);
    pool_run(threads, w->c->elements, ELEMENTS_CHUNK, box_work, w);
    table_elements(w);
    pool_run(threads, w->c->elements, ELEMENTS_CHUNK, list_work, w);
    w->nears = 0;
    for (int64_t i = 0; i < w->c->samples; i++)
        if (w->table.count[w->c->sample_element[i]])
            w->near[w->nears++] = (int32_t)i;
    w->is_listed = true;
}
