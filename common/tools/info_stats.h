/* What can be said of an array in a few numbers, and how its values are written for people. Nothing is kept.
 */
#ifndef SINEW_INFO_STATS_H
#define SINEW_INFO_STATS_H

#include "base/out.h"
#include "model/model.h"

/* An array of three floating-point columns counts as vectors: min and max are then norms, and each column has a sum. */
typedef struct info_stats {
    double min, max; /* of values, or of norms; nan left aside; nan where nothing is left */
    double sum[3];   /* of values in [0], or of columns; nan where a value is */
    int64_t at_max;  /* the row of max, -1: none */
    int64_t nans;    /* values that are nan */
    int64_t count;   /* values, or vectors */
} info_stats;

bool info_is_vector(const model_array *a);

/* Not for strings. */
info_stats info_stats_of(const model_array *a);

/* The least and the greatest of one column, nan left aside; nan where nothing is left. */
void info_column_range(const model_array *a, int32_t column, double *low, double *high);

/* Writes one number: short for a float, where it comes from an f32 array. */
void info_put_number(double value, model_type from, out *to);

#endif
