#include "link/track/track.h"

#include "base/chars.h"
#include "base/clock.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define CHOICE 1.0 /* s after the first pose of any name: what there is has come by then */
#define HELD   1.0 /* s without a message of its holder, after which another may be heard */
#define ASK    2.0 /* s without the pose that is meant, before what there is is told */

void track_warn(const tool *t, const char *format, ...)
{
    char text[sizeof((err *)NULL)->text + 200];
    notes warnings = {0};
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    notes_add(&warnings, "%s", text);
    tool_warn(t, &warnings);
}

/* ---- what is told once */

static bool is_new(track *k, const char *form)
{
    for (int i = 0; i < k->tolds; i++)
        if (k->told[i] == form)
            return false;
    if (k->tolds == TRACK_TOLD)
        return false;
    k->told[k->tolds++] = form;
    return true;
}

void track_skip(track *k, err *e)
{
    k->counts.skipped++;
    k->counts.checksums += strstr(e->form, "checksum") != NULL;
    if (is_new(k, e->form))
        track_warn(k->t, "%s; the message is skipped, and others like it are", e->text);
    *e = (err){0};
}

/* ---- who is heard */

static bool is_chosen(const track *k, const track_pose *p)
{
    return k->plan->transform ? track_pose_is(p, k->plan->transform) : !strcmp(k->chosen, p->name);
}

static bool is_heard(track *k, const track_peer *from, const track_pose *p, double now)
{
    static const char form[] = "another sender";
    if (k->holder == from && k->kind == p->kind)
        return true;
    if (k->holder && now - k->heard <= HELD) {
        k->counts.other++;
        if (k->holder != from && is_new(k, form))
            track_warn(k->t, "%s: sends %s too; it is left out while %s does", from->place, p->name, k->holder->place);
        return false;
    }
    k->holder = from;
    k->kind = p->kind;
    return true;
}

void track_forget(track *k, const track_peer *gone)
{
    if (k->holder == gone)
        k->holder = NULL;
}

/* ---- whether it is tracked */

static void lose(track *k, const char *name, const char *why, double now)
{
    if (k->state == TRACK_LOST)
        return;
    const bool had = k->state == TRACK_FOUND;
    k->since = had ? k->since : now;
    k->state = TRACK_LOST;
    track_warn(k->t, "%s: %s; %s", name, why, had ? "the last pose stays" : "there was none yet");
}

static void find(track *k, const char *name, double now)
{
    if (k->state == TRACK_LOST)
        track_warn(k->t, "%s: tracked again after %.1f s", name, now - k->since);
    k->state = TRACK_FOUND;
    k->since = now;
}

/* ---- poses */

static bool keep_time(track *k, const track_pose *p, double now, double *time)
{
    static const char late[] = "late", back[] = "a jump";
    double jump;
    switch (track_time_of(&k->time, p->stamp, now, time, &jump)) {
    case TRACK_LATE:
        k->counts.late++;
        if (is_new(k, late))
            track_warn(k->t,
                       "%s: a time stamp is %.3g s before the last one; its pose is skipped, and others like it are",
                       p->name, -jump);
        return false;
    case TRACK_JUMP:
        k->counts.jumps++;
        if (is_new(k, back))
            track_warn(k->t, "%s: time stamps jump by %.6g s; lines go on by the clock of this machine, here and later",
                       p->name, jump);
        return true;
    case TRACK_ON_TIME:
        break;
    }
    return true;
}

/* Its matrix is no pose, for the reason in e. */
static void refuse(track *k, const track_pose *p, err *e)
{
    k->counts.skipped++;
    if (is_new(k, e->form))
        track_warn(k->t, "%s: %s; the pose is skipped, and others like it are", p->name, e->text);
    *e = (err){0};
}

static int take_chosen(track *k, const track_pose *p, double now, err *e)
{
    pose at;
    double time;
    k->heard = now;
    if (p->lost[0]) {
        char why[80];
        snprintf(why, sizeof why, "not tracked: %s", p->lost);
        k->counts.untracked++;
        lose(k, p->name, why, now);
        return 0;
    }
    if (space_pose_of_matrix(p->matrix, k->plan->in, &at, e)) {
        refuse(k, p, e);
        return 0;
    }
    find(k, p->name, now);
    return keep_time(k, p, now, &time) ? track_lines_put(&k->lines, time, &at, e) : 0;
}

/* Poses are chosen among those that came in the first second, or at once where nothing better can come. */
static int choose(track *k, double now, err *e)
{
    char list[TRACK_LIST];
    if (k->chosen[0] || k->plan->transform || !k->names.poses)
        return 0;
    const char *name = track_names_choose(&k->names);
    if (now - k->began < CHOICE && !(name && track_names_is_first(name)))
        return 0;
    track_names_list(&k->names, list);
    if (!name)
        return err_option(e, NULL, "several poses are sent: %s; expected --transform NAME", list);
    snprintf(k->chosen, sizeof k->chosen, "%s", name);
    if (k->names.poses > 1)
        tool_say(k->t, "%s is taken, of: %s", name, list);
    else
        tool_say(k->t, "%s is taken", name);
    return 0;
}

/* *taken: one of the message is heard already, of tools with one name. */
static int take_pose(track *k, track_peer *from, const igtl_message *m, int i, double now, bool *taken, err *e)
{
    static const char *const type[TRACK_KINDS] = {"TRANSFORM", "POSITION", "TDATA"};
    track_pose p;
    if (track_pose_read(m, i, &p, from->place, e)) {
        track_skip(k, e);
        return 0;
    }
    k->began = k->names.poses ? k->began : now;
    if (track_names_add(&k->names, type[p.kind], p.name, true, now))
        tool_detail(k->t, "%s: sends %s '%s'", from->place, type[p.kind], p.name);
    if (k->plan->only_names)
        return 0;
    if (choose(k, now, e))
        return -1;
    if (*taken || !is_chosen(k, &p) || !is_heard(k, from, &p, now))
        return 0;
    *taken = true;
    track_pose_status(m, &p);
    return take_chosen(k, &p, now, e);
}

