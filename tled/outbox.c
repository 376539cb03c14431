#include "tled/outbox.h"

#include "base/mem.h"

#include <pthread.h>
#include <stdlib.h>

enum { BUFFERS = 3 };

typedef struct letter {
    double *displacement, *velocity, time; /* nodes x 3 */
} letter;

struct outbox {
    outbox_frame *write;
    void *context;
    int64_t nodes;
    letter letter[BUFFERS]; /* a ring; made when first wanted */
    int64_t sent, written;  /* how many so far */
    bool closing, running;
    err e; /* the writer's */
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
        const letter *l = &o->letter[o->written % BUFFERS];
        bool broken = o->e.status != 0;
        pthread_mutex_unlock(&o->lock);
        err e = {0};
        if (!broken)
            o->write(o->context, l->time, l->displacement, l->velocity, &e);
        pthread_mutex_lock(&o->lock);
        if (!broken)
            o->e = e;
        o->written++;
        pthread_cond_broadcast(&o->changed);
    }
    pthread_mutex_unlock(&o->lock);
    return NULL;
}

outbox *outbox_create(int64_t nodes, outbox_frame *write, void *context, err *e)
{
    outbox *o = mem_array(1, sizeof *o, "the frames", e);
    if (!o)
        return NULL;
    o->write = write;
    o->context = context;
    o->nodes = nodes;
    pthread_mutex_init(&o->lock, NULL);
    pthread_cond_init(&o->changed, NULL);
    int code = pthread_create(&o->thread, NULL, deliver, o);
    o->running = !code;
    if (code) {
        err_system(e, NULL, code, "a thread for the frames");
        outbox_close(o, e);
        return NULL;
    }
    return o;
}

int outbox_next(outbox *o, tled_taken *to, err *e)
{
    pthread_mutex_lock(&o->lock);
    while (o->sent - o->written == BUFFERS)
        pthread_cond_wait(&o->changed, &o->lock);
    bool broken = o->e.status != 0;
    if (broken && !e->status)
        *e = o->e;
    pthread_mutex_unlock(&o->lock);
    if (broken)
        return -1;
    letter *l = &o->letter[o->sent % BUFFERS];
    if (!l->displacement)
        l->displacement = mem_array(o->nodes, 6 * sizeof *l->displacement, "the frames", e);
    if (!l->displacement)
        return -1;
    l->velocity = l->displacement + 3 * o->nodes;
    to->displacement = l->displacement;
    to->velocity = l->velocity;
    return 0;
}

void outbox_send(outbox *o, double time)
{
    pthread_mutex_lock(&o->lock);
    o->letter[o->sent++ % BUFFERS].time = time;
    pthread_cond_broadcast(&o->changed);
    pthread_mutex_unlock(&o->lock);
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
    for (int i = 0; i < BUFFERS; i++)
        free(o->letter[i].displacement);
    pthread_mutex_destroy(&o->lock);
    pthread_cond_destroy(&o->changed);
    free(o);
    return broken ? -1 : 0;
}
