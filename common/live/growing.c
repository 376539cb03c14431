#include "live/growing.h"

#include "base/mem.h"
#include "base/replace.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct growing {
    int fd;
    char *name;
    off_t size; /* of what is whole */
    bool named; /* its name is stored */
};

/* A new file, or what is to be kept of one. */
static int open_at(const char *path, int64_t keep, err *e)
{
    struct stat s;
    int fd = open(path, O_WRONLY | O_CREAT | (keep ? 0 : O_TRUNC) | O_APPEND | O_CLOEXEC, 0666);
    if (fd < 0)
        return err_system(e, path, errno, "cannot open for writing");
    const bool unknown = keep && fstat(fd, &s);
    if (!keep || (!unknown && !S_ISREG(s.st_mode)))
        return fd;
    if (!unknown && s.st_size < (off_t)keep)
        err_set(e, path, 0, "has %lld bytes; expected the first %lld of this run's", (long long)s.st_size,
                (long long)keep);
    else if (unknown || ftruncate(fd, (off_t)keep))
        err_system(e, path, errno, "cannot write");
    else
        return fd;
    close(fd);
    return -1;
}

growing *growing_open(const char *path, int64_t keep, err *e)
{
    if (!strcmp(path, "-")) {
        err_set(e, path, 0, "standard output is the model's; expected a file");
        return NULL;
    }
    growing *g = mem_array(1, sizeof *g, path, e);
    if (!g)
        return NULL;
    g->name = mem_text(path, e);
    g->fd = g->name ? open_at(path, keep, e) : -1;
    g->size = (off_t)keep;
    if (g->fd >= 0)
        return g;
    free(g->name);
    free(g);
    return NULL;
}

int growing_put(growing *g, const void *lines, size_t size, err *e)
{
    const char *at = lines;
    const size_t whole = size;
    while (size) {
        ssize_t n = write(g->fd, at, size);
        if (n >= 0) {
            at += n;
            size -= (size_t)n;
        } else if (errno != EINTR) {
            const int code = errno;
            /* What of it is not a regular file cannot be taken back. */
            if (size < whole && ftruncate(g->fd, g->size))
                errno = code;
            return err_system(e, g->name, code, "cannot write");
        }
    }
    g->size += (off_t)whole;
    return 0;
}

int64_t growing_size(const growing *g)
{
    return g->size;
}

int growing_store(growing *g, err *e)
{
    if (replace_store(g->fd))
        return err_system(e, g->name, errno, "cannot write");
    if (!g->named && replace_store_names(g->name, g->name, e))
        return -1;
    g->named = true;
    return 0;
}

int growing_close(growing *g, err *e)
{
    if (!g)
        return 0;
    int bad = close(g->fd) && errno != EINTR ? err_system(e, g->name, errno, "cannot write") : 0;
    free(g->name);
    free(g);
    return bad;
}
