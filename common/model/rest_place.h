/* The row of an axis that rests nearest to a place: what at.X,Y,Z means in `sinew info` and in a log. */
#ifndef SINEW_REST_PLACE_H
#define SINEW_REST_PLACE_H

#include "model/model.h"

/* Three lengths between commas, in metres or each with its unit. False: they are not. */
bool rest_place_of(const char *text, double *place);

/* The row of the axis nearest to the place (m), the lower of two as near; an element stands at the mean of its nodes.
 * -1: the axis has no places. */
int64_t rest_place_row(const model *m, const char *axis, const double *place);

#endif
