/* Numbers, lengths and lists as people write them: the whole text must be the number, in the C locale.
 * Nothing here allocates or keeps state.
 */
#ifndef SINEW_NUM_H
#define SINEW_NUM_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

enum { NUM_TEXT = 32 }; /* bytes that hold any number as text */

/* A unit of length, as its count of micrometres; 0: none was written. */
typedef int num_unit;

typedef struct num_length {
    double value;
    num_unit unit; /* the suffix's; 0: it had none */
} num_length;

/* Reads a finite decimal number from text up to end; *stop (may be NULL) gets where it ends. Returns 0, or -1
 * where there is no number or it is out of a double's range. Exact (correctly rounded), and fast for what
 * people and tools write. "nan" and "inf" are not numbers here. */
int num_scan(const char *text, const char *end, const char **stop, double *value);

/* The whole of text as a finite number. Returns 0 or -1. */
int num_double(const char *text, double *value);

/* The whole of text as a decimal integer within [low, high]. Returns 0 or -1. */
int num_int(const char *text, int64_t low, int64_t high, int64_t *value);

/* The names of units: for messages, for the arguments of options, and in a list. */
#define NUM_UNITS_JOINED(comma, last) "um" comma "mm" comma "cm" comma "m" last "in"
#define NUM_UNITS                     NUM_UNITS_JOINED(", ", " or ")
#define NUM_UNITS_CHOICES             NUM_UNITS_JOINED("|", "|")
#define NUM_UNITS_LIST                NUM_UNITS_JOINED(", ", ", ")

/* um mm cm m in (any case), or 0 where it is none of these. */
num_unit num_unit_of(const char *name);
const char *num_unit_name(num_unit unit);

/* "4cm", "2.5mm", "0.1": the whole of text. Returns 0 or -1. */
int num_length_of(const char *text, num_length *length);

/* A length in the unit `to`; what has no suffix is taken to be in `unsuffixed`. One
 * rounding; two between inches and mm, cm or m. */
double num_length_in(num_length length, num_unit unsuffixed, num_unit to);

/* "10mmHg", "1.3kPa", "500Pa", "500": a pressure in Pa; the whole of text. Returns 0 or -1. */
int num_pressure_of(const char *text, double *pressure);

/* "500MB", "2GiB", "1.5 GB", "4096B": bytes, in units of 1000 or 1024; the whole of text, more than 0. Returns 0 or
 * -1. */
int num_size_of(const char *text, int64_t *bytes);

/* Bytes for people: "2.35 GB". to holds at least NUM_TEXT bytes, and is returned. */
char *num_size_text(double bytes, char *to);

/* A list of lengths between commas, at most `most`. Returns how many, or -1. */
int num_lengths_of(const char *text, num_length *list, int most);

/* A list of numbers between commas, at most `most`. Returns how many, or -1. */
int num_list(const char *text, double *list, int most);

/* Numbers between white space, from text up to end, at most `most`. Returns how many, or -1 where it is not all
 * numbers, or more. */
int num_words(const char *text, const char *end, double *list, int most);

/* The shortest text that reads back as the same double (single: as the same float), C locale; to holds at least
 * NUM_TEXT bytes. "nan" has no sign. Returns its length. */
int num_text(double value, bool single, char *to);

/* x, or the nearer of low and high where it lies outside of them. nan stays. low <= high. */
static inline double num_clamp(double x, double low, double high)
{
    if (x < low)
        return low;
    return x > high ? high : x;
}

static inline int64_t num_clamp_int(int64_t x, int64_t low, int64_t high)
{
    if (x < low)
        return low;
    return x > high ? high : x;
}

#endif
