/* The rules of sinew-model(5) for names, units and text. model_check() of model.h, which applies the rules to a
 * whole array, is here too. Nothing is allocated.
 */
#ifndef SINEW_CHECK_H
#define SINEW_CHECK_H

#include "model/model.h"

/* Names of arrays and axes, keys, tools and versions: 1 to 255 of letters, digits and . _ - / */
bool check_name(const char *name);

/* Units: 1 to 255 printable ASCII characters, no space or quote; after '@' an axis's name. */
bool check_unit(const char *unit);

/* Types of blocks: four letters or digits. */
bool check_type(const char *type);

/* What is wrong with a string, after its name ("is not UTF-8"), or NULL. A string has a length of 32 bits. */
const char *check_text(const char *text);

/* The two parts of model_check: all but the range of indices, and that, which needs every axis. finite: it is known
 * that all values are, so that they need not be looked at for that. */
int check_array(const model_array *a, bool finite, const char *where, int64_t line, err *e);
int check_indexed(const model *m, const model_array *a, const char *where, int64_t line, err *e);

/* What indices have to be: from `low` on and below `end`. There are none where end is -1: the array is not of indices,
 * or m does not have their axis (yet). */
typedef struct check_range {
    int64_t low, end;
} check_range;
check_range check_range_of(const model *m, const model_array *a);

/* Whether all n values, i32 or i64, are within a range that there is. */
bool check_within(check_range r, model_type type, const void *values, int64_t n);

/* rows x columns, or -1 where that many things of `size` bytes cannot be. */
int64_t check_count(int64_t rows, int32_t columns, size_t size);

#endif
