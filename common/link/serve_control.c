#include "link/serve_control.h"

#include "base/mem.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINES = 1000, LINE = 200 }; /* that wait at most; bytes of one: less than a pipe takes at once */

struct serve_control {
    const char *path;
    int fd; /* -1: nobody reads yet */
    char line[LINES][LINE];
    int first, count;
};

serve_control *serve_control_open(const char *path, err *e)
{
    struct stat is;
    if (stat(path, &is)) {
        err_system(e, path, errno, "cannot open");
        return NULL;
    }
    if (!S_ISFIFO(is.st_mode)) {
        err_set(e, path, 0, "is no FIFO; expected one that us-slice --live --control reads (mkfifo)");
        return NULL;
    }
    serve_control *c = mem_array(1, sizeof *c, "controls", e);
    if (!c)
        return NULL;
    c->path = path;
    c->fd = -1;
    return c;
}

void serve_control_close(serve_control *c)
{
    if (c && c->fd >= 0)
        close(c->fd);
    free(c);
}

int serve_control_put(serve_control *c, const char *line, err *e)
{
    if (!c)
        return err_set(e, NULL, 0, "sinew igtl-out has no --control, a FIFO that us-slice reads");
    if (c->count == LINES)
        return err_set(e, NULL, 0, "%d lines wait already, which us-slice does not read", LINES);
    snprintf(c->line[(c->first + c->count++) % LINES], LINE, "%s\n", line);
    return 0;
}

int serve_control_write(serve_control *c)
{
    if (c && c->count && c->fd < 0)
        c->fd = open(c->path, O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    while (c && c->count && c->fd >= 0) {
        const char *line = c->line[c->first];
        if (write(c->fd, line, strlen(line)) < 0) { /* all of a short line, or nothing */
            if (errno != EAGAIN && errno != EINTR) {
                close(c->fd);
                c->fd = -1;
            }
            break;
        }
        c->first = (c->first + 1) % LINES;
        c->count--;
    }
    return c ? c->count : 0;
}

struct pollfd serve_control_waits(const serve_control *c)
{
    return (struct pollfd){.fd = c && c->count ? c->fd : -1, .events = POLLOUT};
}
