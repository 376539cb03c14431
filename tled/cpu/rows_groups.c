#include "tled/cpu/rows_groups.h"

#include "base/mem.h"

#include <stdlib.h>

int rows_groups_make(rows_groups *b)
{
    b->kind = mem_array(ROWS_BLOCK, sizeof *b->kind, "the rows", b->e);
    b->kind_of = mem_array(ROWS_BLOCK, sizeof *b->kind_of, "the rows", b->e);
    b->by_kind = mem_array(ROWS_BLOCK, sizeof *b->by_kind, "the rows", b->e);
    b->begins = mem_array(ROWS_BLOCK, sizeof *b->begins, "the rows", b->e);
    b->begins_in = mem_array(ROWS_BLOCK, sizeof *b->begins_in, "the rows", b->e);
    return b->kind && b->kind_of && b->by_kind && b->begins && b->begins_in ? 0 : -1;
}

void rows_groups_free(rows_groups *b)
{
    free(b->kind);
    free(b->kind_of);
    free(b->by_kind);
    free(b->begins);
    free(b->begins_in);
    free(b->listed);
    free(b->terms);
}

static bool is_of(const rows_kind *a, const rows_kind *k)
{
    return a->volume == k->volume && a->mix == k->mix && a->is_cut == k->is_cut && a->is_laminate == k->is_laminate;
}

/* Which of the block's kinds an element is of; before: that of the element before, which is mostly the same. */
static int32_t kind_of(rows_groups *b, int64_t element, int32_t before)
{
    const rows_kind k = {.volume = b->p->element_volume[element],
                         .mix = tled_mix(b->p, element),
                         .is_cut = tled_cut(b->p, element) != NULL,
                         .is_laminate = tled_border(b->p, element) != NULL};
    if (b->kinds && is_of(&b->kind[before], &k))
        return before;
    for (int32_t i = 0; i < b->kinds; i++)
        if (is_of(&b->kind[i], &k))
            return i;
    b->kind[b->kinds] = k;
    return b->kinds++;
}

/* Puts a block's elements in the order of their kinds, and each kind's in theirs. */
static void sort_kinds(rows_groups *b, const int32_t *element, int32_t count)
{
    b->kinds = 0;
    for (int32_t i = 0; i < count; i++) {
        b->kind_of[i] = kind_of(b, element[i], i ? b->kind_of[i - 1] : 0);
        b->kind[b->kind_of[i]].count++;
    }
    for (int32_t k = 1; k < b->kinds; k++)
        b->kind[k].from = b->kind[k - 1].from + b->kind[k - 1].count;
    for (int32_t i = 0; i < count; i++)
        b->by_kind[b->kind[b->kind_of[i]].from++] = i;
}

static bool is_regular(const int32_t *n)
{
    return n[1] == n[0] + 1 && n[2] == n[3] + 1 && n[5] == n[4] + 1 && n[6] == n[7] + 1;
}

static bool follows(const rows_groups *b, const rows_stretch *s, int64_t element)
{
    if (!s->regular)
        return false;
    for (int c = 0; c < 8; c++)
        if (b->r->place[b->p->element_node[8 * element + c]] != s->node[c] + s->count)
            return false;
    return true;
}

static int begin_group(rows_groups *b, const rows_kind *k, int32_t seat)
{
    rows *r = b->r;
    if (mem_grow(&r->group, &b->group_capacity, r->groups + 1, sizeof *r->group, "the rows", b->e))
        return -1;
    r->group[r->groups++] = (rows_group){.cell = r->cells,
                                         .stretch = r->stretches,
                                         .seat = seat,
                                         .volume = k->volume,
                                         .mix = k->mix,
                                         .cut = k->is_cut ? r->cuts++ : -1,
                                         .border = k->is_laminate ? r->borders++ : -1};
    return 0;
}

static int begin_stretch(rows_groups *b, rows_group *g, int64_t element)
{
    rows *r = b->r;
    if (mem_grow(&r->stretch, &b->stretch_capacity, r->stretches + 1, sizeof *r->stretch, "the rows", b->e))
        return -1;
    rows_stretch *s = &r->stretch[r->stretches++];
    *s = (rows_stretch){.lane = g->count, .count = 1};
    for (int c = 0; c < 8; c++)
        s->node[c] = r->place[b->p->element_node[8 * element + c]];
    s->regular = is_regular(s->node);
    g->stretches++;
    return 0;
}

/* Adds an element to the last group. `at` is its place in the block, `last` that of the element that was added before
 * it. A stretch holds what follows each other in the block too: else forces would be added in another order at slits,
 * where several elements have the same place. */
