#include "msds/problem/sell.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* A slot whose neighbours stand in a row is worth having from so many lanes on; the rest are scattered. */
enum { ROW_LEAST = 3 };

typedef struct link { /* of one node of a slice */
    int32_t offset;   /* to the neighbour, in our order */
    int32_t lane, spring;
} link;

typedef struct maker {
    sell *s;
    const msds_problem *p;
    int64_t *start;    /* the model's nodes + 1: springs of each */
    int32_t *incident; /* springs twice */
    link *links;       /* of one slice */
    int64_t link_room, slot_room, slot_room_neighbour, slot_room_spring;
} maker;

static int list_incident(maker *m, err *e)
{
    const msds_problem *p = m->p;
    m->start = mem_array(p->nodes + 2, sizeof *m->start, "the solver", e);
    m->incident = mem_array(2 * p->springs, sizeof *m->incident, "the solver", e);
    if (!m->start || !m->incident)
        return -1;
    for (int64_t i = 0; i < p->springs; i++)
        for (int c = 0; c < 2; c++)
            m->start[p->spring[i].node[c] + 2]++;
    for (int64_t n = 2; n <= p->nodes + 1; n++)
        m->start[n] += m->start[n - 1];
    for (int64_t i = 0; i < p->springs; i++)
        for (int c = 0; c < 2; c++)
            m->incident[m->start[p->spring[i].node[c] + 1]++] = (int32_t)i;
    return 0;
}

/* Whether a neighbour has fewer springs: in a lattice of five tetrahedra a cell, true of every other node, those where
 * diagonals meet, on the surface and at its corners too. */
static bool has_many(const maker *m, int64_t n)
{
    for (int64_t i = m->start[n]; i < m->start[n + 1]; i++) {
        const int32_t *ends = m->p->spring[m->incident[i]].node;
        int64_t other = ends[0] == n ? ends[1] : ends[0];
        if (m->start[other + 1] - m->start[other] < m->start[n + 1] - m->start[n])
            return true;
    }
    return false;
}

/* Nodes with many springs come first, in the model's order, then those with few. So a slice of a lattice never mixes
 * rows of both lengths, but for one. */
static int order_nodes(maker *m, err *e)
{
    sell *s = m->s;
    const msds_problem *p = m->p;
    s->count = (p->nodes + LANES - 1) / LANES;
    s->nodes = s->count * LANES;
    s->model_node = mem_array(s->nodes, sizeof *s->model_node, "the solver", e);
    s->own_node = mem_array(p->nodes, sizeof *s->own_node, "the solver", e);
    if (!s->model_node || !s->own_node)
        return -1;
    int64_t at = 0;
    for (int few = 0; few < 2; few++)
        for (int64_t n = 0; n < p->nodes; n++)
            if (has_many(m, n) != few) {
                s->own_node[n] = (int32_t)at;
                s->model_node[at++] = (int32_t)n;
            }
    for (; at < s->nodes; at++)
        s->model_node[at] = -1;
    return 0;
}

static int by_offset(const void *a, const void *b)
{
    const link *x = a, *y = b;
    if (x->offset != y->offset)
        return x->offset < y->offset ? -1 : 1;
    return (x->lane > y->lane) - (x->lane < y->lane);
}

static int64_t list_links(maker *m, int64_t slice, err *e)
{
    const sell *s = m->s;
    int64_t count = 0;
    for (int32_t lane = 0; lane < LANES; lane++) {
        int32_t own = (int32_t)(slice * LANES) + lane, n = s->model_node[own];
        for (int64_t i = n < 0 ? 0 : m->start[n]; n >= 0 && i < m->start[n + 1]; i++) {
            const int32_t *ends = m->p->spring[m->incident[i]].node;
            int32_t other = s->own_node[ends[0] == n ? ends[1] : ends[0]];
            if (MEM_ROOM(&m->links, &m->link_room, count + 1, "the solver", e))
                return -1;
            m->links[count++] = (link){other - own, lane, m->incident[i]};
        }
    }
    qsort(m->links, (size_t)count, sizeof *m->links, by_offset);
    return count;
}

