#include "link/serve_poses.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/space.h"
#include "base/thread.h"
#include "link/igtl_content.h"
#include "live/stop.h"

#include <stdatomic.h>
#include <stdlib.h>

struct serve_poses {
    serve_poses_plan plan;
    pthread_t thread;
    bool joined;
    atomic_bool ended, ends;
    lines_counts counts;
    igtl_buffer content;
};

static int put(serve_poses *s, const lines_pose *p, err *e)
{
    double matrix[16];
    space_matrix_of_pose(&p->at, SPACE_RAS, matrix);
    const int failed = igtl_write_transform(&s->content, matrix, e) ||
                       serve_board_put(s->plan.board, s->plan.probe, igtl_now(), -1, &s->content, e);
    s->content.size = 0;
    return failed ? -1 : 0;
}

static void skip_controls(lines *l)
{
    keyfile k;
    while (lines_take(l, &k)) {
        err e = {0};
        err_set(&e, k.name, k.line, "'%.60s' is no pose; expected `time x y z qx qy qz qw`", k.word[0]);
        lines_skip(l, &e);
    }
}

static void tell(const serve_poses *s, lines *l)
{
    notes told = {0};
    lines_tell(l, &told);
    for (int i = 0; i < told.count; i++)
        s->plan.say(s->plan.context, told.line[i]);
    notes_free(&told);
}

static int serve(serve_poses *s, lines *l, err *e)
{
    static const double often = .25; /* s: the end rings no bell */
    lines_pose p;
    bool over;
    do {
        lines_wait(l, clock_now() + often);
        over = atomic_load(&s->ends) || stop_came() || lines_ended(l);
        if (lines_take_pose(l, &p) && put(s, &p, e))
            return -1;
        skip_controls(l);
        tell(s, l);
    } while (!over);
    return 0;
}

static void *read_all(void *context)
{
    serve_poses *s = context;
    err e = {0};
    lines *l = lines_open_named(s->plan.path, NULL, NULL, &e);
    if (!l || serve(s, l, &e))
        s->plan.failed(s->plan.context, &e);
    if (l)
        s->counts = lines_count(l);
    lines_close(l);
    atomic_store(&s->ended, true);
    serve_board_wake(s->plan.board);
    return NULL;
}

serve_poses *serve_poses_open(const serve_poses_plan *plan, err *e)
{
    serve_poses *s = mem_array(1, sizeof *s, "poses", e);
    if (!s)
        return NULL;
    s->plan = *plan;
    const int code = thread_start(&s->thread, read_all, s);
    if (!code)
        return s;
    err_system(e, plan->path, code, "cannot start a thread");
    free(s);
    return NULL;
}

bool serve_poses_ended(serve_poses *s)
{
    return atomic_load(&s->ended);
}

lines_counts serve_poses_count(const serve_poses *s)
{
    return s->counts;
}

void serve_poses_end(serve_poses *s)
{
    atomic_store(&s->ends, true);
    if (!s->joined)
        pthread_join(s->thread, NULL);
    s->joined = true;
}

void serve_poses_close(serve_poses *s)
{
    if (!s)
        return;
    serve_poses_end(s);
    igtl_buffer_free(&s->content);
    free(s);
}
