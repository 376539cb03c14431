/* Whether the values of a known array are what the table of known arrays says (known.h): finite, in their range, of
 * length 1.
 */
#ifndef SINEW_VALUES_H
#define SINEW_VALUES_H

#include "model/known.h"

/* The first row that breaks the rule, or -1. The array's type and columns are k's. finite: it is known that all are.
 * One pass over what is good, at most. */
int64_t values_bad_row(const known *k, const model_array *a, bool finite);

/* Whether n numbers of a type are all finite; those that are not real are. */
bool values_finite(model_type type, const void *values, int64_t n);

/* Whether the rule has no place for nan and infinities. */
bool values_must_be_finite(const known *k);

/* A row's values between spaces, as short as they read back; to holds at least VALUES_TEXT bytes. */
enum { VALUES_MOST = 8, VALUES_TEXT = VALUES_MOST * 33 };
void values_text(const model_array *a, int64_t row, char to[VALUES_TEXT]);

#endif
