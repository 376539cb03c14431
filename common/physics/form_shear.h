/* How stiff a law is in shear, at rest and where tissue is deformed: hourglass control follows it (hourglass.h). In
 * simple shear of the amount g is x = I1bar - 3 = g^2, and the stress grows with g by 2 T(x), so mu = 2 T(0). Each form
 * has T as a function of x, of which it takes that of the state, whatever this is; T is above 0 for all laws that
 * law.h accepts. Owns nothing.
 */
#ifndef SINEW_FORM_SHEAR_H
#define SINEW_FORM_SHEAR_H

#include "physics/strain.h"

/* T(0), T(x) and dT/dx, Pa. */
typedef struct form_shear {
    real rest, now, slope;
} form_shear;

#endif
