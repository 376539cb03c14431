/* Puts skin that touches itself on a card: what the host makes for the kernel of cuda_skin.cuh, and its memory.
 * Included by cuda_state.cuh alone.
 */
#ifndef SINEW_CUDA_SKIN_MAKE_CUH
#define SINEW_CUDA_SKIN_MAKE_CUH

#include "tled/cuda/cuda_skin.cuh"

/* The host's list of nodes, the caller's to free. stand: of the model's. NULL with e filled. */
static cuda_skin_node *skin_nodes(const tled_problem *p, const int32_t *stand, err *e)
{
    const self_contact *c = p->self_contact;
    cuda_skin_node *to = (cuda_skin_node *)mem_array(c->nodes, sizeof *to, "the skin", e);
    for (int64_t i = 0; to && i < c->nodes; i++) {
        const int64_t n = c->node[i];
        to[i].free = 0;
        for (int a = 0; a < 3; a++) {
            to[i].position[a] = p->position[3 * n + a];
            to[i].free |= (uint32_t)(p->hold[3 * n + a] == HOLD_FREE) << a;
        }
        to[i].mass = p->mass[n];
        to[i].stand = stand[n];
    }
    return to;
}

/* cuda_skin.entry, the caller's to free. NULL with e filled. */
static int32_t *skin_entries(const self_contact *c, err *e)
{
    const contact_blend *b = c->blend;
    const int64_t maps = b ? 8 * c->elements : 0;
    int32_t *to = (int32_t *)mem_array(maps, BLEND_MOST * sizeof *to, "the skin", e);
    for (int64_t i = 0; to && i < maps; i++) {
        const int32_t first = b->place[i] < 0 ? SKIN_OWN : b->start[b->place[i]];
        for (int k = 0; k < BLEND_MOST; k++)
            to[i * BLEND_MOST + k] = -1;
        for (int k = 0; k < contact_blend_entries(b, i / 8, (int)(i % 8)); k++)
            to[i * BLEND_MOST + b->index[i * BLEND_NODES + k]] = first + k;
    }
    return to;
}

/* Elements that have samples, the caller's to free. NULL with e filled. */
static int32_t *skin_owners(const self_contact *c, int32_t *count, err *e)
{
    int32_t *to = (int32_t *)mem_array(c->elements, sizeof *to, "the skin", e);
    *count = 0;
    for (int64_t i = 0; to && i < c->elements; i++)
        if (c->sample_start[i] < c->sample_start[i + 1])
            to[(*count)++] = (int32_t)i;
    return to;
}

/* What the host makes for the card. */
typedef struct skin_made {
    cuda_skin_node *node;
    int32_t *entry, *owner, owners;
} skin_made;

static void skin_made_free(const skin_made *made)
{
    free(made->node);
    free(made->entry);
    free(made->owner);
}

static void skin_list_model(const self_contact *c, const skin_made *made, cuda_skin *s, card_layout *l)
{
    s->owners = made->owners;
    card_layout_copy(l, &s->owner, made->owner, made->owners);
    card_layout_copy(l, &s->node, made->node, c->nodes);
    card_layout_copy(l, &s->c.sample_element, c->sample_element, c->samples);
    card_layout_copy(l, &s->c.sample_start, c->sample_start, c->elements + 1);
    card_layout_copy(l, &s->c.sample, c->sample, c->samples);
    card_layout_copy(l, &s->c.place, c->place, 3 * c->samples);
    card_layout_copy(l, &s->c.lever_start, c->lever_start, c->samples + 1);
    card_layout_copy(l, &s->c.lever_node, c->lever_node, c->lever_start[c->samples]);
    card_layout_copy(l, &s->c.lever_share, c->lever_share, c->lever_start[c->samples]);
    card_layout_copy(l, &s->c.element, c->element, 8 * c->elements);
    card_layout_copy(l, &s->c.distance, c->distance, c->elements);
    card_layout_copy(l, &s->c.rest, c->rest, c->samples);
    card_layout_copy(l, &s->c.ring_start, c->ring_start, c->elements + 1);
    card_layout_copy(l, &s->c.ring, c->ring, c->ring_start[c->elements]);
    card_layout_copy(l, &s->c.solid, c->solid, c->solids);
    card_layout_copy(l, &s->c.bone_rest, c->bone_rest, c->solids * c->samples);
    if (!c->blend)
        return;
    const contact_blend *b = c->blend;
    card_layout_copy(l, &s->blend.place, b->place, 8 * c->elements);
    card_layout_copy(l, &s->blend.node, b->node, BLEND_MOST * c->elements);
    card_layout_copy(l, &s->blend.count, b->count, c->elements);
    card_layout_copy(l, &s->entry, made->entry, 8 * BLEND_MOST * c->elements);
    card_layout_copy(l, &s->blend.start, b->start, b->maps + 1);
    card_layout_copy(l, &s->blend.coefficient, b->coefficient, 4 * (int64_t)b->start[b->maps]);
}

