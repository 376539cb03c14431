#include "tled/loop/run_parts.h"
#include "tled/loop/timeline.h"

#include <math.h>
#include <stdio.h>

double run_now(const run *n)
{
    return n->is_last_short && n->plan.first == n->last ? n->r->end : tled_time(&n->plan, 0);
}

double run_part(const run *n)
{
    return n->live ? 1 / (n->plan.rate * (double)n->parts) : ldexp(1 / n->plan.rate, -n->course.cuts);
}

double run_margin(const run *n)
{
    return n->plan.rate == n->r->rate ? RUN_MARGIN : RUN_HASTE_MARGIN;
}

static int64_t parts_of(const run *n)
{
    return n->live ? n->parts : INT64_C(1) << n->course.cuts;
}

/* ---- What a state is like */

static int monitor_at(run *n, double time)
{
    return monitor_read(n->monitor, n->device, n->state, time, n->e);
}

int run_monitor(run *n)
{
    return monitor_at(n, run_now(n));
}

bool run_is_sound(const run *n)
{
    const monitor_reading *s = &n->monitor->reading;
    return s->broken < 0 && s->stable >= run_part(n) * (1 - 1e-12);
}

/* What is wrong with the element that the monitor names. */
static void say_wrong(const run *n, char *to, size_t size)
{
    const monitor_reading *s = &n->monitor->reading;
    if (s->broken >= 0)
        snprintf(to, size, "%s", s->inverted ? "is inverted" : "is no longer finite");
    else
        snprintf(to, size, "has a stable step of %.3g ms now, below the step of %.3g ms%s", 1e3 * s->stable,
                 1e3 * run_part(n), n->r->rate_fixed ? "; expected a smaller --dt" : "");
}

int run_diverged(run *n)
{
    char wrong[200];
    const tled_problem *p = n->r->p;
    const monitor_reading *s = &n->monitor->reading;
    if (monitor_locate(n->monitor, n->device, n->state, n->e))
        return -1;
    int64_t element = s->broken >= 0 ? s->broken : s->stable_element;
    if (element < 0)
        element = 0;
    say_wrong(n, wrong, sizeof wrong);
    return err_diverged(n->e, NULL, 0, "diverged at step %lld, %.6g s: element %lld (volume '%s') %s",
                        (long long)(n->plan.first - n->course.from), s->time, (long long)element,
                        p->volume[p->element_volume[element]].name, wrong);
}

void run_tell_cut(run *n, const monitor_reading *why)
{
    if (n->course.cuts <= n->cuts_told)
        return;
    n->cuts_told = n->course.cuts;
    if (n->r->cut)
        n->r->cut(n->r->context, why, parts_of(n));
}

int run_restore(run *n)
{
    n->plan.first = n->saved_first;
    if (n->r->log && log_restore(n->r->log, n->e))
        return -1;
    return n->device->restore(n->state, n->e);
}

int run_save(run *n)
{
    n->saved_first = n->plan.first;
    return monitor_save(n->monitor, n->device, n->state, n->e);
}

/* ---- Steps */

/* The steps from `first` on, as they are cut: all of one length, but the last where it is short. Of that one times are
 * counted back from its end, so that this is met to the last bit. */
static tled_plan cut_plan(const run *n, int64_t first)
{
    const int64_t parts = parts_of(n);
    tled_plan cut = {n->plan.origin, n->plan.rate * (double)parts, first * parts, n->course.damping};
    if (n->is_last_short && first == n->last - 1) {
        const double begins = tled_time(&n->plan, first - n->plan.first);
        cut = (tled_plan){n->r->end, (double)parts / (n->r->end - begins), -parts, n->course.damping};
    }
    return cut;
}

/* Steps of one length. */
static int step_evenly(run *n, int64_t to)
{
    const int64_t count = (to - n->plan.first) * parts_of(n);
    const tled_plan cut = cut_plan(n, n->plan.first);
    if (n->device->step(n->state, &cut, count, n->e))
        return -1;
    n->dt = 1 / cut.rate;
    n->damped = n->course.damping;
    n->course.taken += count;
    n->plan.first = to;
    return 0;
}

static int step_to(run *n, int64_t to)
{
    const int64_t even = n->is_last_short && to == n->last ? to - 1 : to;
    if (even > n->plan.first && step_evenly(n, even))
        return -1;
    return to > n->plan.first ? step_evenly(n, to) : 0;
}

/* ---- Frames and rows of the log */

int64_t run_next_frame(const run *n, int64_t after)
{
    return timeline_next(&n->plan, n->r->every, after);
}

/* With a row of the log, but for those at checks. */
static int64_t next_row(const run *n, int64_t after)
{
    return timeline_next(&n->plan, n->r->log ? n->r->log->every : 0, after);
}

/* Takes a snapshot of the state for a frame: it may yet turn out to be unsound. */
static int take_snapshot(run *n)
{
    const int64_t index = n->sent + n->unsure++;
    const int slot = (int)(index % n->slots);
    if (index >= n->slots && frame_writer_wait_fetched(n->writer, index - n->slots, n->e))
        return -1;
    n->frame_time[slot] = run_now(n);
    return n->device->snapshot(n->state, slot, n->e);
}

/* The snapshots are of sound states: hands them on. */
static void send_snapshots(run *n)
{
    for (; n->unsure; n->unsure--, n->sent++)
        frame_writer_send(n->writer, (int)(n->sent % n->slots), n->frame_time[n->sent % n->slots]);
}

