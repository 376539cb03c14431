/* `sinew info --json`: the whole summary of a model that has been read to its end, as one JSON object. Numbers that
 * JSON lacks (nan, inf) are null.
 */
#ifndef SINEW_INFO_JSON_H
#define SINEW_INFO_JSON_H

#include "base/out.h"
#include "model/source.h"

/* times: those of the first and of the last frame, where there are frames. elements: of each volume. */
void info_json(const source *s, const double *times, const int64_t *elements, out *to);

#endif
