#include "base/inputs.h"

#include "base/mem.h"

#include <pthread.h>

typedef struct input {
    dev_t device;
    ino_t inode;
} input;

static struct {
    pthread_mutex_t busy;
    input *v;
    int64_t count, capacity;
} list = {.busy = PTHREAD_MUTEX_INITIALIZER};

static bool is_at(int64_t i, const struct stat *s)
{
    return list.v[i].device == s->st_dev && list.v[i].inode == s->st_ino;
}

int inputs_note(const struct stat *s, err *e)
{
    int bad = 0;
    if (!S_ISREG(s->st_mode))
        return 0;
    pthread_mutex_lock(&list.busy);
    if (!list.count || !is_at(list.count - 1, s)) { /* often a file is opened twice in a row */
        bad = mem_grow(&list.v, &list.capacity, list.count + 1, sizeof *list.v, "the list of inputs", e);
        if (!bad)
            list.v[list.count++] = (input){s->st_dev, s->st_ino};
    }
    pthread_mutex_unlock(&list.busy);
    return bad;
}

bool inputs_has(const char *path)
{
    struct stat s;
    bool found = false;
    if (stat(path, &s))
        return false;
    pthread_mutex_lock(&list.busy);
    for (int64_t i = 0; i < list.count && !found; i++)
        found = is_at(i, &s);
    pthread_mutex_unlock(&list.busy);
    return found;
}
