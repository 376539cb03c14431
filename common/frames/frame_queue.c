#include "frames/frame_queue.h"

#include "base/mem.h"
#include "base/thread.h"

#include <stdlib.h>

enum { FRAMES = 2 };

struct frame_queue {
    frame_queue_write *write;
    void *context;
    frame frame[FRAMES];   /* by number, in turn */
    int64_t sent, written; /* how many so far; those after a failure are counted, and not written */
    bool closing;
    bool threaded;
    err e; /* of the first that could not be written */
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
};

/* Writes the frames that are sent, until there are no more to come. */
static void *work(void *context)
{
    frame_queue *q = context;
    pthread_mutex_lock(&q->lock);
    for (;;) {
        while (q->written == q->sent && !q->closing)
            pthread_cond_wait(&q->changed, &q->lock);
        if (q->written == q->sent)
            break;
        frame *f = &q->frame[q->written % FRAMES];
        const bool whole = !q->e.status;
        pthread_mutex_unlock(&q->lock);
        err e = {0};
        if (whole)
            q->write(q->context, f, &e);
        pthread_mutex_lock(&q->lock);
        err_join(&q->e, &e);
        q->written++;
        pthread_cond_broadcast(&q->changed);
    }
    pthread_mutex_unlock(&q->lock);
    return NULL;
}

static int start(frame_queue *q, err *e)
{
    const int code = thread_start_quiet(&q->thread, work, q);
    q->threaded = !code;
    return code ? err_system(e, NULL, code, "a thread for the frames") : 0;
}

frame_queue *frame_queue_open(frame_queue_write *write, void *context, bool at_once, err *e)
{
    frame_queue *q = mem_array(1, sizeof *q, "the frames", e);
    if (!q)
        return NULL;
    q->write = write;
    q->context = context;
    pthread_mutex_init(&q->lock, NULL);
    pthread_cond_init(&q->changed, NULL);
    if (at_once || !start(q, e))
        return q;
    frame_queue_close(q, e);
    return NULL;
}

frame *frame_queue_next(frame_queue *q, err *e)
{
    pthread_mutex_lock(&q->lock);
    while (q->sent - q->written == FRAMES)
        pthread_cond_wait(&q->changed, &q->lock);
    const int broken = err_join(e, &q->e);
    pthread_mutex_unlock(&q->lock);
    return broken ? NULL : &q->frame[q->sent % FRAMES];
}

model_array *frame_queue_array(frame *f, const model *m, const char *name, err *e)
{
    model_array *there = frame_find(f, name);
    return there && there->rows == model_count(m, there->axis) ? there : frame_add(f, m, name, e);
}

int frame_queue_send(frame_queue *q, err *e)
{
    if (!q->threaded)
        return q->write(q->context, &q->frame[0], e);
    pthread_mutex_lock(&q->lock);
    q->sent++;
    pthread_cond_broadcast(&q->changed);
    const int broken = err_join(e, &q->e);
    pthread_mutex_unlock(&q->lock);
    return broken;
}

int frame_queue_close(frame_queue *q, err *e)
{
    if (!q)
        return 0;
    pthread_mutex_lock(&q->lock);
    q->closing = true;
    pthread_cond_broadcast(&q->changed);
    pthread_mutex_unlock(&q->lock);
    if (q->threaded)
        pthread_join(q->thread, NULL);
    const bool broken = q->e.status;
    if (broken)
        *e = q->e;
    for (int i = 0; i < FRAMES; i++)
        frame_free(&q->frame[i]);
    pthread_mutex_destroy(&q->lock);
    pthread_cond_destroy(&q->changed);
    free(q);
    return broken ? -1 : 0;
}
