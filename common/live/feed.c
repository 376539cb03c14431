#include "live/feed.h"

#include "base/mem.h"
#include "base/thread.h"
#include "model/stream.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

struct feed {
    feed_plan plan;
    int write_here, read_here; /* the pipe of what is read here */
    pthread_t copier, reader, shower;
    int threads; /* that were started, in this order */
    model body;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t some;
    frame newest;
    bool has_newest, over, shown;
    int64_t count; /* frames read */
};

static void close_one(int *fd)
{
    if (*fd >= 0)
        close(*fd);
    *fd = -1;
}

/* Where nobody reads any more, it is closed, and the rest goes on without it: an errno value. */
static int write_to(int *fd, const char *bytes, size_t size)
{
    int code = 0;
    while (*fd >= 0 && size) {
        const ssize_t n = write(*fd, bytes, size);
        if (n > 0) {
            bytes += n;
            size -= (size_t)n;
        } else if (n < 0 && errno != EINTR) {
            code = errno;
            close_one(fd);
        }
    }
    return code;
}

/* Waits until there is something to read. False: the end was asked for. */
static bool wait_for_bytes(const feed *f)
{
    struct pollfd p[2] = {{.fd = f->plan.from, .events = POLLIN}, {.fd = f->plan.stop, .events = POLLIN}};
    int n;
    do
        n = poll(p, 2, -1);
    while (n < 0 && errno == EINTR);
    return !p[1].revents;
}

static void *copy(void *context)
{
    enum { CHUNK = 1 << 16 };
    feed *f = context;
    char bytes[CHUNK];
    ssize_t n = 0;
    while (wait_for_bytes(f) &&
           ((n = read(f->plan.from, bytes, sizeof bytes)) > 0 || (n < 0 && (errno == EINTR || errno == EAGAIN)))) {
        const int code = write_to(&f->plan.copy_to, bytes, n > 0 ? (size_t)n : 0);
        if (code && f->plan.cut)
            f->plan.cut(f->plan.context, code);
        (void)write_to(&f->write_here, bytes, n > 0 ? (size_t)n : 0);
    }
    close_one(&f->plan.copy_to);
    close_one(&f->write_here);
    return NULL;
}

/* *is is empty after this. */
static void keep_newest(feed *f, frame *is)
{
    pthread_mutex_lock(&f->lock);
    const frame before = f->newest;
    f->newest = *is;
    f->has_newest = true;
    f->count++;
    pthread_cond_signal(&f->some);
    pthread_mutex_unlock(&f->lock);
    *is = before;
    frame_free(is);
}

static int read_frames(feed *f, model_reader *r, err *e)
{
    frame next = {0};
    int got;
    if (model_read(r, &f->body, e))
        return -1;
    while ((got = model_read_frame(r, &f->body, &next, e)) > 0)
        keep_newest(f, &next);
    frame_free(&next);
    return got;
}

static void *read_all(void *context)
{
    feed *f = context;
    err e = {0};
    in *s = in_take(f->read_here, f->plan.tool, &e);
    if (!s)
        close(f->read_here);
    f->read_here = -1;
    const bool empty = s && f->plan.may_be_empty && in_peek(s, &e) == -1;
    model_reader *r = s && !empty ? model_reader_open(s, &e) : NULL;
    if (!empty && (!r || read_frames(f, r, &e)))
        f->plan.failed(f->plan.context, f->plan.tool, &e);
    model_reader_close(r);
    in_close(s);
    pthread_mutex_lock(&f->lock);
    f->over = true;
    pthread_cond_signal(&f->some);
    pthread_mutex_unlock(&f->lock);
    return NULL;
}

static void *show(void *context)
{
    feed *f = context;
    bool over = false;
    while (!over) {
        frame now = {0};
        pthread_mutex_lock(&f->lock);
        while (!f->has_newest && !f->over)
            pthread_cond_wait(&f->some, &f->lock);
        const bool has = f->has_newest;
        if (has) {
            now = f->newest;
            f->newest = (frame){0};
        }
        f->has_newest = false;
        over = f->over && !has;
        pthread_mutex_unlock(&f->lock);
        if (has)
            f->plan.show(f->plan.context, &f->body, &now);
        frame_free(&now);
    }
    pthread_mutex_lock(&f->lock);
    f->shown = true;
    pthread_mutex_unlock(&f->lock);
    return NULL;
}

bool feed_ended(feed *f)
{
    pthread_mutex_lock(&f->lock);
    const bool ended = f->shown;
    pthread_mutex_unlock(&f->lock);
    return ended;
}

int64_t feed_count(feed *f)
{
    pthread_mutex_lock(&f->lock);
    const int64_t count = f->count;
    pthread_mutex_unlock(&f->lock);
    return count;
}

static int start(feed *f, err *e)
{
    int code = thread_start(&f->copier, copy, f);
    f->threads += !code;
    if (!code)
        code = thread_start(&f->reader, read_all, f);
    f->threads += !code;
    if (!code)
        code = thread_start(&f->shower, show, f);
    f->threads += !code;
    return code ? err_system(e, f->plan.tool, code, "cannot start a thread") : 0;
}

feed *feed_open(const feed_plan *plan, err *e)
{
    int fd[2] = {-1, -1};
    feed_plan own = *plan;
    feed *f = mem_array(1, sizeof *f, "frames", e);
    if (!f || pipe(fd)) {
        if (f)
            err_system(e, plan->tool, errno, "cannot make a pipe");
        close_one(&own.from);
        close_one(&own.copy_to);
        free(f);
        return NULL;
    }
    *f = (feed){.plan = own, .read_here = fd[0], .write_here = fd[1]};
    pthread_mutex_init(&f->lock, NULL);
    pthread_cond_init(&f->some, NULL);
    if (!start(f, e))
        return f;
    feed_close(f); /* the tool's output ends, as its caller ends it */
    return NULL;
}

void feed_close(feed *f)
{
    if (!f)
        return;
    if (f->threads > 0)
        pthread_join(f->copier, NULL);
    close_one(&f->plan.copy_to);
    close_one(&f->write_here);
    if (f->threads > 1)
        pthread_join(f->reader, NULL);
    if (f->threads > 2)
        pthread_join(f->shower, NULL);
    close_one(&f->read_here);
    close_one(&f->plan.from);
    frame_free(&f->newest);
    model_free(&f->body);
    pthread_cond_destroy(&f->some);
    pthread_mutex_destroy(&f->lock);
    free(f);
}
