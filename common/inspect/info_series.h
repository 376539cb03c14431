/* `sinew info --tsv KEY`: one or several values of each frame of a stream as it comes, a row a frame, tab-separated.
 * The caller owns the struct; begin with a zeroed one.
 */
#ifndef SINEW_INFO_SERIES_H
#define SINEW_INFO_SERIES_H

#include "cli/opt.h"
#include "inspect/info_quality.h"
#include "model/source.h"

typedef struct info_series {
    int values[64]; /* how many each key has in a frame */
    info_quality_seen seen;
} info_series;

/* Writes the row of the frame read last, and before the first the heading. -1 with e filled: a key that frames have no
 * value for. */
int info_series_row(info_series *series, const source *s, const opt_list *keys, out *to, err *e);

#endif
