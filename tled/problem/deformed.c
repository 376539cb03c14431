#include "tled/problem/deformed.h"

#include "mesh/fibre_sets.h"
#include "physics/element_cut.h"
#include "tled/problem/conforming_step.h"
#include "tled/problem/muscle_fibre.h"

static element_modes modes_of(const tled_problem *p, int64_t element, const double *displacement, int axis)
{
    element_corners c;
    for (int i = 0; i < 8; i++)
        c.at[i] = displacement[3 * (int64_t)p->element_node[8 * element + i] + axis];
    return element_modes_of(c);
}

deformed deformed_of(const tled_problem *p, int64_t element, element_shape box, const double *displacement)
{
    deformed d = {.law = tled_law_of(p, element)};
    element_modes x = modes_of(p, element, displacement, 0), y = modes_of(p, element, displacement, 1);
    element_modes z = modes_of(p, element, displacement, 2);
    hourglass_force f;
    if (p->conforming) {
        const conforming_hold hold = conforming_hold_of(p, element);
        const element_any any = conforming_shape(p, element, &hold);
        d.h = element_any_twist(&any, &x, &y, &z);
        d.modes = element_hourglass_modes(x, y, z);
        f = element_any_hourglass(p->control.kind, d.modes, d.h, &any, hold.law);
        d.rest = any.volume;
    } else {
        d.h = element_gradient_by(tled_cut(p, element), x, y, z, box.slope);
        d.modes = element_hourglass_modes(x, y, z);
        f = hourglass_of(p->control.kind, d.modes, d.h, box, d.law.hourglass);
        d.rest = p->side[0] * p->side[1] * p->side[2];
    }
    const double w0 = hourglass_dot(&f.f, &d.modes) / 2; /* f.m = s.q: the energy is quadratic in q */
    d.dilation = element_dilation(d.h);
    const fibre_sets fibres = fibre_sets_at(&p->fibres, element);
    d.energy =
        form_energy(p->form, d.h, d.law.c) + muscle_fibre_energy(p, element, d.h) + fibre_sets_energy(&fibres, d.h);
    d.stiffening = stability_stiffening_of(p->form, p->control.kind, d.h, d.law.c);
    d.hourglass = d.stiffening.now * w0;
    stability_stiffen(d.stiffening, w0 / d.rest, d.law.c);
    return d;
}
