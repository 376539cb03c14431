#include "tled/run/outbox.h"

#include "base/mem.h"
#include "base/thread.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>

enum { FRAMES = 2, RING = TLED_SLOTS + FRAMES };

/* What one of the threads does. */
typedef struct stage {
    outbox *o;
    int (*work)(outbox *o, int64_t index, err *e);
    const int64_t *ready; /* how many it can have done */
    int64_t *done;
} stage;

struct outbox {
    const tled_executor *device;
    tled_state *state;
    outbox_frame *write;
    void *context;
    field_values frame[FRAMES]; /* by number: what is being fetched, and what is being written */
    int slot[RING];             /* what is sent */
    double time[RING];
    int64_t sent, fetched, written; /* how many so far */
    int64_t whole;                  /* so many can be written: those before the first that something was wrong with */
    bool closing;
    int running;    /* threads */
    stage stage[2]; /* one fetches, and one writes what the first has fetched */
    err e;
    pthread_t thread[2];
    pthread_mutex_t lock;
    pthread_cond_t changed;
};

static int fetch(outbox *o, int64_t index, err *e)
{
    return o->device->fetch(o->state, o->slot[index % RING], &o->frame[index % FRAMES], e);
}

static int put(outbox *o, int64_t index, err *e)
{
    return o->write(o->context, o->time[index % RING], &o->frame[index % FRAMES], e);
}

/* Does its work with the frames that are ready for it, until there are no more to come. After one that
 * something was wrong with it only counts. */
static void *work(void *context)
{
    const stage *s = context;
    outbox *o = s->o;
    pthread_mutex_lock(&o->lock);
    for (;;) {
        /* Nothing is ready, and more may come; or there is no room for one more. */
        while (*s->done == *s->ready ? !o->closing || *s->done < o->sent : *s->done - o->written == FRAMES)
            pthread_cond_wait(&o->changed, &o->lock);
        const int64_t index = *s->done;
        if (index == *s->ready)
            break;
        const bool whole = index < o->whole;
        pthread_mutex_unlock(&o->lock);
        err e = {0};
        const bool wrong = whole && s->work(o, index, &e);
        pthread_mutex_lock(&o->lock);
        if (wrong && index < o->whole) {
            o->whole = index;
            o->e = e;
        }
        ++*s->done;
        pthread_cond_broadcast(&o->changed);
    }
    pthread_mutex_unlock(&o->lock);
    return NULL;
}

/* Starts the threads; signals are the main thread's, as with the pool's. 0 or errno's code. */
static int start(outbox *o)
{
    sigset_t all, before;
    int code = 0;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    while (!code && o->running < 2) {
        code = thread_start(&o->thread[o->running], work, &o->stage[o->running]);
        o->running += !code;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return code;
}

static int make_frames(outbox *o, const fields *f, err *e)
{
    for (int i = 0; i < FRAMES; i++)
        if (fields_allocate(f, FIELD_IN_FRAMES, &o->frame[i], "the frames", e))
            return -1;
    return 0;
}

outbox *outbox_create(const tled_problem *p, const tled_executor *device, tled_state *state, outbox_frame *write,
                      void *context, err *e)
{
    outbox *o = mem_array(1, sizeof *o, "the frames", e);
    if (!o)
        return NULL;
    o->device = device;
    o->state = state;
    o->write = write;
    o->context = context;
    o->whole = INT64_MAX;
    o->stage[0] = (stage){o, fetch, &o->sent, &o->fetched};
    o->stage[1] = (stage){o, put, &o->fetched, &o->written};
    pthread_mutex_init(&o->lock, NULL);
    pthread_cond_init(&o->changed, NULL);
    int code = make_frames(o, &p->fields, e) ? -1 : start(o);
    if (!code)
        return o;
    if (code > 0)
        err_system(e, NULL, code, "a thread for the frames");
    outbox_close(o, e);
    return NULL;
}

void outbox_send(outbox *o, int slot, double time)
{
    pthread_mutex_lock(&o->lock);
    o->slot[o->sent % RING] = slot;
    o->time[o->sent % RING] = time;
    o->sent++;
    pthread_cond_broadcast(&o->changed);
    pthread_mutex_unlock(&o->lock);
}

/* Until *count is past index. -1 with e filled where something was wrong with a frame: the first such,
 * so that those before it are waited for. */
static int wait_for(outbox *o, const int64_t *count, int64_t index, err *e)
{
    pthread_mutex_lock(&o->lock);
    while (*count <= index || (o->e.status && o->written < o->whole))
        pthread_cond_wait(&o->changed, &o->lock);
    const int broken = err_join(e, &o->e);
    pthread_mutex_unlock(&o->lock);
    return broken;
}

int outbox_wait_fetched(outbox *o, int64_t index, err *e)
{
    return wait_for(o, &o->fetched, index, e);
}

int outbox_wait(outbox *o, int64_t index, err *e)
{
    return wait_for(o, &o->written, index, e);
}

int outbox_close(outbox *o, err *e)
{
    if (!o)
        return 0;
    pthread_mutex_lock(&o->lock);
    o->closing = true;
    pthread_cond_broadcast(&o->changed);
    pthread_mutex_unlock(&o->lock);
    while (o->running)
        pthread_join(o->thread[--o->running], NULL);
    const int broken = err_join(e, &o->e);
    for (int i = 0; i < FRAMES; i++)
        fields_free(&o->frame[i]);
    pthread_mutex_destroy(&o->lock);
    pthread_cond_destroy(&o->changed);
    free(o);
    return broken;
}
