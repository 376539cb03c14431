#include "tled/contact/contact_near.h"

#include "surface/hash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ELEMENTS_CHUNK = 64 };

/* Between the skin's normals at the middles of elements, cosine: what faces as much the same way is not listed. */
static const double listed_facing = .8;

void contact_place(const self_contact_work *w, int64_t sample, double x[3])
{
    const self_contact *c = w->c;
    x[0] = x[1] = x[2] = 0;
    for (int32_t k = c->lever_start[sample]; k < c->lever_start[sample + 1]; k++)
        for (int a = 0; a < 3; a++)
            x[a] += c->lever_share[k] * w->x[3 * (int64_t)c->lever_node[k] + a];
}

static int32_t cell_of(const self_contact_work *w, const int64_t at[3])
{
    return (int32_t)(hash_next(hash_next(hash_mix((uint64_t)at[0]), (uint64_t)at[1]), (uint64_t)at[2]) &
                     (uint64_t)(w->cells - 1));
}

static void cell_at(const self_contact_work *w, const double x[3], int64_t at[3])
{
    for (int a = 0; a < 3; a++)
        at[a] = (int64_t)fmin(fmax(floor(x[a] / w->side), -1e15), 1e15);
}

deformed_map contact_map(const self_contact_work *w, int32_t element)
{
    double corner[8][3];
    for (int k = 0; k < 8; k++) {
        const int64_t n = w->c->element[8 * (int64_t)element + k];
        for (int a = 0; a < 3; a++)
            corner[k][a] = w->x[3 * n + a];
    }
    return deformed_map_of(corner);
}

/* The boxes of the elements, with margins, and the skin's normal at their middles. */
static void box_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    static const double half[3] = {.5, .5, .5};
    const self_contact_work *w = context;
    const self_contact *c = w->c;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const deformed_map d = contact_map(w, (int32_t)i);
        deformed_slope(&d, half, &c->distance[i], w->middle + 3 * i);
        for (int a = 0; a < 3; a++) {
            double low = INFINITY, high = -INFINITY;
            for (int k = 0; k < 8; k++) {
                const double x = w->x[3 * (int64_t)c->element[8 * i + k] + a];
                low = x < low ? x : low;
                high = x > high ? x : high;
            }
            const double over = CONTACT_BEYOND * (high - low) + CONTACT_MARGIN * c->shortest;
            w->low[3 * i + a] = low - over;
            w->high[3 * i + a] = high + over;
            w->sampled[6 * i + a] = INFINITY;
            w->sampled[6 * i + 3 + a] = -INFINITY;
        }
    }
}

/* The boxes of the elements' samples; and the side of cells: an element's box that meets a box of samples has its
 * middle in the cell of that one's, or in one beside it. */
static void box_samples(self_contact_work *w)
{
    const self_contact *c = w->c;
    double longest = 0, widest = 0;
    for (int64_t i = 0; i < c->samples; i++) {
        double x[3], *box = w->sampled + 6 * (int64_t)c->sample_element[i];
        contact_place(w, i, x);
        for (int a = 0; a < 3; a++) {
            box[a] = x[a] < box[a] ? x[a] : box[a];
            box[3 + a] = x[a] > box[3 + a] ? x[a] : box[3 + a];
        }
    }
    for (int64_t i = 0; i < 3 * c->elements; i++) {
        const double *box = w->sampled + 6 * (i / 3) + i % 3;
        longest = fmax(longest, w->high[i] - w->low[i]);
        widest = fmax(widest, box[3] - box[0]);
    }
    w->side = fmax((longest + widest) / 2, c->shortest);
}

/* Elements by cells, ascending in each: those of cell k begin at start[k + 1]. */
static void table_elements(self_contact_work *w)
{
    const self_contact *c = w->c;
    memset(w->start, 0, (size_t)(w->cells + 1) * sizeof *w->start);
    for (int64_t i = 0; i < c->elements; i++) {
        double middle[3];
        int64_t at[3];
        for (int a = 0; a < 3; a++)
            middle[a] = (w->low[3 * i + a] + w->high[3 * i + a]) / 2;
        cell_at(w, middle, at);
        w->cell[i] = cell_of(w, at);
        w->start[w->cell[i] + 1]++;
    }
    for (int64_t k = 0; k < w->cells; k++)
        w->start[k + 1] += w->start[k];
    for (int64_t i = c->elements; i-- > 0;)
        w->of[--w->start[w->cell[i] + 1]] = (int32_t)i;
}

