#include "base/temporary.h"

#include "base/mem.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FOLDERS = 8 }; /* that are known to be swept */

static struct {
    char **path;
    int64_t count, capacity;
    bool watching;
    struct {
        dev_t device;
        ino_t inode;
    } swept[FOLDERS];
    int64_t sweeps;
    atomic_llong number; /* of the next name */
    atomic_flag busy; /* a thread uses the list. One that ends the process never clears it: the list stays as it is */
} list = {.busy = ATOMIC_FLAG_INIT};

/* All that end a process from outside and can be caught. */
static const int ends[] = {SIGINT,  SIGTERM,   SIGHUP,  SIGQUIT, SIGXCPU, SIGXFSZ,
                           SIGALRM, SIGVTALRM, SIGPROF, SIGUSR1, SIGUSR2, SIGPIPE};

enum { ENDS = sizeof ends / sizeof *ends };

static void fill_ends(sigset_t *set)
{
    sigemptyset(set);
    for (int i = 0; i < ENDS; i++)
        sigaddset(set, ends[i]);
}

static void remove_all(void)
{
    while (atomic_flag_test_and_set(&list.busy))
        ;
    for (int64_t i = 0; i < list.count; i++)
        unlink(list.path[i]);
}

/* Then the signal does what it would have done: SA_RESETHAND has put its default back. */
static void on_end(int signal_number)
{
    remove_all();
    raise(signal_number);
}

void temporary_end(int signal_number)
{
    sigset_t set;
    fill_ends(&set);
    pthread_sigmask(SIG_BLOCK, &set, NULL);
    remove_all();
    signal(signal_number, SIG_DFL);
    sigemptyset(&set);
    sigaddset(&set, signal_number);
    pthread_sigmask(SIG_UNBLOCK, &set, NULL);
    raise(signal_number);
}

/* A signal that was ignored when we began (nohup) stays so. */
static void watch(void)
{
    struct sigaction now, act = {.sa_handler = on_end, .sa_flags = (int)SA_RESETHAND};
    fill_ends(&act.sa_mask);
    for (int i = 0; i < ENDS; i++)
        if (!sigaction(ends[i], NULL, &now) && now.sa_handler == SIG_DFL)
            sigaction(ends[i], &act, NULL);
    list.watching = true;
}

/* The list is ours until release(): the signals stay away from this thread, and wait in others. */
static void hold(sigset_t *before)
{
    sigset_t set;
    fill_ends(&set);
    pthread_sigmask(SIG_BLOCK, &set, before);
    while (atomic_flag_test_and_set(&list.busy))
        ;
    if (!list.watching)
        watch();
}

static void release(const sigset_t *before)
{
    atomic_flag_clear(&list.busy);
    pthread_sigmask(SIG_SETMASK, before, NULL);
}

int temporary_make(const char *path, int (*make)(const void *context, const char *path), const void *context, err *e)
{
    sigset_t before;
    char *copy = mem_text(path, e);
    if (!copy) {
        errno = 0;
        return -1;
    }
    hold(&before);
    int made = -1, code = 0;
    if (!mem_grow(&list.path, &list.capacity, list.count + 1, sizeof *list.path, "names of files", e)) {
        made = make(context, path);
        code = errno;
    }
    if (made >= 0)
        list.path[list.count++] = copy;
    release(&before);
    if (made < 0)
        free(copy);
    errno = code;
    return made;
}

void temporary_drop(const char *path)
{
    sigset_t before;
    hold(&before);
    int64_t i = list.count - 1;
    while (i >= 0 && strcmp(list.path[i], path) != 0)
        i--;
    if (i >= 0) {
        free(list.path[i]);
        list.path[i] = list.path[--list.count];
    }
    if (!list.count) {
        free(list.path);
        list.path = NULL;
        list.capacity = 0;
    }
    release(&before);
}

/* ---- names, and what others left */

/* Whose processes we know by their numbers: a folder may be shared by hosts, and by containers on one. */
static uint32_t host(void)
{
    struct stat s = {0};
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    (void)stat("/proc/self/ns/pid", &s);
    uint32_t h = 2166136261u ^ (uint32_t)s.st_ino; /* FNV-1a */
    for (const char *p = name; *p; p++)
        h = (h ^ (unsigned char)*p) * 16777619u;
    return h;
}

void temporary_name(char name[TEMPORARY_NAME])
{
    snprintf(name, TEMPORARY_NAME, ".sinew-%08" PRIx32 "-%ld-%lld.tmp", host(), (long)getpid(),
             (long long)atomic_fetch_add(&list.number, 1));
}

/* Whether the name is one of this host's, and its process is gone. */
static bool is_left(const char *name)
{
    uint32_t of;
    long pid;
    int64_t i;
    int end = 0;
    if (sscanf(name, ".sinew-%8" SCNx32 "-%ld-%" SCNd64 ".tmp%n", &of, &pid, &i, &end) != 3 || !end || name[end])
        return false;
    return of == host() && pid > 0 && kill((pid_t)pid, 0) && errno == ESRCH;
}

/* Its process may be one that cannot be seen from here: then it has locked it. */
static void sweep_one(int folder, const char *name)
{
    struct stat s, named;
    const int fd = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
        return;
    if (!fstat(fd, &s) && S_ISREG(s.st_mode) && s.st_uid == geteuid() && !flock(fd, LOCK_EX | LOCK_NB) &&
        !fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) && s.st_dev == named.st_dev && s.st_ino == named.st_ino)
        unlinkat(folder, name, 0);
    close(fd);
}

/* Whether the folder is a new one, which from now on is known. */
static bool is_new(const struct stat *s)
{
    sigset_t before;
    bool known = false;
    hold(&before);
    for (int64_t i = 0; i < FOLDERS && i < list.sweeps; i++)
        known = known || (list.swept[i].device == s->st_dev && list.swept[i].inode == s->st_ino);
    if (!known) {
        list.swept[list.sweeps % FOLDERS].device = s->st_dev;
        list.swept[list.sweeps++ % FOLDERS].inode = s->st_ino;
    }
    release(&before);
    return !known;
}

void temporary_sweep(const char *folder)
{
    struct stat s;
    if (stat(*folder ? folder : ".", &s) || !is_new(&s))
        return;
    DIR *d = opendir(*folder ? folder : ".");
    if (!d)
        return;
    for (const struct dirent *f; (f = readdir(d));)
        if (is_left(f->d_name))
            sweep_one(dirfd(d), f->d_name);
    closedir(d);
}
