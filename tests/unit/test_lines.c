/* Lines that come live, through a pipe with a name: the newest pose, controls in their order, what is wrong skipped and
 * told once a kind, writers that go away and come back; and the ends of FIFOs and of pipes.
 */
#include "base/clock.h"
#include "live/lines.h"

#include "tap.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WAIT = 10 }; /* s: nothing here takes so long */

static void say(int fd, const char *text)
{
    const size_t n = strlen(text);
    ok(write(fd, text, n) == (ssize_t)n, "written");
}

/* Waits until so many lines were seen in all. */
static lines_counts wait_for(lines *l, int64_t sum)
{
    const double until = clock_now() + WAIT;
    lines_counts c = lines_count(l);
    while (c.poses + c.skipped + c.writers < sum && clock_now() < until) {
        usleep(1000);
        c = lines_count(l);
    }
    return c;
}

static void newest(lines *l, int fd)
{
    lines_pose at;
    say(fd, "0 1 0 0 0 0 0 1\n.5 2 0 0 0 0 0 1\n1 3 0 0 0 0 0 1\n");
    lines_counts c = wait_for(l, 3);
    ok(lines_take_pose(l, &at) && at.at.position[0] == 3 && at.time == 1, "the newest pose");
    ok(!lines_take_pose(l, &at), "once");
    ok(c.poses == 3 && c.stale == 2, "two are stale");
    ok(clock_now() - at.came < WAIT && at.came <= clock_now(), "when it came");
    ok(strstr(at.name, "fifo") && at.line == 3, "and where it stood");
    lines_drop_pose(l);
    ok(lines_count(l).stale == 3, "given up for a newer one it is stale too");
}

static void garbage(lines *l, int fd)
{
    static const char *const bad[] = {
        "2 nan 0 0 0 0 0 1\n", "nan 0 0 0 0 0 0 1\n", "2 0 0 0 0 0 0 0\n", "2 0 0 0 0 0 0 7\n",
        ".5 0 0 0 0 0 0 1\n",  "2 0 0 0 0 0 1\n",     "2 0 0\n",           "\x01\x02\n",
        "2 0 0 0 0 0 0 1 1\n", "inf 0 0 0 0 0 0 1\n"};
    enum { BAD = sizeof bad / sizeof *bad };
    lines_pose at;
    notes told = {0};
    for (int i = 0; i < BAD; i++)
        say(fd, bad[i]);
    say(fd, "3 9 0 0 0 0 0 1\n");
    const lines_counts c = wait_for(l, 3 + BAD + 1);
    ok(c.skipped == BAD, "%lld lines are skipped", (long long)c.skipped);
    ok(lines_take_pose(l, &at) && at.at.position[0] == 9, "and the pose after them is taken");
    lines_tell(l, &told);
    ok(told.count == 5, "told once a kind: %d", told.count);
    for (int i = 0; i < told.count; i++)
        ok(strstr(told.line[i], "skipped") && strstr(told.line[i], ":"), "%s", told.line[i]);
    notes_free(&told);
    lines_tell(l, &told);
    ok(told.count == 0, "and not again");
}

/* A writer that begins anew without going away: one line is lost, not all. */
static void anew(lines *l, int fd)
{
    lines_pose at;
    const lines_counts before = lines_count(l);
    say(fd, ".1 4 0 0 0 0 0 1\n.2 5 0 0 0 0 0 1\n3 6 0 0 0 0 0 1\n");
    const lines_counts c = wait_for(l, before.poses + before.skipped + before.writers + 3);
    ok(c.skipped == before.skipped + 1 && lines_take_pose(l, &at) && at.at.position[0] == 6, "times that begin anew");
}

static void controls(lines *l, int fd)
{
    keyfile k;
    err e = {0};
    say(fd, "set a 1\nmethod fem # so\n\n\r\nnow contract x .5\r\n");
    lines_wait(l, clock_now() + WAIT);
    ok(lines_take(l, &k) && k.count == 3 && !strcmp(k.word[2], "1"), "the first control");
    const int64_t line = k.line;
    lines_wait(l, clock_now() + WAIT);
    ok(lines_take(l, &k) && k.count == 2 && k.line == line + 1, "the second, and its line");
    lines_wait(l, clock_now() + WAIT);
    ok(lines_take(l, &k) && k.count == 4 && !strcmp(k.word[3], ".5"), "the third");
    keyfile_error(&k, &e, "no such verb");
    const int64_t skipped = lines_count(l).skipped;
    lines_skip(l, &e);
    ok(!e.status && lines_count(l).skipped == skipped + 1, "a control that cannot be taken is skipped too");
    ok(lines_count(l).controls == 2, "and not counted as taken");
}

