#define _GNU_SOURCE
#include "console/programs/steering.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/num.h"
#include "base/thread.h"
#include "live/lines.h"
#include "live/spnav.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define IGTL_PREFIX "igtl:"

enum { IN, OUT, WORD = 256, WHY = 300, WORDS = 8 };

static const char *const tools[STEERING_PROGRAMS] = {"sinew-igtl-in", "sinew-igtl-out"};

struct steering {
    steering_plan plan;
    const char *word;
    lines *lines;     /* NULL: no source */
    char path[WORD];  /* of the source */
    const char *name; /* of the source, for messages */
    child program[STEERING_PROGRAMS];
    bool started[STEERING_PROGRAMS], told[STEERING_PROGRAMS];
    int idle; /* what igtl-out has as its standard input: it stays open, and nothing is written; -1: none */
    pthread_t thread;
    bool runs;
    atomic_bool ends;
    pthread_mutex_t lock; /* for what follows */
    char last[STEERING_PROGRAMS][WHY];
};

/* ---- The programs */

static void hear(void *context, const char *tool, const char *line)
{
    steering *s = context;
    const size_t n = strlen(tool);
    const char *text = !strncmp(line, tool, n) && !strncmp(line + n, ": ", 2) ? line + n + 2 : line;
    pthread_mutex_lock(&s->lock);
    snprintf(s->last[strcmp(tool, tools[IN]) ? OUT : IN], WHY, "%.*s", WHY - 1, text);
    pthread_mutex_unlock(&s->lock);
    s->plan.said(s->plan.context, tool, line);
}

/* execv takes what it does not write as if it did. */
static char *borrow(const char *word)
{
    union {
        const char *in;
        char *out;
    } same = {.in = word};
    return same.out;
}

static int start(steering *s, int which, char **argv, int input, err *e)
{
    const child_plan plan = {tools[which], argv, input, s, hear};
    s->started[which] = !child_start(&s->program[which], &plan, e);
    return s->started[which] ? 0 : -1;
}

/* "igtl:HOST:PORT[,TRANSFORM]" as the words of a command line. */
static int start_tracker(steering *s, err *e)
{
    char at[WORD];
    int64_t port;
    char *argv[WORDS] = {borrow(tools[IN]), at};
    const int n = snprintf(at, sizeof at, "%s", s->plan.poses + strlen(IGTL_PREFIX));
    char *comma = strchr(at, ','), *name = comma ? comma + 1 : NULL;
    if (comma)
        *comma = '\0';
    const char *colon = strrchr(at, ':');
    if (n >= WORD || !colon || colon == at || num_int(colon + 1, 1, 65535, &port) || *at == '-' || (name && !*name))
        return err_usage(e, "--poses %.80s; expected " IGTL_PREFIX "HOST:PORT, or " IGTL_PREFIX "HOST:PORT,TRANSFORM",
                         s->plan.poses);
    if (name) {
        argv[2] = borrow("--transform");
        argv[3] = name;
    }
    if (start(s, IN, argv, -1, e))
        return -1;
    snprintf(s->path, sizeof s->path, "/proc/self/fd/%d", s->program[IN].out);
    return 0;
}

/* Its standard input, on which a model may come, never ends before it does. */
static int start_server(steering *s, err *e)
{
    int ends[2];
    const char *colon = strrchr(s->plan.out, ':');
    int64_t port;
    if (num_int(colon ? colon + 1 : s->plan.out, 0, 65535, &port) || colon == s->plan.out || *s->plan.out == '-')
        return err_usage(e, "--igtl-out '%.80s'; expected [ADDRESS:]PORT, such as 18944", s->plan.out);
    char *argv[WORDS] = {borrow(tools[OUT]), borrow("--listen"), borrow(s->plan.out), borrow("--poses"),
                         borrow(CHILD_CONTROL)};
    if (pipe2(ends, O_CLOEXEC))
        return err_system(e, tools[OUT], errno, "cannot make a pipe");
    s->idle = ends[1];
    if (start(s, OUT, argv, ends[0], e))
        return -1;
    close(s->program[OUT].out);
    s->program[OUT].out = -1;
    return 0;
}

bool steering_has_lost(steering *s, char *why, size_t size)
{
    for (int i = 0; s && i < STEERING_PROGRAMS; i++) {
        char how[80];
        if (!s->started[i] || s->told[i] || !child_has_ended(&s->program[i]))
            continue;
        child_end(&s->program[i], 0); /* and all that it said is heard */
        s->told[i] = true;
        child_how(&s->program[i], how, sizeof how);
        pthread_mutex_lock(&s->lock);
        /* One that a signal killed has not said why. */
        const bool said = WIFEXITED(s->program[i].status) && WEXITSTATUS(s->program[i].status) && *s->last[i];
        snprintf(why, size, "%s %s%s%s", tools[i], how, said ? ": " : "", said ? s->last[i] : "");
        pthread_mutex_unlock(&s->lock);
        return true;
    }
    return false;
}

