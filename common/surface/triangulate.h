/* Polygons cut into triangles: ear clipping in the plane of the polygon's Newell normal, so that concave ones come out
 * right; one that crosses itself is cut so that little is covered twice. Nothing is kept between calls.
 */
#ifndef SINEW_TRIANGULATE_H
#define SINEW_TRIANGULATE_H

#include "base/err.h"

#include <stdint.h>

/* Cuts a polygon of `count` corners (vertex: indices into position) into count - 2 triangles.
 * triangle: (count - 2) x 3 corners (0 to count - 1). Fewer than 3 corners give none. Returns 0, or -1 where memory is
 * short. Time is near-linear. */
int triangulate(const double *position, const int32_t *vertex, int64_t count, int32_t *triangle, err *e);

#endif
