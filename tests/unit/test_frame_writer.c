/* The asynchronous writer: frames in order, each fetched from its own slot; one is fetched while another is written;
 * and what was sound before something went wrong is written all the same.
 */
// needs: tled/*/*.c
#include "tled/loop/frame_writer.h"

#include "tap.h"

#include <pthread.h>
#include <string.h>
#include <time.h>

enum { NODES = 50, SLOTS = 3, NEVER = 1 << 20 };

/* A device whose frame is the number in its slot, and what came of its frames. */
typedef struct tled_state world;

struct tled_state {
    int64_t slot[SLOTS];
    int64_t bad_fetch, bad_write; /* frames that fail */
    int64_t fetched, written;
    int64_t lasts, last; /* how often it was told the last frame, and which that was */
    bool whole;          /* each written frame was the one that was due, all of it */
    bool beside; /* the first waits, while it is written, for the second to be fetched; false once that was in vain */
    pthread_mutex_t lock;
    pthread_cond_t changed;
};

static int fetch(world *w, int slot, const field_values *t, err *e)
{
    pthread_mutex_lock(&w->lock);
    const int64_t number = w->slot[slot];
    for (int i = 0; i < 3 * NODES; i++)
        t->of[TLED_DISPLACEMENT][i] = (double)number, t->of[TLED_VELOCITY][i] = -(double)number;
    w->fetched++;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    return number == w->bad_fetch ? err_set(e, NULL, 0, "no frame %lld", (long long)number) : 0;
}

static int put(void *context, double time, const field_values *state, err *e)
{
    world *w = context;
    pthread_mutex_lock(&w->lock);
    const int64_t number = w->written;
    if (number == w->bad_write) { /* the next has long been fetched */
        pthread_mutex_unlock(&w->lock);
        nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
        pthread_mutex_lock(&w->lock);
    }
    struct timespec end;
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_sec += 180;
    while (number == 0 && w->beside && w->fetched < 2)
        w->beside = !pthread_cond_timedwait(&w->changed, &w->lock, &end); /* in vain, where frames go one by one */
    w->whole = w->whole && time == (double)number;
    for (int i = 0; i < 3 * NODES; i++)
        w->whole = w->whole && state->of[TLED_DISPLACEMENT][i] == (double)number &&
                   state->of[TLED_VELOCITY][i] == -(double)number;
    w->written++;
    pthread_mutex_unlock(&w->lock);
    return number == w->bad_write ? err_set(e, NULL, 0, "no room for %lld", (long long)number) : 0;
}

static void note_last(void *context, const field_values *state)
{
    world *w = context;
    w->lasts++;
    w->last = (int64_t)state->of[TLED_DISPLACEMENT][3 * NODES - 1];
}

/* Sends frames as run.c does; how many were sent before something was known to be wrong. */
static int64_t send_all(world *w, int64_t frames, err *e)
{
    const tled_problem p = {.nodes = NODES, .fields = tled_fields(NODES, 0)};
    const tled_executor device = {.fetch = fetch};
    int64_t i = 0;
    frame_writer *o = frame_writer_create(&p, &device, w, put, note_last, w, e);
    ok(o, "an frame_writer");
    for (; o && i < frames; i++) {
        if (i >= SLOTS && frame_writer_wait_fetched(o, i - SLOTS, e))
            break;
        pthread_mutex_lock(&w->lock);
        w->slot[i % SLOTS] = i;
        pthread_mutex_unlock(&w->lock);
        frame_writer_send(o, (int)(i % SLOTS), (double)i);
        if (i == frames / 2 && !e->status && frame_writer_wait(o, i, e))
            break;
        if (i == frames / 2)
            ok(w->written == i + 1, "what was waited for is written");
    }
    frame_writer_close(o, e);
    return i;
}

static void begin(world *w)
{
    *w = (world){.bad_fetch = NEVER, .bad_write = NEVER, .whole = true};
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->changed, NULL);
}

int main(void)
{
    err e = {0};
    world w;
    begin(&w);
    ok(send_all(&w, 1000, &e) == 1000 && !e.status && w.whole && w.written == 1000, "1000 frames, in order, whole %s",
       e.text);
    ok(w.lasts == 1 && w.last == 999, "and the last is told once");
    begin(&w);
    w.beside = true;
    ok(send_all(&w, 100, &e) == 100 && w.whole && w.written == 100 && w.beside,
       "the second is fetched while the first is written");
    begin(&w);
    w.bad_fetch = 20;
    ok(send_all(&w, 1000, &e) < 1000 && !strcmp(e.text, "no frame 20") && w.whole && w.written == 20,
       "a frame that is not to be had: those before it are written: %s", e.text);
    begin(&w);
    w.bad_write = 20;
    e = (err){0};
    ok(send_all(&w, 1000, &e) < 1000 && !strcmp(e.text, "no room for 20") && w.whole && w.written == 21,
       "one that cannot be written is the last: %s", e.text);
    ok(!w.lasts, "and then none is told as the last");
    begin(&w);
    w.bad_fetch = 2;
    w.bad_write = 1;
    e = (err){0};
    send_all(&w, 1000, &e);
    ok(!strcmp(e.text, "no room for 1") && w.written == 2, "of two, the first is told: %s", e.text);
    begin(&w);
    e = (err){0};
    ok(send_all(&w, 0, &e) == 0 && !e.status && !w.lasts, "none");
    return done_testing();
}