/* What steps work in, all 0 at first. */
static void skin_list_room(const self_contact *c, cuda_skin *s, card_layout *l)
{
    contact_table *t = &s->table;
    card_layout_add(l, &t->at, 3 * c->samples);
    card_layout_add(l, &t->sampled, 6 * c->elements);
    card_layout_add(l, &t->middle, 3 * c->elements);
    card_layout_add(l, &t->low, 3 * c->elements);
    card_layout_add(l, &t->high, 3 * c->elements);
    card_layout_add(l, &t->count, c->elements);
    card_layout_add(l, &t->candidate, CONTACT_CANDIDATES * c->elements);
    card_layout_add(l, &t->crowded, c->elements);
    card_layout_add(l, &t->cell, c->elements);
    card_layout_add(l, &t->start, t->cells);
    card_layout_add(l, &t->of, c->elements);
    card_layout_add(l, &t->filled, t->cells);
    card_layout_add(l, &s->taken, t->cells);
    card_layout_add(l, &s->x, 3 * c->nodes);
    card_layout_add(l, &s->listed, 3 * c->nodes);
    card_layout_add(l, &s->active, c->samples);
    card_layout_add(l, &s->until, c->samples);
    card_layout_add(l, &s->bone_until, c->solids * c->samples);
    card_layout_add(l, &s->found, 2 * c->samples);
    card_layout_add(l, &s->place_node, s->place_most * c->samples);
    card_layout_add(l, &s->place_share, s->place_most * c->samples);
    card_layout_add(l, &s->sum, c->nodes);
    for (int i = 0; i < SKIN_CHANGES; i++)
        card_layout_add(l, &s->change[i], 3 * c->nodes);
    card_layout_add(l, &s->fresh, 3 * c->nodes);
    card_layout_add(l, &s->moved, 3 * c->nodes);
    card_layout_add(l, &s->about, c->nodes);
    card_layout_add(l, &s->all, 1);
    card_layout_add(l, &s->done, SKIN_BLOCKS);
}

/* Puts the problem's skin on the card; ground: of its bones, there already. *memory is the caller's, for card_give,
 * even if this fails. Returns its bytes; -1 with e filled. */
static int64_t skin_make(cuda_skin *s, const tled_problem *p, const int32_t *stand, const sliding_ground *ground,
                         char **memory, err *e)
{
    const self_contact *c = p->self_contact;
    card_layout layout = {0};
    if (c->solids > SKIN_SOLIDS)
        return err_set(e, NULL, 0, "skin may not enter %d distance fields of bone; expected at most %d on a card",
                       c->solids, (int)SKIN_SOLIDS);
    skin_made made = {skin_nodes(p, stand, e)};
    made.entry = made.node ? skin_entries(c, e) : NULL;
    made.owner = made.entry ? skin_owners(c, &made.owners, e) : NULL;
    if (!made.owner) {
        skin_made_free(&made);
        return -1;
    }
    s->c = *c;
    s->table.cells = hash_size(c->elements);
    s->place_most = c->blend ? BLEND_MOST : 8;
    if (c->blend)
        s->blend = *c->blend;
    s->ground = *ground;
    skin_list_model(c, &made, s, &layout);
    skin_list_room(c, s, &layout);
    const int failed = card_layout_place(&layout, true, "the skin", memory, e);
    skin_made_free(&made);
    return failed ? -1 : layout.bytes;
}

#endif
