#include "tled/run/tled_live.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/num.h"
#include "live/lines.h"
#include "live/live_clock.h"
#include "live/spnav.h"
#include "live/stop.h"
#include "tled/problem/bodies.h"
#include "tled/problem/step.h"
#include "tled/run/tled_frame.h"
#include "tled/run/tled_record.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RING = TLED_SLOTS + 16, TOLD = 5 }; /* frames on their way at most, and more; breaks that are told one by one */

enum { SPARE_CURVES = 16, SPARE_NODES = 16384 }; /* of what lines add, before a card's state is made again */

static const double usual_rate = 60; /* frames a second */

/* Of a frame that is on its way. */
typedef struct shown {
    bool placed; /* a pose came by then */
    collider_moment at;
    double came;   /* s, by clock_now: of a pose that is new in it; 0: none is */
    double *value; /* the curves' values, where there are bodies or results; owned */
    int64_t room;
} shown;

struct live {
    session *s;
    run_live run;
    double rate;     /* ticks a second */
    double ramp;     /* s: how long contact takes to come up */
    placing placing; /* of --body and --marker */
    live_clock clock;
    lines *lines;    /* NULL: no source, or a replay */
    record *record;  /* NULL: none */
    replay *replay;  /* NULL: it is live */
    bool cut;        /* the record ended without its `end` */
    lines_pose pose; /* that came last */
    bool has_pose;   /* it has not been taken */
    record_frame next;
    int64_t recorded; /* replay: the steps of this frame */
    double came;      /* s: of the pose that is new in this tick; 0: none is */
    double *displacement;
    int64_t broken; /* times */
    bool told_over; /* that levels add up to more than 1 */
    shown shown[RING];
    int64_t put, written; /* frames that were handed on, and written */
};

/* ---- Options */

static int check_sources(const struct options *o, err *e)
{
    const char *came[] = {o->poses, o->lines, o->body, o->marker};
    static const char *const names[] = {"poses", "control", "body", "marker"};
    for (int i = 0; i < 4; i++)
        if (o->replay && came[i])
            return err_usage(e, "--replay with --%s; expected the record alone, which has what came", names[i]);
    if (!o->live && spnav_refuse(o->poses, e))
        return -1;
    if (o->lines && !o->live)
        return err_usage(e, "--control without --live; expected both, or --script for what changes in time");
    if (o->rate >= 0 && !o->live && !o->replay)
        return err_usage(e, "--rate without --live; expected both, or --every for the time between frames");
    if (o->record && !o->live)
        return err_usage(e, "--record without --live, whose run it records; expected both");
    if (o->force && !o->record)
        return err_usage(e, "--force without --record, which it lets write over a file; expected both");
    if (o->body && !o->poses && !o->rigid_poses)
        return err_usage(e, "--body without --poses or --rigid-poses, whose frame it is; expected both");
    if (o->marker && !o->poses)
        return err_usage(e, "--marker without --poses, which are of the marker; expected both");
    if (o->live && o->poses && o->lines && !strcmp(o->poses, o->lines))
        return err_usage(e,
                         "--poses and --control are both '%s'; expected one of them: either may have poses and "
                         "controls",
                         o->poses);
    return 0;
}

int live_check(const struct options *o, err *e)
{
    const struct {
        bool given;
        const char *name;
    } other[] = {{o->rest >= 0, "--rest"},
                 {o->every > 0, "--every"},
                 {o->log != NULL, "--log"},
                 {o->checkpoint || o->restart, o->checkpoint ? "--checkpoint" : "--restart"}};
    if (o->live && o->replay)
        return err_usage(e, "--live and --replay; expected one of them");
    if (check_sources(o, e))
        return -1;
    for (size_t i = 0; (o->live || o->replay) && i < sizeof other / sizeof *other; i++)
        if (other[i].given)
            return err_usage(e,
                             "%s with --%s, whose frames come at --rate until it is told to end; expected one of them",
                             other[i].name, o->live ? "live" : "replay");
    return 0;
}

/* ---- Life */

