#define _GNU_SOURCE
#include "live/spnav.h"

#include "base/clock.h"
#include "base/mem.h"
#include "probe/poses.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum {
    WORDS = 8,         /* of an event */
    EVENT = 4 * WORDS, /* bytes */
    ROOM = 64 * EVENT,
    TICK = 8,   /* ms between poses while the probe moves by itself */
    RETRY = 200 /* ms between attempts to connect again */
};

/* In messages, with the number of an event. */
static const char short_name[] = "spnav";

struct spnav {
    const char *path; /* of the socket: the environment's, or a constant */
    puck_plan plan;
    puck puck;
    int fd; /* -1: the daemon has gone away */
    double began;
    int64_t events;
    bool has_start, told;
    pose start, last; /* last: that was sent on */
    bool sent;
    unsigned char bytes[ROOM];
    size_t filled;
};

/* ---- Opening */

bool spnav_is(const char *name)
{
    return name && !strncmp(name, SPNAV_PREFIX, strlen(SPNAV_PREFIX));
}

int spnav_refuse(const char *source, err *e)
{
    if (!spnav_is(source))
        return 0;
    return err_usage(e, "--poses %.60s without --live; expected both, as a 3D mouse moves when a hand does", source);
}

bool spnav_has_start(const char *name)
{
    return strstr(name, ",start=") || !strncmp(name + strlen(SPNAV_PREFIX), "start=", strlen("start="));
}

int spnav_check(const char *source, const char *control, err *e)
{
    if (spnav_is(control))
        return err_usage(e, "--control %.60s; expected --poses, as a 3D mouse has poses alone", control);
    if (spnav_is(source) && !control && !spnav_has_start(source))
        return err_usage(e,
                         "--poses %.60s: where the probe begins is not said; expected start=FILE, with its first pose, "
                         "at the end of the word, or --control, through which a pose may come",
                         source);
    return 0;
}

static int read_start(spnav *s, err *e)
{
    poses list;
    poses_event event = {.kind = POSES_CONTROL};
    if (!s->plan.start)
        return 0;
    in *source = in_open(s->plan.start, e);
    int got = source && !poses_open(&list, source, NULL, e) ? 1 : -1;
    while (got > 0 && event.kind != POSES_POSE)
        got = poses_next(&list, &event, e);
    if (!got)
        err_set(e, s->plan.start, 0, "has no pose; expected one, where the probe begins");
    in_close(source);
    s->start = event.at;
    s->has_start = got > 0;
    return s->has_start ? 0 : -1;
}

/* A new descriptor, connected, that does not block; -1 with errno. */
static int dial(const char *path)
{
    struct sockaddr_un at = {.sun_family = AF_UNIX};
    if (strlen(path) >= sizeof at.sun_path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    strcpy(at.sun_path, path);
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd >= 0 && !connect(fd, (struct sockaddr *)&at, sizeof at))
        return fd;
    const int code = errno;
    if (fd >= 0)
        close(fd);
    errno = code;
    return -1;
}

spnav *spnav_open(const char *name, err *e)
{
    const char *path = getenv("SPNAV_SOCKET");
    spnav *s = mem_array(1, sizeof *s, "the 3D mouse", e);
    if (!s)
        return NULL;
    s->path = path && *path ? path : "/var/run/spnav.sock";
    s->fd = -1;
    s->began = clock_now();
    if (puck_plan_read(name + strlen(SPNAV_PREFIX), &s->plan, e) || read_start(s, e))
        goto failed;
    s->puck = puck_make(&s->plan);
    if (s->has_start)
        puck_place(&s->puck, &s->start, s->began);
    s->fd = dial(s->path);
    if (s->fd >= 0)
        return s;
    err_set(e, s->path, 0, "cannot connect: %s; expected spacenavd to run, or its socket in $SPNAV_SOCKET",
            strerror(errno));
failed:
    spnav_close(s);
    return NULL;
}

void spnav_close(spnav *s)
{
    if (s && s->fd >= 0)
        close(s->fd);
    free(s);
}

/* ---- Running */

static void send_pose(spnav *s, const spnav_to *to)
{
    if (!s->puck.placed || (s->sent && !memcmp(&s->last, &s->puck.at, sizeof s->last)))
        return;
    s->last = s->puck.at;
    s->sent = true;
    to->pose(to->context, s->puck.time - s->began, &s->puck.at, s->events);
}

