#define _GNU_SOURCE
#include "live/lines.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/thread.h"
#include "live/kinds.h"
#include "live/spnav.h"
#include "live/stop.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <linux/magic.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

enum {
    KEPT = 4096,                /* controls that wait: then their writer does */
    ROOM = KEYFILE_LINE + 4096, /* bytes of a source that are looked at */
    ROUND = 256 /* controls that are taken before a frame: a writer that never stops does not stop frames */
};

typedef struct control {
    char *text; /* owned */
    const struct source *from;
    int64_t line;
} control;

typedef struct source {
    lines *all;
    char *name;   /* owned */
    in *before;   /* what was read of it already, or NULL; borrowed */
    spnav *mouse; /* a 3D mouse, which is all that it is then; owned */
    int fd;
    bool is_owned; /* the descriptor */
    bool waits;    /* for another writer, at the end */
    dev_t device;  /* which file it is */
    ino_t inode;
    bool is_long; /* the line that is being read: its beginning is gone */
    int64_t line; /* lines read */
    double last;  /* s: of the pose before */
    char *text;   /* ROOM + 1, owned */
    size_t filled;
    pthread_t thread;
    bool started;
} source;

struct lines {
    pthread_mutex_t lock; /* for all that follows but the sources, which are their threads' */
    pthread_cond_t came, taken;
    source source[LINES_SOURCES];
    int sources, running;
    int stop[2]; /* a pipe: closed to end the threads */
    bool has_pose, ends, woken;
    bool over; /* standard input has ended */
    lines_pose pose;
    pose placed;        /* the newest pose that is no 3D mouse's, which goes on from there */
    bool has_placed;    /* it was not taken by one */
    control list[KEPT]; /* a ring */
    int64_t first, count;
    int round;     /* controls that were taken since lines_take() had none */
    char *current; /* of the control that was taken last; owned */
    lines_counts counts;
    kinds kinds;
};

/* ---- What a thread does */

/* With the lock. what: "line", or "event". */
static void skip(lines *l, const err *e, const char *what)
{
    l->counts.skipped++;
    kinds_add(&l->kinds, e, what);
}

static bool is_name(const char *word)
{
    return isalpha((unsigned char)*word) && strcasecmp(word, "nan") && strncasecmp(word, "inf", 3);
}

static bool is_pose(const keyfile *k)
{
    return k->count == 8 || (!is_name(k->word[0]) && (k->count == 1 || !is_name(k->word[1])));
}

/* With the lock. */
static void place(lines *l, const pose *at)
{
    l->placed = *at;
    l->has_placed = true;
}

static void put_pose(void *context, double time, const pose *at, int64_t line)
{
    const source *s = context;
    lines *l = s->all;
    pthread_mutex_lock(&l->lock);
    l->counts.poses++;
    l->counts.stale += l->has_pose;
    l->has_pose = true;
    l->pose = (lines_pose){time, *at, clock_now(), s->name, line};
    if (!s->mouse)
        place(l, at);
    pthread_cond_signal(&l->came);
    pthread_mutex_unlock(&l->lock);
}

static int take_pose(source *s, const keyfile *k, err *e)
{
    poses_event at;
    if (poses_take(k, &at, e))
        return -1;
    const double last = s->last;
    s->last = at.time; /* also of a line that is skipped: a tracker that begins anew loses one */
    if (at.time < last)
        return keyfile_error(k, e, "time %.9g comes after %.9g; expected times that do not decrease", at.time, last);
    put_pose(s, at.time, &at.at, s->line);
    return 0;
}

/* text: owned by the list from here on. Where the list is full, its writer waits. */
static void put_control(source *s, char *text, int64_t line)
{
    lines *l = s->all;
    pthread_mutex_lock(&l->lock);
    while (l->count == KEPT && !l->ends)
        pthread_cond_wait(&l->taken, &l->lock);
    if (l->count == KEPT) {
        free(text);
    } else {
        l->list[(l->first + l->count++) % KEPT] = (control){text, s, line};
        pthread_cond_signal(&l->came);
    }
    pthread_mutex_unlock(&l->lock);
}

static int take_line(source *s, char *text, size_t length, err *e)
{
    keyfile k = {.name = s->name};
    if (strlen(text) != length)
        return err_set(e, s->name, s->line, "a zero byte; expected a line of text");
    char *copy = mem_text(text, e);
    const int got = copy ? keyfile_take(&k, text, (int64_t)length, s->line, e) : -1;
    if (got > 0 && !is_pose(&k)) {
        put_control(s, copy, s->line);
        return 0;
    }
    free(copy);
    return got > 0 ? take_pose(s, &k, e) : got;
}

