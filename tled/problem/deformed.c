#include "tled/problem/deformed.h"

#include "mesh/fibre_sets.h"
#include "physics/element_cut.h"
#include "tled/problem/conforming_step.h"
#include "tled/problem/muscle_fibre.h"

/* Of a laminate: its energies, nan where its parts cannot be. The law keeps what adds to the tangent at the mean F. */
static void find_laminate(const tled_problem *p, int64_t element, element_shape box, element_modes x, element_modes y,
                          element_modes z, deformed *d)
{
    d->parts = border_parts_of(p, element, d->border);
    d->laminate = border_state(p, &d->parts, x, y, z, box);
    const double held = hourglass_dot(&d->laminate.held.f, &d->laminate.modes) / 2;
    d->energy = border_is_found(&d->laminate) ? laminate_energy(p->form, &d->laminate, d->parts.c[0], d->parts.c[1])
                                              : (double)NAN;
    d->stiffening = stability_stiffening_of(p->form, p->control.kind, d->h, d->law.c);
    d->hourglass = held;
    for (int i = 0; i < form_moduli(p->form); i++)
        d->law.c[i] = 0;
    stability_stiffen(d->stiffening, held / d->stiffening.now / d->rest, d->law.c);
}

deformed deformed_of(const tled_problem *p, int64_t element, element_shape box, const double *displacement)
{
    deformed d = {.law = tled_law_of(p, element)};
    element_modes x = deformed_modes(p, element, displacement, 0), y = deformed_modes(p, element, displacement, 1);
    element_modes z = deformed_modes(p, element, displacement, 2);
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
    const double along = muscle_fibre_energy(p, element, d.h) + fibre_sets_energy(&fibres, d.h);
    d.border = tled_border(p, element);
    if (d.border) {
        find_laminate(p, element, box, x, y, z, &d);
        d.energy += along;
        return d;
    }
    d.energy = form_energy(p->form, d.h, d.law.c) + along;
    d.stiffening = stability_stiffening_of(p->form, p->control.kind, d.h, d.law.c);
    d.hourglass = d.stiffening.now * w0;
    stability_stiffen(d.stiffening, w0 / d.rest, d.law.c);
    return d;
}
