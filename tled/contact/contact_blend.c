#include "tled/contact/contact_blend.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct maker {
    contact_blend *b;
    const motion *of;
    const int32_t *element, *node, *row;
    int32_t *entry_node; /* entries: rows of nodes */
    int64_t entry_room, coefficient_room, entries;
    err *e;
} maker;

/* ---- the maps of nodes */

/* The entry of the map that begins at `from` for a node's row, which may be a new one. */
static int64_t entry_of(maker *k, int64_t from, int32_t row)
{
    contact_blend *b = k->b;
    for (int64_t i = from; i < k->entries; i++)
        if (k->entry_node[i] == row)
            return i;
    if (mem_grow(&k->entry_node, &k->entry_room, k->entries + 1, sizeof *k->entry_node, "the skin", k->e) ||
        mem_grow(&b->coefficient, &k->coefficient_room, 4 * (k->entries + 1), sizeof *b->coefficient, "the skin", k->e))
        return -1;
    k->entry_node[k->entries] = row;
    memset(b->coefficient + 4 * k->entries, 0, 4 * sizeof *b->coefficient);
    return k->entries++;
}

static int add_element(maker *k, int64_t from, int32_t element, double part)
{
    for (int c = 0; c < 8; c++) {
        const int64_t i = entry_of(k, from, k->row[k->node[8 * (int64_t)element + c]]);
        if (i < 0)
            return -1;
        double *to = k->b->coefficient + 4 * i;
        to[0] += part / 8;
        for (int a = 0; a < 3; a++)
            to[1 + a] += part * contact_blend_slope(k->b->side, c, a);
    }
    return 0;
}

static int make_maps(maker *k)
{
    contact_blend *b = k->b;
    const motion *m = k->of;
    b->maps = m->places;
    b->start = mem_array(m->places + 1, sizeof *b->start, "the skin", k->e);
    for (int64_t i = 0; b->start && i < m->places; i++) {
        const int64_t from = k->entries, count = m->start[i + 1] - m->start[i];
        for (int64_t j = m->start[i]; j < m->start[i + 1]; j++)
            if (add_element(k, from, m->element[m->around[j]], 1 / (double)count))
                return -1;
        for (int64_t j = from; j < k->entries; j++)
            for (int a = 0; a < 3; a++)
                b->coefficient[4 * j] += b->coefficient[4 * j + 1 + a] * m->offset[3 * i + a];
        if (k->entries - from > BLEND_NODES)
            return err_set(k->e, NULL, 0, "the elements around node %d have %lld nodes; expected at most %d",
                           m->node[i], (long long)(k->entries - from), BLEND_NODES);
        b->start[i + 1] = (int32_t)k->entries;
    }
    return b->start ? 0 : -1;
}

/* ---- the elements' lists */

/* Which of the element's nodes a row is, or a new one; -1: there are too many. */
static int place_in(contact_blend *b, int64_t element, int32_t row)
{
    int32_t *node = b->node + BLEND_MOST * element;
    for (int i = 0; i < b->count[element]; i++)
        if (node[i] == row)
            return i;
    if (b->count[element] == BLEND_MOST)
        return -1;
    node[b->count[element]] = row;
    return b->count[element]++;
}

static int list_element(maker *k, int64_t i)
{
    contact_blend *b = k->b;
    const int32_t *node = k->node + 8 * (int64_t)k->element[i];
    for (int c = 0; c < 8; c++) {
        const int32_t place = k->of->place[node[c]];
        const bool own = b->start[place] == b->start[place + 1];
        const int count = own ? 8 : b->start[place + 1] - b->start[place];
        b->place[8 * i + c] = own ? -1 : place;
        for (int j = 0; j < count; j++) {
            const int at = place_in(b, i, own ? k->row[node[j]] : k->entry_node[b->start[place] + j]);
            if (at < 0)
                return err_set(k->e, NULL, 0, "element %d moves with more than %d nodes; expected fewer about a slit",
                               k->element[i], BLEND_MOST);
            b->index[(8 * i + c) * BLEND_NODES + j] = (uint8_t)at;
        }
    }
    return 0;
}

int contact_blend_make(contact_blend *b, const motion *of, const int32_t *element, int64_t elements,
                       const int32_t *node, const int32_t *row, const double side[3], err *e)
{
    maker k = {.b = b, .of = of, .element = element, .node = node, .row = row, .e = e};
    const char what[] = "the skin";
    *b = (contact_blend){.elements = elements};
    memcpy(b->side, side, sizeof b->side);
    int failed = make_maps(&k) || !(b->place = mem_array(elements, 8 * sizeof *b->place, what, e)) ||
                 !(b->node = mem_array(elements, BLEND_MOST * sizeof *b->node, what, e)) ||
                 !(b->count = mem_array(elements, sizeof *b->count, what, e)) ||
                 !(b->index = mem_array(elements, 8 * BLEND_NODES * sizeof *b->index, what, e));
    for (int64_t i = 0; i < elements && !failed; i++)
        failed = list_element(&k, i);
    free(k.entry_node);
    return failed ? -1 : 0;
}

void contact_blend_free(contact_blend *b)
{
    free(b->place);
    free(b->node);
    free(b->count);
    free(b->index);
    free(b->start);
    free(b->coefficient);
    *b = (contact_blend){.elements = 0};
}

/* ---- shares */

void contact_blend_shares(const contact_blend *b, int64_t element, const double xi[3], double share[BLEND_MOST])
{
    double part[8];
    contact_blend_parts(xi, part);
    memset(share, 0, b->count[element] * sizeof *share);
    for (int c = 0; c < 8; c++) {
        const uint8_t *index = b->index + (8 * element + c) * BLEND_NODES;
        const int32_t place = b->place[8 * element + c];
        const int count = contact_blend_entries(b, element, c);
        double from[3];
        if (part[c] == 0)
            continue;
        contact_blend_from(b->side, c, place < 0, xi, from);
        for (int k = 0; k < count; k++)
            share[index[k]] +=
                part[c] * (place < 0 ? contact_blend_own(b->side, k, from)
                                     : contact_blend_share(b->coefficient + 4 * (int64_t)(b->start[place] + k), from));
    }
}

int contact_blend_lever(const contact_blend *b, int64_t element, const double xi[3], int32_t node[BLEND_MOST],
                        double share[BLEND_MOST])
{
    double all[BLEND_MOST];
    int count = 0;
    contact_blend_shares(b, element, xi, all);
    for (int k = 0; k < b->count[element]; k++)
        if (fabs(all[k]) > BLEND_LEAST) {
            node[count] = b->node[BLEND_MOST * element + k];
            share[count++] = all[k];
        }
    return count;
}
