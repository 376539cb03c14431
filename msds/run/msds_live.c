#include "msds/run/msds_live.h"

#include "base/clock.h"
#include "live/lines.h"
#include "live/live_clock.h"
#include "live/stop.h"
#include "msds/run/frame_report.h"
#include "msds/run/haptics.h"
#include "msds/run/msds_record.h"
#include "msds/run/settings.h"

#include <math.h>
#include <string.h>

enum { FAILED_MOST = 60 };

static const double usual_rate = 60; /* Hz, where --rate is 0 */

typedef struct live {
    session *s;
    lines *lines;
    record *record;   /* or NULL */
    haptics *haptics; /* or NULL */
    live_clock clock;
    double start;    /* s: the frames' time when the clock began */
    double earliest; /* s, by clock_now: of the next frame */
    bool has_pose;
    lines_pose pose; /* the newest */
    int64_t rests;   /* how often the tissue was put back to rest */
    int failed;      /* frames in a row that could not be solved, though they did not diverge */
} live;

/* ---- Input */

static double tick(const session *s)
{
    return 1 / (s->o->rate > 0 ? s->o->rate : usual_rate);
}

/* Controls that wait, in their order. True: there was one that changed something. */
static bool take_controls(live *l)
{
    keyfile k;
    err e = {0};
    bool any = false;
    while (lines_take(l->lines, &k)) {
        if (settings_take(l->s, &k, &e)) {
            lines_skip(l->lines, &e);
            continue;
        }
        record_control(l->record, &k);
        any = true;
    }
    l->clock.each = tick(l->s);
    return any;
}

/* All frames have a pose, or none has. */
static bool take_pose(live *l)
{
    lines_pose newest;
    if (!lines_take_pose(l->lines, &newest))
        return false;
    if (!l->has_pose && !l->s->o->poses) {
        err e = {0};
        err_set(&e, newest.name, newest.line,
                "a pose among the controls, when frames have begun without one; expected --poses");
        lines_skip_pose(l->lines, &e);
        return false;
    }
    l->pose = newest;
    l->has_pose = true;
    l->pose.at = placing_of(&l->s->placing, &newest.at);
    return true;
}

/* Frames begin with the first pose, or at once where none can come. */
static bool has_begun(const live *l)
{
    return l->has_pose || !l->s->o->poses;
}

static void sleep_until(double when)
{
    clock_sleep(fmin(when - clock_now(), 1));
}

/* Until something has come, or a tick is due; but not before twice the rate allows. */
static void wait_for_turn(live *l)
{
    const double never = clock_now() + 3600;
    lines_wait(l->lines, has_begun(l) ? l->clock.due : never);
    sleep_until(l->earliest);
}

static void tell(live *l)
{
    session *s = l->s;
    lines_tell(l->lines, &s->warnings);
    if (!s->warnings.count)
        return;
    progress_clear(&s->progress);
    tool_warn(s->t, &s->warnings);
}

/* ---- Frames */

/* Where a frame cannot be solved, the tissue goes back to rest, which the frame then shows. What lasts, as a device
 * that fails, ends the run. */
static int put_to_rest(live *l, const frame_input *from, err *e)
{
    err none = {0};
    l->failed += !l->s->diverged;
    if (l->failed == FAILED_MOST)
        return -1;
    if (!l->rests++)
        notes_add(&l->s->warnings, "%s; the tissue is put back to rest, and the run goes on", e->text);
    *e = none;
    return solve_frame_rest(l->s, from, e);
}

/* s of the model's time that the frame took, `since` s after the one before. The first one shows the tissue as it was
 * until then. */
static double time_taken(const session *s, double since)
{
    const double each = (double)s->o->iterations * s->o->rate;
    return each > 0 && !s->moves.inside && s->posed > 1 ? (double)press_sum(&s->moves) / each : since;
}

/* Exact frames begin when their solver is made; until then, conjugate gradients go on. Where it cannot be made, they do
 * for good. */
static method_word method_now(live *l)
{
    session *s = l->s;
    err e = {0};
    const method_word meanwhile = methods_warps(s->method) ? METHOD_WARP : METHOD_FEM;
    const msds_plan plan = {.method = methods_solver(s->method), .warp = methods_warps(s->method)};
    const int is_ready = s->device->ready(s->state, &plan, &e);
    if (is_ready > 0)
        return s->method;
    if (is_ready < 0) {
        notes_add(&s->warnings, "%s; the method is %s from here on", e.text, methods_words[meanwhile]);
        s->method = meanwhile;
    }
    return meanwhile;
}

static int make_frame(live *l, bool posed, err *e)
{
    session *s = l->s;
    const double before = s->time;
    frame_input from = solve_frame_input(s, l->start + live_clock_now(&l->clock), &l->pose.at, 0);
    from.has_pose = l->has_pose;
    from.method = method_now(l);
    l->earliest = clock_now() + .5 * l->clock.each;
    const bool rested = solve_frame_solve(s, &from, e);
    if (rested && put_to_rest(l, &from, e))
        return -1;
    if (!rested)
        l->failed = 0;
    if (solve_frame_write(s, &from, e))
        return -1;
    if (posed)
        live_clock_showed(&l->clock, l->pose.came);
    live_clock_tick(&l->clock, rested ? 0 : time_taken(s, s->time - before));
    msds_record_add(l->record, s, &from, rested);
    return l->haptics ? haptics_send(l->haptics, l->pose.came, rested, e) : 0;
}

static int go_on(live *l, err *e)
{
    while (!stop_came()) {
        wait_for_turn(l);
        const bool changed = take_controls(l), posed = take_pose(l), due = clock_now() >= l->clock.due;
        tell(l);
        if (!changed && !posed && lines_ended(l->lines))
            break;
        if (has_begun(l) && (changed || posed || due) && make_frame(l, posed, e))
            return -1;
    }
    return 0;
}

/* ---- Beginning and end */

static void say_end(live *l)
{
    session *s = l->s;
    char frames[LIVE_CLOCK_TEXT], counts[LINES_TEXT];
    const lines_counts count = lines_count(l->lines);
    live_clock_text(&l->clock, frames);
    lines_text(&count, counts);
    progress_clear(&s->progress);
    if (s->posed)
        frame_report_end(s);
    tool_say(s->t, "%s; %s", frames, counts);
    if (l->rests)
        tool_say(s->t, "the tissue was put back to rest %lld times", (long long)l->rests);
    if (l->haptics)
        haptics_end(l->haptics);
}

static void begin(live *l)
{
    session *s = l->s;
    s->press.live = true;
    l->start = s->time;
    l->has_pose = s->press.any;
    l->pose.at = l->has_pose ? s->press.last : pose_none();
    method_now(l);
    live_clock_begin(&l->clock, 1 / tick(s));
}

int msds_live_run(session *s, err *e)
{
    live l = {.s = s};
    int failed = -1;
    s->source = s->o->poses ? s->o->poses : s->o->control;
    if (s->o->record && !(l.record = msds_record_create(s, e)))
        return -1;
    if (s->o->haptics && !(l.haptics = haptics_create(s, e)))
        goto out;
    l.lines = lines_open_named(s->o->poses, s->o->control, s->stage.source, e);
    if (l.lines) {
        begin(&l);
        failed = go_on(&l, e);
        tell(&l);
        say_end(&l);
    }
    lines_close(l.lines);
out:
    haptics_destroy(l.haptics);
    record_close(l.record, &s->warnings);
    return failed;
}
