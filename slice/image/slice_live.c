#include "slice/image/slice_live.h"

#include "base/checksum.h"
#include "base/clock.h"
#include "live/live_clock.h"
#include "live/record.h"
#include "live/stop.h"
#include "model/binary.h"
#include "slice/image/slice_feed.h"
#include "slice/image/slice_settings.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { RATE = 60 }; /* Hz */

typedef struct live {
    slice_session *s;
    lines *lines;
    slice_feed *feed; /* NULL: there is no model */
    record *record;   /* NULL: none is made */
    live_clock clock;
    double last; /* s, by clock_now: the last image */
    /* What the image shows. */
    frame frame;
    bool has_frame, has_pose;
    pose from;
    /* What came since the last image. */
    bool is_new;
    double came; /* s, by clock_now: when the newest of it came; 0: only controls */
    lines_pose next;
    bool has_next; /* a pose that is not shown, since the image stays */
} live;

/* ---- What a record is of */

enum { PARTS = 6, PART = 200 };

/* The keys and values that must be the same in a replay. */
typedef struct parts {
    char text[PARTS][PART];
    record_of of[PARTS];
} parts;

static uint32_t checksum_of_array(uint32_t crc, const model *m, const char *name)
{
    const model_array *a = model_find(m, name);
    const uint32_t own = a ? binary_crc(&(item){.kind = ITEM_ARRAY, .array = *a}) : 0;
    return checksum_add(crc, &own, sizeof own);
}

static void put_place(const pose *place, char text[PART])
{
    double row[7];
    pose_to_row(place, row);
    snprintf(text, PART, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", row[0], row[1], row[2], row[3], row[4], row[5],
             row[6]);
}

static void put_checksum(bool is, uint32_t crc, char text[PART])
{
    snprintf(text, PART, is ? "0x%08" PRIx32 : "none", crc);
}

static void make_parts(const slice_session *s, parts *p)
{
    static const char *const keys[PARTS] = {"size", "method", "body", "model", "labels", "volume"};
    const model *m = &s->model.body;
    const uint32_t crc =
        s->o.rigid ? 0 : checksum_of_array(checksum_of_array(0, m, "element.node"), m, "node.position");
    snprintf(p->text[0], PART, "%dx%d", (int)s->view.size.columns, (int)s->view.size.rows);
    snprintf(p->text[1], PART, "%s", s->o.method ? "paper" : "spans");
    put_place(&s->placing.body, p->text[2]);
    put_checksum(!s->o.rigid, crc, p->text[3]);
    put_checksum(s->o.labels, s->labels_crc, p->text[4]);
    snprintf(p->text[5], PART, "0x%08" PRIx32 ",%.17g,%.17g", s->volume_crc, s->window.low, s->window.high);
    for (int i = 0; i < PARTS; i++)
        p->of[i] = (record_of){keys[i], p->text[i]};
}

/* ---- Beginning and ending */

static int open_record(live *l, err *e)
{
    const slice_options *o = &l->s->o;
    parts p = {0};
    if (!o->record)
        return 0;
    make_parts(l->s, &p);
    l->record = record_create(o->record, o->force, "us-slice", p.of, PARTS, e);
    if (l->record)
        slice_settings_record(l->s, l->record);
    return l->record ? 0 : -1;
}

static void say_poses(const slice_session *s)
{
    const char *from = s->o.poses;
    if (!from)
        tool_say(s->t, "poses: those of the frames");
    else
        tool_say(s->t, "poses: lines of %s; their frame is %s", strcmp(from, "-") != 0 ? from : "stdin",
                 s->o.body ? "that of the body, in which the volume lies as --body says" : "the volume's");
}

static int begin(live *l, err *e)
{
    l->lines = lines_open_named(l->s->o.poses, l->s->o.control, NULL, e);
    if (!l->lines || open_record(l, e))
        return -1;
    if (!l->s->o.rigid) {
        l->feed = slice_feed_open(&l->s->model, l->lines, e);
        if (!l->feed)
            return -1;
    }
    say_poses(l->s);
    live_clock_begin(&l->clock, isnan(l->s->o.rate) ? RATE : l->s->o.rate);
    return 0;
}

