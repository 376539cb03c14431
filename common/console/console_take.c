/* What pages ask for. A wrong line goes back to the page that sent it. */
#include "console/console.h"

#include "base/clock.h"
#include "console/json.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static void answer(console *c, int client, const char *level, const char *text)
{
    web_send(c->web, client, MAIL_SAID, json_said(level, NULL, text));
}

static int need_case(const console *c, err *e)
{
    if (c->open < 0)
        return err_set(e, NULL, 0, "no case is open; expected open CASE first");
    return c->replaying ? err_set(e, NULL, 0, "a record is shown; expected reset before anything else") : 0;
}

static int need_ultrasound(const console *c, const char *what, err *e)
{
    if (need_case(c, e))
        return -1;
    return c->face ? err_set(e, NULL, 0, "%s is for ultrasound; the case is a face", what) : 0;
}

/* ---- poses */

static void note_pose(console *c, const pose *at)
{
    console_shared *s = &c->shared;
    pthread_mutex_lock(&s->lock);
    pose_to_row(at, s->poses[s->next_pose].row);
    s->poses[s->next_pose].sent = clock_now();
    s->next_pose = (s->next_pose + 1) % CONSOLE_POSES;
    pthread_mutex_unlock(&s->lock);
}

/* s since 1970, as OpenIGTLink has times. */
static double unix_time(void)
{
    struct timespec now = {0};
    clock_gettime(CLOCK_REALTIME, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void put_line(double time, const pose *at, char *line, size_t size)
{
    double row[7];
    pose_to_row(at, row);
    snprintf(line, size, "%.6f %.17g %.17g %.17g %.17g %.17g %.17g %.17g", time, row[0], row[1], row[2], row[3], row[4],
             row[5], row[6]);
}

int console_pose(console *c, const pose *at, err *e)
{
    char line[300];
    const pose told = around_pose(&c->around, at), in_body = around_to_body(&c->around, at);
    put_line(clock_now() - c->began, &told, line, sizeof line);
    note_pose(c, at);
    c->pose = *at;
    const int failed = child_tell(&c->compute, line, e);
    put_line(unix_time(), &in_body, line, sizeof line);
    return steering_tell(c->steering, line, e) || failed ? -1 : 0;
}

/* Where a page has put it, a 3D mouse goes on. */
static int pose_by_hand(console *c, const pose *at, err *e)
{
    const pose in_body = around_to_body(&c->around, at);
    c->waits = false;
    c->hand = clock_now();
    steering_place(c->steering, &in_body);
    return console_pose(c, at, e);
}

static int pose_by_other(console *c, err *e)
{
    const pose own = around_from_body(&c->around, &c->steered);
    c->waits = false;
    return console_pose(c, &own, e);
}

int console_begin_pose(console *c, const pose *at, err *e)
{
    const bool has_places = steering_has_places(c->steering);
    c->by_hand = !c->has_steered || !has_places;
    const int failed = c->by_hand ? pose_by_hand(c, at, e) : pose_by_other(c, e);
    if (has_places)
        c->hand = -(double)INFINITY; /* which has not moved it yet */
    return failed;
}

/* Pages show whose hand it is in. */
static void note_hand(console *c, bool by_hand)
{
    const bool is_new = c->by_hand != by_hand;
    c->by_hand = by_hand;
    if (is_new)
        console_send_state(c);
}

static int take_pose(console *c, const pose *at, err *e)
{
    if (need_ultrasound(c, "pose", e))
        return -1;
    const int failed = pose_by_hand(c, at, e);
    note_hand(c, true);
    return failed;
}

/* A hand that drags has the probe until it has been still for a second: then the newest pose counts that came since its
 * last one. A 3D mouse goes on from where the hand is: of it only what was on its way then is too old. */
int console_steer(console *c, err *e)
{
    static const double second = 1, old = .1;
    const bool has_places = steering_has_places(c->steering);
    if (!c->waits || clock_now() < c->hand + (has_places ? second : old))
        return 0;
    const int failed = pose_by_other(c, e);
    note_hand(c, false);
    return failed;
}

static int take_steered(console *c, const pose *at, err *e)
{
    c->steered = *at;
    c->has_steered = true;
    c->waits = c->open >= 0 && !c->face && !c->replaying;
    const int failed = console_steer(c, e);
    c->waits = c->waits && steering_has_places(c->steering);
    return failed;
}

void console_steered(void *context, const pose *at)
{
    const console *c = context;
    message m = {.kind = MESSAGE_POSE, .at = *at};
    inbox_put(c->inbox, CONSOLE_STEERING, &m);
}

/* ---- lines for tools */

static bool begins(const char *text, const char *with)
{
    return !strncmp(text, with, strlen(with));
}

/* "now contract MUSCLE LEVEL" */
static void note_contraction(console *c, const char *line)
{
    char name[CONSOLE_WORD];
    const char *is;
    double level;
    if (sscanf(line, "now contract %63s %lf", name, &level) != 2)
        return;
    for (int64_t i = 0; (is = console_muscle(c, i)); i++)
        if (!strcmp(is, name))
            c->level[i] = level;
}

static int find_pull(const console *c, const char *id)
{
    for (int i = 0; i < c->pull_count; i++)
        if (!strcmp(c->pulls[i].id, id))
            return i;
    return -1;
}

static void note_release(console *c, const char *id)
{
    const int i = find_pull(c, id);
    if (i >= 0)
        c->pulls[i] = c->pulls[--c->pull_count];
}

static int note_pull(console *c, const char *line, err *e)
{
    char id[CONSOLE_WORD];
    if (sscanf(line, "pull %63s", id) != 1 || strlen(line) >= CONSOLE_LINE)
        return err_set(e, NULL, 0, "a line of %zu bytes; expected fewer than %d", strlen(line), CONSOLE_LINE);
    int i = find_pull(c, id);
    if (i < 0 && c->pull_count == CONSOLE_PULLS)
        return err_set(e, NULL, 0, "%d points are pulled already; expected release ID first", CONSOLE_PULLS);
    if (i < 0)
        i = c->pull_count++;
    snprintf(c->pulls[i].id, sizeof c->pulls[i].id, "%s", id);
    snprintf(c->pulls[i].line, sizeof c->pulls[i].line, "%.*s", CONSOLE_LINE - 1, line);
    return 0;
}

/* The probe of the image is that which presses, where it has an array. */
static int follow_probe(console *c, const char *line, err *e)
{
    const bool array = begins(line, "set probe linear:") || begins(line, "set probe curved:");
    return array ? child_tell(&c->slice, line, e) : 0;
}

static int take_line(console *c, const char *line, err *e)
{
    const bool for_face = begins(line, "now ") || begins(line, "pull ") || begins(line, "release ");
    if (need_case(c, e))
        return -1;
    if (for_face != c->face)
        return err_set(e, NULL, 0, "'%.60s' is for a %s", line, for_face ? "face" : "case of ultrasound");
    if (begins(line, "pull ") && note_pull(c, line, e))
        return -1;
    if (begins(line, "release "))
        note_release(c, line + strlen("release "));
    if (begins(line, "method "))
        snprintf(c->method, sizeof c->method, "%.63s", line + strlen("method "));
    note_contraction(c, line);
    dials_note(&c->dials, line);
    return child_tell(&c->compute, line, e) || follow_probe(c, line, e) ? -1 : 0;
}

static int take_image(console *c, const char *line, err *e)
{
    if (need_ultrasound(c, "image", e))
        return -1;
    dials_note(&c->knobs, line);
    return child_tell(&c->slice, line, e);
}

static int take_colour(console *c, const char *name, err *e)
{
    char words[COLOURING_WORDS];
    const int is = colouring_find(name);
    if (need_case(c, e))
        return -1;
    if (is < 0) {
        colouring_words(words);
        return err_set(e, NULL, 0, "colour '%.60s'; expected one of %s", name, words);
    }
    atomic_store(&c->colour, is);
    return 0;
}

/* ---- time */

static void pause_tools(console *c, bool on)
{
    if (c->has_compute)
        child_pause(&c->compute, on);
    if (c->has_slice)
        child_pause(&c->slice, on);
}

static int take_pause(console *c, bool on, err *e)
{
    if (need_case(c, e))
        return -1;
    c->paused = on;
    pause_tools(c, on);
    return 0;
}

/* Lets the tools go on until a frame was shown. */
static int take_step(console *c, err *e)
{
    if (need_case(c, e))
        return -1;
    if (!c->paused)
        return err_set(e, NULL, 0, "step: the case is not paused; expected pause on first");
    const long long before = atomic_load(&c->frames);
    const double until = clock_now() + 2;
    pause_tools(c, false);
    while (atomic_load(&c->frames) == before && clock_now() < until)
        clock_sleep(.002);
    pause_tools(c, true);
    return 0;
}

static int take_reset(console *c, err *e)
{
    return c->open < 0 ? need_case(c, e) : console_open(c, c->open, false, e);
}

static int take_open(console *c, const char *name, err *e)
{
    const int i = cases_find(&c->cases, name);
    return i < 0 ? err_set(e, NULL, 0, "there is no case '%.100s'", name) : console_open(c, i, false, e);
}

/* ---- records */

/* A record is of a whole run, so the case begins anew. */
static int take_record(console *c, int client, bool on, err *e)
{
    if (!c->record)
        return err_set(e, NULL, 0, "record: there is no folder for records; expected sinew console --record FOLDER");
    if (c->recording == on)
        return 0;
    c->recording = on;
    answer(c, client, "info", on ? "recording: the case begins anew" : "recording has ended: the case begins anew");
    return c->open >= 0 ? console_open(c, c->open, false, e) : 0;
}

static int take_replay(console *c, err *e)
{
    if (c->open < 0)
        return need_case(c, e);
    if (!*c->records[0])
        return err_set(e, NULL, 0, "replay: nothing was recorded; expected record on first");
    return console_open(c, c->open, true, e);
}

/* ---- saving */

const char *console_folder(console *c, err *e)
{
    const char *temporary = getenv("TMPDIR");
    if (c->record)
        return c->record;
    if (*c->kept)
        return c->kept;
    snprintf(c->kept, sizeof c->kept, "%.3000s/sinew-console-XXXXXX", temporary && *temporary ? temporary : "/tmp");
    if (mkdtemp(c->kept))
        return c->kept;
    err_system(e, c->kept, errno, "cannot make a folder");
    c->kept[0] = '\0';
    return NULL;
}

void console_remove_folder(console *c)
{
    char path[CONSOLE_FILE + 300];
    DIR *folder = *c->kept ? opendir(c->kept) : NULL;
    struct dirent *one;
    if (!folder)
        return;
    while ((one = readdir(folder))) {
        snprintf(path, sizeof path, "%s/%s", c->kept, one->d_name);
        if (one->d_name[0] != '.')
            unlink(path);
    }
    closedir(folder);
    rmdir(c->kept);
}

/* A name that is free: image-1.png, model-2.sinew. */
static int name_save(console *c, const char *what, char path[CONSOLE_FILE], err *e)
{
    const char *folder = console_folder(c, e);
    if (!folder)
        return -1;
    do
        snprintf(path, CONSOLE_FILE, "%.4000s/%.10s-%d%s", folder, what, ++c->saves,
                 strcmp(what, "image") ? ".sinew" : ".png");
    while (!access(path, F_OK));
    return 0;
}

static int take_save(console *c, int client, const char *what, err *e)
{
    char path[CONSOLE_FILE];
    const bool image = !strcmp(what, "image");
    if ((image ? need_ultrasound(c, "save image", e) : need_case(c, e)) || name_save(c, what, path, e))
        return -1;
    if (image) {
        if (images_save(c->images, path, e))
            return -1;
        web_send(c->web, client, MAIL_SAID, json_saved(strrchr(path, '/') + 1));
        return 0;
    }
    pthread_mutex_lock(&c->shared.lock);
    memcpy(c->shared.save, path, sizeof path);
    pthread_mutex_unlock(&c->shared.lock);
    return 0;
}

/* What stands behind "case/NAME/picture.png" and "save/NAME": names that are in the list, or that were made here. By
 * civetweb's threads: cases and the folder's name stay as they are. */
int console_file(void *context, const char *uri, char path[WEB_PATH])
{
    const console *c = context;
    const char *name = strchr(uri, '/') + 1, *end = strrchr(uri, '/');
    char is[300];
    if (begins(uri, "case/") && end > name && !strcmp(end, "/picture.png")) {
        snprintf(is, sizeof is, "%.*s", (int)(end - name), name);
        const int i = cases_find(&c->cases, is);
        if (i < 0 || !c->cases.list[i].picture)
            return -1;
        return snprintf(path, WEB_PATH, "%s", c->cases.list[i].picture) < WEB_PATH ? 0 : -1;
    }
    const char *folder = c->record ? c->record : c->kept;
    if (!begins(uri, "save/") || end > name || !*folder || (!begins(name, "image-") && !begins(name, "model-")))
        return -1;
    return snprintf(path, WEB_PATH, "%s/%s", folder, name) < WEB_PATH ? 0 : -1;
}

/* ---- all */

static int take(console *c, int client, const message *m, err *e)
{
    switch (m->kind) {
    case MESSAGE_OPEN:
        return take_open(c, m->line, e);
    case MESSAGE_POSE:
        return client == CONSOLE_STEERING ? take_steered(c, &m->at, e) : take_pose(c, &m->at, e);
    case MESSAGE_TOOL:
        return take_line(c, m->line, e);
    case MESSAGE_IMAGE:
        return take_image(c, m->line, e);
    case MESSAGE_COLOUR:
        return take_colour(c, m->line, e);
    case MESSAGE_PAUSE:
        return take_pause(c, m->on, e);
    case MESSAGE_STEP:
        return take_step(c, e);
    case MESSAGE_RESET:
        return take_reset(c, e);
    case MESSAGE_RECORD:
        return take_record(c, client, m->on, e);
    case MESSAGE_SAVE:
        return take_save(c, client, m->line, e);
    default:
        return take_replay(c, e);
    }
}

void console_take(console *c, int client, const message *m)
{
    err e = {0};
    if (take(c, client, m, &e))
        answer(c, client == CONSOLE_STEERING ? -1 : client, "error", e.text);
    if (m->kind != MESSAGE_POSE && m->kind != MESSAGE_STEP && m->kind != MESSAGE_SAVE)
        console_send_state(c);
}
