/* The loss of power: preloaded into a program (LD_PRELOAD), it ends it at its n-th fsync, from 1, that
 * SINEW_FAULT_AT gives, as by kill -9, or after all is done, where n is one past the last. What write() gave a
 * file since that was stored last is taken from it. A name that was made, given to another file or removed since
 * its folder was stored is as it was, but for those whose bits SINEW_FAULT_KEPT has, in the order in which they
 * were touched. Where SINEW_FAULT_COUNT names a file, that gets the number of syncs at the end. Only the calls
 * below are known, of all that the C library has.
 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1 /* RTLD_NEXT */
#endif
// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): those of the C library begin with __
#include "next.h"

#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FILES = 256, NAMES = 4096, CLOSED = 512 }; /* closed: files that are stay open to us from this number on */

/* A regular file, by whatever descriptors, and how much of it would be there. */
typedef struct known {
    dev_t device;
    ino_t inode;
    off_t stored;
} known;

/* A name whose folder has not been stored since it was touched. */
typedef struct touched {
    char *name;
    char *was;    /* another name of what it was of before, or NULL: of nothing */
    dev_t device; /* of its folder */
    ino_t folder;
} touched;

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static known file[FILES];
static int files;
static touched changed[NAMES];
static int changes;
static long long syncs, backups;

static int really_link(const char *from, const char *to)
{
    NEXT(int, "link", const char *, const char *);
    return next(from, to);
}

static int really_unlink(const char *path)
{
    NEXT(int, "unlink", const char *);
    return next(path);
}

static int really_rename(const char *from, const char *to)
{
    NEXT(int, "rename", const char *, const char *);
    return next(from, to);
}

/* The file at fd, noted as it is now where it is new; NULL: it is no regular one. What
 * is noted keeps its number: see close(). */
static known *find(int fd, struct stat *s)
{
    if (fstat(fd, s) || !S_ISREG(s->st_mode))
        return NULL;
    for (int i = 0; i < files; i++)
        if (file[i].inode == s->st_ino && file[i].device == s->st_dev)
            return file + i;
    if (files == FILES)
        abort();
    file[files] = (known){s->st_dev, s->st_ino, s->st_size};
    return file + files++;
}

/* A name is about to change: what it is of gets another one, until that is stored. A device keeps its name whatever is
 * done: what is lost with the power is of disks, and links in /dev are for nobody to make. */
static void touch(const char *path)
{
    char beside[PATH_MAX];
    const char *slash = strrchr(path, '/');
    const int length = slash ? (int)(slash - path) + 1 : 0;
    struct stat s;
    for (int i = 0; i < changes; i++)
        if (!strcmp(changed[i].name, path))
            return;
    snprintf(beside, sizeof beside, "%.*s", length ? length : 1, length ? path : ".");
    if (changes == NAMES)
        abort();
    if (stat(beside, &s))
        return; /* whatever it is, it fails */
    touched t = {.name = strdup(path), .device = s.st_dev, .folder = s.st_ino};
    snprintf(beside, sizeof beside, "%.*s.power-%lld-%lld", length, path, (long long)getpid(), backups++);
    if (!lstat(path, &s)) {
        if (!S_ISREG(s.st_mode) && !S_ISLNK(s.st_mode)) {
            free(t.name);
            return;
        }
        if (really_link(path, beside))
            abort();
        t.was = strdup(beside);
    }
    if (!t.name)
        abort();
    changed[changes++] = t;
}

static void drop(const touched *t)
{
    if (t->was)
        really_unlink(t->was);
    free(t->name);
    free(t->was);
}

