#include "form_double.h"

#include "physics/fibre.h"
#include "physics/form_maths.h"

void form_double(form f, const double h[9], const double *c, double p[9])
{
    element_tensor at, stress;
    memcpy(&at, h, sizeof at);
    stress = form_stress(f, at, c);
    memcpy(p, &stress, sizeof stress);
}

void fibre_double(const fibre_local *l, const double h[9], double p[9])
{
    const fibre_set set = fibre_set_of(l, 1);
    element_tensor at, stress;
    memcpy(&at, h, sizeof at);
    stress = fibre_stress(at, &set, 1);
    memcpy(p, &stress, sizeof stress);
}
