/* Frames written while the next is filled: in order, each whole; two at a time and no more; what was sound before a
 * failure is written all the same, and nothing after it.
 */
#include "frames/frame_queue.h"

#include "tap.h"

#include <pthread.h>
#include <stdlib.h>
#include <time.h>

enum { NODES = 500, NEVER = 1 << 20 };

/* What came of the frames. */
typedef struct world {
    int64_t written, bad; /* the frame that fails */
    int64_t sent, ahead;  /* the most frames that were sent beyond those written */
    bool whole;           /* each was the one that was due, all of it */
    bool beside;          /* the first waits for the second to be sent; false once that was in vain */
    pthread_mutex_t lock;
    pthread_cond_t changed;
} world;

static bool is_whole(const world *w, const frame *f)
{
    const model_array *u = frame_find(f, "node.displacement");
    bool whole = f->index == w->written && f->time == (double)w->written && u && u->rows == NODES;
    for (int i = 0; whole && i < 3 * NODES; i++)
        whole = u->f64[i] == (double)w->written;
    return whole;
}

static int put(void *context, frame *f, err *e)
{
    world *w = context;
    struct timespec end;
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_sec += 180;
    pthread_mutex_lock(&w->lock);
    while (w->beside && w->written == 0 && w->sent < 2)
        w->beside = !pthread_cond_timedwait(&w->changed, &w->lock, &end);
    const int64_t ahead = w->sent - w->written;
    w->ahead = ahead > w->ahead ? ahead : w->ahead;
    w->whole = w->whole && is_whole(w, f);
    const bool bad = w->written == w->bad;
    w->written += !bad;
    pthread_mutex_unlock(&w->lock);
    return bad ? err_set(e, NULL, 0, "no frame %lld", (long long)f->index) : 0;
}

static model nodes_model(void)
{
    model m = {0};
    err e = {0};
    if (model_axis_add(&m, "node", NODES, &e))
        exit(1);
    return m;
}

/* Sends frames until `count` are sent or one is refused; returns how many were. */
static int64_t send_frames(frame_queue *q, world *w, const model *m, int64_t count, err *e)
{
    for (int64_t n = 0; n < count; n++) {
        frame *f = frame_queue_next(q, e);
        model_array *u = f ? frame_queue_array(f, m, "node.displacement", e) : NULL;
        if (!u)
            return n;
        f->index = n;
        f->time = (double)n;
        for (int i = 0; i < 3 * NODES; i++)
            u->f64[i] = (double)n;
        pthread_mutex_lock(&w->lock);
        w->sent = n + 1;
        pthread_cond_broadcast(&w->changed);
        pthread_mutex_unlock(&w->lock);
        if (frame_queue_send(q, e))
            return n + 1;
    }
    return count;
}

static world world_of(int64_t bad, bool beside)
{
    return (world){.bad = bad,
                   .whole = true,
                   .beside = beside,
                   .lock = PTHREAD_MUTEX_INITIALIZER,
                   .changed = PTHREAD_COND_INITIALIZER};
}

static void test_order(void)
{
    world w = world_of(NEVER, true);
    model m = nodes_model();
    err e = {0};
    frame_queue *q = frame_queue_open(put, &w, false, &e);
    ok(q && send_frames(q, &w, &m, 200, &e) == 200 && !frame_queue_close(q, &e), "200 frames: %s", e.text);
    ok(w.written == 200 && w.whole, "are all written when the queue is closed, in order, each whole");
    ok(w.beside, "the second is filled while the first is written");
    ok(w.ahead <= 2, "two at a time, and no more");
    model_free(&m);
}

static void test_at_once(void)
{
    world w = world_of(3, false);
    model m = nodes_model();
    err e = {0};
    frame_queue *q = frame_queue_open(put, &w, true, &e);
    ok(q && send_frames(q, &w, &m, 3, &e) == 3 && w.written == 3 && w.whole && w.ahead == 1,
       "at once: each is written when it has been sent");
    frame_queue_close(q, &e);
    model_free(&m);
}

static void test_failure(void)
{
    world w = world_of(5, false);
    model m = nodes_model();
    err e = {0}, later = {0};
    frame_queue *q = frame_queue_open(put, &w, false, &e);
    const int64_t sent = q ? send_frames(q, &w, &m, 100, &e) : 0;
    ok(e.status == STATUS_BAD && sent >= 6 && sent <= 8, "after a frame that fails at most two more are taken");
    err_diverged(&later, NULL, 0, "diverged");
    ok(frame_queue_close(q, &later) && later.status == STATUS_BAD, "its error stands before what went wrong later: %s",
       later.text);
    ok(w.written == 5 && w.whole, "what came before is written, and nothing after");
    model_free(&m);
}

static void test_kept_arrays(void)
{
    world w = world_of(NEVER, false);
    model m = nodes_model();
    err e = {0};
    frame_queue *q = frame_queue_open(put, &w, true, &e);
    frame *f = q ? frame_queue_next(q, &e) : NULL;
    const double *first = f ? frame_queue_array(f, &m, "node.displacement", &e)->f64 : NULL;
    ok(first && frame_queue_array(f, &m, "node.displacement", &e)->f64 == first && f->arrays.count == 1,
       "an array of an earlier frame is taken again");
    err none = {.status = STATUS_BAD};
    ok(!frame_queue_close(NULL, &none) && none.status == STATUS_BAD, "no queue: nothing to close");
    frame_queue_close(q, &e);
    model_free(&m);
}

int main(void)
{
    test_order();
    test_at_once();
    test_failure();
    test_kept_arrays();
    return done_testing();
}
