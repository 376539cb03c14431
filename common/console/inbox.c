#include "console/inbox.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/thread.h"

#include <pthread.h>
#include <stdlib.h>

enum { MOST = 64 };

typedef struct letter {
    int client;
    message said;
} letter;

struct inbox {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    letter list[MOST];
    int first, count;
    bool woken, ended;
};

inbox *inbox_make(err *e)
{
    inbox *b = mem_array(1, sizeof *b, "messages", e);
    if (!b)
        return NULL;
    pthread_mutex_init(&b->lock, NULL);
    const int code = thread_condition(&b->changed);
    if (!code)
        return b;
    err_system(e, NULL, code, "cannot take messages");
    pthread_mutex_destroy(&b->lock);
    free(b);
    return NULL;
}

void inbox_free(inbox *b)
{
    if (!b)
        return;
    pthread_cond_destroy(&b->changed);
    pthread_mutex_destroy(&b->lock);
    free(b);
}

void inbox_end(inbox *b)
{
    pthread_mutex_lock(&b->lock);
    b->ended = true;
    pthread_cond_broadcast(&b->changed);
    pthread_mutex_unlock(&b->lock);
}

static letter *last(inbox *b)
{
    return b->count ? &b->list[(b->first + b->count - 1) % MOST] : NULL;
}

void inbox_put(inbox *b, int client, const message *m)
{
    pthread_mutex_lock(&b->lock);
    while (b->count == MOST && !b->ended)
        pthread_cond_wait(&b->changed, &b->lock);
    if (!b->ended) {
        if (!last(b) || m->kind != MESSAGE_POSE || last(b)->said.kind != MESSAGE_POSE || last(b)->client != client)
            b->count++;
        *last(b) = (letter){client, *m};
        pthread_cond_broadcast(&b->changed);
    }
    pthread_mutex_unlock(&b->lock);
}

void inbox_wake(inbox *b)
{
    pthread_mutex_lock(&b->lock);
    b->woken = true;
    pthread_cond_broadcast(&b->changed);
    pthread_mutex_unlock(&b->lock);
}

bool inbox_take(inbox *b, double seconds, int *client, message *m)
{
    const struct timespec until = clock_timespec(clock_now() + seconds);
    int code = 0;
    pthread_mutex_lock(&b->lock);
    while (!b->count && !b->woken && !b->ended && !code)
        code = pthread_cond_timedwait(&b->changed, &b->lock, &until);
    b->woken = false;
    const bool got = b->count > 0 && !b->ended;
    if (got) {
        *client = b->list[b->first].client;
        *m = b->list[b->first].said;
        b->first = (b->first + 1) % MOST;
        b->count--;
        pthread_cond_broadcast(&b->changed);
    }
    pthread_mutex_unlock(&b->lock);
    return got;
}