/* What was seen and dropped, in a line. */
static void say_counts(live *l)
{
    char clock[LIVE_CLOCK_TEXT], counts[LINES_TEXT], frames[80] = "";
    const lines_counts c = lines_count(l->lines);
    live_clock_text(&l->clock, clock);
    lines_text(&c, counts);
    if (l->feed) {
        const slice_feed_counts f = slice_feed_count(l->feed);
        snprintf(frames, sizeof frames, "; %" PRId64 " frames read, %" PRId64 " of them dropped", f.came, f.dropped);
    }
    tool_say(l->s->t, "live: %s; %s%s", clock, counts, frames);
}

static void end(live *l, int failed)
{
    notes *warnings = &l->s->warnings;
    if (l->lines)
        lines_tell(l->lines, warnings);
    record_close(l->record, failed ? NULL : warnings);
    tool_warn(l->s->t, warnings);
    if (!failed)
        say_counts(l);
    slice_feed_close(l->feed);
    lines_close(l->lines);
    frame_free(&l->frame);
}

/* ---- What comes */

static void take_controls(live *l)
{
    keyfile k;
    while (lines_take(l->lines, &k)) {
        err e = {0};
        if (slice_settings_take(l->s, &k, &e)) {
            lines_skip(l->lines, &e);
            continue;
        }
        record_control(l->record, &k);
        l->is_new = true;
    }
}

/* The newest pose that came. False: none waits. */
static bool take_newest(live *l)
{
    err e = {0};
    lines_pose newest;
    if (!lines_take_pose(l->lines, &newest))
        return l->has_next;
    if (!l->s->o.poses) {
        err_set(&e, newest.name, newest.line,
                "a pose among the controls, but images are from the poses of the frames; expected --poses");
        lines_skip_pose(l->lines, &e);
        return false;
    }
    if (l->has_next)
        lines_drop_pose(l->lines);
    l->next = newest;
    l->has_next = true;
    return true;
}

/* The newest pose; it waits where the image stays. */
static void take_pose(live *l)
{
    if (!take_newest(l) || l->s->frozen)
        return;
    l->from = placing_of(&l->s->placing, &l->next.at);
    l->has_pose = l->is_new = true;
    l->came = fmax(l->came, l->next.came);
    l->has_next = false;
}

/* The newest frame. Where the image stays, the feed keeps it. */
static int take_frame(live *l, err *e)
{
    double came;
    if (!l->feed || l->s->frozen || !slice_feed_take(l->feed, &l->frame, &came))
        return 0;
    l->has_frame = l->is_new = true;
    l->came = fmax(l->came, came);
    if (l->s->o.poses)
        return 0;
    l->has_pose = !slice_session_pose(l->s, &l->frame, &l->from, e);
    return l->has_pose ? 0 : -1;
}

static int take(live *l, err *e)
{
    take_controls(l);
    take_pose(l);
    lines_tell(l->lines, &l->s->warnings);
    const int failed = take_frame(l, e);
    tool_warn(l->s->t, &l->s->warnings);
    return failed;
}

/* ---- Images */

static void add_to_record(live *l, int64_t index)
{
    const record_frame f = {.index = index,
                            .time = live_clock_now(&l->clock),
                            .has_pose = true,
                            .at = l->from,
                            .steps = -1,
                            .of = l->has_frame ? l->frame.index : -1};
    record_add(l->record, &f, &l->s->warnings);
    tool_warn(l->s->t, &l->s->warnings);
}

