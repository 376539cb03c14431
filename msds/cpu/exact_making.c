#include "msds/cpu/exact_making.h"

#include "base/mem.h"
#include "base/thread.h"

#include <stdlib.h>

struct exact_making {
    const msds_problem *p;
    bool warped;
    contacts *c;
    const lanes *loops;
    int threads;
    stiffness k;
    exact x;
    pthread_t thread;
    bool started, joined;
    atomic_bool stop, done;
    err wrong; /* the thread's, until it is done */
};

static void *make(void *context)
{
    exact_making *m = context;
    thread_yield_to_others();
    pool *threads = pool_create(m->threads, &m->wrong);
    m->x.factor.stop = &m->stop;
    if (threads && !stiffness_make(&m->k, m->p, m->warped, threads, &m->wrong))
        exact_make(&m->x, m->p, &m->k, m->c, m->loops, threads, &m->wrong);
    pool_destroy(threads);
    atomic_store(&m->done, true);
    return NULL;
}

exact_making *exact_making_start(const msds_problem *p, bool warped, contacts *c, const lanes *loops, int threads,
                                 err *e)
{
    exact_making *m = mem_array(1, sizeof *m, "the solver", e);
    if (!m)
        return NULL;
    m->p = p;
    m->warped = warped;
    m->c = c;
    m->loops = loops;
    m->threads = threads;
    const int code = thread_start(&m->thread, make, m);
    m->started = !code;
    if (!code)
        return m;
    exact_making_free(m);
    err_system(e, NULL, code, "cannot start a thread");
    return NULL;
}

static void join(exact_making *m)
{
    if (m->started && !m->joined)
        pthread_join(m->thread, NULL);
    m->joined = true;
}

int exact_making_look(exact_making *m, bool wait, err *e)
{
    if (!wait && !atomic_load(&m->done))
        return 0;
    join(m);
    return err_join(e, &m->wrong) ? -1 : 1;
}

void exact_making_take(exact_making *m, stiffness *k, exact *x, pool *threads)
{
    *k = m->k;
    *x = m->x;
    m->k = (stiffness){0};
    m->x = (exact){0};
    k->threads = threads;
    exact_moved(x, k, threads);
    x->factor.stop = NULL;
    exact_making_free(m);
}

void exact_making_free(exact_making *m)
{
    if (!m)
        return;
    atomic_store(&m->stop, true);
    join(m);
    exact_free(&m->x);
    stiffness_free(&m->k);
    free(m);
}
