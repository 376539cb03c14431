/* The rigid motion that is nearest to what points did, in the sum of squares (Horn 1987). Keeps nothing.
 */
#ifndef SINEW_POSE_FIT_H
#define SINEW_POSE_FIT_H

#include "base/pose.h"

#include <stdint.h>

/* rest: positions x 3, m; displacement: x 3, m, of the same points; point: which of them, count of them. Where they do
 * not say how they turned, as on one line, it is by the least of the turns that suit. */
pose pose_fit(const double *rest, const double *displacement, const int32_t *point, int64_t count);

#endif
