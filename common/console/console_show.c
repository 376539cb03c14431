/* What comes from the tools, on its way to the pages: frames as text and positions, images, words. */
#include "console/console.h"

#include "base/clock.h"
#include "console/json.h"
#include "model/stream.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- words */

static bool begins(const char *text, const char *with)
{
    return !strncmp(text, with, strlen(with));
}

/* "TOOL: warning: text": its level and the text. */
static const char *level_of(const char *name, const char *line, const char **text)
{
    const size_t n = strlen(name);
    if (begins(line, name) && line[n] == ':' && line[n + 1] == ' ')
        line += n + 2;
    *text = begins(line, "warning: ") ? line + strlen("warning: ") : line;
    return *text == line ? "info" : "warning";
}

/* Where the console's lines come from says nothing to a person: "/dev/fd/3:12: text" is `text`. */
static void cut_place(char *line)
{
    static const char place[] = CHILD_CONTROL ":";
    char *at = strstr(line, place), *after = at ? at + strlen(place) : NULL;
    const size_t digits = after ? strspn(after, "0123456789") : 0;
    if (digits && !strncmp(after + digits, ": ", 2))
        memmove(at, after + digits + 2, strlen(after + digits + 2) + 1);
}

/* The device, where the line has it as a word: "cpu", "...; cpu, single precision", "cuda: NVIDIA ...". Under the
 * lock. */
static void note_device(console_shared *s, const char *text)
{
    static const char *const words[] = {"cpu", "cuda"};
    for (size_t i = 0; i < sizeof words / sizeof *words && !*s->device; i++) {
        const char *at = strstr(text, words[i]), *after = at ? at + strlen(words[i]) : "x";
        if (!at || (at > text && at[-1] != ' ') || (*after && !strchr(",;: ", *after)))
            continue;
        snprintf(s->device, sizeof s->device, "%.63s", at);
        s->device_is_new = true;
    }
}

void console_said(void *context, const char *name, const char *line)
{
    console *c = context;
    char own[CHILD_SAID];
    snprintf(own, sizeof own, "%s", line);
    cut_place(own);
    const char *text, *level = level_of(name, own, &text);
    pthread_mutex_lock(&c->shared.lock);
    snprintf(c->shared.said[!strcmp(name, "us-slice")], CONSOLE_LINE, "%.*s", CONSOLE_LINE - 1, text);
    if (strcmp(name, "us-slice") != 0)
        note_device(&c->shared, text);
    pthread_mutex_unlock(&c->shared.lock);
    tool_detail(c->t, "%s", own);
    web_send(c->web, -1, MAIL_SAID, json_said(level, name, text));
}

void console_heard(void *context, const char *name, const char *line)
{
    console *c = context;
    const char *text, *level = level_of(name, line, &text);
    notes warnings = {0};
    if (!strcmp(level, "warning"))
        notes_add(&warnings, "%s: %s", name, text);
    else
        tool_say(c->t, "%s: %s", name, text);
    tool_warn(c->t, &warnings);
    web_send(c->web, -1, MAIL_SAID, json_said(level, name, text));
}

void console_failed(void *context, const char *name, const err *e)
{
    console *c = context;
    if (!e->silent)
        web_send(c->web, -1, MAIL_SAID, json_said("error", name, e->text));
}

/* ---- frames */

void console_begin_showing(console *c)
{
    pthread_mutex_lock(&c->shared.lock);
    console_shared *s = &c->shared;
    s->next_pose = 0;
    memset(s->poses, 0, sizeof s->poses);
    memset(s->last_row, 0, sizeof s->last_row);
    s->lag = (double)NAN;
    s->began_wall = s->before_wall = 0;
    s->said[0][0] = s->said[1][0] = s->device[0] = s->save[0] = '\0';
    pthread_mutex_unlock(&c->shared.lock);
    atomic_store(&c->frames, 0);
    atomic_store(&c->time_bits, 0);
}

double console_time(void *context)
{
    console *c = context;
    const uint64_t bits = atomic_load(&c->time_bits);
    double time;
    memcpy(&time, &bits, sizeof time);
    return time;
}

static void set_time(console *c, double time)
{
    uint64_t bits;
    memcpy(&bits, &time, sizeof bits);
    atomic_store(&c->time_bits, bits);
}

static bool is_same(const double *a, const double *b)
{
    for (int i = 0; i < 7; i++)
        if (!(fabs(a[i] - b[i]) < 1e-9))
            return false;
    return true;
}

/* How long ago the pose of a frame was sent, when it shows it first. Under the lock. */
static void find_lag(console_shared *s, const double *row)
{
    if (is_same(row, s->last_row))
        return;
    memcpy(s->last_row, row, sizeof s->last_row);
    for (int i = 0; i < CONSOLE_POSES; i++)
        if (s->poses[i].sent > 0 && is_same(row, s->poses[i].row))
            s->lag = clock_now() - s->poses[i].sent;
}

