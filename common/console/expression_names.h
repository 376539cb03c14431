/* The names of the expressions of a case, of which a page has sliders: the first word of each line of a file that
 * tled-run reads, and checks. The owner zeroes them to begin with, and frees them.
 */
#ifndef SINEW_EXPRESSION_NAMES_H
#define SINEW_EXPRESSION_NAMES_H

#include "base/err.h"

typedef struct expression_names {
    char **name; /* "@smile", each owned */
    int64_t count, room;
} expression_names;

/* -1 with e filled. */
int expression_names_read(expression_names *x, const char *path, err *e);
void expression_names_free(expression_names *x);

#endif
