/* Statistics of an array, and its values as text for people. Keeps nothing.
 */
#ifndef SINEW_INFO_STATS_H
#define SINEW_INFO_STATS_H

#include "base/out.h"
#include "model/model.h"

/* An array of three floating-point columns counts as vectors: min and max are then norms, and each column has a sum. */
typedef struct info_stats {
    double min, max;          /* of values, or of norms; nan left aside; nan where nothing is left */
    int64_t min_i64, max_i64; /* the same of i64, which a double does not always hold */
    double sum[3];            /* of values in [0], or of columns; nan where a value is */
    int64_t at_max;           /* the row of max, -1: none */
    int64_t nans;             /* values that are nan */
    int64_t count;            /* values, or vectors */
} info_stats;

bool info_is_vector(const model_array *a);

/* Not for strings. */
info_stats info_stats_of(const model_array *a);

/* The min and max of one column. */
info_stats info_column_of(const model_array *a, int32_t column);

/* Writes one number: short for a float, where it comes from an f32 array. */
void info_put_number(double value, model_type from, out *to);

/* Writes the min or the max of an array or a column of it, exact. */
void info_put_end(const model_array *a, const info_stats *s, bool max, out *to);

/* Writes one value, which is no string, exact. */
void info_put_value(const model_array *a, int64_t at, out *to);

#endif