/* Seconds of the model's to one of the wall's, over the last second or two. Under the lock. */
static double find_ratio(console_shared *s, double time)
{
    const double now = clock_now();
    if (!(s->began_wall > 0) || time < s->began_time) {
        s->began_wall = s->before_wall = now;
        s->began_time = s->before_time = time;
    }
    if (now - s->before_wall > 1) {
        s->began_wall = s->before_wall;
        s->began_time = s->before_time;
        s->before_wall = now;
        s->before_time = time;
    }
    return now - s->began_wall > .2 ? (time - s->began_time) / (now - s->began_wall) : (double)NAN;
}

static void put_rows(const frame *f, const char *key, const char *name, int columns, out *to)
{
    const model_array *a = frame_find(f, name);
    out_format(to, ",\"%s\":", key);
    if (a && a->rows == 1 && a->columns == columns && a->type == MODEL_F64)
        json_numbers(a->f64, columns, to);
    else
        out_text(to, "null");
}

static mail *frame_mail(console *c, const frame *f)
{
    err none = {0};
    const model_array *at = frame_find(f, "probe.pose");
    pthread_mutex_lock(&c->shared.lock);
    if (at && at->rows == 1)
        find_lag(&c->shared, at->f64);
    const double lag = c->shared.lag, ratio = find_ratio(&c->shared, f->time);
    pthread_mutex_unlock(&c->shared.lock);
    out *o = out_memory(&none);
    if (!o)
        return NULL;
    out_format(o, "{\"type\":\"frame\",\"index\":%" PRId64 ",\"time\":", f->index);
    json_number(f->time, o);
    put_rows(f, "force", "probe.force", 3, o);
    put_rows(f, "torque", "probe.torque", 3, o);
    put_rows(f, "pose", "probe.pose", 7, o);
    out_text(o, ",\"contacts\":null,\"lag\":");
    json_number(1000 * lag, o);
    out_text(o, ",\"ratio\":");
    json_number(ratio, o);
    out_text(o, "}");
    return json_mail(o, &none);
}

static int write_model(const model *m, const frame *f, const char *path, err *e)
{
    out *o = out_open(path, false, e);
    if (!o)
        return -1;
    model_writer *w = model_writer_open(o, false, e);
    const int failed = !w || model_write(w, m, e) || model_write_frame(w, f, e) || model_write_end(w, e);
    model_writer_close(w);
    return out_end(o, failed, e);
}

static void save_model(console *c, const model *m, const frame *f)
{
    char path[CONSOLE_FILE];
    err e = {0};
    pthread_mutex_lock(&c->shared.lock);
    memcpy(path, c->shared.save, sizeof path);
    c->shared.save[0] = '\0';
    pthread_mutex_unlock(&c->shared.lock);
    if (!*path)
        return;
    if (write_model(m, f, path, &e))
        web_send(c->web, -1, MAIL_SAID, json_said("error", NULL, e.text));
    else
        web_send(c->web, -1, MAIL_SAID, json_saved(strrchr(path, '/') + 1));
}

/* Where no page is open, pictures are made twice a second, for the one that comes next: the processors are the tools'.
 * since: s, by clock_now, when the last was made. */
static bool is_wanted(console *c, double *since)
{
    static const double seldom = .5; /* s */
    const double now = clock_now();
    if (!web_clients(c->web) && now - *since < seldom)
        return false;
    *since = now;
    return true;
}

static void show_positions(console *c, const frame *f, const double *u)
{
    static const double dear = .001, longest = .1; /* s: what may be made in vain, and a wait for a page that is busy */
    err e = {0};
    char name[SURFACE_NAME_MOST + 30];
    if (c->making > dear)
        web_wait(c->web, MAIL_POSITIONS, longest);
    const double began = clock_now();
    geometry_frame is = {.index = f->index, .rigid = f, .u = u};
    snprintf(name, sizeof name, "%s/vertex.displacement", c->around.skin);
    const model_array *skin = *c->around.skin ? frame_find(f, name) : NULL;
    if (skin && skin->type == MODEL_F64 && skin->rows == geometry_skin(c->scene))
        is.skin = skin->f64;
    colouring_fill((colouring)atomic_load(&c->colour), &c->colours, f, &is);
    mail *made = geometry_positions(c->scene, &is, &e);
    c->making += .2 * (clock_now() - began - c->making);
    web_send(c->web, -1, MAIL_POSITIONS, made);
}

void console_show(void *context, const model *m, const frame *f)
{
    console *c = context;
    const model_array *u = frame_find(f, "node.displacement");
    set_time(c, f->time);
    save_model(c, m, f);
    web_send(c->web, -1, MAIL_FRAME, frame_mail(c, f));
    if (u && u->type == MODEL_F64 && u->rows == model_count(&c->body.body, "node") && is_wanted(c, &c->drawn))
        show_positions(c, f, u->f64);
    atomic_fetch_add(&c->frames, 1);
}

bool console_wants_image(void *context)
{
    console *c = context;
    return is_wanted(c, &c->imaged);
}

bool console_wants_raw(void *context)
{
    console *c = context;
    return web_all_raw(c->web);
}

void console_show_image(void *context, mail *m)
{
    console *c = context;
    web_send(c->web, -1, MAIL_IMAGE, m);
}
