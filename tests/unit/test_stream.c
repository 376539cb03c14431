/* Streams: what is written comes back, plain and gzipped, whole or not at all. */
#define _GNU_SOURCE /* F_GETPIPE_SZ */
#include "base/in.h"
#include "base/inputs.h"
#include "base/mem.h"
#include "base/out.h"

#include "tap.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int files_in(const char *folder)
{
    DIR *d = opendir(folder);
    int n = 0;
    for (struct dirent *f; d && (f = readdir(d));)
        n += f->d_name[0] != '.' || strlen(f->d_name) > 2;
    if (d)
        closedir(d);
    return n;
}

static void round_trip(const char *path, bool gzip)
{
    err e = {0};
    enum { COUNT = 300000 };
    out *o = out_open(path, gzip, &e);
    for (int i = 0; o && i < COUNT; i++)
        out_format(o, "%d\r\n", i);
    ok(o && access(path, F_OK), "nothing under the name before the end (gzip %d)", gzip);
    ok(!out_close(o, &e), "closed (gzip %d) %s", gzip, e.text);
    in *s = in_open(path, &e);
    int64_t lines = 0, right = 0, n;
    char *line;
    bool whole = false;
    while (s && (n = in_line(s, &line, &whole, &e)) >= 0)
        right += atoi(line) == lines++ && line[n] == 0 && whole;
    ok(s && right == COUNT && in_lines(s) == COUNT && !e.status, "%d lines come back (gzip %d)", COUNT, gzip);
    in_close(s);
    unlink(path);
}

static void damaged(const char *path)
{
    err e = {0};
    out *o = out_open(path, true, &e);
    for (int i = 0; o && i < 100000; i++)
        out_format(o, "%d\n", i * 7919 % 1000003);
    out_close(o, &e);
    in *s = in_open(path, &e);
    char *bytes = NULL;
    in_close(s);
    FILE *f = fopen(path, "rb+");
    fseek(f, 0, SEEK_END);
    ok(ftruncate(fileno(f), ftell(f) - 9) == 0, "cut");
    fclose(f);
    s = in_open(path, &e);
    ok(s && in_all(s, &bytes, &e) == -1 && strstr(e.text, "cut short"), "a cut gzip stream: %s", e.text);
    in_close(s);
    unlink(path);
}

/* Zeros that end blocks, after the end and between members. */
static void padded(const char *path)
{
    err e = {0};
    char all[600] = {0}, *bytes = NULL;
    out *o = out_open(path, true, &e);
    out_text(o, "one");
    out_close(o, &e);
    FILE *f = fopen(path, "rb");
    size_t n = fread(all, 1, 100, f);
    fclose(f);
    memcpy(all + 300, all, n);
    in *s = in_memory(all, sizeof all, "memory", &e);
    ok(s && in_all(s, &bytes, &e) == 6 && !strcmp(bytes, "oneone"), "zeros after gzipped data are padding %s", e.text);
    in_close(s);
    free(bytes);
    unlink(path);
}

static void long_line(void)
{
    err e = {0};
    char *line;
    size_t size = (size_t)IN_LINE_MOST + 2;
    char *bytes = malloc(size);
    if (!bytes) {
        skip(2, "too little memory");
        return;
    }
    memset(bytes, 'x', size);
    bytes[IN_LINE_MOST] = '\n';
    in *s = in_memory(bytes, size, "memory", &e);
    ok(s && in_line(s, &line, NULL, &e) == IN_LINE_MOST, "the longest line");
    in_close(s);
    bytes[IN_LINE_MOST] = 'x';
    s = in_memory(bytes, size, "memory", &e);
    ok(s && in_line(s, &line, NULL, &e) == -2 && strstr(e.text, "memory:1: a line of more than 256 MiB"), "%s", e.text);
    in_close(s);
    free(bytes);
}

static void refused(const char *folder, const char *path)
{
    err e = {0};
    ok(!in_open(path, &e) && strstr(e.text, "No such file"), "missing: %s", e.text);
    e = (err){0};
    ok(!out_open(folder, false, &e) && strstr(e.text, "is a folder"), "a folder: %s", e.text);
    e = (err){0};
    ok(!out_open("/nonexistent/x", false, &e) && strstr(e.text, "cannot create"), "no such folder: %s", e.text);
    e = (err){0};
    in *s = in_memory("a\0b\n", 4, "memory", &e);
    char *line;
    ok(in_line(s, &line, NULL, &e) == -2 && strstr(e.text, "memory:1: a NUL byte"), "%s", e.text);
    in_close(s);
}

/* Less than is buffered, and so much that the first of its pieces fails. */
static void full(void)
{
    static const size_t sizes[] = {1, 8 << 20};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        err e = {0};
        out *o = out_open("/dev/full", false, &e);
        char *bytes = o ? calloc(sizes[i], 1) : NULL;
        if (bytes) {
            out_write(o, bytes, sizes[i]);
            ok(out_close(o, &e) == -1 && strstr(e.text, "No space"), "%zu bytes, a full disk: %s", sizes[i], e.text);
        } else {
            out_discard(o);
            skip(1, "no /dev/full");
        }
        free(bytes);
    }
}

