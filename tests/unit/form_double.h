/* The stress of a form, and that of fibres, in double, for a test whose own numbers are float. */
#ifndef SINEW_FORM_DOUBLE_H
#define SINEW_FORM_DOUBLE_H

#include "physics/fibre_numbers.h"
#include "physics/forms.h"

/* h, p: row by row. */
void form_double(form f, const double h[9], const double *c, double p[9]);
void fibre_double(const fibre_local *l, const double h[9], double p[9]);

#endif
