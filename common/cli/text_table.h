/* A report as a table of text: a line or two of headings, and rows whose columns are aligned, whatever
 * characters are in them. The caller owns it. Errors stick: text_table_lines() returns them.
 */
#ifndef SINEW_TEXT_TABLE_H
#define SINEW_TEXT_TABLE_H

#include "base/err.h"
#include "base/out.h"

typedef struct text_table text_table;

/* heads: of the columns (at most 16), up to NULL, each with its alignment first: "<name" to the left, ">size\nmm" to
 * the right; a newline begins the second line. The texts are borrowed. NULL with e filled. */
text_table *text_table_create(const char *const *heads, err *e);
void text_table_free(text_table *t);

/* The next cell, row after row. Control characters in it become '?'. */
void text_table_cell(text_table *t, const char *format, ...) SINEW_PRINTF(2, 3);

/* A cell of a whole number, and one of a number with so many decimals ("-": nan). */
void text_table_count(text_table *t, int64_t number);
void text_table_number(text_table *t, double number, int decimals);

/* Whether it has no rows. */
bool text_table_is_empty(const text_table *t);

/* How many decimals show `digits` digits of the largest of some numbers: 0 to 9. */
int text_table_decimals(double largest, int digits);

/* The table's lines, which begin with two spaces. It fits 80 columns where all but the first column leave that 24 or
 * more; a longer name in the first column has a line of its own. The caller frees the text. NULL with e filled. */
char *text_table_lines(const text_table *t, err *e);

/* Writes them, and frees the table, which may be NULL with e filled. -1 with e filled. */
int text_table_put(text_table *t, out *to, err *e);

#endif
