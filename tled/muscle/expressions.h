/* Expressions: names for several muscles together, each with a level, as a file gives them:
 *
 *     smile: zyg_*=.8 ris_*=.4   # a comment
 *
 * At a level of an expression its muscles have that share of their levels. The owner zeroes expressions to begin with,
 * and frees them.
 */
#ifndef SINEW_EXPRESSIONS_H
#define SINEW_EXPRESSIONS_H

#include "base/in.h"
#include "base/lookup.h"
#include "model/model.h"

typedef struct expression_part {
    int32_t volume; /* of a muscle */
    double level;   /* 0 to 1 */
} expression_part;

typedef struct expression {
    char *name; /* without the '@' that stands before it where it is used; owned */
    int64_t line;
    int64_t first, count; /* of its parts, ascending by volume */
} expression;

typedef struct expressions {
    expression *list;
    int32_t count;
    int64_t room;
    expression_part *part; /* of all */
    int64_t parts, part_room;
    lookup index; /* of list */
} expressions;

/* Reads a file, for the muscles of m. -1 with e filled at the first thing that is wrong: file:line. */
int expressions_read(expressions *x, in *source, const model *m, err *e);
void expressions_free(expressions *x);

/* The index of the expression of that name, or -1 with e filled at place:line; line 0: place is an option of the
 * command line. x may be NULL, where no file was given. */
int32_t expressions_find(const expressions *x, const char *name, const char *place, int64_t line, err *e);

#endif