static void given_up(const char *folder, const char *path)
{
    err e = {0};
    int before = files_in(folder);
    out *o = out_open(path, false, &e);
    out_text(o, "half");
    out_discard(o);
    ok(files_in(folder) == before, "a discarded output leaves no file");
    o = out_open(path, false, &e);
    out_text(o, "....tail");
    ok(!out_patch(o, 0, "head", 4, &e) && !out_close(o, &e), "patched");
    char text[9] = {0};
    int fd = open(path, O_RDONLY);
    ok(fd >= 0 && read(fd, text, 8) == 8 && !strcmp(text, "headtail"), "the head was written last: %s", text);
    close(fd);
    chmod(path, 0640);
    o = out_open(path, false, &e);
    out_text(o, "new");
    struct stat st;
    ok(!out_close(o, &e) && !stat(path, &st) && (st.st_mode & 0777) == 0640 && st.st_size == 3,
       "a file that is replaced keeps its mode");
    ok(files_in(folder) == before + 1, "and nothing else is left");
    unlink(path);
}

static void put_file(const char *folder, const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    if (f) {
        fputs(text, f);
        fclose(f);
    }
}

/* A file that was read is known again, by another name too. A new file that got its inode is not taken for it. */
static void inputs(const char *folder)
{
    char first[128], second[128];
    err e = {0};
    snprintf(first, sizeof first, "%s/first", folder);
    snprintf(second, sizeof second, "%s/second", folder);
    put_file(folder, "first", "read");
    in_close(in_open(first, &e));
    ok(inputs_has(first) && !link(first, second) && inputs_has(second), "a file that was read, by both of its names");
    unlink(first);
    unlink(second);
    ok(!inputs_has(first), "not once it is gone");
    usleep(20000); /* a clock of files may tick so rarely */
    put_file(folder, "second", "new");
    ok(!inputs_has(second), "nor what came in its place");
    unlink(second);
}

/* Memory in control groups: the least that one of them leaves, caches not counted. */
static void groups(const char *folder)
{
    char inner[96];
    snprintf(inner, sizeof inner, "%s/a", folder);
    mkdir(inner, 0700);
    int64_t unknown = mem_group_left(folder, "/a");
    ok(unknown > INT64_MAX / 8, "groups without limits");
    put_file(inner, "memory.max", "max\n");
    put_file(inner, "memory.current", "500\n");
    ok(mem_group_left(folder, "/a") == unknown, "max is no limit");
    put_file(folder, "memory.max", "1000\n");
    put_file(folder, "memory.current", "700\n");
    ok(mem_group_left(folder, "/a") == 300 && mem_group_left(folder, "/") == 300,
       "the outer group's limit holds inside");
    put_file(inner, "memory.max", "600\n");
    ok(mem_group_left(folder, "/a/") == 100, "the inner one is less");
    put_file(inner, "memory.stat", "anon 100\nfile 400\n");
    ok(mem_group_left(folder, "/a") == 300, "files in the cache are not counted");
    put_file(inner, "memory.max", "50\n");
    ok(mem_group_left(folder, "/a") == 0, "nothing is left");
    static const char *const made[] = {"a/memory.max", "a/memory.current", "a/memory.stat", "memory.max",
                                       "memory.current"};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
        char path[160];
        snprintf(path, sizeof path, "%s/%s", folder, made[i]);
        unlink(path);
    }
    rmdir(inner);
    ok(mem_available() > 0, "some memory is free here");
}

/* A pipe is widened to a large piece, for those alone, and passes it on whole. Neither end
 * waits, so that one left narrow fails. */
static void widened(void)
{
#ifdef F_GETPIPE_SZ
    enum { SIZE = 1 << 18 };
    err e = {0};
    int fd[2] = {-1, -1};
    char *bytes = calloc(SIZE, 1);
    out *o = bytes && !pipe2(fd, O_NONBLOCK) ? out_take(fd[1], "a pipe", &e) : NULL;
    const int narrow = fcntl(fd[0], F_GETPIPE_SZ);
    if (!o || narrow >= SIZE || fcntl(fd[0], F_SETPIPE_SZ, (int)SIZE) != SIZE ||
        fcntl(fd[0], F_SETPIPE_SZ, narrow) != narrow) {
        skip(3, "no wide pipe");
    } else {
        out_text(o, "small");
        out_flush(o);
        ok(fcntl(fd[0], F_GETPIPE_SZ) == narrow && read(fd[0], bytes, SIZE) == 5, "a pipe stays as it is");
        for (int i = 0; i < SIZE; i++)
            bytes[i] = (char)(i * 7 / 5);
        out_write(o, bytes, SIZE);
        out_flush(o);
        ok(!out_failed(o, &e) && fcntl(fd[0], F_GETPIPE_SZ) == SIZE, "and is widened for a large piece %s", e.text);
        char *got = calloc(SIZE, 1);
        ok(got && read(fd[0], got, SIZE) == SIZE && !memcmp(got, bytes, SIZE), "which comes whole");
        free(got);
    }
    out_discard(o);
    close(fd[0]);
    free(bytes);
#else
    skip(3, "pipes have one size");
#endif
}

int main(void)
{
    char folder[] = "/tmp/sinew-stream-XXXXXX", path[64];
    if (!mkdtemp(folder))
        return 1;
    snprintf(path, sizeof path, "%s/file", folder);
    round_trip(path, false);
    round_trip(path, true);
    damaged(path);
    padded(path);
    long_line();
    refused(folder, path);
    full();
    given_up(folder, path);
    inputs(folder);
    groups(folder);
    widened();
    rmdir(folder);

    err e = {0};
    in *s = in_memory("", 0, "memory", &e);
    ok(s && in_peek(s, &e) == -1 && !e.status, "an empty stream is at its end");
    in_close(s);
    void *p = mem_array(INT64_MAX, 16, "a test", &e);
    ok(!p && e.status, "a size that overflows is refused: %s", e.text);
    return done_testing();
}
