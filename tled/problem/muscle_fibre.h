/* The fibres of elements as the maths of an element takes them, in double: for the stable step, monitors and reports.
 * Owns nothing.
 */
#ifndef SINEW_MUSCLE_FIBRE_H
#define SINEW_MUSCLE_FIBRE_H

#include "physics/element.h"
#include "tled/problem/state.h"

/* An element's fibre that belongs to a volume. along: elements x 3, NULL: there are none; volume below 0: likewise;
 * share: what of the element is the volume's; value: of all curves, NULL: levels of 0. */
element_fibre muscle_fibre_of(const tled_problem *p, const float *along, int64_t element, int32_t volume, double share,
                              const double *value);

/* What the passive curves of an element's muscles hold at H, J/m3 by volume at rest. */
double muscle_fibre_energy(const tled_problem *p, int64_t element, element_tensor h);

/* Whether the stress along any fibre of an element falls as it is stretched (stability_falls). value: of all curves;
 * mu: of the element's law, Pa. */
bool muscle_fibre_falls(const tled_problem *p, int64_t element, const double *value, element_tensor h, double mu);

/* Contractile elements (physics/muscle_series.h) at the start, field TLED_CONTRACTILE or TLED_MIXCONTRACTILE: at its
 * displacements each muscle pulls as it does where nothing moves. -1 with e filled. */
int muscle_fibre_rest(tled_problem *p, int i, double time, err *e);

#endif
