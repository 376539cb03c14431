/* The energies of a model's elements and films in a frame of tled-run: strain energy, and the energy of the modes that
 * hourglass control resists, as the solver computes them (element.h, element_any.h, bone_films.h). The coefficient of
 * hourglass control is the model's metadata hourglass.kappa. Owns nothing.
 */
#ifndef SINEW_ENERGY_H
#define SINEW_ENERGY_H

#include "model/model.h"

typedef struct energy {
    double strain,
        hourglass; /* J; strain without hourglass energy, with that of stretched muscles, without what these do */
    double scale;  /* J: the sum of mu V, beside which these may be rounding (quality_hourglass) */
} energy;

/* -1 with e filled: the elements are no hexahedra, it is not known by what coefficient their modes were
 * held, or the model lacks what it takes. */
int energy_of(energy *to, const model *m, const frame *f, err *e);

#endif
