/* Coefficients to try each form with: of a shear modulus and a bulk modulus at rest (Pa). A new form has its case here,
 * from which the tests of forms, of the stable step and of steppers take them. Owns nothing.
 */
#ifndef SINEW_FORM_TRIED_H
#define SINEW_FORM_TRIED_H

#include "physics/form_general.h"

#include <stdbool.h>
#include <string.h>

/* False, and all of c 0, where the form has no case. */
static inline bool form_tried(form f, double mu, double bulk, double c[FORM_NUMBERS])
{
    memset(c, 0, FORM_NUMBERS * sizeof *c);
    switch (f) {
    case FORM_NEO_HOOKEAN:
        c[0] = mu, c[1] = bulk;
        return true;
    case FORM_MOONEY_RIVLIN: /* mu = 2 (c10 + c01) */
        c[0] = .3 * mu, c[1] = .2 * mu, c[2] = bulk;
        return true;
    case FORM_FIRST: /* mu = 2 c1 */
        c[0] = .5 * mu, c[1] = .3 * mu, c[2] = .1 * mu, c[3] = .03 * mu, c[4] = .01 * mu, c[5] = bulk;
        return true;
    case FORM_GENERAL: /* some of each, with c01 below 0: of mu .2, .4 and .4 */
        c[0] = .15 * mu, c[1] = .1 * mu, c[FORM_GENERAL_c01] = -.05 * mu, c[FORM_GENERAL_K] = bulk;
        c[FORM_GENERAL_e] = .2 * mu, c[FORM_GENERAL_b] = 1;
        c[FORM_GENERAL_m] = .15 * mu, c[FORM_GENERAL_a] = -2;
        c[FORM_GENERAL_m + 1] = .1 * mu / 4.5, c[FORM_GENERAL_a + 1] = 3;
        return true;
    default:
        return false;
    }
}

#endif
