/* A set of names, numbered in the order in which they were first given. Owns all; begin with a zeroed one.
 */
#ifndef SINEW_NAMES_H
#define SINEW_NAMES_H

#include "base/lookup.h"

typedef struct names {
    char **name; /* each owned */
    int32_t count;
    int64_t room;
    lookup index;
} names;

/* The number of the name, which is added where it is new. -1 with e filled on no memory. */
int32_t names_number(names *n, const char *name, err *e);

/* The number of the name, or -1 where it has none. */
int32_t names_find(const names *n, const char *name);

void names_free(names *n);

#endif