int live_create(session *s, const struct options *o, err *e)
{
    if (!o->live && !o->replay)
        return 0;
    s->live = mem_array(1, sizeof *s->live, "the live run", e);
    if (!s->live)
        return -1;
    s->live->s = s;
    s->live->rate = o->rate > 0 ? o->rate : usual_rate;
    s->live->ramp = o->ramp;
    return 0;
}

void live_destroy(live *l)
{
    if (!l)
        return;
    lines_close(l->lines);
    record_close(l->record, NULL);
    replay_close(l->replay);
    free(l->displacement);
    for (int i = 0; i < RING; i++)
        free(l->shown[i].value);
    free(l);
}

int live_collider(session *s, const placing *of, err *e)
{
    s->live->placing = *of;
    return collider_begin_live(&s->collider, e);
}

int64_t live_parts(const live *l)
{
    return l ? l->run.parts : 1;
}

double live_ramp(const live *l)
{
    return l->ramp;
}

/* A step from check to check, as many as a tick needs; in so many parts at least as are stable at rest, or as --dt asks
 * for. */
static void choose_steps(session *s, const struct options *o)
{
    live *l = s->live;
    const double part = o->dt > 0 ? o->dt : RUN_MARGIN * s->stable, parts = ceil(1 / l->rate / part * (1 - 1e-9));
    l->run.tick = (int64_t)ceil(parts / (o->dt > 0 ? STEP_UNSEEN_GIVEN : STEP_UNSEEN));
    l->run.parts = (int64_t)fmax(1, ceil(parts / (double)l->run.tick));
    s->run.rate = l->rate * (double)l->run.tick;
    s->run.check = 1;
    s->run.rate_fixed = false;
}

int live_prepare(session *s, const struct options *o, err *e)
{
    live *l = s->live;
    choose_steps(s, o);
    s->problem.spare_curves = SPARE_CURVES;
    s->problem.spare_nodes = SPARE_NODES;
    l->displacement = mem_array(s->problem.nodes, 3 * sizeof *l->displacement, "the live run", e);
    return !l->displacement || script_add_idle(&s->script, &s->m, e) || tled_problem_reload(&s->problem, &s->m, e) ? -1
                                                                                                                   : 0;
}

/* ---- What came */

/* Once a run. */
static void tell_over(live *l, const run_tick *at)
{
    double sum;
    const int32_t volume = l->told_over ? -1 : script_over(&l->s->script, at->from, &sum);
    if (volume < 0)
        return;
    l->told_over = true;
    notes_add(&l->s->warnings, "at %.6g s the levels of %.200s add up to %.4g; what is above 1 counts as 1", at->from,
              l->s->problem.volume[volume].name, sum);
}

/* A control that may be wrong: then nothing has changed. */
static int take_control(live *l, const keyfile *k, const run_tick *at, bool *anew, err *e)
{
    const executor *device = &l->s->run.device->is;
    const char *verb = k->word[k->count > 1 && !strcmp(k->word[0], "now")];
    script_now now = {at->from, at->until, NULL};
    if (!script_is_now(k))
        return keyfile_error(k, e, "'%.100s'; expected now VERB ..., pull ID ..., release ID, or a pose", k->word[0]);
    if (!strcmp(verb, "pressure") && !(device->features & EXECUTOR_FOLLOWERS))
        return keyfile_error(k, e, "device %s has no pressure on a surface; expected --device cpu", device->device);
    if (!strcmp(verb, "displace") || !strcmp(verb, "move")) {
        if (at->displacement(at->run, l->displacement, e))
            return -1;
        now.displacement = l->displacement;
    }
    if (script_take_now(&l->s->script, &l->s->m, k, &now, anew, e))
        return -1;
    if (!strcmp(verb, "contract"))
        tell_over(l, at);
    return 0;
}

static void take_pose(live *l, const run_tick *at, const pose *to)
{
    collider *c = &l->s->collider;
    if (c->is_away)
        collider_rise(c, at->from, l->ramp);
    collider_move(c, at->from, at->until, to);
    l->next.has_pose = true;
    l->next.at = *to;
}