/* A pose that the caller has no use for. */
static void unused(lines *l, int fd)
{
    lines_pose at;
    err e = {0};
    notes told = {0};
    const lines_counts before = lines_count(l);
    say(fd, "3.5 1 0 0 0 0 0 1\n");
    wait_for(l, before.poses + before.skipped + before.writers + 1);
    ok(lines_take_pose(l, &at), "a pose");
    err_set(&e, at.name, at.line, "no use for it");
    lines_skip_pose(l, &e);
    const lines_counts c = lines_count(l);
    ok(!e.status && c.poses == before.poses && c.skipped == before.skipped + 1, "is counted as skipped");
    lines_tell(l, &told);
    ok(told.count && strstr(told.line[told.count - 1], "no use for it; the line is skipped"), "and told");
    notes_free(&told);
}

/* A line of more bytes than any has, then a writer that leaves in the midst of one. */
static void cut(lines *l, int *fd, const char *path)
{
    enum { LONG = 100000 };
    lines_pose at;
    const lines_counts before = lines_count(l);
    char *text = malloc(LONG + 2);
    ok(text != NULL, "memory");
    if (!text)
        return;
    memset(text, 'x', LONG);
    strcpy(text + LONG, "\n");
    say(*fd, text);
    free(text);
    say(*fd, "4 5 0 0 0 0 0 1\n5 6 0 0 0");
    close(*fd);
    const lines_counts c = wait_for(l, before.poses + before.skipped + before.writers + 4);
    ok(c.skipped == before.skipped + 2, "a line that is too long, and one that is cut, are skipped");
    ok(c.writers == 1, "the writer went away");
    ok(lines_take_pose(l, &at) && at.at.position[0] == 5, "the pose between them is taken");
    ok(!lines_ended(l), "a FIFO does not end");
    *fd = open(path, O_WRONLY);
    say(*fd, "0 7 0 0 0 0 0 1\n");
    wait_for(l, before.poses + before.skipped + before.writers + 5);
    ok(lines_take_pose(l, &at) && at.at.position[0] == 7, "the next writer's times begin anew");
}

static void fifo(const char *folder)
{
    char path[300];
    err e = {0};
    snprintf(path, sizeof path, "%s/fifo", folder);
    ok(!mkfifo(path, 0600), "a FIFO");
    const char *const list[] = {path};
    lines *l = lines_open(list, 1, NULL, &e);
    ok(l != NULL, "opened without a writer: %s", e.text);
    if (!l)
        return;
    const double before = clock_now();
    lines_wait(l, before + .02);
    ok(clock_now() - before >= .02, "a wait ends at its time");
    int fd = open(path, O_WRONLY);
    newest(l, fd);
    garbage(l, fd);
    anew(l, fd);
    controls(l, fd);
    unused(l, fd);
    cut(l, &fd, path);
    lines_close(l);
    close(fd);
    unlink(path);
}

static void refused(const char *folder)
{
    char path[300];
    err e = {0};
    snprintf(path, sizeof path, "%s/file", folder);
    close(open(path, O_WRONLY | O_CREAT, 0600));
    const char *list[] = {path};
    ok(!lines_open(list, 1, NULL, &e) && strstr(e.text, "regular file"), "%s", e.text);
    unlink(path);
    e = (err){0};
    ok(!lines_open(list, 1, NULL, &e) && strstr(e.text, "No such file"), "%s", e.text);
}

/* A FIFO by two names: each source would get a part of its lines. Named the same for both, it is one source. */
static void twice(const char *folder)
{
    char path[300], again[310];
    err e = {0};
    snprintf(path, sizeof path, "%s/fifo", folder);
    snprintf(again, sizeof again, "%s/./fifo", folder);
    ok(!mkfifo(path, 0600), "a FIFO");
    const char *const list[] = {path, again};
    ok(!lines_open(list, 2, NULL, &e) && strstr(e.text, "the same pipe"), "%s", e.text);
    e = (err){0};
    ok(!lines_open_named(path, again, NULL, &e) && strstr(e.text, "the same pipe"), "of poses and controls: %s",
       e.text);
    e = (err){0};
    lines *l = lines_open_named(path, path, NULL, &e);
    ok(l != NULL, "one that is named for both is read once%s", e.text);
    lines_close(l);
    l = lines_open_named(NULL, path, NULL, &e);
    ok(l && !lines_ended(l), "controls without poses%s", e.text);
    lines_close(l);
    unlink(path);
}

/* A writer of more controls than a frame waits for; then a file takes the FIFO's name, which ends the source. */
static void rounds(const char *folder)
{
    enum { SENT = 1000, MOST = 256 };
    char path[300];
    err e = {0};
    keyfile k;
    snprintf(path, sizeof path, "%s/fifo", folder);
    ok(!mkfifo(path, 0600), "a FIFO");
    const char *const list[] = {path};
    lines *l = lines_open(list, 1, NULL, &e);
    ok(l != NULL, "opened: %s", e.text);
    if (!l)
        return;
    const int fd = open(path, O_WRONLY);
    for (int i = 0; i < SENT; i++)
        say(fd, "set gain 1\n");
    unlink(path);
    close(open(path, O_WRONLY | O_CREAT, 0600));
    close(fd);
    const double until = clock_now() + WAIT;
    int all = 0, most = 0;
    while (!lines_ended(l) && clock_now() < until) {
        int round = 0;
        while (lines_take(l, &k))
            round++;
        all += round;
        most = round > most ? round : most;
        lines_wait(l, clock_now() + .01);
    }
    ok(all == SENT && most <= MOST, "all %d controls are taken, %d at a time", all, most);
    ok(lines_ended(l), "a FIFO whose name is a file's ends");
    lines_close(l);
    unlink(path);
}