/* An image of what is newest, once there is a pose to look from. */
static int show(live *l, err *e)
{
    const int64_t index = l->s->images;
    const double *u = NULL;
    if (!l->has_pose) {
        live_clock_pass(&l->clock);
        return 0;
    }
    if (l->has_frame && !(u = slice_session_displacement(l->s, &l->frame, e)))
        return -1;
    if (slice_session_put(l->s, index, &l->from, u, e))
        return -1;
    add_to_record(l, index);
    l->last = clock_now();
    live_clock_tick(&l->clock, 0);
    if (l->came > 0)
        live_clock_showed(&l->clock, l->came);
    l->is_new = false;
    l->came = 0;
    return 0;
}

/* Waits for what comes, or the next tick; and half an interval from the last image in any case. */
static void wait_for_more(const live *l)
{
    lines_wait(l->lines, l->clock.due);
    clock_sleep(fmin(l->last + .5 * l->clock.each - clock_now(), 1));
}

/* Whether what came by now is the last. A signal that ends a whole pipe also ends the stream, soon. */
static bool is_over(live *l)
{
    enum { GRACE = 1 }; /* s */
    if (stop_came() && l->feed)
        slice_feed_finish(l->feed, GRACE);
    return stop_came() || (l->feed ? slice_feed_ended(l->feed) : lines_ended(l->lines));
}

static int go_on(live *l, err *e)
{
    bool over;
    do {
        wait_for_more(l);
        over = is_over(l);
        if (take(l, e) || ((l->is_new || clock_now() >= l->clock.due) && show(l, e)))
            return -1;
    } while (!over);
    return l->feed && !stop_came() ? slice_feed_error(l->feed, e) : 0;
}

int slice_live_run(slice_session *s, err *e)
{
    live l = {.s = s};
    const int failed = begin(&l, e) || go_on(&l, e);
    end(&l, failed);
    return failed ? -1 : 0;
}

/* ---- Replay */

/* Reads on to the frame of this index; -1: the model at rest. -1 with e filled. */
static int seek(slice_session *s, int64_t of, err *e)
{
    source *m = &s->model;
    if (of < 0 && !m->frames)
        return 0;
    while (of >= 0 && (!m->frames || m->frame.index < of)) {
        const int got = source_next(m, e);
        if (got <= 0)
            return got < 0 ? -1
                           : err_set(e, source_name(m), 0, "ends before frame %" PRId64 ", which the record names", of);
    }
    return m->frame.index == of
               ? 0
               : err_set(e, source_name(m), 0, "has no frame %" PRId64 " where the record names it", of);
}

static int replay_image(slice_session *s, const keyfile *k, const record_frame *f, err *e)
{
    const double *u = NULL;
    if (!f->has_pose || (s->o.rigid && f->of >= 0))
        return keyfile_error(k, e, f->has_pose ? "of= without a model; expected none" : "a frame without pose=");
    if (!s->o.rigid && seek(s, f->of, e))
        return -1;
    if (f->of >= 0 && !(u = slice_session_displacement(s, &s->model.frame, e)))
        return -1;
    return slice_session_put(s, f->index, &f->at, u, e);
}

static int replay_all(slice_session *s, replay *r, err *e)
{
    replay_kind kind;
    record_frame f;
    keyfile k;
    int got;
    while ((got = replay_next(r, &kind, &k, &f, e)) > 0)
        if (kind == REPLAY_FRAME ? replay_image(s, &k, &f, e) : slice_settings_take(s, &k, e))
            return -1;
    if (!got && !replay_is_whole(r))
        notes_add(&s->warnings, "%s has no `end`: its run was cut off after image %" PRId64, s->o.replay,
                  s->images - 1);
    return got;
}

/* What the record does not name is read all the same, so that its writer can end. */
static int drain(slice_session *s, err *e)
{
    int got = 0;
    while (!s->o.rigid && (got = source_next(&s->model, e)) > 0)
        ;
    return got;
}

int slice_live_replay(slice_session *s, err *e)
{
    parts p = {0};
    make_parts(s, &p);
    replay *r = replay_open(s->o.replay, "us-slice", p.of, PARTS, e);
    const int failed = !r || replay_all(s, r, e) || drain(s, e);
    replay_close(r);
    return failed ? -1 : 0;
}