int run_write_frame(run *n)
{
    if (take_snapshot(n))
        return -1;
    send_snapshots(n);
    n->written = n->plan.first;
    return 0;
}

/* Accounts for the state in the log; `shown`, by a row. */
static int log_state(run *n, bool shown)
{
    const log_row row = {.step = n->plan.first - n->course.from,
                         .taken = n->course.taken,
                         .time = run_now(n),
                         .dt = n->dt,
                         .stable = n->monitor->reading.stable,
                         .damping = n->damped,
                         .remaining = n->course.remaining};
    return log_read(n->r->log, n->device, n->state, &row, shown, n->e);
}

run_due run_due_now(const run *n)
{
    const int64_t at = n->plan.first;
    const run_log *log = n->r->log;
    return (run_due){.frame = run_next_frame(n, at - 1) == at,
                     .row = log && (log->every == 0 || next_row(n, at - 1) == at)};
}

int run_log_sound(run *n, bool shown)
{
    run_log *log = n->r->log;
    if (!log)
        return 0;
    return log_state(n, shown) || log_save(log, n->e) ? -1 : 0;
}

/* ---- Where it diverged */

/* Takes the parts of the step past what is saved one by one, until one breaks. Returns -1. */
static int find_part(run *n)
{
    tled_plan cut = cut_plan(n, n->saved_first);
    bool sound = true;
    if (run_restore(n))
        return -1;
    n->plan.first++;
    for (int64_t i = 0; sound && i < parts_of(n); i++, cut.first++) {
        if (n->device->step(n->state, &cut, 1, n->e) || monitor_at(n, tled_time(&cut, 1)))
            return -1;
        sound = run_is_sound(n);
    }
    return run_diverged(n);
}

/* Goes one step on, with its frame. Sets `sound`; where it is not, nothing is written of it. */
static int try_step(run *n, bool *sound)
{
    if (step_to(n, n->plan.first + 1) || run_monitor(n))
        return -1;
    *sound = run_is_sound(n);
    if (!*sound)
        return 0;
    const run_due due = run_due_now(n);
    if (run_log_sound(n, due.row) || run_save(n))
        return -1;
    return due.frame ? run_write_frame(n) : 0;
}

/* What lies before `to` is not sound: goes there again step by step, to say where and when it broke, and with the
 * frames before that. Returns -1. */
static int find_break(run *n, int64_t to)
{
    bool sound = true;
    if (run_restore(n))
        return -1;
    while (sound && n->plan.first < to)
        if (try_step(n, &sound))
            return -1;
    return find_part(n);
}

/* ---- From check to check */

/* Whether slots suffice for snapshots of all frames before `to`. */
static bool has_slots(const run *n, int64_t to)
{
    int64_t at = n->plan.first;
    for (int count = 0; count < n->slots; count++) {
        at = run_next_frame(n, at);
        if (at >= to)
            return true;
    }
    return false;
}

/* Steps to `to`, making rows of the log on the way, and, if so asked, snapshots for frames. */
static int step_by(run *n, int64_t to, bool framed)
{
    for (;;) {
        const int64_t row = next_row(n, n->plan.first);
        const int64_t shot = framed ? run_next_frame(n, n->plan.first) : INT64_MAX;
        const int64_t at = shot < row ? shot : row;
        if (at >= to)
            return step_to(n, to);
        if (step_to(n, at) || (at == shot && take_snapshot(n)) || (at == row && log_state(n, true)))
            return -1;
    }
}

/* Goes back to the last check, to step from there again with steps cut once more; diverges where they cannot be. */
static int cut_once_more(run *n, int64_t to)
{
    n->unsure = 0;
    if (n->r->rate_fixed || n->course.cuts == CUTS_MAX)
        return find_break(n, to);
    n->course.cuts++;
    return run_restore(n);
}

/* Steps to `to`, and monitors the state there. */
static int try_steps(run *n, int64_t to, bool framed)
{
    return step_by(n, to, framed) || run_monitor(n) ? -1 : 0;
}

int run_try(run *n, int64_t to)
{
    return try_steps(n, to, false);
}

/* Steps to `to`, and again from the last check with steps cut once more, until the state there is sound. */
static int step_until_sound(run *n, int64_t to, bool framed)
{
    const monitor_reading before = n->monitor->reading; /* why steps are cut already where a run is continued */
    if (try_steps(n, to, framed))
        return -1;
    const monitor_reading why = run_is_sound(n) ? before : n->monitor->reading;
    while (!run_is_sound(n))
        if (cut_once_more(n, to) || try_steps(n, to, framed))
            return -1;
    send_snapshots(n);
    run_tell_cut(n, &why);
    return n->r->log ? log_save(n->r->log, n->e) : 0;
}

/* Steps once more from the last check to `to`, all of which is known to be sound, for
 * frames that the slots do not suffice for. */
static int step_again(run *n, int64_t to)
{
    if (run_restore(n))
        return -1;
    for (int64_t at = run_next_frame(n, n->plan.first); at < to; at = run_next_frame(n, at))
        if (step_to(n, at) || run_write_frame(n))
            return -1;
    return step_to(n, to) || run_monitor(n) ? -1 : 0;
}

int run_advance(run *n, int64_t to)
{
    const bool framed = has_slots(n, to);
    if (run_save(n) || step_until_sound(n, to, framed))
        return -1;
    return framed ? 0 : step_again(n, to);
}
