/* Lines on a local socket: who gets which, clients that come, go, or do not read, and what is at the path before and
 * after.
 */
#include "live/broadcast.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "tap.h"

static char folder[64], path[80];

static struct sockaddr_un address(void)
{
    struct sockaddr_un at = {.sun_family = AF_UNIX};
    snprintf(at.sun_path, sizeof at.sun_path, "%.79s", path);
    return at;
}

static int connected(void)
{
    const struct sockaddr_un at = address();
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0);
    if (fd >= 0 && connect(fd, (const struct sockaddr *)&at, sizeof at)) {
        close(fd);
        return -1;
    }
    return fd;
}

static broadcast *must_open(void)
{
    err e = {0};
    broadcast *b = broadcast_open(path, &e);
    if (b)
        return b;
    printf("Bail out! %s\n", e.text);
    exit(1);
}

/* What is there to be read, as text. */
static const char *heard(int fd, char *to, size_t size)
{
    size_t length = 0;
    ssize_t got;
    while (length + 1 < size && (got = recv(fd, to + length, size - 1 - length, 0)) > 0)
        length += (size_t)got;
    to[length] = 0;
    return to;
}

static void tell(broadcast *b, const char *line)
{
    broadcast_clients(b);
    broadcast_send(b, line, strlen(line));
}

static void test_clients(void)
{
    char text[100];
    struct stat made;
    broadcast *b = must_open();
    const bool is = !lstat(path, &made);
    ok(is && S_ISSOCK(made.st_mode) && (made.st_mode & 0777) == 0600, "a socket of mode 0600");
    tell(b, "one\n");
    const int first = connected();
    tell(b, "two\n");
    const int second = connected();
    ok(send(second, "hello", 5, 0) == 5 && broadcast_clients(b) == 2, "two clients, one of which says something");
    tell(b, "three\n");
    ok(!strcmp(heard(first, text, sizeof text), "two\nthree\n"), "the first has what was sent since it came");
    ok(!strcmp(heard(second, text, sizeof text), "three\n"), "and so has the second");
    close(first);
    tell(b, "four\n");
    ok(broadcast_clients(b) == 1 && !strcmp(heard(second, text, sizeof text), "four\n"), "one goes, the other stays");
    const broadcast_counts c = broadcast_count(b);
    ok(c.clients == 2 && c.lines == 4 && c.lost == 0 && c.refused == 0, "all is counted");
    broadcast_close(b);
    ok(recv(second, text, sizeof text, 0) == 0, "at the end it is hung up on");
    ok(lstat(path, &made) && errno == ENOENT, "and the socket is gone");
    close(second);
}

/* Lines of a client that does not read are lost whole; the other has all, and none waits. */
static void test_slow(void)
{
    enum { LINES = 400, LENGTH = 700 };
    static char line[LENGTH + 1], got[LINES * LENGTH + 1];
    broadcast *b = must_open();
    const int slow = connected(), quick = connected();
    int right = 0;
    broadcast_clients(b);
    for (int i = 0; i < LINES; i++) {
        snprintf(line, sizeof line, "%0*d\n", LENGTH - 1, i);
        broadcast_send(b, line, LENGTH);
        right += !strcmp(heard(quick, got, sizeof got), line);
    }
    ok(right == LINES, "one that reads has every line: %d", right);
    const int64_t lost = broadcast_count(b).lost;
    const size_t waited = strlen(heard(slow, got, sizeof got));
    ok(waited < 20000 && lost > LINES / 2, "%zu bytes waited for one that does not, %lld lines are lost", waited,
       (long long)lost);
    broadcast_send(b, "", 0); /* what a line lacks yet comes first */
    for (int i = 0; i < 3; i++)
        broadcast_send(b, line, LENGTH);
    heard(slow, got + waited, sizeof got - waited);
    int whole = 0, all = 0;
    for (char *at = got; *at; at += LENGTH, all++) {
        char number[LENGTH + 1];
        snprintf(number, sizeof number, "%0*d\n", LENGTH - 1, atoi(at));
        whole += !strncmp(at, number, LENGTH);
    }
    ok(all > 3 && whole == all, "each line that it gets is whole: %d of %d", whole, all);
    close(slow);
    close(quick);
    broadcast_close(b);
}

static void test_many(void)
{
    int fd[100], good = 0;
    char text[20];
    broadcast *b = must_open();
    for (int i = 0; i < 100; i++) {
        fd[i] = connected();
        broadcast_clients(b);
    }
    tell(b, "line\n");
    for (int i = 0; i < 100; i++) {
        good += fd[i] >= 0 && !strcmp(heard(fd[i], text, sizeof text), "line\n");
        close(fd[i]);
    }
    ok(good == BROADCAST_CLIENTS && broadcast_count(b).refused == 100 - BROADCAST_CLIENTS,
       "of 100 clients, %d are kept", good);
    ok(broadcast_clients(b) == 0, "and all go");
    broadcast_close(b);
}

static void refused(const char *name, const char *why)
{
    err e = {0};
    broadcast *b = broadcast_open(path, &e);
    ok(!b && strstr(e.text, why), "%s: %s", name, e.text);
    broadcast_close(b);
}

static void test_path(void)
{
    struct stat there;
    broadcast *b = must_open();
    refused("one that is in use", "another program listens");
    ok(!lstat(path, &there), "stays");
    unlink(path);
    broadcast *other = must_open();
    broadcast_close(b);
    ok(!lstat(path, &there), "what took its place stays too");
    broadcast_close(other);

    const struct sockaddr_un at = address();
    const int left = socket(AF_UNIX, SOCK_STREAM, 0);
    ok(left >= 0 && !bind(left, (const struct sockaddr *)&at, sizeof at) && !close(left) && !lstat(path, &there),
       "a socket that a run left which was killed");
    broadcast_close(must_open());
    ok(lstat(path, &there) && errno == ENOENT, "is replaced, and removed");

    FILE *f = fopen(path, "w");
    ok(f && fputs("precious", f) >= 0 && !fclose(f), "a file");
    refused("stays", "is no socket");
    ok(!lstat(path, &there) && there.st_size == 8 && !unlink(path), "as it is");
    snprintf(path, sizeof path, "%.60s/none/socket", folder);
    refused("a folder that is not there", "No such file or directory");
    err e = {0};
    char name[300];
    memset(name, 'x', sizeof name - 1);
    name[sizeof name - 1] = 0;
    ok(!broadcast_open(name, &e) && strstr(e.text, "299 bytes of path; a socket's has 1 to 107"), "a long path: %s",
       e.text + 300);
}

int main(void)
{
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%.40s/broadcast-XXXXXX", temporary ? temporary : "/tmp");
    if (!mkdtemp(folder)) {
        printf("Bail out! no folder\n");
        return 1;
    }
    snprintf(path, sizeof path, "%.60s/socket", folder);
    test_clients();
    test_slow();
    test_many();
    test_path();
    rmdir(folder);
    return done_testing();
}
