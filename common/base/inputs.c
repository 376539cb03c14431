#define _GNU_SOURCE /* statx */

#include "base/inputs.h"

#include "base/mem.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <sys/stat.h>

/* A file system gives the inode of a file that is gone to the next one. The time of
 * birth, where it is known, tells them apart. */
typedef struct input {
    uint32_t major, minor;
    uint64_t inode;
    int64_t born; /* s, and ns of it; 0: not known */
    uint32_t born_ns;
} input;

static struct {
    pthread_mutex_t busy;
    input *v;
    int64_t count, capacity;
} list = {.busy = PTHREAD_MUTEX_INITIALIZER};

/* Fills *to of the file at path, or of fd where path is "". Returns whether it is there and a regular file. */
static bool find(int fd, const char *path, input *to)
{
    struct statx s;
    if (statx(fd, path, AT_EMPTY_PATH, STATX_TYPE | STATX_INO | STATX_BTIME, &s) || !S_ISREG(s.stx_mode))
        return false;
    *to = (input){.major = s.stx_dev_major, .minor = s.stx_dev_minor, .inode = s.stx_ino};
    if (s.stx_mask & STATX_BTIME) {
        to->born = s.stx_btime.tv_sec;
        to->born_ns = s.stx_btime.tv_nsec;
    }
    return true;
}

static bool is_same(const input *a, const input *b)
{
    return a->inode == b->inode && a->major == b->major && a->minor == b->minor && a->born == b->born &&
           a->born_ns == b->born_ns;
}

static int note(const input *file, err *e)
{
    int bad = 0;
    pthread_mutex_lock(&list.busy);
    if (!list.count || !is_same(&list.v[list.count - 1], file)) { /* often a file is opened twice in a row */
        bad = mem_grow(&list.v, &list.capacity, list.count + 1, sizeof *list.v, "the list of inputs", e);
        if (!bad)
            list.v[list.count++] = *file;
    }
    pthread_mutex_unlock(&list.busy);
    return bad;
}

int inputs_note(int fd, err *e)
{
    input file;
    return find(fd, "", &file) ? note(&file, e) : 0;
}

int inputs_note_path(const char *path, err *e)
{
    input file;
    return find(AT_FDCWD, path, &file) ? note(&file, e) : 0;
}

bool inputs_has(const char *path)
{
    input file;
    bool found = false;
    if (!find(AT_FDCWD, path, &file))
        return false;
    pthread_mutex_lock(&list.busy);
    for (int64_t i = 0; i < list.count && !found; i++)
        found = is_same(&list.v[i], &file);
    pthread_mutex_unlock(&list.busy);
    return found;
}
