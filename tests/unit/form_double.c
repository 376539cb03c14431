#include "form_double.h"

#include "physics/form_maths.h"

void form_double(form f, const double h[9], const double *c, double p[9])
{
    element_tensor at, stress;
    memcpy(&at, h, sizeof at);
    stress = form_stress(f, at, c);
    memcpy(p, &stress, sizeof stress);
}
