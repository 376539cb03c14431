/* The forms of energy that Abaqus has too, as sinew export writes them and sinew import reads them: W = C10 (I1bar -
 * 3) + C01 (I2bar - 3) + (J - 1)^2 / D1, and the first and the last term alone. Abaqus Analysis User's Guide,
 * "Hyperelastic behavior". Owns nothing.
 */
#ifndef SINEW_INP_LAW_H
#define SINEW_INP_LAW_H

#include "physics/forms.h"

enum { INP_CONSTANTS = 3 }; /* the most */

typedef struct inp_law {
    const char *name; /* as *HYPERELASTIC has it */
    form form;
    int constants;
    const char *words; /* their names */
} inp_law;

static const inp_law inp_laws[] = {{"NEO HOOKE", FORM_NEO_HOOKEAN, 2, "C10, D1"},
                                   {"MOONEY-RIVLIN", FORM_MOONEY_RIVLIN, 3, "C10, C01, D1"}};
enum { INP_LAWS = sizeof inp_laws / sizeof *inp_laws };
#define INP_LAW_NAMES "NEO HOOKE or MOONEY-RIVLIN" /* for messages */

/* From the coefficients of the form, Pa. */
static inline void inp_law_write(const inp_law *of, const double *c, double *constants)
{
    const int last = of->constants - 1;
    for (int i = 0; i < last; i++)
        constants[i] = c[i];
    if (of->form == FORM_NEO_HOOKEAN)
        constants[0] = c[0] / 2;
    constants[last] = 2 / c[last];
}

/* The way back. */
static inline void inp_law_read(const inp_law *of, const double *constants, double *c)
{
    const int last = of->constants - 1;
    for (int i = 0; i < last; i++)
        c[i] = constants[i];
    if (of->form == FORM_NEO_HOOKEAN)
        c[0] = 2 * constants[0];
    c[last] = 2 / constants[last];
}

#endif
