/* Makes the names of numbered files, one for each frame, from a pattern such as f_%04d.obj. Keeps nothing; the pattern
 * is the caller's.
 */
#ifndef SINEW_NUMBERED_H
#define SINEW_NUMBERED_H

#include "base/err.h"

#include <stddef.h>

typedef struct numbered {
    const char *pattern;
    size_t from, to; /* where the conversion stands in it */
    int width;
    bool zeros;
} numbered;

/* pattern (NULL: a usage error too): one conversion %d, %4d or %04d, and no other '%'. otherwise: what the tool offers
 * in place of files, as ", or --format pc2"; "": nothing. -1 with e filled (status 2). */
int numbered_of(numbered *n, const char *pattern, const char *otherwise, err *e);

/* Whether a name (or NULL) is such a pattern. */
bool numbered_is(const char *name);

/* The file's name for a frame; the caller frees it. */
char *numbered_name(const numbered *n, int64_t index, err *e);

#endif