static int add_cell(rows_groups *b, int64_t element, int32_t at, int32_t last)
{
    rows *r = b->r;
    rows_group *g = &r->group[r->groups - 1];
    if (r->cells > INT32_MAX - ROWS_PAD ||
        mem_grow(&r->cell_element, &b->cell_capacity, r->cells + 1, sizeof *r->cell_element, "the rows", b->e))
        return -1;
    r->cell_element[r->cells++] = (int32_t)element;
    if (g->stretches && last == at - 1 && follows(b, &r->stretch[r->stretches - 1], element)) {
        r->stretch[r->stretches - 1].count++;
    } else {
        b->begins[at] = r->stretches;
        b->begins_in[at] = r->groups - 1;
        if (begin_stretch(b, g, element))
            return -1;
    }
    g->count++;
    return 0;
}

static int add_groups(rows_groups *b, const int32_t *element, int32_t count)
{
    rows *r = b->r;
    const int32_t first = r->groups;
    for (int32_t i = 0; i < count; i++) {
        const int32_t at = b->by_kind[i], last = i ? b->by_kind[i - 1] : -1;
        const bool begins = !i || b->kind_of[at] != b->kind_of[last] || r->group[r->groups - 1].count == r->lanes;
        if ((begins && begin_group(b, &b->kind[b->kind_of[at]], b->seat + r->groups - first)) ||
            add_cell(b, element[at], at, last))
            return -1;
    }
    if (r->seats < b->seat + r->groups - first)
        r->seats = b->seat + r->groups - first;
    return 0;
}

/* Of a corner of a stretch, what belongs to the slab's nodes: `count` of these from `node` on. */
static int add_terms(rows_groups *b, const rows_group *g, const rows_stretch *s, int corner)
{
    const int lanes = b->r->lanes, node = s->node[corner];
    if (node < b->node || node >= b->node + b->nodes)
        return 0;
    for (int done = 0; done < s->count;) {
        const int sum = (node - b->node + done) / lanes, first = (node - b->node + done) % lanes;
        const int some = s->count - done < lanes - first ? s->count - done : lanes - first;
        const int64_t at = ((int64_t)g->seat * 24 + corner) * lanes + s->lane + done - first;
        if (at > INT32_MAX - 24 * lanes)
            return err_set(b->e, NULL, 0, "%d elements are too many", b->r->cells);
        if (mem_grow(&b->listed, &b->listed_capacity, b->count + 1, sizeof *b->listed, "the rows", b->e))
            return -1;
        b->listed[b->count++] = (rows_placed_term){sum, {(int32_t)at, ((1U << some) - 1) << first}};
        done += some;
    }
    return 0;
}

/* All terms of the block. At each node the element before is added first: where x is high. */
static int list_terms(rows_groups *b, int32_t count)
{
    static const int order[8] = {6, 7, 5, 4, 2, 3, 1, 0};
    b->count = 0;
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; b->begins[i] >= 0 && k < 8; k++)
            if (add_terms(b, &b->r->group[b->begins_in[i]], &b->r->stretch[b->begins[i]], order[k]))
                return -1;
    return 0;
}

/* Puts them in the order of the sums. */
static int sort_terms(rows_groups *b)
{
    rows *r = b->r;
    const int64_t sums = (b->nodes - 1) / r->lanes + 1;
    if (mem_grow(&b->terms, &b->terms_capacity, sums, sizeof *b->terms, "the rows", b->e) ||
        mem_grow(&r->term, &b->term_capacity, r->terms + b->count, sizeof *r->term, "the rows", b->e) ||
        mem_grow(&r->sum, &b->sum_capacity, r->sums + sums, sizeof *r->sum, "the rows", b->e))
        return -1;
    if (r->terms + b->count > INT32_MAX)
        return err_set(b->e, NULL, 0, "%d elements are too many", r->cells);
    for (int64_t i = 0; i < sums; i++)
        b->terms[i] = 0;
    for (int64_t i = 0; i < b->count; i++)
        b->terms[b->listed[i].sum]++;
    for (int64_t i = 0; i < sums; i++) {
        const int32_t terms = (int32_t)b->terms[i];
        b->terms[i] = r->terms;
        if (terms)
            r->sum[r->sums++] = (rows_sum){b->node + (int32_t)i * r->lanes, r->terms, terms};
        r->terms += terms;
    }
    for (int64_t i = 0; i < b->count; i++)
        r->term[b->terms[b->listed[i].sum]++] = b->listed[i].term;
    return 0;
}

int rows_add_block(rows_groups *b, const int32_t *element, int32_t count)
{
    rows *r = b->r;
    if (mem_grow(&r->block, &b->block_capacity, r->blocks + 1, sizeof *r->block, "the rows", b->e))
        return -1;
    rows_block *block = &r->block[r->blocks++];
    *block = (rows_block){.group = r->groups, .sum = r->sums};
    for (int32_t i = 0; i < count; i++)
        b->begins[i] = -1;
    sort_kinds(b, element, count);
    if (add_groups(b, element, count) || list_terms(b, count) || sort_terms(b))
        return -1;
    block->groups = r->groups - block->group;
    block->sums = r->sums - block->sum;
    return 0;
}
