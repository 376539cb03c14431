/* Which points are at one place: so soups of polygons, whose corners are written anew for each, are as good as
 * connected meshes. Owns nothing.
 */
#ifndef SINEW_COINCIDENT_H
#define SINEW_COINCIDENT_H

#include "base/err.h"

#include <stdint.h>

/* place: of each point, the number of its place, in the order of the first point at each; 0 and -0 are the same
 * coordinate. position: count x 3. Returns how many places there are, or -1 with e filled. */
int64_t coincident_places(const double *position, int64_t count, int32_t *place, err *e);

#endif
