/* The cases that a console offers: of the command line, or of a folder that it names. A page knows them by their names
 * alone, so no other file can be asked for. The caller owns the list, zeroed to begin with.
 */
#ifndef SINEW_CASES_H
#define SINEW_CASES_H

#include "base/err.h"

typedef struct console_case {
    char *name;        /* no two are the same */
    char *model;       /* path */
    char *volume;      /* path; NULL: none */
    char *labels;      /* path; NULL: none */
    char *picture;     /* path; NULL: none */
    char *body;        /* path of body.txt; NULL: none */
    char *skin;        /* path of skin.obj, pressed as springs of its own; NULL: none */
    char *bones;       /* path of skeleton.obj; NULL: none */
    char *expressions; /* path of expressions.txt, of a face; NULL: none */
} console_case;

typedef struct cases {
    console_case *list;
    int count;
    int64_t capacity;
} cases;

/* Adds what the operands name: models, each followed by its volume or not; folders that are cases (a model, a volume,
 * labels), or that hold cases and models. -1 with e filled: also where one has none. */
int cases_add(cases *c, char *const *operand, int count, err *e);

/* The case's index, or -1. */
int cases_find(const cases *c, const char *name);
void cases_free(cases *c);

#endif