/* The newest pose, where one came since the last that was taken here. */
static bool take_newest(live *l)
{
    const bool is = lines_take_pose(l->lines, &l->pose);
    if (is && l->has_pose)
        lines_drop_pose(l->lines);
    const bool any = is || l->has_pose;
    l->has_pose = false;
    return any;
}

static void skip_pose(live *l)
{
    err e = {0};
    err_set(&e, l->pose.name, l->pose.line, "a pose, but there is no probe; expected --probe and --poses");
    lines_skip_pose(l->lines, &e);
}

static void take_lines(live *l, const run_tick *at, bool *anew)
{
    keyfile k;
    err wrong = {0};
    while (lines_take(l->lines, &k))
        if (take_control(l, &k, at, anew, &wrong))
            lines_skip(l->lines, &wrong);
        else
            record_control(l->record, &k);
    const bool posed = take_newest(l);
    if (posed && l->s->collider.poses) {
        const pose to = placing_of(&l->placing, &l->pose.at);
        take_pose(l, at, &to);
        l->came = l->pose.came;
    } else if (posed) {
        skip_pose(l);
    }
    lines_tell(l->lines, &l->s->warnings);
    tool_warn(l->s->t, &l->s->warnings);
}

/* A run with a probe begins with its first pose. */
static bool has_begun(live *l)
{
    if (!l->s->collider.poses || !l->s->collider.is_away || l->has_pose)
        return true;
    l->has_pose = lines_take_pose(l->lines, &l->pose);
    if (l->has_pose)
        live_clock_begin(&l->clock, l->rate);
    return l->has_pose;
}

/* Not by lines_wait, which ends as something comes: that is for the tick. */
static bool wait_until_due(live *l)
{
    static const double look = .05, soon = .0005; /* s: how soon a signal, and the first pose, is seen */
    for (;;) {
        const double left = l->clock.due - clock_now();
        if (stop_came() || (l->lines && lines_ended(l->lines)))
            return false;
        if (left <= 0 && has_begun(l))
            return true;
        clock_sleep(num_clamp(left, soon, look));
    }
}

/* The record's next frame, with the controls before it. */
static int take_record(live *l, const run_tick *at, bool *anew, err *e)
{
    replay_kind kind;
    keyfile k;
    record_frame f;
    int got;
    while ((got = replay_next(l->replay, &kind, &k, &f, e)) > 0 && kind == REPLAY_CONTROL)
        if (take_control(l, &k, at, anew, e))
            return -1;
    l->cut = !got && !replay_is_whole(l->replay);
    if (got <= 0)
        return got;
    if (f.time != at->until)
        return keyfile_error(&k, e, "a frame at %.17g s; expected one at %.17g s", f.time, at->until);
    l->recorded = f.steps;
    if (f.has_pose && l->s->collider.poses)
        take_pose(l, at, &f.at);
    return 1;
}

static int take(void *context, const run_tick *at, bool *anew, err *e)
{
    session *s = context;
    live *l = s->live;
    l->next.has_pose = false;
    l->came = 0;
    if (l->replay)
        return stop_came() ? 0 : take_record(l, at, anew, e);
    if (!wait_until_due(l))
        return 0;
    if (l->lines)
        take_lines(l, at, anew);
    return 1;
}

/* ---- Frames */

/* What is known of the next frame, for whoever writes it. */
static int show(live *l, double time, double came, err *e)
{
    const collider *c = &l->s->collider;
    const tled_problem *p = &l->s->problem;
    shown *to = &l->shown[l->put++ % RING];
    to->placed = c->poses && !c->is_away;
    to->came = came;
    if (to->placed)
        to->at = collider_moment_at(c, time);
    if (!tled_frame_takes_curves(l->s))
        return 0;
    if (MEM_ROOM(&to->value, &to->room, 3 * p->script->curves, "the live run", e))
        return -1;
    tled_curves(p, time, to->value);
    return 0;
}

