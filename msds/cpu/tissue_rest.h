/* Cavities in the method tissue: their pressures, and the prestress that is in balance with these where the tissue is
 * at rest, as a model has the shape in which it was imaged. It is the stress that linear elasticity has under them,
 * taken as a second Piola-Kirchhoff stress, which turns with the tissue. Owns nothing.
 */
#ifndef SINEW_TISSUE_REST_H
#define SINEW_TISSUE_REST_H

#include "msds/cpu/tissue.h"

/* Makes t->m.prestress, if a cavity has a pressure at rest, by conjugate gradients. -1 with e filled. */
int tissue_rest_make(tissue *t, err *e);

/* Takes the pressures that cavities have now; elapsed as tissue_begin's. */
void tissue_rest_fill(tissue *t, double elapsed);

#endif
