#include "msds/problem/springs.h"

#include "base/mem.h"

#include <stdlib.h>

typedef struct edge {
    int32_t node[2];
    int32_t element;
} edge;

/* Those of one pair of nodes stand by their elements: the sums have one order. */
static int ascending(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    if (x->node[0] != y->node[0])
        return x->node[0] < y->node[0] ? -1 : 1;
    if (x->node[1] != y->node[1])
        return x->node[1] < y->node[1] ? -1 : 1;
    return (x->element > y->element) - (x->element < y->element);
}

static edge *all_edges(const msds_problem *p, err *e)
{
    static const int corner[6][2] = SIMPLEX_EDGES;
    edge *list = mem_array(p->elements, 6 * sizeof *list, "springs", e);
    if (!list)
        return NULL;
    for (int64_t t = 0; t < p->elements; t++)
        for (int i = 0; i < 6; i++) {
            int32_t a = p->element_node[4 * t + corner[i][0]], b = p->element_node[4 * t + corner[i][1]];
            list[6 * t + i] = a < b ? (edge){{a, b}, (int32_t)t} : (edge){{b, a}, (int32_t)t};
        }
    qsort(list, 6 * (size_t)p->elements, sizeof *list, ascending);
    return list;
}

static double length_of(const msds_problem *p, const int32_t node[2])
{
    const double *a = p->position + 3 * (int64_t)node[0], *b = p->position + 3 * (int64_t)node[1];
    return sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
}

/* The line numbers are Algorithm 1's. */
int springs_make(msds_problem *p, double scale, double damping, err *e)
{
    edge *list = all_edges(p, e);
    msds_spring *made = list ? mem_array(6 * p->elements, sizeof *made, "springs", e) : NULL;
    int64_t count = 0;
    for (int64_t i = 0; made && i < 6 * p->elements; i++) {
        double k = scale * p->young[list[i].element]; /* 5 */
        const int32_t *n = list[i].node, *last = count ? made[count - 1].node : NULL;
        if (!last || last[0] != n[0] || last[1] != n[1])                        /* 7 */
            made[count++] = (msds_spring){{n[0], n[1]}, length_of(p, n), 0, 0}; /* 11 */
        made[count - 1].stiffness += k;                                         /* 8 */
        made[count - 1].damper += damping * k;                                  /* 6, 9 */
    }
    free(list);
    p->spring = made;
    p->springs = count;
    return made ? 0 : -1;
}

int springs_find(const msds_problem *p, int32_t a, int32_t b)
{
    int64_t low = 0, high = p->springs - 1;
    int32_t first = a < b ? a : b;
    int32_t second = a < b ? b : a;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        const int32_t *n = p->spring[middle].node;
        if (n[0] < first || (n[0] == first && n[1] < second))
            low = middle + 1;
        else
            high = middle;
    }
    return (int)low;
}

void springs_change(msds_problem *p, double scale, double damping)
{
    static const int corner[6][2] = SIMPLEX_EDGES;
    for (int64_t i = 0; i < p->springs; i++)
        p->spring[i].stiffness = p->spring[i].damper = 0;
    for (int64_t t = 0; t < p->elements; t++) /* each edge's elements ascend, as in springs_make: sums have one order */
        for (int i = 0; i < 6; i++) {
            const int32_t *n = p->element_node + 4 * t;
            msds_spring *s = &p->spring[springs_find(p, n[corner[i][0]], n[corner[i][1]])];
            const double k = scale * p->young[t];
            s->stiffness += k;
            s->damper += damping * k;
        }
}