bool contact_have_neighbour(const self_contact_work *w, int32_t one, int32_t other)
{
    const int32_t from = w->c->ring_start[one], count = w->c->ring_start[one + 1] - from;
    for (int k = 0; k < 8; k++)
        if (bsearch(&w->c->element[8 * (int64_t)other + k], w->c->ring + from, (size_t)count, sizeof *w->c->ring,
                    contact_by_number))
            return true;
    return false;
}

static bool share_node(const self_contact *c, int32_t one, int32_t other)
{
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 8; k++)
            if (c->element[8 * (int64_t)one + i] == c->element[8 * (int64_t)other + k])
                return true;
    return false;
}

bool contact_in_box(const self_contact_work *w, int32_t element, const double x[3])
{
    for (int a = 0; a < 3; a++)
        if (!(x[a] >= w->low[3 * (int64_t)element + a] && x[a] <= w->high[3 * (int64_t)element + a]))
            return false;
    return true;
}

/* Whether samples of one element may be in the other. */
static bool may_touch(const self_contact_work *w, int32_t one, int32_t other)
{
    const double *box = w->sampled + 6 * (int64_t)one;
    const double *n = w->middle + 3 * (int64_t)one, *m = w->middle + 3 * (int64_t)other;
    for (int a = 0; a < 3; a++)
        if (!(box[3 + a] >= w->low[3 * (int64_t)other + a] && box[a] <= w->high[3 * (int64_t)other + a]))
            return false;
    return n[0] * m[0] + n[1] * m[1] + n[2] * m[2] < listed_facing && !share_node(w->c, one, other);
}

/* Keeps ascending elements, once each: two cells of space may be one of the table. */
static void add_candidate(self_contact_work *w, int64_t to, int32_t element)
{
    int32_t *list = w->candidate + CANDIDATES * to, n = w->count[to], at = n;
    while (at > 0 && list[at - 1] >= element)
        at--;
    if ((at < n && list[at] == element) || at == CANDIDATES)
        return;
    n = n < CANDIDATES ? n + 1 : n;
    memmove(list + at + 1, list + at, (size_t)(n - 1 - at) * sizeof *list);
    list[at] = element;
    w->count[to] = n;
}

static void list_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    self_contact_work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const double *box = w->sampled + 6 * i;
        double middle[3];
        int64_t cell[3];
        w->count[i] = 0;
        if (!(box[0] <= box[3]))
            continue;
        for (int a = 0; a < 3; a++)
            middle[a] = (box[a] + box[3 + a]) / 2;
        cell_at(w, middle, cell);
        for (int n = 0; n < 27; n++) {
            const int64_t at[3] = {cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1};
            const int32_t k = cell_of(w, at);
            const int32_t last = k + 2 <= w->cells ? w->start[k + 2] : (int32_t)w->c->elements;
            for (int32_t j = w->start[k + 1]; j < last; j++)
                if (may_touch(w, (int32_t)i, w->of[j]))
                    add_candidate(w, i, w->of[j]);
        }
    }
}

static bool has_moved(const self_contact_work *w)
{
    /* A sample and an element both move by as much at most, and what is extrapolated by more. */
    const double most = CONTACT_MARGIN / 8 * w->c->shortest, square = most * most;
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
    box_samples(w);
    table_elements(w);
    pool_run(threads, w->c->elements, ELEMENTS_CHUNK, list_work, w);
    w->nears = 0;
    for (int64_t i = 0; i < w->c->samples; i++)
        if (w->count[w->c->sample_element[i]])
            w->near[w->nears++] = (int32_t)i;
    w->is_listed = true;
}
