/* The stress of one volume's fibres in float. Owns nothing. */
#ifndef SINEW_FIBRE_SINGLE_H
#define SINEW_FIBRE_SINGLE_H

#include "physics/fibre_numbers.h"

void fibre_single(const fibre_local *l, const double h[9], float p[9]);

#endif
