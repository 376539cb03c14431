/* Threads that share loops. A loop is cut into chunks of a fixed size, whatever the number of threads: work
 * that depends only on its chunk gives the same bytes for any number of them. The creator owns the pool.
 */
#ifndef SINEW_POOL_H
#define SINEW_POOL_H

#include "base/err.h"

typedef struct pool pool;

/* chunk: its number; [from, to): its items. */
typedef void pool_work(void *context, int64_t chunk, int64_t from, int64_t to);

/* A pool of `threads`, the caller's among them. NULL with e filled. */
pool *pool_create(int threads, err *e);
void pool_destroy(pool *p);
int pool_threads(const pool *p);

/* Runs work over items [0, count) in chunks of `size`, and returns when all are done. Not reentrant. p: NULL for the
 * caller alone. */
void pool_run(pool *p, int64_t count, int64_t size, pool_work *work, void *context);

/* How many chunks pool_run makes. */
int64_t pool_chunks(int64_t count, int64_t size);

#endif
