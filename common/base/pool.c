#include "base/pool.h"

#include "base/mem.h"
#include "base/thread.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Iterations that a thread spins before it sleeps: a solver's next loop mostly begins within microseconds. */
enum { SPINS = 2000 };

/* A thread's part of a loop: the last `untaken` of the chunks below `end`. Apart from others' in the cache. */
typedef struct pool_share {
    atomic_llong untaken;
    int64_t end;
    char apart[112];
} pool_share;

/* Each thread has its own part of every loop, so that its data stays in its cache from loop to loop. When its part is
 * done, it takes chunks from the parts of others (work stealing). The loop's description may be read by whoever has
 * taken a chunk, and does not change before that chunk is done. So the caller waits for chunks and not for workers: a
 * worker that wakes late finds no chunk, and delays nobody. */
struct pool {
    int threads, started;
    pthread_t *worker;
    pthread_mutex_t lock;
    pthread_cond_t begin, finished;
    atomic_int numbered; /* workers that have a number, from 1; the caller's is 0 */
    atomic_uint round;   /* grows by one a loop; workers wait for it to change */
    atomic_int asleep;   /* workers that wait under the lock */
    atomic_bool waiting; /* the caller does */
    atomic_bool stop;
    pool_share *share; /* threads */
    pool_work *work;
    void *context;
    int64_t count, size;
    atomic_llong undone; /* chunks */
};

static inline void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

static void run_chunk(pool *p, int64_t c)
{
    int64_t from = c * p->size, to = from + p->size;
    p->work(p->context, c, from, to < p->count ? to : p->count);
}

static void finish_chunk(pool *p)
{
    if (atomic_fetch_sub(&p->undone, 1) > 1 || !atomic_load(&p->waiting))
        return;
    pthread_mutex_lock(&p->lock);
    pthread_cond_signal(&p->finished);
    pthread_mutex_unlock(&p->lock);
}

static void share_chunks(pool *p, int number)
{
    for (int i = 0; i < p->threads; i++) {
        pool_share *s = &p->share[(number + i) % p->threads];
        for (int64_t left; (left = atomic_fetch_sub(&s->untaken, 1)) > 0;) {
            run_chunk(p, s->end - left);
            finish_chunk(p);
        }
    }
}

static void cut_shares(pool *p, int64_t chunks)
{
    const int64_t each = chunks / p->threads, more = chunks % p->threads;
    int64_t end = 0;
    atomic_store(&p->undone, chunks);
    for (int i = 0; i < p->threads; i++) {
        int64_t own = each + (i < more);
        end += own;
        p->share[i].end = end;
        atomic_store(&p->share[i].untaken, own);
    }
}

/* Returns the round that has begun. */
static unsigned wait_round(pool *p, unsigned seen)
{
    for (int i = 0; i < SPINS; i++) {
        if (atomic_load(&p->round) != seen)
            return atomic_load(&p->round);
        relax();
    }
    pthread_mutex_lock(&p->lock);
    atomic_fetch_add(&p->asleep, 1);
    while (atomic_load(&p->round) == seen)
        pthread_cond_wait(&p->begin, &p->lock);
    atomic_fetch_sub(&p->asleep, 1);
    pthread_mutex_unlock(&p->lock);
    return atomic_load(&p->round);
}

static void *worker_main(void *argument)
{
    pool *p = argument;
    const int number = atomic_fetch_add(&p->numbered, 1) + 1;
    for (unsigned seen = 0;;) {
        seen = wait_round(p, seen);
        if (atomic_load(&p->stop))
            return NULL;
        share_chunks(p, number);
    }
}

/* A worker counts itself asleep before it reads the round for the last time. So either it sees the new round, or this
 * thread sees that it sleeps, and wakes it. */
static void next_round(pool *p)
{
    atomic_fetch_add(&p->round, 1);
    if (!atomic_load(&p->asleep))
        return;
    pthread_mutex_lock(&p->lock);
    pthread_cond_broadcast(&p->begin);
    pthread_mutex_unlock(&p->lock);
}

/* For the chunks that others have taken; `waiting` as `asleep` above. */
static void wait_done(pool *p)
{
    for (int i = 0; i < SPINS && atomic_load(&p->undone); i++)
        relax();
    if (!atomic_load(&p->undone))
        return;
    pthread_mutex_lock(&p->lock);
    atomic_store(&p->waiting, true);
    while (atomic_load(&p->undone))
        pthread_cond_wait(&p->finished, &p->lock);
    atomic_store(&p->waiting, false);
    pthread_mutex_unlock(&p->lock);
}

pool *pool_create(int threads, err *e)
{
    pool *p = mem_array(1, sizeof *p, "threads", e);
    if (!p)
        return NULL;
    p->threads = threads < 1 ? 1 : threads;
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->begin, NULL);
    pthread_cond_init(&p->finished, NULL);
    p->worker = mem_array(p->threads, sizeof *p->worker, "threads", e);
    p->share = mem_array(p->threads, sizeof *p->share, "threads", e);
    /* Signals are the main thread's: a handler then never runs beside what it looks at. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    int failed = p->worker && p->share ? 0 : -1;
    while (!failed && p->started < p->threads - 1) {
        int code = thread_start(&p->worker[p->started], worker_main, p);
        if (code)
            failed = err_system(e, NULL, code, "cannot start a thread");
        else
            p->started++;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (failed) {
        pool_destroy(p);
        return NULL;
    }
    return p;
}

void pool_destroy(pool *p)
{
    if (!p)
        return;
    atomic_store(&p->stop, true);
    next_round(p);
    for (int i = 0; i < p->started; i++)
        pthread_join(p->worker[i], NULL);
    pthread_cond_destroy(&p->finished);
    pthread_cond_destroy(&p->begin);
    pthread_mutex_destroy(&p->lock);
    free(p->worker);
    free(p->share);
    free(p);
}

int pool_threads(const pool *p)
{
    return p->threads;
}

void pool_run(pool *p, int64_t count, int64_t size, pool_work *work, void *context)
{
    pool alone = {0};
    p = p ? p : &alone;
    p->work = work;
    p->context = context;
    p->count = count;
    p->size = size;
    const int64_t chunks = pool_chunks(count, size);
    if (!p->started || chunks < 2) {
        for (int64_t c = 0; c < chunks; c++)
            run_chunk(p, c);
        return;
    }
    cut_shares(p, chunks);
    next_round(p);
    share_chunks(p, 0);
    wait_done(p);
}

int64_t pool_chunks(int64_t count, int64_t size)
{
    return count > 0 ? (count - 1) / size + 1 : 0;
}