const child *steering_program(const steering *s, int i)
{
    return s && s->started[i] ? &s->program[i] : NULL;
}

/* ---- The poses */

static void warn(steering *s, const char *text)
{
    char line[CHILD_SAID];
    const size_t n = strlen(s->path);
    const bool has_place = !strncmp(text, s->path, n) && text[n] == ':';
    snprintf(line, sizeof line, "warning: %s%s", has_place ? "line " : "", has_place ? text + n + 1 : text);
    s->plan.said(s->plan.context, s->name, line);
}

static void tell_warnings(steering *s)
{
    notes told = {0};
    lines_tell(s->lines, &told);
    for (int i = 0; i < told.count; i++)
        warn(s, told.line[i]);
    notes_free(&told);
}

/* Controls are the page's alone. */
static void skip_controls(steering *s)
{
    keyfile k;
    while (lines_take(s->lines, &k)) {
        err e = {0};
        keyfile_error(&k, &e, "'%.60s'; expected poses alone", k.word[0]);
        lines_skip(s->lines, &e);
    }
}

static void *read_poses(void *context)
{
    static const double often = .1; /* s */
    steering *s = context;
    lines_pose at;
    while (!atomic_load(&s->ends) && !lines_ended(s->lines)) {
        lines_wait(s->lines, clock_now() + often);
        if (lines_take_pose(s->lines, &at))
            s->plan.came(s->plan.context, &at.at);
        skip_controls(s);
        tell_warnings(s);
    }
    if (!atomic_load(&s->ends) && !s->started[IN])
        warn(s, "the poses have ended");
    return NULL;
}

static int open_source(steering *s, err *e)
{
    const char *from = s->plan.poses, *path = s->path;
    const bool mouse = spnav_is(from), tracker = !strncmp(from, IGTL_PREFIX, strlen(IGTL_PREFIX));
    s->word = "lines";
    s->name = "poses";
    if (mouse) {
        s->word = s->name = "3D mouse";
        if (spnav_has_start(from))
            return err_usage(e, "--poses %.80s: a case begins where it says itself; expected no start=", from);
    }
    if (snprintf(s->path, sizeof s->path, "%s", from) >= WORD)
        return err_usage(e, "--poses of %zu bytes; expected fewer than %d", strlen(from), WORD);
    if (tracker) {
        s->word = "tracker";
        s->name = tools[IN];
        if (start_tracker(s, e))
            return -1;
    }
    s->lines = lines_open(&path, 1, NULL, e);
    if (tracker) {
        close(s->program[IN].out);
        s->program[IN].out = -1;
    }
    return s->lines ? 0 : -1;
}

steering *steering_open(const steering_plan *plan, err *e)
{
    steering *s = mem_array(1, sizeof *s, "the source of poses", e);
    if (!s)
        return NULL;
    s->plan = *plan;
    s->idle = -1;
    int code = pthread_mutex_init(&s->lock, NULL);
    if (code)
        err_system(e, NULL, code, "cannot take poses");
    if (code || (plan->poses && open_source(s, e)) || (plan->out && start_server(s, e)))
        goto failed;
    if (s->lines && (code = thread_start(&s->thread, read_poses, s))) {
        err_system(e, s->name, code, "cannot start a thread");
        goto failed;
    }
    s->runs = s->lines != NULL;
    return s;
failed:
    steering_close(s);
    return NULL;
}

void steering_close(steering *s)
{
    enum { GRACE = 2 }; /* s */
    if (!s)
        return;
    atomic_store(&s->ends, true);
    if (s->lines)
        lines_wake(s->lines);
    if (s->runs)
        pthread_join(s->thread, NULL);
    if (s->idle >= 0)
        close(s->idle);
    for (int i = 0; i < STEERING_PROGRAMS; i++)
        if (s->started[i])
            child_ask(&s->program[i]);
    for (int i = 0; i < STEERING_PROGRAMS; i++)
        if (s->started[i])
            child_end(&s->program[i], GRACE);
    lines_close(s->lines);
    pthread_mutex_destroy(&s->lock);
    free(s);
}

/* ---- Where the probe is */

const char *steering_word(const steering *s)
{
    return s ? s->word : NULL;
}

bool steering_has_places(const steering *s)
{
    return s && s->word && !spnav_is(s->plan.poses);
}

void steering_place(steering *s, const pose *at)
{
    if (s && s->lines)
        lines_place(s->lines, at);
}

int steering_tell(steering *s, const char *line, err *e)
{
    return s && s->started[OUT] ? child_tell(&s->program[OUT], line, e) : 0;
}
