#include "tled/cuda/march_near.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* Pairs of units: the first in the high half. */
typedef struct pairs {
    uint64_t *of;
    int64_t count, capacity;
} pairs;

static int add_pair(pairs *p, int64_t one, int64_t other, err *e)
{
    if (MEM_ROOM(&p->of, &p->capacity, p->count + 1, "the march", e))
        return -1;
    p->of[p->count++] = (uint64_t)one << 32 | (uint64_t)other;
    return 0;
}

static int ascending(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Of a layer of a unit. */
static const uint32_t *words_of(const march *m, const march_unit *u, int32_t layer)
{
    return m->word + MARCH_WORDS * ((int64_t)u->base + layer);
}

void march_owners(const march *m, int32_t *owner)
{
    for (int64_t i = 0; i < m->units; i++) {
        const march_unit *u = &m->unit[i];
        for (int32_t k = 0; k < u->tips; k++)
            owner[m->tip_first + u->base + k] = (int32_t)i;
        if (u->tips)
            continue;
        for (const uint32_t *word = words_of(m, u, 1); word < words_of(m, u, u->cells); word++)
            if (*word & MARCH_OWN)
                owner[*word & MARCH_NODE] = (int32_t)i;
    }
}

/* A unit with who owns a node that it has, both ways round. */
static int pair_with(int64_t unit, int32_t other, int32_t *last, pairs *p, err *e)
{
    if (last[other] == (int32_t)unit)
        return 0;
    last[other] = (int32_t)unit;
    return add_pair(p, unit, other, e) || add_pair(p, other, unit, e) ? -1 : 0;
}

static int pair_tips(const march *m, int64_t unit, const int32_t *owner, int32_t *last, pairs *p, err *e)
{
    const march_unit *u = &m->unit[unit];
    for (const march_tip *tip = m->tip + 8 * (int64_t)u->base; tip < m->tip + 8 * ((int64_t)u->base + u->tips); tip++)
        for (int c = 0; tip->corner >= 0 && c < 8; c++)
            if (pair_with(unit, owner[tip->node[c]], last, p, e))
                return -1;
    return 0;
}

/* Each unit with those whose nodes it has, both ways round: what it reads they write, and
 * may write again once it has read that. */
static int pair_units(const march *m, const int32_t *owner, int32_t *last, pairs *p, err *e)
{
    for (int64_t i = 0; i < m->units; i++) {
        const march_unit *u = &m->unit[i];
        if (u->tips) {
            if (pair_tips(m, i, owner, last, p, e))
                return -1;
            continue;
        }
        for (const uint32_t *word = words_of(m, u, 0); word < words_of(m, u, u->cells + 1); word++)
            if (*word & MARCH_THERE && pair_with(i, owner[*word & MARCH_NODE], last, p, e))
                return -1;
    }
    return 0;
}

/* Sorts them; each once. */
static void sort_pairs(pairs *p)
{
    int64_t count = 0;
    if (p->count)
        qsort(p->of, (size_t)p->count, sizeof *p->of, ascending);
    for (int64_t i = 0; i < p->count; i++)
        if (!i || p->of[i] != p->of[i - 1])
            p->of[count++] = p->of[i];
    p->count = count;
}

static int list_pairs(march *m, const pairs *p, err *e)
{
    int64_t most = 0;
    for (int64_t i = 0, row = 0; i < p->count; i++) {
        row = i && p->of[i] >> 32 == p->of[i - 1] >> 32 ? row + 1 : 1;
        most = row > most ? row : most;
    }
    m->nears = (most + 31) / 32 * 32;
    m->near = mem_array(m->units, (size_t)m->nears * sizeof *m->near, "the march", e);
    if (!m->near)
        return -1;
    memset(m->near, 0xff, (size_t)(m->units * m->nears) * sizeof *m->near);
    for (int64_t i = 0, row = 0; i < p->count; i++) {
        const int64_t unit = (int64_t)(p->of[i] >> 32);
        row = i && unit == (int64_t)(p->of[i - 1] >> 32) ? row + 1 : 0;
        m->near[unit * m->nears + row] = (int32_t)p->of[i];
    }
    return 0;
}

int march_near_find(march *m, int64_t nodes, err *e)
{
    pairs p = {0};
    int32_t *owner = mem_array(nodes, sizeof *owner, "the march", e);
    int32_t *last = mem_array(m->units, sizeof *last, "the march", e);
    int result = -1;
    if (!owner || !last)
        goto out;
    memset(last, 0xff, (size_t)m->units * sizeof *last);
    march_owners(m, owner);
    if (pair_units(m, owner, last, &p, e))
        goto out;
    sort_pairs(&p);
    result = list_pairs(m, &p, e);
out:
    free(owner);
    free(last);
    free(p.of);
    return result;
}

/* ---- the order in which blocks take them */

typedef struct turn {
    double at; /* among the units of first sheets */
    int64_t was;
} turn;

/* Units of which each has some nodes, and the sum of their turns. */
typedef struct mean {
    double sum;
    int64_t count;
} mean;

static int by_turn(const void *a, const void *b)
{
    const turn *x = a, *y = b;
    if (x->at != y->at)
        return x->at < y->at ? -1 : 1;
    return x->was < y->was ? -1 : 1;
}

/* first: of units: they own nodes of a first sheet. */
static void add_node(mean *to, int32_t owner, const bool *first)
{
    to->sum += first[owner] ? owner : 0;
    to->count += first[owner];
}

/* The mean turn of those whose nodes a unit has; its own, where it has none. */
static double turn_beside(const march *m, int64_t which, const int32_t *owner, const bool *first)
{
    const march_unit *u = &m->unit[which];
    const march_tip *tip = u->tips ? m->tip + 8 * (int64_t)u->base : NULL;
    const uint32_t *word = u->tips ? NULL : m->word + MARCH_WORDS * (int64_t)u->base;
    mean beside = {0, 0};
    for (int64_t i = 0; i < 8 * u->tips; i++)
        for (int c = 0; tip[i].corner >= 0 && c < 8; c++)
            add_node(&beside, owner[tip[i].node[c]], first);
    for (int64_t i = 0; word && i < MARCH_WORDS * (int64_t)(u->cells + 1); i++)
        if (word[i] & MARCH_THERE)
            add_node(&beside, owner[word[i] & MARCH_NODE], first);
    return beside.count ? beside.sum / (double)beside.count : (double)which;
}

int march_turns_order(march *m, const int32_t *sheet, int64_t nodes, err *e)
{
    int result = -1;
    int32_t *owner = mem_array(nodes, sizeof *owner, "the march", e);
    bool *first = mem_array(m->units, sizeof *first, "the march", e);
    turn *of = mem_array(m->units, sizeof *of, "the march", e);
    march_unit *unit = mem_array(m->units, sizeof *unit, "the march", e);
    if (!owner || !first || !of || !unit)
        goto out;
    march_owners(m, owner);
    for (int64_t n = 0; n < nodes; n++)
        first[owner[m->order[n]]] |= sheet[n] == 0;
    for (int64_t i = 0; i < m->units; i++)
        of[i] = (turn){first[i] ? (double)i : turn_beside(m, i, owner, first), i};
    qsort(of, (size_t)m->units, sizeof *of, by_turn);
    for (int64_t i = 0; i < m->units; i++)
        unit[i] = m->unit[of[i].was];
    free(m->unit);
    m->unit = unit;
    unit = NULL;
    result = 0;
out:
    free(owner);
    free(first);
    free(of);
    free(unit);
    return result;
}
