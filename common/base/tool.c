#define _GNU_SOURCE /* sched_getaffinity */
#include "base/tool.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINE = 4096 }; /* the most bytes of a message */

/* Answers -h, -V and --table on stdout. */
static int answer(tool *t, err *e)
{
    const opt_common *c = t->common;
    out *o = out_open(NULL, false, e);
    if (!o)
        return -1;
    t->done = true;
    if (c->help)
        opt_usage(t->table, o);
    else if (c->version)
        out_format(o, "%s (Sinew) %s\n", t->table->name, SINEW_VERSION);
    else if (opt_table(t->table, c->table, o, e)) {
        out_discard(o);
        return -1;
    }
    return out_close(o, e);
}

/* A closed descriptor would become the next file's, and messages would go into the output. What is opened in its place
 * fails as the closed one did: it cannot be read (0) or written (1, 2). */
static int fill_descriptors(err *e)
{
    for (int fd = 0; fd <= STDERR_FILENO; fd++) {
        if (fcntl(fd, F_GETFD) >= 0 || errno != EBADF)
            continue;
        if (open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0)
            return err_system(e, "/dev/null", errno, "cannot open");
    }
    return 0;
}

/* Whether -o would write over the file at path. */
static bool is_output(const opt_common *c, const char *path)
{
    struct stat a, b;
    return path && c->output && !stat(c->output, &a) && !stat(path, &b) && S_ISREG(a.st_mode) && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

/* What is written over while it is read, or for want of a second look at the command line, is lost. */
static int check_output(const tool *t, char *const *operand, const void *options, err *e)
{
    const char *lost = NULL;
    for (int i = 0; i < t->operands; i++)
        lost = is_output(t->common, operand[i]) ? operand[i] : lost;
    for (int i = 0; i < opt_own(t->table); i++) {
        const opt *o = opt_at(t->table, i);
        const char *path =
            o->flags & OPT_FILE && o->kind == OPT_TEXT ? *(const char *const *)((const char *)options + o->to) : NULL;
        lost = is_output(t->common, path) ? path : lost;
    }
    return lost ? err_usage(e, "-o '%s' would overwrite what is read; expected another file", lost) : 0;
}

int tool_begin(tool *t, const opt_tool *table, int argc, char **argv, void *options, err *e)
{
    *t = (tool){.table = table, .common = options};
    if (fill_descriptors(e))
        return -1;
    t->operands = opt_parse(table, argc, argv, options, e);
    if (t->operands < 0)
        return -1;
    if (t->common->help || t->common->version || t->common->table)
        return answer(t, e);
    if (check_output(t, argv + 1, options, e))
        return -1;
    t->provenance = opt_provenance(table, options, t->operands, argv + 1, e);
    return t->provenance ? 0 : -1;
}

/* Whether a character at p steers a terminal: C0, DEL, and C1 in UTF-8 (the first of its two bytes). */
static bool steers(const char *p)
{
    unsigned char c = (unsigned char)p[0], next = (unsigned char)(c ? p[1] : 0);
    return c < 0x20 || c == 0x7f || (c == 0xc2 && next >= 0x80 && next < 0xa0);
}

/* "tool: kind: text": one line in one write, so that those of the tools in a pipe do not mix. */
static void print(const tool *t, const char *kind, const char *text)
{
    char line[LINE];
    int n = snprintf(line, sizeof line, "%s: %s%s", t->table->name, kind, text);
    if (n > LINE - 2)
        n = LINE - 2;
    for (char *p = line; *p; p++)
        if (steers(p)) {
            p[1] = (unsigned char)*p == 0xc2 ? '?' : p[1];
            *p = '?';
        }
    line[n++] = '\n';
    fwrite(line, 1, (size_t)n, stderr);
}

static void print_usage(const tool *t)
{
    err ignored = {0};
    size_t size;
    out *o = out_memory(&ignored);
    if (!o)
        return;
    opt_usage(t->table, o);
    const unsigned char *text = out_bytes(o, &size);
    fwrite(text, 1, size, stderr);
    out_discard(o);
}

int tool_end(tool *t, const err *e)
{
    if (e->status && !e->silent)
        print(t, "", e->text);
    if (e->status && e->usage)
        print_usage(t);
    free(t->provenance);
    t->provenance = NULL;
    return e->status;
}

int tool_need_stdin(const char *what, err *e)
{
    if (!isatty(STDIN_FILENO))
        return 0;
    e->usage = !e->status;
    return err_usage(e, "reads %s on stdin, which is a terminal", what);
}

SINEW_PRINTF(2, 0) static void say(const tool *t, const char *format, va_list args)
{
    char text[LINE];
    vsnprintf(text, sizeof text, format, args);
    print(t, "", text);
}

void tool_say(const tool *t, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    if (!t->common->quiet)
        say(t, format, args);
    va_end(args);
}

void tool_detail(const tool *t, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    if (t->common->verbose && !t->common->quiet)
        say(t, format, args);
    va_end(args);
}

void tool_warn(const tool *t, notes *n)
{
    for (int i = 0; i < n->count; i++)
        print(t, "warning: ", n->line[i]);
    notes_free(n);
}

/* How many processors the process may run on. */
static int64_t processors(void)
{
    cpu_set_t set;
    if (!sched_getaffinity(0, sizeof set, &set))
        return CPU_COUNT(&set);
    return sysconf(_SC_NPROCESSORS_ONLN);
}

int tool_threads(const tool *t, err *e)
{
    if (t->common->threads > 0)
        return (int)t->common->threads;
    const char *text = getenv("SINEW_THREADS");
    int64_t threads;
    if (text && *text) {
        if (!num_int(text, 1, 1024, &threads))
            return (int)threads;
        return err_set(e, NULL, 0, "SINEW_THREADS '%s': expected a whole number from 1 to 1024", text);
    }
    int64_t all = processors();
    return all < 1 ? 1 : all > 1024 ? 1024 : (int)all;
}