static void skip_line(void *context, const err *e)
{
    const source *s = context;
    pthread_mutex_lock(&s->all->lock);
    skip(s->all, e, s->mouse ? "event" : "line");
    pthread_mutex_unlock(&s->all->lock);
}

static void end_line(source *s, char *text, size_t length)
{
    err e = {0};
    s->line++;
    if (length && text[length - 1] == '\r')
        text[--length] = '\0';
    if (s->is_long)
        s->is_long = false;
    else if (take_line(s, text, length, &e))
        skip_line(s, &e);
}

/* The lines that are whole in what was read; what is left of it moves to the front. */
static void cut_lines(source *s)
{
    char *at = s->text, *end;
    s->text[s->filled] = '\0';
    while ((end = memchr(at, '\n', s->filled - (size_t)(at - s->text)))) {
        *end = '\0';
        end_line(s, at, (size_t)(end - at));
        at = end + 1;
    }
    s->filled -= (size_t)(at - s->text);
    memmove(s->text, at, s->filled);
    if (s->filled < ROOM)
        return;
    err e = {0};
    err_set(&e, s->name, s->line + 1, "a line of more than %d bytes", KEYFILE_LINE);
    if (!s->is_long)
        skip_line(s, &e);
    s->is_long = true;
    s->filled = 0;
}

/* A writer went away: what it left of a line is no line. */
static void end_writer(source *s)
{
    err e = {0};
    err_set(&e, s->name, s->line + 1, "the line is cut: its writer went away");
    if (s->filled && !s->is_long)
        skip_line(s, &e);
    s->filled = 0;
    s->is_long = false;
    s->last = -(double)INFINITY;
}

