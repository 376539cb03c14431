/* A 3D mouse as a source of poses, against a daemon that speaks spacenavd's protocol: eight 32-bit integers an event,
 * in parts and several at once, newer types among them, garbage, half events; a daemon that goes away and comes back;
 * poses of other sources, which the joystick goes on from; where there is no daemon.
 */
#include "base/clock.h"
#include "live/lines.h"
#include "live/spnav.h"

#include "tap.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

enum { WAIT = 10 }; /* s: nothing here takes so long */

static int listen_at(const char *path)
{
    struct sockaddr_un at = {.sun_family = AF_UNIX};
    const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
    snprintf(at.sun_path, sizeof at.sun_path, "%s", path);
    unlink(path);
    ok(fd >= 0 && !bind(fd, (struct sockaddr *)&at, sizeof at) && !listen(fd, 8), "a daemon");
    return fd;
}

static void say(int fd, const void *bytes, size_t n)
{
    ok(write(fd, bytes, n) == (ssize_t)n, "%zu bytes", n);
}

static void event(int fd, int32_t type, int32_t a, int32_t b, int32_t c, int32_t period)
{
    const int32_t words[8] = {type, a, b, c, 0, 0, 0, period};
    say(fd, words, sizeof words);
}

/* The next pose; its x, or nan. */
static double next_pose(lines *l, lines_pose *at)
{
    const double until = clock_now() + WAIT;
    while (clock_now() < until) {
        lines_wait(l, until);
        if (lines_take_pose(l, at))
            return at->at.position[0];
    }
    return (double)NAN;
}

/* Poses come until one has this x. */
static bool comes_to(lines *l, double x)
{
    lines_pose at;
    double is;
    do
        is = next_pose(l, &at);
    while (!isnan(is) && fabs(is - x) > 1e-12);
    return !isnan(is);
}

static bool is_told(lines *l, const char *what)
{
    const double until = clock_now() + WAIT;
    bool is = false;
    while (!is && clock_now() < until) {
        notes told = {0};
        lines_tell(l, &told);
        for (int i = 0; i < told.count; i++) {
            printf("# %s\n", told.line[i]);
            is = is || strstr(told.line[i], what);
        }
        notes_free(&told);
        clock_sleep(.002);
    }
    return is;
}

/* Of a joystick, whose poses are its events', whatever the clock is. */
static void talk(lines *l, int fd)
{
    lines_pose at;
    near_(next_pose(l, &at), 0, 0, "it begins where start= says");
    near_(at.at.position[2], .25, 0, "in the file");
    event(fd, 0, 175, 0, 0, 8);
    near_(next_pose(l, &at), .01, 1e-12, "half a deflection");
    ok(strstr(at.name, "spnav:joystick") && at.line == 1 && at.time >= 0 && at.time < WAIT,
       "the source, its event and time");
    event(fd, 6, 1, 1, 0, 0); /* UEV_RAWBUTTON of a newer daemon */
    event(fd, 3, 0, 2, 0, 0); /* UEV_DEV */
    const int32_t two[16] = {0, 0, 0, 0, 0, 0, 0, 8, 0, 350, 0, 0, 0, 0, 0, 8};
    say(fd, two, 10);
    clock_sleep(.01);
    say(fd, (const char *)two + 10, 44);
    clock_sleep(.01);
    say(fd, (const char *)two + 54, 10);
    ok(comes_to(l, .02), "events in parts");
    event(fd, 1, 0, 1, 0, 0);
    ok(comes_to(l, 0), "the first button brings it back");
    event(fd, 0, 1 << 30, 0, 0, 8);
    event(fd, 0, -(1 << 30), 0, 0, 8);
    event(fd, -5, 1, 2, 3, 4);
    event(fd, 0, -350, 0, 0, 8);
    ok(comes_to(l, -.02), "an event after wrong ones");
    ok(is_told(l, "expected at most 20000; the event is skipped, and others like it are"), "which are told");
    ok(lines_count(l).skipped == 3, "and counted: %lld", (long long)lines_count(l).skipped);
}

static void come_back(lines *l, int *daemon, int *fd, const char *path)
{
    lines_pose at;
    say(*fd, "half an event", 13);
    close(*fd);
    close(*daemon);
    ok(is_told(l, "spacenavd went away; the probe stays where it is until it is back"),
       "a daemon that goes away is told");
    ok(lines_count(l).skipped == 4 && lines_count(l).writers == 1, "and counted, as the half of an event is");
    ok(!lines_ended(l), "the source does not end");
    *daemon = listen_at(path);
    *fd = accept(*daemon, NULL, NULL);
    ok(is_told(l, "spacenavd is back"), "so is one that is back");
    event(*fd, 0, 35, 0, 0, 8);
    near_(next_pose(l, &at), -.018, 1e-12, "the probe goes on from where it was");
}

