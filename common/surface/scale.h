/* The unit of an OBJ's coordinates and its length in metres, by one rule for all tools that take a unit. Owns nothing.
 */
#ifndef SINEW_SCALE_H
#define SINEW_SCALE_H

#include "base/num.h"
#include "model/model.h"

/* unit: as given on the command line (an unknown one is a usage error), or NULL: the model's source.unit. Returns the
 * unit, or 0 with e filled. */
num_unit scale_unit(const char *unit, const model *m, err *e);

/* Metres in it. */
double scale_of(num_unit unit);

#endif
