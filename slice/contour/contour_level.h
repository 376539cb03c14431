/* The level at which a contour of samples within 0 and 1 encloses a given volume: what Gaussian filtering takes from
 * thin parts of a label is not lost.
 */
#ifndef SINEW_CONTOUR_LEVEL_H
#define SINEW_CONTOUR_LEVEL_H

#include "slice/contour/contour.h"

/* As contour_make, at a level of its own choice. Where no level gives the volume to a half per cent, as where many
 * samples are equal, one that is near. */
int contour_make_of_volume(contour *c, const float *value, const int64_t size[3], double volume, const cubes *table,
                           err *e);

#endif
