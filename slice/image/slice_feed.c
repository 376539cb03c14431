#define _GNU_SOURCE
#include "slice/image/slice_feed.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/thread.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

struct slice_feed {
    pthread_mutex_t lock; /* for all that follows but the source, which is the thread's */
    pthread_cond_t end;
    pthread_t thread;
    bool started, ended, has_newest;
    int stop[2]; /* a pipe: closed to end the thread */
    source *from;
    lines *wakes;
    frame newest;
    double came; /* s */
    slice_feed_counts counts;
    err wrong;
};

/* Puts the frame that was read last into the place of the newest. */
static void put(slice_feed *f)
{
    pthread_mutex_lock(&f->lock);
    const frame before = f->newest;
    f->newest = f->from->frame;
    f->from->frame = before;
    f->came = clock_now();
    f->counts.came++;
    f->counts.dropped += f->has_newest;
    f->has_newest = true;
    pthread_mutex_unlock(&f->lock);
    lines_wake(f->wakes);
}

static void *read_frames(void *context)
{
    slice_feed *f = context;
    err e = {0};
    int got;
    while ((got = source_next(f->from, &e)) > 0)
        put(f);
    pthread_mutex_lock(&f->lock);
    if (got < 0)
        f->wrong = e;
    f->ended = true;
    pthread_cond_signal(&f->end);
    pthread_mutex_unlock(&f->lock);
    lines_leave(f->wakes);
    return NULL;
}

static int start(slice_feed *f, err *e)
{
    int code = pthread_mutex_init(&f->lock, NULL);
    code = code ? code : thread_condition(&f->end);
    if (code || pipe2(f->stop, O_CLOEXEC))
        return err_system(e, source_name(f->from), code ? code : errno, "cannot read frames");
    in_watch(f->from->stream, f->stop[0]);
    lines_join(f->wakes);
    code = thread_start(&f->thread, read_frames, f);
    f->started = !code;
    return code ? err_system(e, source_name(f->from), code, "cannot start a thread") : 0;
}

slice_feed *slice_feed_open(source *s, lines *wakes, err *e)
{
    slice_feed *f = mem_array(1, sizeof *f, "frames", e);
    if (!f)
        return NULL;
    f->stop[0] = f->stop[1] = -1;
    f->from = s;
    f->wakes = wakes;
    if (!start(f, e))
        return f;
    slice_feed_close(f);
    return NULL;
}

void slice_feed_close(slice_feed *f)
{
    if (!f)
        return;
    if (f->stop[1] >= 0)
        close(f->stop[1]);
    if (f->started)
        pthread_join(f->thread, NULL);
    in_watch(f->from->stream, -1);
    if (f->stop[0] >= 0)
        close(f->stop[0]);
    frame_free(&f->newest);
    pthread_cond_destroy(&f->end);
    pthread_mutex_destroy(&f->lock);
    free(f);
}

bool slice_feed_take(slice_feed *f, frame *to, double *came)
{
    pthread_mutex_lock(&f->lock);
    const bool is = f->has_newest;
    if (is) {
        const frame before = *to;
        *to = f->newest;
        f->newest = before;
        *came = f->came;
    }
    f->has_newest = false;
    pthread_mutex_unlock(&f->lock);
    return is;
}

bool slice_feed_ended(slice_feed *f)
{
    pthread_mutex_lock(&f->lock);
    const bool ended = f->ended;
    pthread_mutex_unlock(&f->lock);
    return ended;
}

void slice_feed_finish(slice_feed *f, double seconds)
{
    const struct timespec to = clock_timespec(clock_now() + seconds);
    pthread_mutex_lock(&f->lock);
    while (!f->ended && !pthread_cond_timedwait(&f->end, &f->lock, &to))
        ;
    pthread_mutex_unlock(&f->lock);
}

int slice_feed_error(slice_feed *f, err *e)
{
    pthread_mutex_lock(&f->lock);
    const err wrong = f->wrong;
    pthread_mutex_unlock(&f->lock);
    if (wrong.status)
        *e = wrong;
    return wrong.status ? -1 : 0;
}

slice_feed_counts slice_feed_count(slice_feed *f)
{
    pthread_mutex_lock(&f->lock);
    const slice_feed_counts counts = f->counts;
    pthread_mutex_unlock(&f->lock);
    return counts;
}
