#include "tled/problem/deformed.h"

#include "tled/problem/conforming_step.h"

static element_modes modes_of(const tled_problem *p, int64_t element, const double *displacement, int axis)
{
    element_corners c;
    for (int i = 0; i < 8; i++)
        c.at[i] = displacement[3 * (int64_t)p->element_node[8 * element + i] + axis];
    return element_modes_of(c);
}

/* H; the hourglass modes of an element that is no box lose what H has of them, its
 * law gets its own stiffness against them. */
static element_tensor gradient_of(const tled_problem *p, int64_t i, element_shape box, element_modes *x,
                                  element_modes *y, element_modes *z, tled_law *law)
{
    if (!p->conforming)
        return element_gradient(*x, *y, *z, box.slope);
    const element_any any = conforming_shape(&p->conforming->element[i]);
    law->hourglass = p->conforming->element[i].hourglass;
    return element_any_twist(&any, x, y, z);
}

deformed deformed_of(const tled_problem *p, int64_t element, element_shape box, const double *displacement)
{
    deformed d = {.law = tled_law_of(p, element)};
    element_modes x = modes_of(p, element, displacement, 0), y = modes_of(p, element, displacement, 1);
    element_modes z = modes_of(p, element, displacement, 2);
    d.h = gradient_of(p, element, box, &x, &y, &z, &d.law);
    d.rest = p->conforming ? p->conforming->element[element].volume : p->side[0] * p->side[1] * p->side[2];
    d.dilation = element_dilation(d.h);
    d.energy = form_energy(p->form, d.h, d.law.c);
    d.hourglass = element_hourglass_energy(x, d.law.hourglass) + element_hourglass_energy(y, d.law.hourglass) +
                  element_hourglass_energy(z, d.law.hourglass);
    return d;
}
