#include "base/growing.h"

#include "base/mem.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct growing {
    int fd;
    char *name;
    off_t size; /* of what is whole */
};

growing *growing_open(const char *path, err *e)
{
    if (!strcmp(path, "-")) {
        err_set(e, path, 0, "standard output is the model's; expected a file");
        return NULL;
    }
    growing *g = mem_array(1, sizeof *g, path, e);
    if (!g)
        return NULL;
    g->name = mem_text(path, e);
    g->fd = g->name ? open(path, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666) : -1;
    if (g->fd >= 0)
        return g;
    if (g->name)
        err_system(e, path, errno, "cannot open for writing");
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
            /* What of it is no regular file cannot be taken back. */
            if (size < whole && ftruncate(g->fd, g->size))
                errno = code;
            return err_system(e, g->name, code, "cannot write");
        }
    }
    g->size += (off_t)whole;
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