/* Another source puts the probe somewhere, and the joystick goes on from there. */
static void place(lines *l, int fd, const char *fifo)
{
    lines_pose at;
    const int writer = open(fifo, O_WRONLY);
    say(writer, "0 1 0 0 0 0 0 1\n", 16);
    near_(next_pose(l, &at), 1, 0, "a pose of a line");
    event(fd, 0, 350, 0, 0, 8);
    near_(next_pose(l, &at), 1.02, 1e-12, "and the joystick from there");
    const pose there = {{3, 0, 0}, {0, 0, 0, 1}};
    lines_place(l, &there);
    event(fd, 0, 0, 0, 0, 8);
    event(fd, 0, 350, 0, 0, 8);
    ok(comes_to(l, 3.02), "or from where the caller says");
    close(writer);
}

static void conversation(const char *folder)
{
    char path[300], start[300], fifo[300], name[400];
    err e = {0};
    snprintf(path, sizeof path, "%s/socket", folder);
    snprintf(start, sizeof start, "%s/start.tum", folder);
    snprintf(fifo, sizeof fifo, "%s/fifo", folder);
    snprintf(name, sizeof name, "spnav:joystick,start=%s", start);
    FILE *file = fopen(start, "w");
    ok(file && fputs("# where it begins\nset gain 1\n0 0 0 .25 0 0 0 1\n1 9 9 9 0 0 0 1\n", file) >= 0 && !fclose(file),
       "a start");
    ok(!mkfifo(fifo, 0600), "a FIFO");
    setenv("SPNAV_SOCKET", path, 1);
    int daemon = listen_at(path);
    lines *l = lines_open_named(name, fifo, NULL, &e);
    if (ok(l != NULL, "opened: %s", e.text)) {
        int fd = accept(daemon, NULL, NULL);
        talk(l, fd);
        come_back(l, &daemon, &fd, path);
        place(l, fd, fifo);
        lines_close(l);
        close(fd);
    }
    close(daemon);
    unlink(path);
    unlink(start);
    unlink(fifo);
}

/* A mouse's motion by the clock: the way is the velocity by the time for which it was deflected. */
static void drive(const char *folder)
{
    char path[300];
    err e = {0};
    lines_pose at = {0};
    const pose none = pose_none();
    static const char *const names[] = {"spnav:mouse,speed=10cm,hold=5"};
    snprintf(path, sizeof path, "%s/socket", folder);
    const int daemon = listen_at(path);
    lines *l = lines_open(names, 1, NULL, &e);
    if (!ok(l != NULL, "opened: %s", e.text))
        return;
    const int fd = accept(daemon, NULL, NULL);
    event(fd, 0, 0, 0, 0, 0);
    ok(is_told(l, "moves nothing until a pose has said where the probe is"), "nowhere, which is told");
    lines_place(l, &none);
    const double before = clock_now();
    event(fd, 0, 350, 0, 0, 8);
    double gone = 0;
    int seen = 0;
    while (gone < .02 && !isnan(gone)) {
        gone = next_pose(l, &at);
        seen++;
    }
    const double took = clock_now() - before;
    ok(gone <= .1 * took && took >= .2, "it goes no faster than it should: %g m in %g s", gone, took);
    ok(seen > 5, "in small steps: %d", seen);
    event(fd, 0, 0, 0, 0, 8);
    event(fd, 1, 0, 1, 0, 0);
    ok(comes_to(l, 0), "the first button brings it back");
    clock_sleep(.03);
    ok(!lines_take_pose(l, &at), "and stands still when the puck is released");
    lines_close(l);
    close(fd);
    close(daemon);
    unlink(path);
}

static void refused(const char *folder)
{
    char path[300];
    err e = {0};
    static const char *const none[] = {"spnav:mouse"};
    snprintf(path, sizeof path, "%s/nothing", folder);
    setenv("SPNAV_SOCKET", path, 1);
    ok(!lines_open(none, 1, NULL, &e) &&
           strstr(e.text, "nothing: cannot connect: No such file or directory; expected spacenavd to run"),
       "%s", e.text);
    memset(path, 'x', sizeof path - 1);
    path[sizeof path - 1] = '\0';
    setenv("SPNAV_SOCKET", path, 1);
    e = (err){0};
    ok(!lines_open(none, 1, NULL, &e) && strstr(e.text, "too long"), "%s", e.text);
    e = (err){0};
    ok(!lines_open_named("spnav:joystick", NULL, NULL, &e) && e.status == STATUS_USAGE && strstr(e.text, "start=FILE"),
       "%s", e.text);
    e = (err){0};
    ok(!lines_open_named(NULL, "spnav:", NULL, &e) && e.status == STATUS_USAGE && strstr(e.text, "poses alone"), "%s",
       e.text);
    e = (err){0};
    ok(!lines_open_named("spnav:start=/nothing.tum", NULL, NULL, &e) && strstr(e.text, "/nothing.tum"), "%s", e.text);
    e = (err){0};
    ok(!lines_open_named("spnav:start=/dev/null", NULL, NULL, &e) && strstr(e.text, "no pose"), "%s", e.text);
    e = (err){0};
    ok(spnav_refuse("spnav:joystick", &e) && strstr(e.text, "without --live") && !spnav_refuse("file", &e), "%s",
       e.text);
}

int main(void)
{
    char folder[] = "/tmp/sinew-spnav-XXXXXX";
    if (!mkdtemp(folder))
        return 1;
    conversation(folder);
    drive(folder);
    refused(folder);
    rmdir(folder);
    return done_testing();
}
