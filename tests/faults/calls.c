/* Lets the calls fail by which files are written, or ends the program at one: preloaded into a program (LD_PRELOAD), it
 * counts the calls of the kind that SINEW_FAULT_CALL names (open, stat, write, fsync, link, rename, unlink, truncate,
 * chmod, lock, close; any: all of them), from the beginning of main on, and the one whose number SINEW_FAULT_AT gives,
 * from 1, fails with the error that SINEW_FAULT_ERROR names; with SINEW_FAULT_ON set, so do all after it. Or the
 * process gets the signal of the number SINEW_FAULT_SIGNAL, before that call, or with SINEW_FAULT_AFTER set after it.
 * With SINEW_FAULT_NAMED set, no file system has files without a name. Where SINEW_FAULT_COUNT names a file, it gets
 * the number of calls at the end. A close that fails has closed.
 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1 /* RTLD_NEXT, O_TMPFILE */
#endif
// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): those of the C library begin with __
#include "next.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

int __libc_start_main(int (*begin)(int, char **, char **), int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end);

static struct {
    atomic_llong count;
    const char *call;
    long long at;
    int error, signal;
    bool on, after, named, counting;
    int (*begin)(int, char **, char **);
} fault;

typedef struct fate {
    bool fails, ends; /* ends: the signal comes after the call */
} fate;

/* What becomes of a call of a kind. */
static fate fate_of(const char *kind)
{
    if (!fault.counting || !fault.call || (strcmp(fault.call, kind) != 0 && strcmp(fault.call, "any") != 0))
        return (fate){false, false};
    const long long n = atomic_fetch_add(&fault.count, 1) + 1;
    if (!fault.at || (fault.on ? n < fault.at : n != fault.at))
        return (fate){false, false};
    if (fault.signal && !fault.after)
        kill(getpid(), fault.signal);
    if (fault.error)
        errno = fault.error;
    return (fate){fault.error, fault.signal && fault.after};
}

/* After the call, whose errno stays. */
static void end_by(fate f)
{
    const int code = errno;
    if (f.ends)
        kill(getpid(), fault.signal);
    errno = code;
}

/* The body of a function: `kind`, and the call that it makes where it does not fail. */
#define CALL(type, kind, call)                                                                                         \
    const fate f = fate_of(kind);                                                                                      \
    if (f.fails)                                                                                                       \
        return -1;                                                                                                     \
    const type result = call;                                                                                          \
    end_by(f);                                                                                                         \
    return result

int open(const char *path, int flags, ...)
{
    NEXT(int, "open", const char *, int, ...);
    va_list more;
    va_start(more, flags);
    const bool nameless = (flags & O_TMPFILE) == O_TMPFILE;
    const mode_t mode = flags & O_CREAT || nameless ? va_arg(more, mode_t) : 0;
    va_end(more);
    if (nameless && fault.named) {
        errno = EOPNOTSUPP;
        return -1;
    }
    CALL(int, "open", next(path, flags, mode));
}

int stat(const char *path, struct stat *s)
{
    NEXT(int, "stat", const char *, struct stat *);
    CALL(int, "stat", next(path, s));
}

int lstat(const char *path, struct stat *s)
{
    NEXT(int, "lstat", const char *, struct stat *);
    CALL(int, "stat", next(path, s));
}

int fstat(int fd, struct stat *s)
{
    NEXT(int, "fstat", int, struct stat *);
    CALL(int, "stat", next(fd, s));
}

ssize_t write(int fd, const void *from, size_t size)
{
    NEXT(ssize_t, "write", int, const void *, size_t);
    CALL(ssize_t, "write", next(fd, from, size));
}

ssize_t pwrite(int fd, const void *from, size_t size, off_t at)
{
    NEXT(ssize_t, "pwrite", int, const void *, size_t, off_t);
    CALL(ssize_t, "write", next(fd, from, size, at));
}

ssize_t sendfile(int to, int from, off_t *at, size_t size)
{
    NEXT(ssize_t, "sendfile", int, int, off_t *, size_t);
    CALL(ssize_t, "write", next(to, from, at, size));
}

int fsync(int fd)
{
    NEXT(int, "fsync", int);
    CALL(int, "fsync", next(fd));
}

int link(const char *from, const char *to)
{
    NEXT(int, "link", const char *, const char *);
    CALL(int, "link", next(from, to));
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
    NEXT(int, "linkat", int, const char *, int, const char *, int);
    CALL(int, "link", next(from_folder, from, to_folder, to, flags));
}

int rename(const char *from, const char *to)
{
    NEXT(int, "rename", const char *, const char *);
    CALL(int, "rename", next(from, to));
}

int unlink(const char *path)
{
    NEXT(int, "unlink", const char *);
    CALL(int, "unlink", next(path));
}

int ftruncate(int fd, off_t size)
{
    NEXT(int, "ftruncate", int, off_t);
    CALL(int, "truncate", next(fd, size));
}

int fchmod(int fd, mode_t mode)
{
    NEXT(int, "fchmod", int, mode_t);
    CALL(int, "chmod", next(fd, mode));
}

int flock(int fd, int how)
{
    NEXT(int, "flock", int, int);
    CALL(int, "lock", next(fd, how));
}

int close(int fd)
{
    NEXT(int, "close", int);
    const fate f = fate_of("close");
    const int code = errno, result = next(fd);
    end_by(f);
    errno = f.fails ? code : errno;
    return f.fails ? -1 : result;
}

static void tell(void)
{
    const char *path = getenv("SINEW_FAULT_COUNT");
    fault.counting = false;
    FILE *f = path ? fopen(path, "w") : NULL;
    if (!f)
        return;
    fprintf(f, "%lld\n", (long long)atomic_load(&fault.count));
    fclose(f);
}

static int error_of(const char *name)
{
    static const struct {
        const char *name;
        int error;
    } errors[] = {{"EIO", EIO},       {"ENOSPC", ENOSPC}, {"EDQUOT", EDQUOT}, {"EACCES", EACCES},
                  {"EMFILE", EMFILE}, {"EPERM", EPERM},   {"EROFS", EROFS},   {"EXDEV", EXDEV}};
    for (size_t i = 0; name && i < sizeof errors / sizeof *errors; i++)
        if (!strcmp(errors[i].name, name))
            return errors[i].error;
    return 0;
}

static int begin_counting(int argc, char **argv, char **environment)
{
    const char *at = getenv("SINEW_FAULT_AT"), *number = getenv("SINEW_FAULT_SIGNAL");
    fault.call = getenv("SINEW_FAULT_CALL");
    fault.at = at ? atoll(at) : 0;
    fault.error = error_of(getenv("SINEW_FAULT_ERROR"));
    fault.signal = number ? atoi(number) : 0;
    fault.on = getenv("SINEW_FAULT_ON") != NULL;
    fault.after = getenv("SINEW_FAULT_AFTER") != NULL;
    fault.named = getenv("SINEW_FAULT_NAMED") != NULL;
    if (fault.signal) /* who started the tests may ignore it, as shells do for what runs in the background */
        signal(fault.signal, SIG_DFL);
    atexit(tell);
    fault.counting = true;
    return fault.begin(argc, argv, environment);
}

int __libc_start_main(int (*begin)(int, char **, char **), int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end)
{
    int (*next)(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void), void *);
    void *found = real_function("__libc_start_main");
    memcpy(&next, &found, sizeof next);
    fault.begin = begin;
    return next(begin_counting, argc, argv, init, fini, rtld_fini, stack_end);
}
// NOLINTEND(readability-inconsistent-declaration-parameter-name)
