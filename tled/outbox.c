#include "tled/outbox.h"

#include "base/mem.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>

struct outbox {
    const backend *device;
    void *state;
    outbox_frame *write;
    void *context;
    tled_taken frame;     /* what is being written */
    int slot[TLED_TAKEN]; /* what is sent: a ring */
    double time[TLED_TAKEN];
    int64_t sent, written; /* how many so far */
    bool closing, running;
    err e; /* the thread's */
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
};

/* Writes what is sent, until there is no more to come. After an error it only counts. */
static void *deliver(void *context)
{
    outbox *o = context;
    pthread_mutex_lock(&o->lock);
    for (;;) {
        while (o->written == o->sent && !o->closing)
            pthread_cond_wait(&o->changed, &o->lock);
        if (o->written == o->sent)
            break;
        int slot = o->slot[o->written % TLED_TAKEN];
        double time = o->time[o->written % TLED_TAKEN];
        bool broken = o->e.status != 0;
        pthread_mutex_unlock(&o->lock);
        err e = {0};
        if (!broken && !o->device->taken(o->state, slot, &o->frame, &e))
            o->write(o->context, time, o->frame.displacement, o->frame.velocity, &e);
        pthread_mutex_lock(&o->lock);
        if (!broken)
            o->e = e;
        o->written++;
        pthread_cond_broadcast(&o->changed);
    }
    pthread_mutex_unlock(&o->lock);
    return NULL;
}

/* Starts the thread; signals are the main thread's, as with the pool's. 0 or errno's code. */
static int start(outbox *o)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    int code = pthread_create(&o->thread, NULL, deliver, o);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return code;
}

outbox *outbox_create(const tled_problem *p, const backend *device, void *state, outbox_frame *write, void *context,
                      err *e)
{
    outbox *o = mem_array(1, sizeof *o, "the frames", e);
    if (!o)
        return NULL;
    o->device = device;
    o->state = state;
    o->write = write;
    o->context = context;
    pthread_mutex_init(&o->lock, NULL);
    pthread_cond_init(&o->changed, NULL);
    o->frame.displacement = mem_array(p->nodes, 3 * sizeof *o->frame.displacement, "the frames", e);
    o->frame.velocity = mem_array(p->nodes, 3 * sizeof *o->frame.velocity, "the frames", e);
    bool whole = o->frame.displacement && o->frame.velocity;
    int code = whole ? start(o) : 0;
    o->running = whole && !code;
    if (code)
        err_system(e, NULL, code, "a thread for the frames");
    if (o->running)
        return o;
    outbox_close(o, e);
    return NULL;
}

void outbox_send(outbox *o, int slot, double time)
{
    pthread_mutex_lock(&o->lock);
    o->slot[o->sent % TLED_TAKEN] = slot;
    o->time[o->sent % TLED_TAKEN] = time;
    o->sent++;
    pthread_cond_broadcast(&o->changed);
    pthread_mutex_unlock(&o->lock);
}

int outbox_wait(outbox *o, int64_t index, err *e)
{
    pthread_mutex_lock(&o->lock);
    while (o->written <= index)
        pthread_cond_wait(&o->changed, &o->lock);
    bool broken = o->e.status != 0;
    if (broken && !e->status)
        *e = o->e;
    pthread_mutex_unlock(&o->lock);
    return broken ? -1 : 0;
}

int outbox_close(outbox *o, err *e)
{
    if (!o)
        return 0;
    if (o->running) {
        pthread_mutex_lock(&o->lock);
        o->closing = true;
        pthread_cond_broadcast(&o->changed);
        pthread_mutex_unlock(&o->lock);
        pthread_join(o->thread, NULL);
    }
    bool broken = o->e.status != 0;
    if (broken && !e->status)
        *e = o->e;
    free(o->frame.displacement);
    free(o->frame.velocity);
    pthread_mutex_destroy(&o->lock);
    pthread_cond_destroy(&o->changed);
    free(o);
    return broken ? -1 : 0;
}
