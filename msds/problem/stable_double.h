/* The stable neo-Hookean law (stable.h) in double precision, an element at a time. */
#ifndef SINEW_STABLE_DOUBLE_H
#define SINEW_STABLE_DOUBLE_H

#include <math.h>

typedef double stable_number;
#define stable_larger fmax
#include "msds/problem/stable.h"

#endif
