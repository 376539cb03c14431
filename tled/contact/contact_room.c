#include "tled/contact/contact_room.h"

#include "base/mem.h"
#include "surface/hash.h"

#include <stdlib.h>
#include <string.h>

enum { RING_MOST = 1024 }; /* nodes about an element, with those that come again */

void self_contact_room_free(self_contact_work *w)
{
    if (!w)
        return;
    free(w->u);
    free(w->v);
    free(w->x);
    free(w->listed);
    free(w->change);
    free(w->sum);
    free(w->sampled);
    free(w->middle);
    free(w->count);
    free(w->ring_start);
    free(w->ring);
    free(w->candidate);
    free(w->near);
    free(w->until);
    free(w->found);
    free(w->touch);
    free(w->start);
    free(w->of);
    free(w->cell);
    free(w->low);
    free(w->high);
    free(w);
}

int contact_by_number(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

/* The nodes of the elements around an element's nodes, ascending. Returns how many. */
static int find_ring(const self_contact *c, const int32_t *start, const int32_t *around, int64_t element, int32_t *to)
{
    int count = 0, kept = 0;
    for (int k = 0; k < 8; k++) {
        const int32_t node = c->element[8 * element + k];
        for (int32_t i = start[node]; i < start[node + 1]; i++)
            for (int j = 0; j < 8 && count < RING_MOST; j++)
                to[count++] = c->element[8 * (int64_t)around[i] + j];
    }
    qsort(to, (size_t)count, sizeof *to, contact_by_number);
    for (int i = 0; i < count; i++)
        if (!i || to[i] != to[kept - 1])
            to[kept++] = to[i];
    return kept;
}

/* Elements by their nodes: those of node n are around[start[n]] and on. */
static void list_around(const self_contact *c, int32_t *start, int32_t *around)
{
    for (int64_t i = 0; i < 8 * c->elements; i++)
        start[c->element[i] + 1]++;
    for (int64_t n = 0; n < c->nodes; n++)
        start[n + 1] += start[n];
    for (int64_t i = 8 * c->elements; i-- > 0;)
        around[--start[c->element[i] + 1]] = (int32_t)(i / 8);
    memmove(start, start + 1, (size_t)c->nodes * sizeof *start);
    start[c->nodes] = (int32_t)(8 * c->elements);
}

static int make_rings(self_contact_work *w, err *e)
{
    const self_contact *c = w->c;
    int32_t *start = mem_array(c->nodes + 2, sizeof *start, "the skin", e), ring[RING_MOST];
    int32_t *around = start ? mem_array(8 * c->elements, sizeof *around, "the skin", e) : NULL;
    int64_t room = 0, count = 0;
    int failed = !around || !(w->ring_start = mem_array(c->elements + 1, sizeof *w->ring_start, "the skin", e));
    if (!failed)
        list_around(c, start, around);
    for (int64_t i = 0; i < c->elements && !failed; i++) {
        const int n = find_ring(c, start, around, i, ring);
        failed = mem_grow(&w->ring, &room, count + n, sizeof *w->ring, "the skin", e);
        if (!failed)
            memcpy(w->ring + count, ring, (size_t)n * sizeof *ring);
        count += n;
        w->ring_start[i + 1] = (int32_t)count;
    }
    free(start);
    free(around);
    return failed ? -1 : 0;
}

self_contact_work *contact_room_make(const tled_problem *p, const self_contact *c, err *e)
{
    const char what[] = "the skin";
    self_contact_work *w = mem_array(1, sizeof *w, what, e);
    if (!w)
        return NULL;
    w->p = p;
    w->c = c;
    w->cells = hash_size(c->elements);
    if ((w->u = mem_array(c->nodes, 3 * sizeof *w->u, what, e)) &&
        (w->v = mem_array(c->nodes, 3 * sizeof *w->v, what, e)) &&
        (w->x = mem_array(c->nodes, 3 * sizeof *w->x, what, e)) &&
        (w->listed = mem_array(c->nodes, 3 * sizeof *w->listed, what, e)) &&
        (w->change = mem_array(c->nodes, 3 * sizeof *w->change, what, e)) &&
        (w->sum = mem_array(c->nodes, sizeof *w->sum, what, e)) &&
        (w->sampled = mem_array(c->elements, 6 * sizeof *w->sampled, what, e)) &&
        (w->middle = mem_array(c->elements, 3 * sizeof *w->middle, what, e)) &&
        (w->count = mem_array(c->elements, sizeof *w->count, what, e)) &&
        (w->candidate = mem_array(c->elements, CANDIDATES * sizeof *w->candidate, what, e)) &&
        (w->near = mem_array(c->samples, sizeof *w->near, what, e)) &&
        (w->until = mem_array(c->samples, sizeof *w->until, what, e)) &&
        (w->found = mem_array(c->samples, sizeof *w->found, what, e)) &&
        (w->touch = mem_array(c->samples, sizeof *w->touch, what, e)) &&
        (w->start = mem_array(w->cells + 1, sizeof *w->start, what, e)) &&
        (w->of = mem_array(c->elements, sizeof *w->of, what, e)) &&
        (w->cell = mem_array(c->elements, sizeof *w->cell, what, e)) &&
        (w->low = mem_array(c->elements, 3 * sizeof *w->low, what, e)) &&
        (w->high = mem_array(c->elements, 3 * sizeof *w->high, what, e)) && !make_rings(w, e))
        return w;
    self_contact_room_free(w);
    return NULL;
}

self_contact_work *self_contact_room(const tled_problem *p, err *e)
{
    return contact_room_make(p, p->self_contact, e);
}

int64_t self_contact_bytes(const self_contact_work *w)
{
    if (!w)
        return 0;
    const self_contact *c = w->c;
    return c->nodes * (16 * (int64_t)sizeof(double)) +
           c->samples * (2 * (int64_t)sizeof(touch) + 8 + (int64_t)sizeof(int32_t)) +
           c->elements * (15 * (int64_t)sizeof(double) + (CANDIDATES + 3) * (int64_t)sizeof(int32_t)) +
           (w->cells + 1) * (int64_t)sizeof(int32_t);
}

double *self_contact_displacement(self_contact_work *w)
{
    return w->u;
}

double *self_contact_velocity(self_contact_work *w)
{
    return w->v;
}
