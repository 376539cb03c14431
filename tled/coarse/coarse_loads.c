#include "tled/coarse/coarse_loads.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* How many of the eighths of a finer node each coarser one has so far, from which its holds are; 8: it lies there. */
static void take_holds(coarse *c, int64_t n, uint8_t *eighths)
{
    const tled_problem *p = c->fine;
    const int32_t *parent = coarse_parents(c, n);
    for (int v = 0; v < 8; v++) {
        uint8_t same = 0;
        for (int w = 0; w < 8; w++)
            same = (uint8_t)(same + (parent[w] == parent[v]));
        if (same <= eighths[parent[v]])
            continue;
        const bool held =
            p->hold[3 * n] != HOLD_FREE || p->hold[3 * n + 1] != HOLD_FREE || p->hold[3 * n + 2] != HOLD_FREE;
        if (same < 8 && !held)
            continue;
        eighths[parent[v]] = same;
        memcpy(c->problem.hold + 3 * (int64_t)parent[v], p->hold + 3 * n, 3 * sizeof *p->hold);
    }
}

int coarse_holds(coarse *c, err *e)
{
    tled_problem *p = &c->problem;
    uint8_t *eighths = mem_array(p->nodes, 1, "the coarser model", e);
    if (!eighths)
        return -1;
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        p->hold[i] = HOLD_FREE;
    for (int64_t n = 0; n < c->fine->nodes; n++)
        take_holds(c, n, eighths);
    free(eighths);
    p->held = 0;
    for (int64_t n = 0; n < p->nodes; n++)
        p->held += p->hold[3 * n] != HOLD_FREE || p->hold[3 * n + 1] != HOLD_FREE || p->hold[3 * n + 2] != HOLD_FREE;
    return 0;
}

typedef struct entry {
    int32_t node, curve, spring;
    int64_t of; /* its place among those of finer nodes, in whose order shares are added */
    double share;
} entry;

/* Entries that become one are alike in these. */
static int order_alike(const entry *a, const entry *b)
{
    if (a->node != b->node)
        return a->node < b->node ? -1 : 1;
    if (a->curve != b->curve)
        return a->curve < b->curve ? -1 : 1;
    return (a->spring > b->spring) - (a->spring < b->spring);
}

/* No two are equal, so that every sort makes one order of them, and sums are the same to the last bit. */
static int order(const void *one, const void *other)
{
    const entry *a = one, *b = other;
    const int alike = order_alike(a, b);
    return alike ? alike : (a->of > b->of) - (a->of < b->of);
}

/* The entries of all finer nodes, by their parents in order; those that are alike as one. Returns how many. */
static int64_t list_entries(const coarse *c, entry *list)
{
    const tled_problem *p = c->fine;
    int64_t count = 0, kept = 0;
    for (int64_t n = 0; n < p->nodes; n++) {
        const int32_t *parent = coarse_parents(c, n);
        for (int32_t i = p->force_start[n]; i < p->force_start[n + 1]; i++)
            for (int v = 0; v < 8; v++, count++)
                list[count] = (entry){parent[v], p->force_curve[i], p->force_spring[i], count, p->force_share[i] / 8};
    }
    qsort(list, (size_t)count, sizeof *list, order);
    for (int64_t i = 0; i < count; i++)
        if (kept && !order_alike(&list[kept - 1], &list[i]))
            list[kept - 1].share += list[i].share;
        else
            list[kept++] = list[i];
    return kept;
}

/* Room for forces of its own at each node, behind the others: the last three of a node's entries. */
enum { OWN = 3 };

static void fill_node(coarse *c, int64_t n, const entry *list, int64_t count)
{
    tled_problem *p = &c->problem;
    const int32_t from = p->force_start[n];
    for (int32_t i = 0; i < count + OWN; i++) {
        const entry own = {.curve = (int32_t)(c->own + i - count), .spring = -1}, of = i < count ? list[i] : own;
        p->force_curve[from + i] = of.curve;
        p->force_spring[from + i] = of.spring;
        p->force_share[from + i] = of.share;
    }
    p->force_start[n + 1] = (int32_t)(from + count + OWN);
}

int coarse_loads(coarse *c, err *e)
{
    tled_problem *p = &c->problem;
    const int64_t most = 8 * (int64_t)c->fine->force_start[c->fine->nodes];
    entry *list = mem_array(most, sizeof *list, "the coarser model", e);
    const int64_t count = list ? list_entries(c, list) : 0, all = count + OWN * p->nodes;
    free(p->force_curve);
    free(p->force_spring);
    free(p->force_share);
    p->force_curve = mem_array(all, sizeof *p->force_curve, "the forces", e);
    p->force_spring = mem_array(all, sizeof *p->force_spring, "the forces", e);
    p->force_share = mem_array(all, sizeof *p->force_share, "the forces", e);
    const bool failed = !list || !p->force_curve || !p->force_spring || !p->force_share;
    for (int64_t n = 0, at = 0, next; n < p->nodes && !failed; n++, at = next) {
        for (next = at; next < count && list[next].node == n;)
            next++;
        fill_node(c, n, list + at, next - at);
    }
    free(list);
    return failed ? -1 : 0;
}

void coarse_push(coarse *c, const double *force)
{
    tled_problem *p = &c->problem;
    for (int64_t n = 0; n < p->nodes; n++)
        for (int a = 0; a < OWN; a++)
            p->force_share[p->force_start[n + 1] - OWN + a] += force[3 * n + a];
}
