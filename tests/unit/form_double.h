/* The stress of a form in double, for a test whose own numbers are float. */
#ifndef SINEW_FORM_DOUBLE_H
#define SINEW_FORM_DOUBLE_H

#include "physics/forms.h"

/* h, p: row by row. */
void form_double(form f, const double h[9], const double *c, double p[9]);

#endif
