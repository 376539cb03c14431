/* Memory whose sizes are checked for overflow. What these return is the caller's to free(). */
#ifndef SINEW_MEM_H
#define SINEW_MEM_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

/* Zeroed memory for count things of size bytes, or NULL with e filled. Never NULL for count 0. */
void *mem_array(int64_t count, size_t size, const char *what, err *e);

/* Makes *array (of *capacity things) hold at least need, at least doubling. Returns 0, or -1 with e filled
 * and the array as it was. What is new is not zeroed. */
int mem_grow(void *array, int64_t *capacity, int64_t need, size_t size, const char *what, err *e);

/* mem_grow where it is needed: for loops that add one thing at a time. */
#define MEM_ROOM(array, capacity, need, what, e)                                                                       \
    ((need) > *(capacity) ? mem_grow(array, capacity, need, sizeof **(array), what, e) : 0)

/* Says to the system that memory of this size, which nothing has touched yet, may come in large pages: most of the time
 * that it takes to touch much memory once goes into the pages' coming one at a time. mem_array and mem_grow say it. */
void mem_large(void *p, size_t size);

/* A copy of text, or NULL with e filled. */
char *mem_text(const char *text, err *e);

/* Bytes of memory free for use now: MemAvailable, and no more than the process's control groups leave (cgroup v2); or a
 * guess that is large where it cannot be known. */
int64_t mem_available(void);

/* What the control group at path (as "/a/b") and those that hold it leave, of those mounted at root; the guess where
 * none has a limit. Caches of files do not count as used. */
int64_t mem_group_left(const char *root, const char *path);

#endif