static int take_poses(track *k, track_peer *from, const igtl_message *m, double now, err *e)
{
    int count;
    bool taken = false;
    if (track_pose_count(m, &count, from->place, e)) {
        track_skip(k, e);
        return 0;
    }
    for (int i = 0; i < count; i++)
        if (take_pose(k, from, m, i, now, &taken, e))
            return -1;
    return 0;
}

/* ---- what senders say */

static int take_status(track *k, track_peer *from, const igtl_message *m, err *e)
{
    igtl_status s;
    char said[TRACK_STATUS];
    if (igtl_read_status(m, &s, from->place, e))
        return -1;
    const char *comma = s.name[0] ? ", " : "", *colon = s.text_size ? ": " : "";
    const int size = (int)(s.text_size < 150 ? s.text_size : 150);
    snprintf(said, sizeof said, "%d (%s)%s%s%s%.*s", s.code, igtl_status_text(s.code), comma, s.name, colon, size,
             s.text);
    if (s.code == from->status && !strcmp(said, from->said))
        return 0;
    if (s.code != IGTL_OK || from->status != IGTL_OK)
        track_warn(k->t, "%s: status %s", from->place, said);
    else
        tool_detail(k->t, "%s: status %s", from->place, said);
    from->status = s.code;
    memcpy(from->said, said, sizeof said);
    return 0;
}

static int take_string(track *k, const track_peer *from, const igtl_message *m, err *e)
{
    const char *text;
    size_t size;
    if (igtl_read_string(m, &text, &size, from->place, e))
        return -1;
    tool_detail(k->t, "%s: '%s' says: %.*s", from->place, m->header.device, (int)(size < 1000 ? size : 1000), text);
    return 0;
}

static int take_answer(track *k, const track_peer *from, const igtl_message *m, err *e)
{
    int status;
    if (igtl_read_answer(m, &status, from->place, e))
        return -1;
    if (status)
        track_warn(k->t, "%s: refuses to send TDATA (RTS_TDATA says error %d); poses may come by TRANSFORM or POSITION",
                   from->place, status);
    else
        tool_detail(k->t, "%s: will send TDATA", from->place);
    return 0;
}

bool track_wants(void *context, const igtl_header *h)
{
    track *k = context;
    char name[IGTL_DEVICE + 1];
    if (track_kind_of(h) != TRACK_KINDS)
        return true;
    memcpy(name, h->device, sizeof name);
    chars_tame(name);
    if (track_names_add(&k->names, h->type, name, false, clock_now()))
        tool_detail(k->t, "%s '%s' comes", h->type, name);
    return !strcmp(h->type, "STATUS") || !strcmp(h->type, "STRING") || !strcmp(h->type, "RTS_TDATA");
}

int track_take(track *k, track_peer *from, const igtl_message *m, double now, err *e)
{
    const char *type = m->header.type;
    int failed;
    from->has_spoken = true;
    if (track_kind_of(&m->header) != TRACK_KINDS)
        return take_poses(k, from, m, now, e);
    if (!strcmp(type, "STATUS"))
        failed = take_status(k, from, m, e);
    else if (!strcmp(type, "STRING"))
        failed = take_string(k, from, m, e);
    else
        failed = take_answer(k, from, m, e);
    if (failed)
        track_skip(k, e);
    return 0;
}

/* ---- what time brings */

/* The pose that is meant has not come: says what has. */
static void tell_names(track *k, double now)
{
    char list[TRACK_LIST];
    if (!k->plan->transform || k->state != TRACK_WAITING || k->names.poses <= k->listed || now - k->asked < ASK)
        return;
    track_names_list(&k->names, list);
    track_warn(k->t, "no '%s' has come; there are: %s", k->plan->transform, list);
    k->listed = k->names.poses;
    k->asked = now;
}

int track_pass(track *k, double now, bool connected, err *e)
{
    const char *name = k->plan->transform ? k->plan->transform : k->chosen;
    char why[80];
    if (k->plan->only_names)
        return 0;
    if (choose(k, now, e) || track_lines_flush(&k->lines, e))
        return -1;
    if (!connected)
        k->heard = now; /* that is told by itself */
    if (k->names.poses && k->asked <= 0)
        k->asked = k->began;
    tell_names(k, now);
    if (connected && k->state == TRACK_FOUND && k->plan->timeout > 0 && now - k->heard > k->plan->timeout) {
        snprintf(why, sizeof why, "no pose for %.1f s", now - k->heard);
        lose(k, name, why, now);
    }
    return 0;
}

void track_text(const track *k, char text[TRACK_TEXT])
{
    const track_counts *c = &k->counts;
    int n = snprintf(text, TRACK_TEXT, "%" PRId64 " pose%s", k->lines.written, k->lines.written == 1 ? "" : "s");
    const struct {
        int64_t count;
        const char *what;
    } more[] = {{k->lines.dropped, "dropped, as their reader was slow"},
                {c->untracked, "not tracked"},
                {c->late, "late and skipped"},
                {c->jumps, "jumps of time stamps"},
                {c->other, "of other senders, left out"},
                {c->skipped, "wrong messages skipped"},
                {c->checksums, "of these for their checksums"}};
    for (size_t i = 0; i < sizeof more / sizeof *more; i++)
        if (more[i].count)
            n += snprintf(text + n, TRACK_TEXT - (size_t)n, "; %" PRId64 " %s", more[i].count, more[i].what);
}
