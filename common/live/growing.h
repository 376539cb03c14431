/* A log file, which may be read while it is written. Each call writes its lines to the file at once and in one piece,
 * so that readers see whole lines. Unlike a file of out.h, it has its name from the start, and is not removed after a
 * failure. The creator owns it.
 */
#ifndef SINEW_GROWING_H
#define SINEW_GROWING_H

#include "base/err.h"

#include <stddef.h>

typedef struct growing growing;

/* Makes the file, or cuts it to its first `keep` bytes, which must be there (0: empties it); a device or FIFO is
 * written as it is. "-" is refused. NULL with e filled. */
growing *growing_open(const char *path, int64_t keep, err *e);

/* Bytes of what is there, what was kept included. */
int64_t growing_size(const growing *g);

/* Adds whole lines. -1 with e filled: to a full disk nothing more is written, and a line begun is taken back. */
int growing_put(growing *g, const void *lines, size_t size, err *e);

/* Waits until all that was put is stored, and the file's name. -1 with e filled. */
int growing_store(growing *g, err *e);

/* Closes it and frees g, which may be NULL. 0, or -1 with e filled. */
int growing_close(growing *g, err *e);

#endif