/* What is elsewhere told to be the probe's place is not sent back. */
static void look_where(spnav *s, const spnav_to *to)
{
    pose at;
    if (!to->placed(to->context, &at))
        return;
    puck_place(&s->puck, &at, clock_now());
    s->last = at;
    s->sent = true;
}

static void read_event(const spnav *s, size_t i, int32_t event[WORDS])
{
    memcpy(event, s->bytes + i * EVENT, EVENT);
}

/* When an event happened that came in one read with those after it: their periods before now, s. */
static double time_of(const spnav *s, size_t i, size_t count, double now)
{
    int32_t event[WORDS];
    for (size_t j = i + 1; j < count; j++) {
        read_event(s, j, event);
        if (event[0] == PUCK_MOTION && event[WORDS - 1] > 0)
            now -= 1e-3 * event[WORDS - 1];
    }
    return fmax(now, s->puck.time);
}

static void take_events(spnav *s, const spnav_to *to)
{
    static const char *const nowhere = "the 3D mouse moves nothing until a pose has said where the probe is; expected "
                                       "start=FILE, or a line with a pose";
    const size_t count = s->filled / EVENT;
    const double now = clock_now();
    for (size_t i = 0; i < count; i++) {
        int32_t event[WORDS];
        err e = {0}, placed = {0};
        read_event(s, i, event);
        s->events++;
        if (!puck_take(&s->puck, event, time_of(s, i, count, now), &e))
            continue;
        err_set_as(&placed, e.form, short_name, s->events, e.text);
        to->wrong(to->context, &placed);
    }
    if (!s->puck.placed && !s->told && count)
        to->say(to->context, nowhere, false);
    s->told = s->told || count;
    s->filled -= count * EVENT;
    memmove(s->bytes, s->bytes + count * EVENT, s->filled);
}

static void lose(spnav *s, const spnav_to *to)
{
    char text[PUCK_WORD];
    err e = {0};
    err_set(&e, short_name, s->events + 1, "the event is cut: spacenavd went away");
    if (s->filled)
        to->wrong(to->context, &e);
    snprintf(text, sizeof text, "%s: spacenavd went away; the probe stays where it is until it is back", s->path);
    to->say(to->context, text, true);
    close(s->fd);
    s->fd = -1;
    s->filled = 0;
    puck_drop(&s->puck, clock_now());
}

static void find_again(spnav *s, const spnav_to *to)
{
    char text[PUCK_WORD];
    s->fd = dial(s->path);
    if (s->fd < 0)
        return;
    snprintf(text, sizeof text, "%s: spacenavd is back", s->path);
    to->say(to->context, text, false);
}

static void read_more(spnav *s, const spnav_to *to)
{
    const ssize_t n = read(s->fd, s->bytes + s->filled, ROOM - s->filled);
    if (n < 0 && (errno == EINTR || errno == EAGAIN))
        return;
    if (n <= 0) {
        lose(s, to);
        return;
    }
    s->filled += (size_t)n;
    take_events(s, to);
}

/* Waits for an event, for the time of the next pose, or for the daemon. False: it is to end. */
static bool wait_for_event(const spnav *s, int stop, bool *ready)
{
    struct pollfd list[2] = {{.fd = stop, .events = POLLIN}, {.fd = s->fd, .events = POLLIN}};
    const int still = s->fd < 0 ? RETRY : -1;
    const int got = poll(list, s->fd < 0 ? 1 : 2, puck_moves(&s->puck, clock_now()) ? TICK : still);
    if (got < 0)
        return errno == EINTR || errno == EAGAIN;
    *ready = list[1].revents != 0;
    return !list[0].revents;
}

void spnav_run(spnav *s, int stop, const spnav_to *to)
{
    bool ready = false;
    send_pose(s, to);
    while (wait_for_event(s, stop, &ready)) {
        look_where(s, to);
        if (s->fd < 0)
            find_again(s, to);
        else if (ready)
            read_more(s, to);
        puck_advance(&s->puck, clock_now());
        send_pose(s, to);
        ready = false;
    }
}