static void lose(void)
{
    struct stat s;
    const char *kept = getenv("SINEW_FAULT_KEPT");
    const long bits = kept ? atol(kept) : 0;
    for (int fd = STDOUT_FILENO; fd < CLOSED + FILES; fd++) {
        const int writes = fcntl(fd, F_GETFL) & O_ACCMODE;
        const known *k = writes && fd != STDERR_FILENO ? find(fd, &s) : NULL;
        if (k && s.st_size > k->stored && ftruncate(fd, k->stored))
            abort();
    }
    for (int i = 0; i < changes; i++) {
        if (i < 31 && bits >> i & 1)
            drop(&changed[i]);
        else if (!changed[i].was)
            really_unlink(changed[i].name);
        else if (really_rename(changed[i].was, changed[i].name) ||
                 (!lstat(changed[i].was, &s) && really_unlink(changed[i].was)))
            abort(); /* names of one file stay two */
    }
    kill(getpid(), SIGKILL);
}

/* The names of that folder are stored. */
static void keep_names(const struct stat *folder)
{
    int left = 0;
    for (int i = 0; i < changes; i++)
        if (changed[i].folder == folder->st_ino && changed[i].device == folder->st_dev)
            drop(&changed[i]);
        else
            changed[left++] = changed[i];
    changes = left;
}

ssize_t write(int fd, const void *from, size_t size)
{
    struct stat s;
    NEXT(ssize_t, "write", int, const void *, size_t);
    pthread_mutex_lock(&mutex);
    find(fd, &s);
    pthread_mutex_unlock(&mutex);
    return next(fd, from, size);
}

int open(const char *path, int flags, ...)
{
    mode_t mode = 0;
    NEXT(int, "open", const char *, int, ...);
    if (flags & O_CREAT || (flags & O_TMPFILE) == O_TMPFILE) {
        va_list more;
        va_start(more, flags);
        mode = va_arg(more, mode_t);
        va_end(more);
    }
    pthread_mutex_lock(&mutex);
    if (flags & O_CREAT)
        touch(path);
    pthread_mutex_unlock(&mutex);
    return next(path, flags, mode);
}

int link(const char *from, const char *to)
{
    pthread_mutex_lock(&mutex);
    touch(to);
    pthread_mutex_unlock(&mutex);
    return really_link(from, to);
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
    NEXT(int, "linkat", int, const char *, int, const char *, int);
    pthread_mutex_lock(&mutex);
    touch(to);
    pthread_mutex_unlock(&mutex);
    return next(from_folder, from, to_folder, to, flags);
}

int unlink(const char *path)
{
    pthread_mutex_lock(&mutex);
    touch(path);
    pthread_mutex_unlock(&mutex);
    return really_unlink(path);
}

int rename(const char *from, const char *to)
{
    pthread_mutex_lock(&mutex);
    touch(from);
    touch(to);
    pthread_mutex_unlock(&mutex);
    return really_rename(from, to);
}

/* Whether it is the n-th sync. */
static bool is_time(long long n)
{
    const char *at = getenv("SINEW_FAULT_AT");
    return at && atoll(at) == n;
}

/* What was written is to be lost all the same, and nothing else is to be taken for that file. */
int close(int fd)
{
    struct stat s;
    NEXT(int, "close", int);
    pthread_mutex_lock(&mutex);
    const int how = fcntl(fd, F_GETFL);
    if (fd < CLOSED && how >= 0 && how & O_ACCMODE && find(fd, &s) && fcntl(fd, F_DUPFD_CLOEXEC, CLOSED) < 0)
        abort();
    pthread_mutex_unlock(&mutex);
    return next(fd);
}

int fsync(int fd)
{
    struct stat s;
    NEXT(int, "fsync", int);
    pthread_mutex_lock(&mutex);
    if (is_time(++syncs))
        lose();
    int bad = next(fd);
    known *k = find(fd, &s);
    if (k && !bad)
        k->stored = s.st_size;
    if (!k && !bad && !fstat(fd, &s) && S_ISDIR(s.st_mode))
        keep_names(&s);
    pthread_mutex_unlock(&mutex);
    return bad;
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("SINEW_FAULT_COUNT");
    if (is_time(syncs + 1))
        lose();
    while (changes)
        drop(&changed[--changes]);
    FILE *f = path ? fopen(path, "w") : NULL;
    if (!f)
        return;
    fprintf(f, "%lld\n", syncs);
    fclose(f);
}
// NOLINTEND(readability-inconsistent-declaration-parameter-name)