/* A pipe without a name, by /dev/fd. */
static void pipe_ends(void)
{
    int end[2];
    char path[40];
    err e = {0};
    keyfile k;
    if (pipe(end)) {
        ok(false, "a pipe");
        return;
    }
    snprintf(path, sizeof path, "/dev/fd/%d", end[0]);
    const char *const list[] = {path};
    lines *l = lines_open(list, 1, NULL, &e);
    ok(l != NULL, "a pipe is opened: %s", e.text);
    if (!l)
        return;
    say(end[1], "set a 1\n");
    close(end[1]);
    const double until = clock_now() + WAIT;
    while (!lines_take(l, &k) && clock_now() < until)
        lines_wait(l, until);
    while (!lines_ended(l) && clock_now() < until)
        lines_wait(l, clock_now() + .01);
    ok(k.count == 3 && lines_ended(l), "it ends after its last line");
    lines_close(l);
    close(end[0]);
}

/* More controls than wait: the writer does, and none is lost. */
static void flood(void)
{
    enum { MANY = 20000 };
    int end[2];
    char path[40];
    err e = {0};
    keyfile k;
    int64_t got = 0, in_order = 0;
    if (pipe(end)) {
        ok(false, "a pipe");
        return;
    }
    snprintf(path, sizeof path, "/dev/fd/%d", end[0]);
    const char *const list[] = {path};
    if (!fork()) {
        FILE *to = fdopen(end[1], "w");
        for (int i = 0; i < MANY; i++)
            fprintf(to, "set n %d\n", i);
        fclose(to);
        _exit(0);
    }
    close(end[1]);
    lines *l = lines_open(list, 1, NULL, &e);
    const double until = clock_now() + WAIT;
    while (l && !lines_ended(l) && clock_now() < until) {
        lines_wait(l, clock_now() + .01);
        for (; lines_take(l, &k); got++)
            in_order += atoi(k.word[2]) == (int)got;
    }
    ok(got == MANY && in_order == MANY, "%lld of %d controls, in their order", (long long)got, (int)MANY);
    lines_close(l);
    close(end[0]);
}

static void *wake(void *context)
{
    lines_wake(context);
    return NULL;
}

/* A source that the caller reads, and no other. */
static void joined(void)
{
    err e = {0};
    char text[LINES_TEXT];
    pthread_t thread;
    lines *l = lines_open_named(NULL, NULL, NULL, &e);
    ok(l && lines_ended(l), "without sources, all have ended");
    if (!l)
        return;
    lines_join(l);
    ok(!lines_ended(l), "one that joins has not");
    const double began = clock_now();
    lines_wait(l, began + .02);
    ok(clock_now() - began >= .02, "and is waited for");
    lines_wake(l);
    lines_wait(l, clock_now() + WAIT);
    ok(clock_now() - began < WAIT, "a wait ends where it was woken before");
    ok(!pthread_create(&thread, NULL, wake, l), "a thread");
    lines_wait(l, clock_now() + WAIT);
    ok(clock_now() - began < WAIT, "and where it is woken");
    pthread_join(thread, NULL);
    lines_leave(l);
    lines_wait(l, clock_now() + WAIT);
    ok(lines_ended(l) && clock_now() - began < WAIT, "it has left");
    const lines_counts c = {600, 3, 12, 2, 1};
    lines_text(&c, text);
    ok(!strcmp(text, "600 poses, 3 of them stale and dropped; 12 controls; 2 lines skipped; writers went away: 1"),
       "%s", text);
    lines_close(l);
}

/* Reading that another thread tells to end. */
static void watched(void)
{
    int end[2], stop[2];
    char path[40], *line;
    err e = {0};
    if (pipe(end) || pipe(stop)) {
        ok(false, "pipes");
        return;
    }
    say(end[1], "a line\nand\n");
    snprintf(path, sizeof path, "/dev/fd/%d", end[0]);
    in *s = in_open(path, &e);
    ok(s != NULL, "%s", e.text);
    in_watch(s, stop[0]);
    ok(in_line(s, &line, NULL, &e) == 6, "what was read is taken");
    ok(in_line(s, &line, NULL, &e) == 3, "all of it");
    close(stop[1]);
    ok(in_line(s, &line, NULL, &e) == -2 && strstr(e.text, "told to end"), "%s", e.text);
    in_close(s);
    close(stop[0]);
    close(end[0]);
    close(end[1]);
}

int main(void)
{
    char folder[] = "/tmp/sinew-lines-XXXXXX";
    if (!mkdtemp(folder))
        return 1;
    fifo(folder);
    twice(folder);
    rounds(folder);
    refused(folder);
    rmdir(folder);
    pipe_ends();
    flood();
    joined();
    watched();
    return done_testing();
}