/* A new slot of the slice, whose lanes have no neighbour yet. Returns its number, or -1. */
static int64_t add_slot(maker *m, int64_t slice, int32_t first, err *e)
{
    sell *s = m->s;
    int64_t at = s->slots;
    int64_t *room = &m->slot_room_neighbour;
    if (MEM_ROOM(&s->first, &m->slot_room, at + 1, "the solver", e) ||
        MEM_ROOM(&s->neighbour, room, (at + 1) * LANES, "the solver", e) ||
        MEM_ROOM(&s->spring, &m->slot_room_spring, (at + 1) * LANES, "the solver", e))
        return -1;
    s->first[at] = first;
    for (int32_t lane = 0; lane < LANES; lane++) {
        s->neighbour[at * LANES + lane] = (int32_t)(slice * LANES) + lane;
        s->spring[at * LANES + lane] = -1;
    }
    s->slots++;
    return at;
}

static void put(sell *s, int64_t slot, int64_t slice, const link *l)
{
    s->neighbour[slot * LANES + l->lane] = (int32_t)(slice * LANES) + l->lane + l->offset;
    s->spring[slot * LANES + l->lane] = l->spring;
}

/* A link that is in no row goes into the slice's first scattered slot, from `from` on, that has room in its lane. */
static int scatter(maker *m, int64_t slice, int64_t from, const link *l, err *e)
{
    int64_t slot = from;
    while (slot < m->s->slots && m->s->spring[slot * LANES + l->lane] >= 0)
        slot++;
    if (slot == m->s->slots && add_slot(m, slice, SELL_SCATTERED, e) < 0)
        return -1;
    put(m->s, slot, slice, l);
    return 0;
}

static int make_slice(maker *m, int64_t slice, err *e)
{
    int64_t count = list_links(m, slice, e), next;
    if (count < 0)
        return -1;
    for (int pass = 0; pass < 2; pass++) {
        int64_t from = m->s->slots;
        for (int64_t i = 0; i < count; i = next) {
            for (next = i; next < count && m->links[next].offset == m->links[i].offset; next++)
                ;
            bool row = next - i >= ROW_LEAST;
            int32_t first = (int32_t)(slice * LANES) + m->links[i].offset;
            int64_t slot = row && !pass ? add_slot(m, slice, first, e) : 0;
            if (slot < 0)
                return -1;
            for (int64_t k = i; k < next; k++)
                if (row && !pass)
                    put(m->s, slot, slice, &m->links[k]);
                else if (!row && pass && scatter(m, slice, from, &m->links[k], e))
                    return -1;
        }
    }
    return 0;
}

int sell_make(sell *s, const msds_problem *p, err *e)
{
    maker m = {.s = s, .p = p};
    int result = -1;
    if (list_incident(&m, e) || order_nodes(&m, e))
        goto out;
    s->start = mem_array(s->count + 1, sizeof *s->start, "the solver", e);
    if (!s->start)
        goto out;
    for (int64_t i = 0; i < s->count; i++) {
        if (make_slice(&m, i, e))
            goto out;
        s->start[i + 1] = s->slots;
    }
    result = 0;
out:
    free(m.start);
    free(m.incident);
    free(m.links);
    return result;
}

static float length_of(const msds_problem *p, const int32_t node[2])
{
    float square = 0;
    for (int a = 0; a < 3; a++) {
        float d = (float)p->position[3 * (int64_t)node[1] + a] - (float)p->position[3 * (int64_t)node[0] + a];
        square += d * d;
    }
    return sqrtf(square);
}

void sell_springs(const sell *s, const msds_problem *p, float *stiffness, float *damper, float *rest)
{
    for (int64_t at = 0; at < s->slots * LANES; at++) {
        const msds_spring *spring = s->spring[at] < 0 ? NULL : &p->spring[s->spring[at]];
        rest[at] = spring ? length_of(p, spring->node) : 1;
        stiffness[at] = spring ? (float)spring->stiffness : 0;
        damper[at] = spring ? (float)spring->damper : 0;
    }
}

void sell_free(sell *s)
{
    free(s->model_node);
    free(s->own_node);
    free(s->start);
    free(s->first);
    free(s->neighbour);
    free(s->spring);
    *s = (sell){0};
}
