/* Named sets of numbers, as ranges and as other sets: what they hold is found only once it is known which numbers there
 * are, so that no line of a file makes a set larger than itself. The creator owns them, zeroed to begin with.
 */
#ifndef SINEW_IMPORT_SETS_H
#define SINEW_IMPORT_SETS_H

#include "exchange/import_ids.h"
#include "surface/names.h"

typedef struct import_range {
    int32_t first, last, step; /* first < 0: the set of index -1 - first */
} import_range;

typedef struct import_set {
    import_range *range;
    int64_t count, room;
    int64_t seen; /* by which call of import_sets_go last */
} import_set;

typedef struct import_sets {
    names names; /* of the sets, in their order */
    import_set *set;
    int64_t count, room;
    int64_t goes; /* calls of import_sets_go */
    int32_t *queue;
    int64_t queue_room;
} import_sets;

/* The index of the set so named, or -1; open adds it where there is none (-1 with e filled). */
int32_t import_sets_find(const import_sets *s, const char *name);
int32_t import_sets_open(import_sets *s, const char *name, err *e);

/* first <= last, step >= 1. */
int import_sets_range(import_sets *s, int32_t at, int32_t first, int32_t last, int32_t step, err *e);
int import_sets_include(import_sets *s, int32_t at, int32_t other, err *e);

/* Calls `each` with the index of every one of `ids` (closed) that is in the set, some perhaps more than once, until it
 * gives other than 0, which is then returned. */
typedef int import_sets_each(void *context, int32_t index);
int import_sets_go(import_sets *s, int32_t at, const import_ids *ids, import_sets_each *each, void *context, err *e);

void import_sets_free(import_sets *s);

#endif
