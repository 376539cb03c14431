#include "tled/contact/contact_near.h"

#include <math.h>
#include <string.h>

enum { ELEMENTS_CHUNK = 64 };

static void box_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const self_contact_work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        contact_box(w->c, w->x, &w->table, i);
}

/* Elements by cells. */
static void table_elements(self_contact_work *w)
{
    const contact_table *t = &w->table;
    double longest = 0, widest = 0;
    for (int64_t i = 0; i < w->c->elements; i++) {
        longest = fmax(longest, contact_longest(t->low + 3 * i, t->high + 3 * i));
        widest = fmax(widest, contact_longest(t->sampled + 6 * i, t->sampled + 6 * i + 3));
    }
    w->side = contact_side(w->c, longest, widest);
    for (int64_t k = 0; k < t->cells; k++)
        t->first[k] = -1;
    for (int64_t i = 0; i < w->c->elements; i++) {
        int32_t *first = &t->first[contact_cell(t, w->side, t->low + 3 * i, t->high + 3 * i, CONTACT_HERE)];
        t->next[i] = *first;
        *first = (int32_t)i;
    }
}

static void list_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const self_contact_work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        contact_list(w->c, &w->table, w->side, i);
}

static bool has_moved(const self_contact_work *w)
{
    const double most = CONTACT_LISTED * w->c->shortest, square = most * most;
    for (int64_t n = 0; n < w->c->nodes; n++) {
        double way = 0;
        for (int a = 0; a < 3; a++) {
            const double d = w->x[3 * n + a] - w->listed[3 * n + a];
            way += d * d;
        }
        if (!(way <= square))
            return true;
    }
    return false;
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
    w->drift += sqrt(most);
}

void contact_near_list(self_contact_work *w, pool *threads)
{
    move_nodes(w);
    if (w->is_listed && !has_moved(w))
        return;
    memcpy(w->listed, w->x, 3 * (size_t)w->c->nodes * sizeof *w->x);
    pool_run(threads, w->c->elements, ELEMENTS_CHUNK, box_work, w);
    table_elements(w);
    pool_run(threads, w->c->elements, ELEMENTS_CHUNK, list_work, w);
    w->nears = 0;
    for (int64_t i = 0; i < w->c->samples; i++)
        if (w->table.count[w->c->sample_element[i]])
            w->near[w->nears++] = (int32_t)i;
    w->is_listed = true;
}
