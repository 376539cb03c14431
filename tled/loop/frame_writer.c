#include "tled/loop/frame_writer.h"

#include "base/mem.h"
#include "base/thread.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 2, RING = TLED_SLOTS + FRAMES };

/* What one of the threads does. */
typedef struct stage {
    frame_writer *w;
    int (*work)(frame_writer *w, int64_t index, err *e);
    const int64_t *ready; /* how many it can have done */
    int64_t *done;
} stage;

struct frame_writer {
    const tled_executor *device;
    tled_state *state;
    frame_writer_write *write;
    frame_writer_last *last;
    void *context;
    const fields *fields;
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

static int fetch(frame_writer *w, int64_t index, err *e)
{
    return w->device->fetch(w->state, w->slot[index % RING], &w->frame[index % FRAMES], e);
}

static int put(frame_writer *w, int64_t index, err *e)
{
    return w->write(w->context, w->time[index % RING], &w->frame[index % FRAMES], e);
}

/* Touches the memory of the first frame, which every run has, before it is there: new pages take a while. */
static void touch_first(frame_writer *w)
{
    for (int i = 0; i < FIELDS_MOST; i++)
        if (w->frame[0].of[i])
            memset(w->frame[0].of[i], 0, (size_t)fields_size(w->fields, i) * sizeof *w->frame[0].of[i]);
}

/* Does its work with the frames that are ready for it, until there are no more to come. After one that failed, it only
 * counts. */
static void *work(void *context)
{
    const stage *s = context;
    frame_writer *w = s->w;
    if (s->work == fetch)
        touch_first(w);
    pthread_mutex_lock(&w->lock);
    for (;;) {
        /* Nothing is ready, and more may come; or there is no room for one more. */
        while (*s->done == *s->ready ? !w->closing || *s->done < w->sent : *s->done - w->written == FRAMES)
            pthread_cond_wait(&w->changed, &w->lock);
        const int64_t index = *s->done;
        if (index == *s->ready)
            break;
        const bool whole = index < w->whole;
        pthread_mutex_unlock(&w->lock);
        err e = {0};
        const bool wrong = whole && s->work(w, index, &e);
        pthread_mutex_lock(&w->lock);
        if (wrong && index < w->whole) {
            w->whole = index;
            w->e = e;
        }
        ++*s->done;
        pthread_cond_broadcast(&w->changed);
    }
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

/* Starts the threads. 0 or errno's code. */
static int start(frame_writer *w)
{
    int code = 0;
    while (!code && w->running < 2) {
        code = thread_start_quiet(&w->thread[w->running], work, &w->stage[w->running]);
        w->running += !code;
    }
    return code;
}

static int make_frames(frame_writer *w, const fields *f, err *e)
{
    for (int i = 0; i < FRAMES; i++)
        if (fields_allocate(f, FIELD_IN_FRAMES, &w->frame[i], "the frames", e))
            return -1;
    return 0;
}

frame_writer *frame_writer_create(const tled_problem *p, const tled_executor *device, tled_state *state,
                                  frame_writer_write *write, frame_writer_last *last, void *context, err *e)
{
    frame_writer *w = mem_array(1, sizeof *w, "the frames", e);
    if (!w)
        return NULL;
    w->device = device;
    w->state = state;
    w->write = write;
    w->last = last;
    w->context = context;
    w->fields = &p->fields;
    w->whole = INT64_MAX;
    w->stage[0] = (stage){w, fetch, &w->sent, &w->fetched};
    w->stage[1] = (stage){w, put, &w->fetched, &w->written};
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->changed, NULL);
    int code = make_frames(w, &p->fields, e) ? -1 : start(w);
    if (!code)
        return w;
    if (code > 0)
        err_system(e, NULL, code, "a thread for the frames");
    frame_writer_close(w, e);
    return NULL;
}

void frame_writer_send(frame_writer *w, int slot, double time)
{
    pthread_mutex_lock(&w->lock);
    w->slot[w->sent % RING] = slot;
    w->time[w->sent % RING] = time;
    w->sent++;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
}

/* Until *count is past index. -1 with e filled where something was wrong with a frame: the first such,
 * so that those before it are waited for. */
static int wait_for(frame_writer *w, const int64_t *count, int64_t index, err *e)
{
    pthread_mutex_lock(&w->lock);
    while (*count <= index || (w->e.status && w->written < w->whole))
        pthread_cond_wait(&w->changed, &w->lock);
    const int broken = err_join(e, &w->e);
    pthread_mutex_unlock(&w->lock);
    return broken;
}

int frame_writer_wait_fetched(frame_writer *w, int64_t index, err *e)
{
    return wait_for(w, &w->fetched, index, e);
}

int frame_writer_wait(frame_writer *w, int64_t index, err *e)
{
    return wait_for(w, &w->written, index, e);
}

int frame_writer_close(frame_writer *w, err *e)
{
    if (!w)
        return 0;
    pthread_mutex_lock(&w->lock);
    w->closing = true;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    while (w->running)
        pthread_join(w->thread[--w->running], NULL);
    if (w->last && w->written && !w->e.status)
        w->last(w->context, &w->frame[(w->written - 1) % FRAMES]);
    const int broken = err_join(e, &w->e);
    for (int i = 0; i < FRAMES; i++)
        fields_free(&w->frame[i]);
    pthread_mutex_destroy(&w->lock);
    pthread_cond_destroy(&w->changed);
    free(w);
    return broken;
}
