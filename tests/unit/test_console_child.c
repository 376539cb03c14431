// Tools that the console runs: they are found, fed, heard and ended, and none outlives it.
// needs: common/console/programs/child.c
#include "base/clock.h"
#include "console/programs/child.h"

#include "tap.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char said[4000];

static void note(void *context, const char *tool, const char *line)
{
    char *to = context;
    snprintf(to + strlen(to), sizeof said - strlen(to), "%s: %s|", tool, line);
}

/* Starts sh with a script. */
static int start_sh(child *c, const char *script, int in)
{
    static char sh[] = "sh", option[] = "-c", text[500];
    static char *argv[] = {sh, option, text, NULL};
    err e = {0};
    snprintf(text, sizeof text, "%s", script);
    said[0] = '\0';
    const child_plan plan = {"sh", argv, in, said, note};
    const int failed = child_start(c, &plan, &e);
    if (failed)
        printf("# %s\n", e.text);
    return failed;
}

/* All that it writes, up to its end. */
static void read_all(int fd, char *to, size_t size)
{
    size_t n = 0;
    ssize_t got;
    while (n + 1 < size && (got = read(fd, to + n, size - 1 - n)) > 0)
        n += (size_t)got;
    to[n] = '\0';
}

/* Whether a process is there, and has not ended. */
static bool is_alive(long pid)
{
    char path[64], text[400] = "";
    snprintf(path, sizeof path, "/proc/%ld/stat", pid);
    FILE *f = fopen(path, "r");
    const bool got = f && fgets(text, sizeof text, f);
    if (f)
        fclose(f);
    const char *state = strrchr(text, ')');
    return got && state && state[2] != 'Z' && state[2] != 'X';
}

static void try_lines(void)
{
    child c;
    err e = {0};
    char got[200], how[80];
    const int in = open("/dev/null", O_RDONLY);
    ok(!start_sh(&c, "read a <&3; echo bad >&2; echo got $a $(ls /proc/self/fd | wc -l) | tr -d '\\n'; exit 3", in),
       "a tool starts");
    ok(fcntl(in, F_GETFD) < 0, "its input is not ours any more");
    ok(!child_tell(&c, "set gain 6", &e), "it is told a line");
    read_all(c.out, got, sizeof got);
    child_end(&c, 5);
    child_how(&c, how, sizeof how);
    /* 0 to 3, and the folder that ls reads. */
    ok(!strcmp(got, "got set gain 6 5"), "it has that line, and no other descriptors: %s", got);
    ok(!strcmp(said, "sh: bad|"), "what it says is heard: %s", said);
    ok(!strcmp(how, "ended with status 3"), "it %s", how);
    ok(child_has_ended(&c) && !child_tell(&c, "x", &e), "telling what has ended does nothing");
    close(c.out);
}

static void try_full(void)
{
    child c;
    err e = {0};
    char line[1001];
    int told = 0;
    memset(line, 'x', 1000);
    line[1000] = '\0';
    ok(!start_sh(&c, "sleep 60", -1), "one that reads nothing");
    for (int i = 0; i < 200; i++) {
        err each = {0};
        told += child_tell(&c, line, &each) != 0;
        if (told == 1 && !e.status)
            e = each;
    }
    ok(told == 1 && strstr(e.text, "sh does not read its lines"), "is told of once, and stalls nobody: %s", e.text);
    child_ask(&c);
    child_end(&c, 5);
    ok(WIFSIGNALED(c.status) && WTERMSIG(c.status) == SIGTERM, "it is asked to end");
    close(c.out);
}

static void try_stubborn(void)
{
    child c;
    char how[80], got[10];
    ok(!start_sh(&c, "trap '' TERM; echo on; while :; do sleep .1; done", -1), "one that does not heed that");
    ok(read(c.out, got, 3) == 3, "it runs");
    child_ask(&c);
    child_end(&c, .2);
    child_how(&c, how, sizeof how);
    ok(!strcmp(how, "was killed by signal 9"), "it %s", how);
    close(c.out);
}

static void try_missing(void)
{
    static char none[] = "no-such-tool";
    static char *argv[] = {none, NULL};
    const child_plan plan = {none, argv, open("/dev/null", O_RDONLY), said, note};
    child c;
    err e = {0};
    ok(child_start(&c, &plan, &e) == -1 && strstr(e.text, "no-such-tool: there is no such tool beside"), "%s", e.text);
    ok(fcntl(plan.in, F_GETFD) < 0, "its input is closed all the same");
    child_end(&c, 1);
    child_end(&(child){0}, 1);
    ok(fcntl(STDIN_FILENO, F_GETFD) >= 0, "ending what never was closes nothing");
}

/* A process that starts a child and is killed: the child goes too. */
static void try_orphan(void)
{
    int fd[2];
    long pid = 0;
    ok(!pipe(fd), "a pipe");
    const pid_t console = fork();
    if (!console) {
        child c;
        if (start_sh(&c, "trap '' TERM HUP; while :; do sleep .1; done", -1))
            _exit(1);
        pid = (long)c.pid;
        if (write(fd[1], &pid, sizeof pid) < 0)
            _exit(1);
        pause();
        _exit(0);
    }
    ok(read(fd[0], &pid, sizeof pid) == sizeof pid && is_alive(pid), "a child of another process");
    kill(console, SIGKILL);
    waitpid(console, NULL, 0);
    for (int i = 0; i < 100 && is_alive(pid); i++)
        clock_sleep(.05);
    ok(!is_alive(pid), "ends with it, though that was killed");
    close(fd[0]);
    close(fd[1]);
}

int main(void)
{
    signal(SIGPIPE, SIG_IGN);
    try_lines();
    try_full();
    try_stubborn();
    try_missing();
    try_orphan();
    return done_testing();
}
