#include "tled/cuda/places.h"

#include "mesh/lattice.h"

#include <math.h>

static int32_t root(int32_t *part, int32_t n)
{
    while (part[n] != n)
        n = part[n] = part[part[n]];
    return n;
}

/* The root of each part is its lowest node. */
static void find_parts(const tled_problem *p, int32_t *part)
{
    for (int32_t n = 0; n < p->nodes; n++)
        part[n] = n;
    for (int64_t i = 0; i < 8 * p->elements; i++) {
        int32_t a = root(part, p->element_node[i / 8 * 8]), b = root(part, p->element_node[i]);
        part[a > b ? a : b] = a > b ? b : a;
    }
    for (int32_t n = 0; n < p->nodes; n++)
        part[n] = root(part, n);
}

int places_none(err *e, int64_t element)
{
    return err_set(e, NULL, 0,
                   "element %lld: two nodes share a place in the lattice, or it is off it; expected elements "
                   "of one part to share their nodes, or -d cpu",
                   (long long)element);
}

int places_find(const tled_problem *p, int32_t *part, int32_t *at, err *e)
{
    find_parts(p, part);
    for (int64_t n = 0; n < p->nodes; n++)
        for (int a = 0; a < 3; a++) {
            double way = p->position[3 * n + a] - p->position[3 * (int64_t)part[n] + a];
            at[3 * n + a] = (int32_t)nearbyint(way / p->side[a]);
        }
    for (int64_t i = 0; i < 8 * p->elements; i++)
        for (int a = 0; a < 3; a++)
            if (at[3 * (int64_t)p->element_node[i] + a] !=
                at[3 * (int64_t)p->element_node[i / 8 * 8] + a] + lattice_vtk[i % 8][a])
                return places_none(e, i / 8);
    return 0;
}
