#define _GNU_SOURCE /* sched_getaffinity */
#include "cli/tool.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/num.h"
#include "base/path.h"
#include "base/thread.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { LINE = 4096 }; /* the most bytes of a message */

/* Bytes: with a smaller stack, libraries that tools call end in SIGSEGV (Embree, by 64 KiB). */
static const rlim_t enough_stack = (rlim_t)2 << 20;

typedef struct errand {
    int (*work)(int argc, char **argv);
    int argc;
    char **argv;
    sigset_t signals; /* the process's mask */
    int status;
} errand;

static void *run_errand(void *given)
{
    errand *r = given;
    pthread_sigmask(SIG_SETMASK, &r->signals, NULL);
    r->status = r->work(r->argc, r->argv);
    return NULL;
}

int tool_run(int (*work)(int argc, char **argv), int argc, char **argv)
{
    errand r = {.work = work, .argc = argc, .argv = argv, .status = STATUS_BAD};
    struct rlimit stack;
    pthread_t thread;
    sigset_t all;
    if (getrlimit(RLIMIT_STACK, &stack) || stack.rlim_cur >= enough_stack)
        return work(argc, argv);
    /* Signals are that thread's: this one only waits. */
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &r.signals);
    int code = thread_start(&thread, run_errand, &r);
    if (code)
        dprintf(STDERR_FILENO,
                "%s: %llu KiB of stack (ulimit -s) are too few, and a thread with more cannot be started: %s\n",
                argv[0] + path_folder(argv[0]), (unsigned long long)stack.rlim_cur / 1024, strerror(code));
    else
        pthread_join(thread, NULL);
    return r.status;
}

