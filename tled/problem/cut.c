#include "tled/problem/cut.h"

#include "base/mem.h"
#include "mesh/lattice.h"

#include <math.h>

double cut_inertia(const tled_problem *p, int64_t element)
{
    const double share = tled_fraction(p, element);
    return share < CUT_LEAST && tled_cut(p, element) ? CUT_LEAST : share;
}

int cut_borrow(tled_problem *p, const model *m, err *e)
{
    if (cut_moments_of(&p->cut, m, e))
        return -1;
    if (p->cut.count && p->conforming)
        return err_set(e, NULL, 0, "cut.moments are of elements without a lattice; expected them of a lattice's boxes");
    return 0;
}

int64_t cut_least(const tled_problem *p)
{
    int64_t count = 0;
    for (int64_t i = 0; i < p->cut.count; i++)
        count += tled_fraction(p, p->cut.element[i]) < CUT_LEAST;
    return count;
}

/* The mean of a corner's shape function over the part. */
static double weight_of(const float *moments, int corner)
{
    const double x = 2 * lattice_vtk[corner][0] - 1, y = 2 * lattice_vtk[corner][1] - 1,
                 z = 2 * lattice_vtk[corner][2] - 1;
    const element_cut c = element_cut_of(moments);
    return (1 + x * c.x + y * c.y + z * c.z + x * y * c.xy + y * z * c.yz + z * x * c.zx +
            x * y * z * (double)moments[CUT_XYZ]) /
           8;
}

int cut_weigh(tled_problem *p, err *e)
{
    const double volume = p->side[0] * p->side[1] * p->side[2];
    if (!p->cut.count)
        return 0;
    p->weight = mem_array(p->nodes, sizeof *p->weight, "the nodes", e);
    for (int64_t i = 0; p->weight && i < p->elements; i++) {
        const double mass = tled_law_of(p, i).density * volume * tled_fraction(p, i);
        const float *moments = tled_cut(p, i);
        for (int c = 0; c < 8; c++)
            p->weight[p->element_node[8 * i + c]] += mass * (moments ? weight_of(moments, c) : .125);
    }
    return p->weight ? 0 : -1;
}

void cut_matrix(const tled_problem *p, int64_t element, const float *moments, step_matrix *a)
{
    stability_cut_matrix(element_cut_of(moments), cut_lighter(tled_fraction(p, element)), a);
}

stability_twists cut_twists(const tled_problem *p, int64_t element, const float *moments, stability_twists whole)
{
    return stability_cut_twists(element_cut_of(moments), cut_lighter(tled_fraction(p, element)), whole);
}

double cut_raises(const tled_problem *p, int64_t element, const float *moments)
{
    const stability_gram g = stability_gram_of(element_cut_of(moments));
    return cut_lighter(tled_fraction(p, element)) * stability_gram_bound(&g);
}