static int put(void *context, double time, int64_t taken, int restored, err *e)
{
    session *s = context;
    live *l = s->live;
    if (l->replay && l->recorded >= 0 && l->recorded != taken)
        return err_set(e, NULL, 0,
                       "frame %" PRId64 " took %" PRId64 " steps, but %" PRId64
                       " as it was recorded; expected the same back end",
                       l->next.index, taken, l->recorded);
    l->next.time = time;
    l->next.steps = taken;
    snprintf(l->next.path, sizeof l->next.path, "%s%s", s->run.device->is.device, restored ? "-restored" : "");
    record_add(l->record, &l->next, &s->warnings);
    tool_warn(s->t, &s->warnings);
    l->next.index++;
    if (show(l, time, l->came, e))
        return -1;
    live_clock_tick(&l->clock, 1 / l->rate);
    return 0;
}

static void broke(void *context, double time, double until, bool anew, const monitor_reading *reading)
{
    session *s = context;
    live *l = s->live;
    char where[400];
    const script_now now = {time, until, NULL};
    const int64_t pulls = script_release_all(&s->script, &now);
    if (anew)
        script_forget_all(&s->script, &now);
    if (s->collider.poses)
        collider_rise(&s->collider, time, l->ramp);
    if (l->broken++ >= TOLD)
        return;
    monitor_words(&s->m, reading, where, sizeof where);
    notes_add(&s->warnings, "at %.6g s the tissue broke: %s; it goes on from %s, at rest; springs released: %" PRId64,
              time, where, anew ? "where it began, without what lines have set" : "its last sound state", pulls);
    if (l->broken == TOLD)
        notes_add(&s->warnings, "from now on, tissue that breaks is counted and no longer told of");
    tool_warn(s->t, &s->warnings);
}

const collider_moment *live_moment(const live *l)
{
    const shown *of = &l->shown[l->written % RING];
    return of->placed ? &of->at : NULL;
}

const double *live_values(const live *l)
{
    return l->shown[l->written % RING].value;
}

void live_written(live *l)
{
    const shown *of = &l->shown[l->written++ % RING];
    if (of->came > 0)
        live_clock_showed(&l->clock, of->came);
}

/* ---- The run */

int live_open(session *s, const struct options *o, err *e)
{
    live *l = s->live;
    if (s->collider.poses)
        s->run.first = false;
    l->next = (record_frame){.index = s->next_frame + s->run.first, .of = -1};
    if (record_begin(s, l->rate, o->record, o->force, o->replay, &l->record, &l->replay, e))
        return -1;
    if (!o->live || (!o->poses && !o->lines))
        return 0;
    l->lines = lines_open_named(o->poses, o->lines, s->stage.source, e);
    return l->lines ? 0 : -1;
}

int live_go(session *s, run_end *end, err *e)
{
    live *l = s->live;
    l->run.p = &s->problem;
    l->run.m = &s->m;
    l->run.take = take;
    l->run.put = put;
    l->run.broke = broke;
    if (s->run.first && show(l, s->problem.start, 0, e))
        return -1;
    live_clock_begin(&l->clock, l->rate);
    return run_live_go(&s->run, &l->run, end, e);
}

void live_end(session *s)
{
    live *l = s->live;
    char text[LIVE_CLOCK_TEXT], counts[LINES_TEXT];
    record_close(l->record, &s->warnings);
    l->record = NULL;
    if (l->cut)
        notes_add(&s->warnings, "the record was cut short: it is replayed up to its last whole frame");
    else if (l->replay && !replay_is_whole(l->replay) && stop_came())
        notes_add(&s->warnings, "a signal ended the replay before the end of its record");
    live_clock_text(&l->clock, text);
    tool_say(s->t, "%s: %s", l->replay ? "replayed" : "live", text);
    if (l->broken)
        tool_say(s->t, "the tissue broke, and went on from a sound state: %" PRId64 " times", l->broken);
    if (!l->lines)
        return;
    const lines_counts c = lines_count(l->lines);
    lines_tell(l->lines, &s->warnings);
    lines_text(&c, counts);
    tool_say(s->t, "%s", counts);
}
