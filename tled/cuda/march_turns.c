#include "tled/cuda/march_turns.h"

#include "base/mem.h"
#include "tled/cuda/march_near.h"

#include <stdlib.h>

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
