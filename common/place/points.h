/* Points that people picked, and their names, from a file: Slicer's .fcsv, whose header says in which axes it is, in
 * mm; or text, a point a line, `x y z` or `NAME x y z`, whose unit the caller knows. And which points of two files are
 * the same. The owner frees them.
 */
#ifndef SINEW_POINTS_H
#define SINEW_POINTS_H

#include "base/in.h"
#include "base/lookup.h"
#include "base/num.h"

enum { POINTS_MOST = 1000000 };

typedef struct points_one {
    char *name;   /* owned; "" where it has none */
    double at[3]; /* m */
    int64_t line;
} points_one;

typedef struct points {
    points_one *one;
    int64_t count, room;
    bool named; /* all are, with different names */
    lookup names;
} points;

typedef struct points_wish {
    num_unit unit; /* of text; 0: not known, which text needs */
    bool shown;    /* .fcsv as Slicer shows it, in RAS; else in LPS */
} points_wish;

/* -1 with e filled: file and line. p, zeroed to begin with, is to be freed all the same. */
int points_read(points *p, in *s, const points_wish *wish, err *e);
void points_free(points *p);

/* pair[i]: which of b is point i of a: by name where both have names, and `by_order` is not set, else by their order.
 * to: count of a. -1 with e filled: one without a partner, which is looked for in b's file. */
int points_pair(const points *a, const points *b, const char *a_name, const char *b_name, bool by_order, int64_t *pair,
                err *e);

#endif