/* Opens a FIFO for its next writer. */
static int open_again(source *s)
{
    const int fd = open(s->name, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    struct stat is;
    if (fd < 0)
        return -1;
    if (fstat(fd, &is) || !S_ISFIFO(is.st_mode)) { /* its name is another file's now, which would be read for ever */
        close(fd);
        return -1;
    }
    close(s->fd);
    s->fd = fd;
    pthread_mutex_lock(&s->all->lock);
    s->all->counts.writers++;
    pthread_mutex_unlock(&s->all->lock);
    return 0;
}

/* Waits until there is something to read. False: the thread is to end. */
static bool wait_for_bytes(const source *s)
{
    struct pollfd list[2] = {{.fd = s->fd, .events = POLLIN}, {.fd = s->all->stop[0], .events = POLLIN}};
    while (poll(list, 2, -1) < 0)
        if (errno != EINTR && errno != EAGAIN)
            return false;
    return !list[1].revents;
}

/* Reads on. False: the source has ended. */
static bool read_more(source *s)
{
    const ssize_t n = read(s->fd, s->text + s->filled, ROOM - s->filled);
    if (n < 0)
        return errno == EINTR || errno == EAGAIN;
    if (n > 0) {
        s->filled += (size_t)n;
        cut_lines(s);
        return true;
    }
    end_writer(s);
    return s->waits && !open_again(s);
}

/* Lines that the reader of the model, before them on standard input, has read already. */
static void take_rest(source *s)
{
    size_t n;
    while (s->before && (n = in_rest(s->before, s->text + s->filled, ROOM - s->filled)) > 0) {
        s->filled += n;
        cut_lines(s);
    }
}

static void mouse_said(void *context, const char *text, bool went)
{
    const source *s = context;
    pthread_mutex_lock(&s->all->lock);
    s->all->counts.writers += went;
    notes_add(&s->all->kinds.told, "%s", text);
    pthread_cond_signal(&s->all->came);
    pthread_mutex_unlock(&s->all->lock);
}

static bool mouse_placed(void *context, pose *at)
{
    lines *l = ((source *)context)->all;
    pthread_mutex_lock(&l->lock);
    const bool is = l->has_placed;
    *at = l->placed;
    l->has_placed = false;
    pthread_mutex_unlock(&l->lock);
    return is;
}

static void *read_source(void *context)
{
    source *s = context;
    if (s->mouse)
        spnav_run(s->mouse, s->all->stop[0], &(spnav_to){s, put_pose, skip_line, mouse_said, mouse_placed});
    take_rest(s);
    while (!s->mouse && wait_for_bytes(s) && read_more(s))
        ;
    pthread_mutex_lock(&s->all->lock);
    s->all->over = s->all->over || !s->is_owned;
    pthread_mutex_unlock(&s->all->lock);
    lines_leave(s->all);
    return NULL;
}

/* ---- Opening and closing */

/* Whether it is a FIFO that a second writer can open by its name. */
static bool has_name(int fd, const struct stat *is)
{
    struct statfs where;
    return S_ISFIFO(is->st_mode) && !fstatfs(fd, &where) && where.f_type != PIPEFS_MAGIC;
}

/* The source before that reads the same pipe, of which each would get a part, or NULL. */
static const source *find_same(const source *s)
{
    for (const source *other = s->all->source; other < s; other++)
        if (other->device == s->device && other->inode == s->inode)
            return other;
    return NULL;
}

static int check_kind(source *s, const struct stat *is, err *e)
{
    s->device = is->st_dev;
    s->inode = is->st_ino;
    const source *same = S_ISFIFO(is->st_mode) ? find_same(s) : NULL;
    if (same)
        return err_set(e, s->name, 0, "is the same pipe as %.200s; expected it once, for lines of all kinds",
                       same->name);
    if (S_ISREG(is->st_mode) || S_ISDIR(is->st_mode))
        return err_set(e, s->name, 0, "is a %s; expected a FIFO or a pipe, as --live takes lines when they come",
                       S_ISREG(is->st_mode) ? "regular file" : "folder");
    return 0;
}

static int open_source(lines *l, const char *path, in *before, err *e)
{
    source *s = &l->source[l->sources++];
    const bool is_standard = !strcmp(path, "-");
    struct stat is;
    *s = (source){.all = l, .fd = -1, .last = -(double)INFINITY};
    s->name = mem_text(is_standard ? "stdin" : path, e);
    s->text = mem_array(ROOM + 1, 1, "lines", e);
    if (!s->name || !s->text)
        return -1;
    s->is_owned = !is_standard;
    if (spnav_is(path))
        return (s->mouse = spnav_open(s->name, e)) ? 0 : -1;
    s->fd = is_standard ? STDIN_FILENO : open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (s->fd < 0 || fstat(s->fd, &is))
        return err_system(e, path, errno, "cannot open");
    if (check_kind(s, &is, e))
        return -1;
    s->waits = !is_standard && has_name(s->fd, &is);
    s->before = is_standard ? before : NULL;
    if (s->before && in_is_gzip(before))
        return err_set(e, s->name, 0, "is compressed; expected lines after a model that is not");
    return 0;
}

static int start_threads(lines *l, err *e)
{
    for (int i = 0; i < l->sources; i++) {
        source *s = &l->source[i];
        lines_join(l);
        const int code = thread_start(&s->thread, read_source, s);
        if (code)
            return err_system(e, s->name, code, "cannot start a thread");
        s->started = true;
    }
    return 0;
}

static int make_locks(lines *l)
{
    int code = pthread_mutex_init(&l->lock, NULL);
    code = code ? code : thread_condition(&l->came);
    return code ? code : pthread_cond_init(&l->taken, NULL);
}

lines *lines_open(const char *const *path, int count, in *before, err *e)
{
    lines *l = mem_array(1, sizeof *l, "lines", e);
    if (!l)
        return NULL;
    l->stop[0] = l->stop[1] = -1;
    const int code = make_locks(l);
    if (code || pipe2(l->stop, O_CLOEXEC)) {
        err_system(e, NULL, code ? code : errno, "cannot take lines");
        goto failed;
    }
    for (int i = 0; i < count; i++)
        if (open_source(l, path[i], before, e))
            goto failed;
    if (!start_threads(l, e))
        return l;
failed:
    lines_close(l);
    return NULL;
}

lines *lines_open_named(const char *poses_path, const char *control_path, in *before, err *e)
{
    const char *path[2];
    int count = 0;
    if (spnav_check(poses_path, control_path, e))
        return NULL;
    if (poses_path)
        path[count++] = poses_path;
    if (control_path && !(poses_path && !strcmp(poses_path, control_path)))
        path[count++] = control_path;
    return lines_open(path, count, before, e);
}

void lines_close(lines *l)
{
    if (!l)
        return;
    if (l->stop[1] >= 0)
        close(l->stop[1]);
    pthread_mutex_lock(&l->lock);
    l->ends = true;
    pthread_cond_broadcast(&l->taken);
    pthread_mutex_unlock(&l->lock);
    for (int i = 0; i < l->sources; i++) {
        source *s = &l->source[i];
        if (s->started)
            pthread_join(s->thread, NULL);
        if (s->is_owned && s->fd >= 0)
            close(s->fd);
        spnav_close(s->mouse);
        free(s->name);
        free(s->text);
    }
    for (int64_t i = 0; i < l->count; i++)
        free(l->list[(l->first + i) % KEPT].text);
    if (l->stop[0] >= 0)
        close(l->stop[0]);
    pthread_cond_destroy(&l->came);
    pthread_cond_destroy(&l->taken);
    pthread_mutex_destroy(&l->lock);
    notes_free(&l->kinds.told);
    free(l->current);
    free(l);
}

/* ---- Taking */

void lines_wait(lines *l, double until)
{
    enum { LOOK = 50 }; /* ms: how soon a signal is seen */
    pthread_mutex_lock(&l->lock);
    for (;;) {
        const double now = clock_now(), soon = now + 1e-3 * LOOK;
        if (l->has_pose || l->count || l->woken || !l->running || l->over || stop_came() || now >= until)
            break;
        const struct timespec to = clock_timespec(soon < until ? soon : until);
        pthread_cond_timedwait(&l->came, &l->lock, &to);
    }
    l->woken = false;
    pthread_mutex_unlock(&l->lock);
}

void lines_wake(lines *l)
{
    pthread_mutex_lock(&l->lock);
    l->woken = true;
    pthread_cond_signal(&l->came);
    pthread_mutex_unlock(&l->lock);
}

/* Counts the sources that have not ended. */
static void count_running(lines *l, int more)
{
    pthread_mutex_lock(&l->lock);
    l->running += more;
    pthread_cond_signal(&l->came);
    pthread_mutex_unlock(&l->lock);
}

void lines_join(lines *l)
{
    count_running(l, 1);
}

void lines_leave(lines *l)
{
    count_running(l, -1);
}

bool lines_take_pose(lines *l, lines_pose *to)
{
    pthread_mutex_lock(&l->lock);
    const bool is = l->has_pose;
    if (is)
        *to = l->pose;
    l->has_pose = false;
    pthread_mutex_unlock(&l->lock);
    return is;
}

/* The oldest control of the list, whose text is the caller's. */
static bool pop(lines *l, control *to)
{
    pthread_mutex_lock(&l->lock);
    const bool is = l->count > 0 && l->round < ROUND;
    l->round = is ? l->round + 1 : 0;
    if (is) {
        *to = l->list[l->first];
        l->first = (l->first + 1) % KEPT;
        l->count--;
        l->counts.controls++;
        pthread_cond_broadcast(&l->taken);
    }
    pthread_mutex_unlock(&l->lock);
    return is;
}

bool lines_take(lines *l, keyfile *k)
{
    control c;
    err none = {0};
    if (!pop(l, &c))
        return false;
    free(l->current);
    l->current = c.text;
    *k = (keyfile){.name = c.from->name};
    return keyfile_take(k, c.text, (int64_t)strlen(c.text), c.line, &none) > 0; /* as it did in the thread */
}

/* One of `count` was wrong. */
static void take_back(lines *l, int64_t *count, err *e)
{
    pthread_mutex_lock(&l->lock);
    --*count;
    skip(l, e, "line");
    pthread_mutex_unlock(&l->lock);
    *e = (err){0};
}

void lines_skip(lines *l, err *e)
{
    take_back(l, &l->counts.controls, e);
}

void lines_skip_pose(lines *l, err *e)
{
    take_back(l, &l->counts.poses, e);
}

void lines_place(lines *l, const pose *at)
{
    pthread_mutex_lock(&l->lock);
    place(l, at);
    pthread_mutex_unlock(&l->lock);
}

void lines_drop_pose(lines *l)
{
    pthread_mutex_lock(&l->lock);
    l->counts.stale++;
    pthread_mutex_unlock(&l->lock);
}

void lines_tell(lines *l, notes *warnings)
{
    pthread_mutex_lock(&l->lock);
    kinds_take(&l->kinds, warnings);
    pthread_mutex_unlock(&l->lock);
}

bool lines_ended(lines *l)
{
    pthread_mutex_lock(&l->lock);
    const bool ended = (!l->running || l->over) && !l->has_pose && !l->count;
    pthread_mutex_unlock(&l->lock);
    return ended;
}

lines_counts lines_count(lines *l)
{
    pthread_mutex_lock(&l->lock);
    const lines_counts counts = l->counts;
    pthread_mutex_unlock(&l->lock);
    return counts;
}

void lines_text(const lines_counts *c, char text[LINES_TEXT])
{
    snprintf(text, LINES_TEXT,
             "%" PRId64 " poses, %" PRId64 " of them stale and dropped; %" PRId64 " controls; %" PRId64
             " lines skipped; writers went away: %" PRId64,
             c->poses, c->stale, c->controls, c->skipped, c->writers);
}
