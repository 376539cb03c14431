#include "tled/contact/contact_room.h"

#include "base/mem.h"
#include "surface/hash.h"
#include "tled/contact/contact_blend.h"

#include <stdlib.h>
#include <string.h>

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
    free(w->about);
    free(w->table.at);
    free(w->table.sampled);
    free(w->table.middle);
    free(w->table.low);
    free(w->table.high);
    free(w->table.count);
    free(w->table.candidate);
    free(w->table.crowded);
    free(w->table.cell);
    free(w->table.start);
    free(w->table.of);
    free(w->table.filled);
    free(w->near);
    free(w->until);
    free(w->touch);
    free(w->place_node);
    free(w->place_share);
    free(w->solid);
    free(w->bone_until);
    free(w->bone_touch);
    free(w);
}

int contact_by_number(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

self_contact_work *contact_room_make(const tled_problem *p, const self_contact *c, err *e)
{
    const char what[] = "the skin";
    self_contact_work *w = mem_array(1, sizeof *w, what, e);
    if (!w)
        return NULL;
    w->p = p;
    w->c = c;
    contact_table *t = &w->table;
    t->cells = hash_size(c->elements);
    w->place_most = c->blend ? BLEND_MOST : 8;
    if ((w->u = mem_array(c->nodes, 3 * sizeof *w->u, what, e)) &&
        (w->v = mem_array(c->nodes, 3 * sizeof *w->v, what, e)) &&
        (w->x = mem_array(c->nodes, 3 * sizeof *w->x, what, e)) &&
        (w->listed = mem_array(c->nodes, 3 * sizeof *w->listed, what, e)) &&
        (w->change = mem_array(c->nodes, 3 * sizeof *w->change, what, e)) &&
        (w->sum = mem_array(c->nodes, sizeof *w->sum, what, e)) &&
        (w->about = mem_array(c->nodes, sizeof *w->about, what, e)) &&
        (t->at = mem_array(c->samples, 3 * sizeof *t->at, what, e)) &&
        (t->sampled = mem_array(c->elements, 6 * sizeof *t->sampled, what, e)) &&
        (t->middle = mem_array(c->elements, 3 * sizeof *t->middle, what, e)) &&
        (t->low = mem_array(c->elements, 3 * sizeof *t->low, what, e)) &&
        (t->high = mem_array(c->elements, 3 * sizeof *t->high, what, e)) &&
        (t->count = mem_array(c->elements, sizeof *t->count, what, e)) &&
        (t->candidate = mem_array(c->elements, CONTACT_CANDIDATES * sizeof *t->candidate, what, e)) &&
        (t->crowded = mem_array(c->elements, sizeof *t->crowded, what, e)) &&
        (t->cell = mem_array(c->elements, sizeof *t->cell, what, e)) &&
        (t->start = mem_array(t->cells, sizeof *t->start, what, e)) &&
        (t->of = mem_array(c->elements, sizeof *t->of, what, e)) &&
        (t->filled = mem_array(t->cells, sizeof *t->filled, what, e)) &&
        (w->near = mem_array(c->samples, sizeof *w->near, what, e)) &&
        (w->until = mem_array(c->samples, sizeof *w->until, what, e)) &&
        (w->touch = mem_array(c->samples, 2 * sizeof *w->touch, what, e)) &&
        (w->place_node = mem_array(c->samples, (size_t)w->place_most * sizeof *w->place_node, what, e)) &&
        (w->place_share = mem_array(c->samples, (size_t)w->place_most * sizeof *w->place_share, what, e)) &&
        (w->solid = mem_array(c->solids, sizeof *w->solid, what, e)) &&
        (w->bone_until = mem_array(c->solids * c->samples, sizeof *w->bone_until, what, e)) &&
        (w->bone_touch = mem_array(c->solids ? c->samples : 0, sizeof *w->bone_touch, what, e)))
        return w;
    self_contact_room_free(w);
    return NULL;
}

self_contact_work *self_contact_room(const tled_problem *p, err *e)
{
    return contact_room_make(p, p->self_contact, e);
}

static int64_t contact_table_bytes(const self_contact *c, int64_t cells)
{
    return c->elements * (15 * (int64_t)sizeof(double) + (CONTACT_CANDIDATES + 4) * (int64_t)sizeof(int32_t)) +
           2 * cells * (int64_t)sizeof(int32_t) + 3 * c->samples * (int64_t)sizeof(double);
}

int64_t self_contact_bytes(const self_contact_work *w)
{
    if (!w)
        return 0;
    const self_contact *c = w->c;
    return c->samples * w->place_most * (int64_t)(sizeof(int32_t) + sizeof(double)) +
           c->nodes * (16 * (int64_t)sizeof(double) + (int64_t)sizeof(int32_t)) +
           c->samples *
               ((2 + (c->solids > 0)) * (int64_t)sizeof(touch) + 8 * (1 + c->solids) + (int64_t)sizeof(int32_t)) +
           contact_table_bytes(c, w->table.cells);
}

void self_contact_forget(self_contact_work *w)
{
    if (!w)
        return;
    const self_contact *c = w->c;
    w->is_listed = false;
    memset(w->until, 0, (size_t)c->samples * sizeof *w->until);
    memset(w->bone_until, 0, (size_t)(c->solids * c->samples) * sizeof *w->bone_until);
    memset(w->solid, 0, (size_t)c->solids * sizeof *w->solid);
}

int64_t self_contact_crowded(const self_contact_work *w)
{
    int64_t count = 0;
    for (int64_t i = 0; w && i < w->c->elements; i++)
        count += w->table.crowded[i];
    return count;
}

double *self_contact_displacement(self_contact_work *w)
{
    return w->u;
}

double *self_contact_velocity(self_contact_work *w)
{
    return w->v;
}
