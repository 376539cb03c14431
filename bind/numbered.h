/* A file a frame: names from a pattern such as f_%04d.obj, and which of them were written, so that a run that fails
 * leaves none. Owns its list; the pattern is the caller's.
 */
#ifndef SINEW_NUMBERED_H
#define SINEW_NUMBERED_H

#include "base/out.h"

#include <stdint.h>

typedef struct numbered {
    const char *pattern;
    size_t from, to; /* where the conversion stands in it */
    int width;
    bool zeros;
    int64_t *written; /* frame indices */
    int64_t count, capacity;
} numbered;

/* pattern (NULL: a usage error too): one conversion %d, %4d or %04d, and no other '%'. -1 with e filled (status 2). */
int numbered_of(numbered *n, const char *pattern, err *e);

/* The file's name for a frame; the caller frees it. */
char *numbered_name(const numbered *n, int64_t index, err *e);

/* Notes that the frame's file is there. */
int numbered_add(numbered *n, int64_t index, err *e);

/* Removes the files noted. */
void numbered_remove(const numbered *n);
void numbered_free(numbered *n);

#endif
