/* The loss of power: preloaded into a program (LD_PRELOAD), it ends it at its n-th fsync, from 1, that SINEW_FAULT_AT gives, as by
 * kill -9, and takes from every file that it has open what was written since that file was stored last. Where SINEW_FAULT_COUNT
 * names a file, that gets the number of syncs at the end.
 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1 /* RTLD_NEXT */
#endif
// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): those of the C library begin with __
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FILES = 256 };

/* A regular file, by whatever descriptors, and how much of it would be there. */
typedef struct known {
    dev_t device;
    ino_t inode;
    off_t stored;
} known;

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static known file[FILES];
static int files;
static long long syncs;

static void *real_function(const char *name)
{
    void *found = dlsym(RTLD_NEXT, name);
    if (!found)
        abort();
    return found;
}

/* The file at fd, noted as it is now where it is new; NULL: it is no regular one. */
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

static void lose(void)
{
    struct stat s;
    for (int fd = STDERR_FILENO + 1; fd < FILES; fd++) {
        const int writes = fcntl(fd, F_GETFL) & O_ACCMODE;
        const known *k = writes ? find(fd, &s) : NULL;
        if (k && s.st_size > k->stored && ftruncate(fd, k->stored))
            abort();
    }
    kill(getpid(), SIGKILL);
}

ssize_t write(int fd, const void *from, size_t size)
{
    ssize_t (*next)(int, const void *, size_t);
    struct stat s;
    void *found = real_function("write");
    memcpy(&next, &found, sizeof next);
    pthread_mutex_lock(&mutex);
    find(fd, &s);
    pthread_mutex_unlock(&mutex);
    return next(fd, from, size);
}

int fsync(int fd)
{
    int (*next)(int);
    struct stat s;
    const char *at = getenv("SINEW_FAULT_AT");
    void *found = real_function("fsync");
    memcpy(&next, &found, sizeof next);
    pthread_mutex_lock(&mutex);
    if (++syncs == (at ? atoll(at) : 0))
        lose();
    int bad = next(fd);
    known *k = find(fd, &s);
    if (k && !bad)
        k->stored = s.st_size;
    pthread_mutex_unlock(&mutex);
    return bad;
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("SINEW_FAULT_COUNT");
    FILE *f = path ? fopen(path, "w") : NULL;
    if (!f)
        return;
    fprintf(f, "%lld\n", syncs);
    fclose(f);
}
// NOLINTEND(readability-inconsistent-declaration-parameter-name)
