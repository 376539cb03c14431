#include "base/num.h"
#include "tled/contact/self_contact.h"
#include "tled/loop/run_parts.h"
#include "tled/loop/timeline.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST = 8 }; /* times as many parts of a step as at rest: more would take longer than anyone waits for a frame */

static int64_t most_parts(const run *n)
{
    return MOST * n->live->parts;
}

void run_choose_parts(run *n)
{
    const double parts = ceil(1 / (n->r->rate * RUN_MARGIN * n->monitor->reading.stable));
    n->parts = (int64_t)num_clamp(parts, (double)n->live->parts, (double)most_parts(n));
}

/* Of the state that was monitored last. */
static void note_check(run *n)
{
    const monitor_reading *s = &n->monitor->reading;
    n->course.most_strain = fmax(n->course.most_strain, s->strain);
    run_choose_parts(n);
    n->r->checked(n->r->context, n->plan.first - n->course.from, s, INFINITY, n->parts, n->course.damping);
}

/* ---- A problem that changed */

/* From which state one is made again. */
typedef enum again { AS_IT_IS, AT_REST, AS_IT_BEGAN } again;

static int find_start(run *n, again from)
{
    const tled_problem *p = n->r->p;
    for (int i = 0; i < p->fields.count; i++)
        if (from == AS_IT_BEGAN)
            memcpy(p->at_start.of[i], n->began.of[i], (size_t)fields_size(&p->fields, i) * sizeof(double));
        else if (n->device->get(n->state, i, p->at_start.of[i], n->e))
            return -1;
    if (from != AS_IT_IS)
        memset(p->at_start.of[TLED_VELOCITY], 0, 3 * (size_t)p->nodes * sizeof(double));
    return 0;
}

/* Makes the state again. All frames are written before. */
static int make_again(run *n, again from)
{
    const run_setup *r = n->r;
    tled_problem *p = n->live->p;
    if (frame_writer_close(n->writer, n->e)) {
        n->writer = NULL;
        return -1;
    }
    n->writer = NULL;
    n->sent = 0;
    if (find_start(n, from) || run_count_crowded(n, n->e))
        return -1;
    p->start = run_now(n);
    n->device->destroy(n->state);
    n->state = n->device->create(p, r->threads, n->e);
    n->writer = n->state ? frame_writer_create(p, n->device, n->state, r->frame, r->last, r->context, n->e) : NULL;
    return n->writer ? 0 : -1;
}

/* Frames that are on their way are written first: their writer reads the problem. */
static int take_over(run *n)
{
    if (n->sent && frame_writer_wait(n->writer, n->sent - 1, n->e))
        return -1;
    if (tled_problem_reload(n->live->p, n->live->m, n->e) || monitor_reload(n->monitor, n->e))
        return -1;
    if (n->live->p->sliding)
        sliding_follow(n->live->p->sliding, n->live->p->script);
    if (n->live->p->self_contact && n->live->p->self_contact->bones)
        sliding_follow(n->live->p->self_contact->bones, n->live->p->script);
    const int more = n->device->reload ? n->device->reload(n->state, n->e) : 1;
    return more < 0 || (more && make_again(n, AS_IT_IS)) || run_monitor(n) ? -1 : 0;
}

/* ---- Steps */

/* Back to the last check, at rest; where that did not help, to the beginning; -1 with status 3 where that did not. */
static int go_back(run *n)
{
    if (n->went_back == 2)
        return run_diverged(n);
    const monitor_reading why = n->monitor->reading;
    n->went_back++;
    n->restored++;
    if (run_restore(n))
        return -1;
    n->live->broke(n->r->context, run_now(n), run_now(n) + (double)n->live->tick / n->r->rate, n->went_back == 2, &why);
    return make_again(n, n->went_back == 2 ? AS_IT_BEGAN : AT_REST) || run_monitor(n) ? -1 : 0;
}

/* To a check, by parts as short as its state needs. It may stay at the check before, at rest. */
static int step_to_check(run *n, int64_t to)
{
    if (run_save(n))
        return -1;
    for (;;) {
        if (run_try(n, to))
            return -1;
        if (run_is_sound(n))
            break;
        if (n->parts == most_parts(n))
            return go_back(n);
        n->parts = n->parts + n->parts / 2 + 1 < most_parts(n) ? n->parts + n->parts / 2 + 1 : most_parts(n);
        if (run_restore(n))
            return -1;
    }
    n->went_back = 0;
    note_check(n);
    return 0;
}

static int copy_displacement(void *context, double *to, err *e)
{
    const run *n = context;
    return n->device->get(n->state, TLED_DISPLACEMENT, to, e);
}

/* 1: done; 0: the caller has ended the run; -1. */
static int tick(run *n)
{
    const int64_t to = n->plan.first + n->live->tick;
    const run_tick at = {run_now(n), tled_time(&n->plan, n->live->tick), copy_displacement, n};
    const int64_t taken = n->course.taken;
    bool anew = false;
    const int got = n->live->take(n->r->context, &at, &anew, n->e);
    if (got <= 0)
        return got;
    if (anew && take_over(n))
        return -1;
    if (anew)
        run_choose_parts(n);
    n->restored = 0;
    while (n->plan.first < to)
        if (step_to_check(n, n->plan.first + 1))
            return -1;
    if (n->live->put(n->r->context, run_now(n), n->course.taken - taken, n->restored, n->e))
        return -1;
    return run_write_frame(n) ? -1 : 1;
}

static int keep_beginning(run *n)
{
    const tled_problem *p = n->r->p;
    if (fields_allocate(&p->fields, FIELDS_ALL, &n->began, "the beginning", n->e))
        return -1;
    for (int i = 0; i < p->fields.count; i++)
        memcpy(n->began.of[i], p->at_start.of[i], (size_t)fields_size(&p->fields, i) * sizeof(double));
    return 0;
}

static int loop(run *n)
{
    n->parts = n->live->parts;
    int got = keep_beginning(n) || run_begin(n) ? -1 : 1;
    while (got > 0 && n->plan.first < n->last)
        got = tick(n);
    return got < 0 ? -1 : 0;
}

int run_live_go(const run_setup *r, const run_live *live, run_end *end, err *e)
{
    return run_by(r, live, loop, end, e);
}
