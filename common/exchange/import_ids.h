/* The numbers that a mesh's file gives its nodes or elements, and the index that each has in our mesh: files may leave
 * numbers out and keep any order. The creator owns the list, zeroed to begin with.
 */
#ifndef SINEW_IMPORT_IDS_H
#define SINEW_IMPORT_IDS_H

#include "base/err.h"

typedef struct import_ids {
    int32_t *id;    /* as they came; once closed, rising */
    int32_t *index; /* whose it is; NULL while they came in rising order: then the place in the list */
    int64_t count, room;
    bool falls; /* some number is not above the one before */
} import_ids;

/* The next one's number. */
int import_ids_add(import_ids *s, int32_t id, err *e);

/* No more come: find may be called. -1 with e filled (place: the file; what: "node") where a number stands twice. */
int import_ids_close(import_ids *s, const char *what, const char *place, err *e);

/* Whose number it is, or -1. */
int32_t import_ids_find(const import_ids *s, int64_t id);

/* The number of one of ours, for messages. */
int32_t import_ids_of(const import_ids *s, int32_t index);

void import_ids_free(import_ids *s);

#endif
