#include "base/pool.h"

#include "base/mem.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Iterations that a thread spins before it sleeps: a solver's next loop mostly begins within microseconds. */
enum { SPINS = 2000 };

struct pool {
    int threads, started;
    pthread_t *worker;
    pthread_mutex_t lock;
    pthread_cond_t begin, finished;
    atomic_uint round; /* grows by one a loop; workers wait for it to change */
    atomic_int busy;   /* workers still in this round */
    bool stop;
    pool_work *work;
    void *context;
    int64_t count, size;
    atomic_llong next; /* the next chunk */
};

static inline void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

static void run_chunks(pool *p)
{
    int64_t chunks = pool_chunks(p->count, p->size);
    for (;;) {
        int64_t c = atomic_fetch_add(&p->next, 1);
        if (c >= chunks)
            return;
        int64_t from = c * p->size, to = from + p->size;
        p->work(p->context, c, from, to < p->count ? to : p->count);
    }
}

static void wait_round(pool *p, unsigned seen)
{
    for (int i = 0; i < SPINS; i++) {
        if (atomic_load(&p->round) != seen)
            return;
        relax();
    }
    pthread_mutex_lock(&p->lock);
    while (atomic_load(&p->round) == seen)
        pthread_cond_wait(&p->begin, &p->lock);
    pthread_mutex_unlock(&p->lock);
}

static void *worker_main(void *argument)
{
    pool *p = argument;
    for (unsigned seen = 0;; seen++) {
        wait_round(p, seen);
        if (p->stop)
            return NULL;
        run_chunks(p);
        if (atomic_fetch_sub(&p->busy, 1) == 1) {
            pthread_mutex_lock(&p->lock);
            pthread_cond_signal(&p->finished);
            pthread_mutex_unlock(&p->lock);
        }
    }
}

static void next_round(pool *p)
{
    pthread_mutex_lock(&p->lock);
    atomic_store(&p->busy, p->started);
    atomic_fetch_add(&p->round, 1);
    pthread_cond_broadcast(&p->begin);
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
    /* Signals are the main thread's: a handler then never runs beside what it looks at. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    while (p->worker && p->started < p->threads - 1) {
        int code = pthread_create(&p->worker[p->started], NULL, worker_main, p);
        if (code) {
            err_system(e, NULL, code, "cannot start a thread");
            break;
        }
        p->started++;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (e->status) {
        pool_destroy(p);
        return NULL;
    }
    return p;
}

void pool_destroy(pool *p)
{
    if (!p)
        return;
    p->stop = true;
    next_round(p);
    for (int i = 0; i < p->started; i++)
        pthread_join(p->worker[i], NULL);
    pthread_cond_destroy(&p->finished);
    pthread_cond_destroy(&p->begin);
    pthread_mutex_destroy(&p->lock);
    free(p->worker);
    free(p);
}

int pool_threads(const pool *p)
{
    return p->threads;
}

void pool_run(pool *p, int64_t count, int64_t size, pool_work *work, void *context)
{
    p->work = work;
    p->context = context;
    p->count = count;
    p->size = size;
    atomic_store(&p->next, 0);
    if (!p->started || pool_chunks(count, size) < 2) {
        run_chunks(p);
        return;
    }
    next_round(p);
    run_chunks(p);
    for (int i = 0; i < SPINS && atomic_load(&p->busy); i++)
        relax();
    pthread_mutex_lock(&p->lock);
    while (atomic_load(&p->busy))
        pthread_cond_wait(&p->finished, &p->lock);
    pthread_mutex_unlock(&p->lock);
}

int64_t pool_chunks(int64_t count, int64_t size)
{
    return count > 0 ? (count - 1) / size + 1 : 0;
}