/* Answers -h, -V and --table on stdout. */
static int answer(tool *t, err *e)
{
    const opt_common *c = t->common;
    int failed = 0;
    out *o = out_open(NULL, false, e);
    if (!o)
        return -1;
    t->done = true;
    if (c->help)
        opt_help(t->table, o);
    else if (c->version)
        out_format(o, "%s (Sinew) %s\n", t->table->name, SINEW_VERSION);
    else
        failed = opt_table(t->table, c->table, o, e);
    return out_end(o, failed, e);
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

/* What is written over while it is read, or for want of a second look at the command line, is lost. */
static int refuse(const char *option, const char *path, const char *what, const char *other, err *e)
{
    err_usage(e, "%s '%.400s' would overwrite %s '%.400s'; expected another file", option, path, what, other);
    e->help = 0; /* --help says nothing of these files */
    return -1;
}

const char *tool_file(const tool *t, const opt *o)
{
    const char *text = o->kind == OPT_TEXT ? *(const char *const *)((const char *)t->common + o->to) : NULL;
    if (text && o->choices && strstr(o->choices, "convex:"))
        return strncmp(text, "convex:", 7) ? NULL : text + 7;
    return o->flags & (OPT_FILE | OPT_WRITES) ? text : NULL;
}

static int check_streams(const tool *t, const char *option, const char *path, err *e)
{
    const char *output = t->common->output, *lost = NULL;
    if (path_is_open(path, STDIN_FILENO))
        lost = "what is read on standard input";
    else if ((!output || !strcmp(output, "-")) && path_is_open(path, STDOUT_FILENO))
        lost = "what goes to standard output";
    if (!lost)
        return 0;
    err_usage(e, "%s '%.400s' would overwrite %s; expected another file", option, path, lost);
    e->help = 0;
    return -1;
}

int tool_check_written(const tool *t, const char *option, const char *path, err *e)
{
    char name[64], what[80];
    const opt *o;
    if (!strcmp(path, "-"))
        return 0;
    for (int i = 0; i < t->operands; i++)
        if (path_is_same(path, t->operand[i]))
            return refuse(option, path, "what is read,", t->operand[i], e);
    for (int i = 0; (o = opt_at(t->table, i)); i++) {
        const char *other = strcmp(opt_dashed(o, name), option) != 0 ? tool_file(t, o) : NULL;
        snprintf(what, sizeof what, "the file of %s", name);
        if (other && path_is_same(path, other))
            return refuse(option, path, what, other, e);
    }
    return strcmp(option, "-o") != 0 ? check_streams(t, option, path, e) : 0;
}

static int check_written(const tool *t, err *e)
{
    char name[64];
    const opt *o;
    for (int i = 0; (o = opt_at(t->table, i)); i++) {
        const char *path = o->flags & OPT_WRITES ? tool_file(t, o) : NULL;
        if (path && tool_check_written(t, opt_dashed(o, name), path, e))
            return -1;
    }
    return 0;
}

int tool_begin(tool *t, const opt_tool *table, int argc, char **argv, void *options, err *e)
{
    *t = (tool){.table = table, .common = options};
    signal(SIGXFSZ, SIG_IGN); /* write() then says what is wrong */
    if (fill_descriptors(e))
        return -1;
    t->operands = opt_parse(table, argc, argv, options, e);
    if (t->operands < 0)
        return -1;
    if (t->common->help || t->common->version || t->common->table)
        return answer(t, e);
    t->operand = argv + 1;
    if (check_written(t, e))
        return -1;
    t->provenance = opt_provenance(table, options, t->operands, argv + 1, e);
    return t->provenance ? 0 : -1;
}

int tool_begin_job(tool *t, const tool *of, void *options, const char *about, err *e)
{
    *t = *of;
    t->common = options;
    t->about = about;
    t->provenance = NULL;
    if (check_written(t, e))
        return -1;
    t->provenance = opt_provenance(t->table, options, t->operands, t->operand, e);
    return t->provenance ? 0 : -1;
}

int tool_provenance(tool *t, err *e, const char *format, ...)
{
    char more[LINE];
    va_list args;
    va_start(args, format);
    vsnprintf(more, sizeof more, format, args);
    va_end(args);
    const size_t size = strlen(t->provenance) + strlen(more) + 2;
    char *all = mem_array((int64_t)size, 1, "provenance", e);
    if (!all)
        return -1;
    snprintf(all, size, "%s%s%s", t->provenance, *t->provenance ? " " : "", more);
    free(t->provenance);
    t->provenance = all;
    return 0;
}

/* "tool: kind: text": one line in one write, so that those of the tools in a pipe do not mix. */
static void print(const tool *t, const char *kind, const char *text)
{
    char line[LINE];
    const char *about = t->about ? t->about : "";
    int n = snprintf(line, sizeof line, "%s: %s%s%s%s", t->table->name, kind, about, *about ? ": " : "", text);
    if (n > LINE - 2)
        n = LINE - 2;
    line[n] = '\0';
    chars_tame(line);
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

static void print_error(const tool *t, const err *e)
{
    char text[LINE];
    const size_t n = strlen(e->text);
    if (e->help)
        snprintf(text, sizeof text, "%s%s try %s --help", e->text, n && e->text[n - 1] == '?' ? "" : ";",
                 opt_command(t->table));
    print(t, "", e->help ? text : e->text);
}

int tool_end(tool *t, const err *e)
{
    if (e->status && !e->silent)
        print_error(t, e);
    if (e->status && e->help == ERR_SHOW_USAGE)
        print_usage(t);
    tool_free(t);
    return e->status;
}

void tool_free(tool *t)
{
    free(t->provenance);
    t->provenance = NULL;
}

void tool_failed(const tool *t, const err *e)
{
    print(t, "", e->text);
}

int tool_need_stdin(const char *what, err *e)
{
    if (!isatty(STDIN_FILENO))
        return 0;
    if (e->status)
        return -1;
    err_usage(e, "reads %s on stdin, which is a terminal", what);
    e->help = ERR_SHOW_USAGE;
    return -1;
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

int tool_table(const tool *t, const text_table *rows, err *e, const char *title, ...)
{
    char text[LINE];
    va_list args;
    if (t->common->quiet)
        return 0;
    va_start(args, title);
    vsnprintf(text, sizeof text, title, args);
    va_end(args);
    chars_tame(text);
    char *lines = text_table_is_empty(rows) ? mem_text("", e) : text_table_lines(rows, e);
    out *o = lines ? out_memory(e) : NULL;
    if (o) {
        size_t size;
        out_format(o, "%s: %s\n%s", t->table->name, text, lines);
        const unsigned char *bytes = out_bytes(o, &size);
        fwrite(bytes, 1, size, stderr);
        out_discard(o);
    }
    free(lines);
    return o ? 0 : -1;
}

/* Notes a warning as given. Returns whether it was new. */
static bool is_new(tool_told *told, const char *line)
{
    bool found = false;
    pthread_mutex_lock(&told->lock);
    for (int i = 0; !found && i < told->lines.count; i++)
        found = !strcmp(told->lines.line[i], line);
    if (!found)
        notes_add(&told->lines, "%s", line);
    pthread_mutex_unlock(&told->lock);
    return !found;
}

void tool_warn(const tool *t, notes *n)
{
    for (int i = 0; i < n->count; i++)
        if (!t->told || is_new(t->told, n->line[i]))
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
    return (int)num_clamp_int(processors(), 1, 1024);
}
