#include "link/track/track_lines.h"

#include "base/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes that a pipe may hold before its reader is behind: some 40 lines, so that poses that come together are kept. */
enum { BEHIND = 4096 };

int track_lines_open(track_lines *l, const char *path, err *e)
{
    struct stat about;
    const bool named = path && strcmp(path, "-") != 0;
    *l = (track_lines){.fd = named ? -1 : STDOUT_FILENO};
    if (named && (stat(path, &about) || S_ISREG(about.st_mode))) {
        l->file = out_open(path, false, e);
        return l->file ? 0 : -1;
    }
    if (named)
        l->fd = open(path, O_WRONLY | O_CLOEXEC);
    if (l->fd < 0)
        return err_system(e, path, errno, "cannot write");
    l->is_pipe = !fstat(l->fd, &about) && S_ISFIFO(about.st_mode);
    return 0;
}

/* Whether a line can be written without waiting. */
static bool has_room(track_lines *l)
{
    struct pollfd p = {.fd = l->fd, .events = POLLOUT};
    int held = 0;
    if (poll(&p, 1, 0) <= 0)
        return false;
    if (p.revents & (POLLERR | POLLNVAL))
        l->gone = true;
    return !l->gone && !(l->is_pipe && !ioctl(l->fd, FIONREAD, &held) && held > BEHIND);
}

static int put_in_file(track_lines *l, err *e)
{
    out_write(l->file, l->line, (size_t)l->size);
    l->size = 0;
    l->written++;
    return out_failed(l->file, e);
}

int track_lines_flush(track_lines *l, err *e)
{
    if (!l->size || l->gone)
        return 0;
    if (l->file)
        return put_in_file(l, e);
    if (!has_room(l))
        return 0;
    const ssize_t n = write(l->fd, l->line, (size_t)l->size);
    if (n < 0 && errno == EPIPE) {
        l->gone = true;
        return 0;
    }
    if (n < 0 && (errno == EAGAIN || errno == EINTR))
        return 0;
    if (n < l->size)
        return err_system(e, NULL, n < 0 ? errno : ENOSPC, "cannot write the poses");
    l->size = 0;
    l->written++;
    return 0;
}

int track_lines_put(track_lines *l, double time, const pose *at, err *e)
{
    double row[7];
    pose_to_row(at, row);
    if (track_lines_flush(l, e)) /* one that waited, where there is room by now */
        return -1;
    l->dropped += l->size > 0;
    l->size = snprintf(l->line, sizeof l->line, "%.6f", time);
    for (int i = 0; i < 7; i++)
        l->size += snprintf(l->line + l->size, sizeof l->line - (size_t)l->size, " %.9g", row[i] + 0.0);
    l->line[l->size++] = '\n';
    return track_lines_flush(l, e);
}

int track_lines_close(track_lines *l, bool failed, double seconds, err *e)
{
    const double until = clock_now() + seconds;
    while (l->size && !l->gone && !failed && clock_now() < until) {
        failed = track_lines_flush(l, e) != 0;
        if (l->size && !failed)
            clock_sleep(1e-3);
    }
    l->dropped += l->size > 0;
    l->size = 0;
    if (l->file)
        return out_end(l->file, failed, e);
    if (l->fd > STDERR_FILENO && close(l->fd) && !failed)
        return err_system(e, NULL, errno, "cannot write the poses");
    return failed ? -1 : 0;
}
