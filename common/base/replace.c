#define _GNU_SOURCE /* O_TMPFILE */
#include "base/replace.h"

#include "base/inputs.h"
#include "base/mem.h"
#include "base/path.h"
#include "base/temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAMES = 1000, PIECE = 1 << 24 }; /* names to try, at most; bytes */

/* False: errno. A file system that has no permissions to give has its own. */
static bool give_mode(int fd, mode_t mode)
{
    return !fchmod(fd, mode) || errno == EPERM || errno == ENOTSUP || errno == ENOSYS;
}

/* Gives a file the permissions that one made by open(2) would have, or those of the file that it replaces. */
static int set_mode(int fd, const char *target, err *e)
{
    struct stat s;
    const int there = path_look(target, &s, e);
    if (there < 0)
        return -1;
    const mode_t mask = umask(0);
    umask(mask);
    return give_mode(fd, there ? s.st_mode & 07777 : 0666 & ~mask)
               ? 0
               : err_system(e, target, errno, "cannot set its permissions");
}

/* The lock tells whoever sweeps that the file is somebody's. */
static int open_locked(const char *path, int flags)
{
    const int fd = open(path, flags | O_RDWR | O_CLOEXEC, 0600);
    if (fd >= 0)
        (void)flock(fd, LOCK_EX | LOCK_NB);
    return fd;
}

static int make_new(const void *context, const char *path)
{
    (void)context;
    return open_locked(path, O_CREAT | O_EXCL);
}

/* Gives the nameless file at *context that name. */
static int make_link(const void *context, const char *path)
{
    const int *fd = context;
    char self[64];
    snprintf(self, sizeof self, "/proc/self/fd/%d", *fd);
    return linkat(AT_FDCWD, self, AT_FDCWD, path, AT_SYMLINK_FOLLOW);
}

/* Makes a file of a name beside its place that nothing else has. Returns what make does, or -1 with errno, which is 0
 * where e is filled. */
static int take_name(replace *r, int (*make)(const void *context, const char *path), err *e)
{
    char name[TEMPORARY_NAME];
    const size_t n = path_folder(r->target);
    char *folder = path_join(r->target, n, "", e);
    int made = -1, code = folder ? EEXIST : 0;
    if (folder)
        temporary_sweep(folder);
    for (int i = 0; code == EEXIST && i < NAMES; i++) {
        temporary_name(name);
        free(r->temporary);
        r->temporary = path_join(r->target, n, name, e);
        errno = 0;
        made = r->temporary ? temporary_make(r->temporary, make, &r->fd, e) : -1;
        code = r->temporary && made < 0 ? errno : 0;
    }
    if (made < 0) {
        free(r->temporary);
        r->temporary = NULL;
    }
    free(folder);
    errno = code;
    return made;
}

/* -1: the file system has no files without a name. */
static int open_nameless(const char *target)
{
    err ignored = {0};
    size_t n = path_folder(target);
    char *folder = n ? path_join(target, n, "", &ignored) : path_join("./", 2, "", &ignored);
    const int fd = folder && !access("/proc/self/fd", X_OK) ? open_locked(folder, O_TMPFILE) : -1;
    free(folder);
    return fd;
}

int replace_open(replace *r, const char *path, err *e)
{
    *r = (replace){.fd = -1, .target = path_target(path, e)};
    if (!r->target)
        return -1;
    r->fd = open_nameless(r->target);
    if (r->fd < 0) {
        r->fd = take_name(r, make_new, e);
        if (r->fd < 0 && errno)
            err_system(e, path, errno, "cannot create");
    }
    if (r->fd >= 0 && !set_mode(r->fd, r->target, e))
        return 0;
    replace_discard(r);
    return -1;
}

int replace_store(int fd)
{
    int bad;
    do
        bad = fsync(fd);
    while (bad && errno == EINTR);
    return bad && errno != EINVAL && errno != ENOTSUP ? -1 : 0;
}

/* 0, or -1 with errno. */
static int store_names(const char *path)
{
    char real[PATH_MAX], folder[PATH_MAX];
    const char *at = realpath(path, real) ? real : path; /* /dev/stdout is, of a pipe, nothing */
    const size_t n = path_folder(at);
    if (n)
        snprintf(folder, sizeof folder, "%.*s", (int)n, at);
    else
        snprintf(folder, sizeof folder, ".");
    const int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0)
        return errno == EACCES ? 0 : -1;
    const int bad = replace_store(fd) && errno != EROFS ? -1 : 0, code = errno;
    close(fd);
    errno = code;
    return bad;
}

int replace_store_names(const char *path, const char *name, err *e)
{
    return store_names(path) ? err_system(e, name, errno, "is there, but its folder cannot be stored") : 0;
}

int replace_settle(replace *r, const char *name, err *e)
{
    if (inputs_has(r->target))
        return err_set(e, name, 0, "is a file that was read; expected another to write");
    if (replace_store(r->fd))
        return err_system(e, name, errno, "cannot write");
    /* What only close() would tell: a name is given while the file is open. */
    const int copy = fcntl(r->fd, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    return copy >= 0 && close(copy) && errno != EINTR ? err_system(e, name, errno, "cannot write") : 0;
}

/* Whether link(2) failed because the file system cannot give a name to a nameless file; other errors are errors. */
static bool is_refusal(int code)
{
    return code == EPERM || code == EXDEV || code == EOPNOTSUPP || code == ENOSYS || code == EINVAL || code == ENOENT;
}

static int copy_bytes(int from, int to)
{
    off_t at = 0;
    ssize_t n;
    do
        n = sendfile(to, from, &at, PIECE);
    while (n > 0 || (n < 0 && errno == EINTR));
    return n < 0 ? -1 : 0;
}

/* The nameless file becomes another, which has a name. */
static int copy_nameless(replace *r, err *e)
{
    struct stat s;
    const int from = r->fd, to = fstat(from, &s) ? -1 : take_name(r, make_new, e);
    if (to < 0)
        return -1;
    r->fd = to;
    const int bad = !give_mode(to, s.st_mode & 07777) || copy_bytes(from, to) || replace_store(to) ? -1 : 0,
              code = errno;
    close(from);
    errno = code;
    return bad;
}

static int name_nameless(replace *r, const char *name, err *e)
{
    if (take_name(r, make_link, e) >= 0)
        return 0;
    if (!is_refusal(errno) || copy_nameless(r, e))
        return errno ? err_system(e, name, errno, "cannot create") : -1;
    return 0;
}

int replace_park(replace *r, const char *name, err *e)
{
    if (!r->temporary && name_nameless(r, name, e))
        return -1;
    close(r->fd);
    r->fd = -1;
    return 0;
}

/* A nameless file goes where none is at once. No link replaces a file: there it takes a name beside it first. */
static int put_in_place(replace *r, const char *name, err *e)
{
    if (!r->temporary && !make_link(&r->fd, r->target))
        return 0;
    if (!r->temporary && name_nameless(r, name, e))
        return -1;
    if (rename(r->temporary, r->target))
        return err_system(e, name, errno, "cannot rename into place");
    temporary_drop(r->temporary);
    free(r->temporary);
    r->temporary = NULL;
    return 0;
}

int replace_place(replace *r, const char *name, err *e)
{
    const int bad = put_in_place(r, name, e);
    replace_discard(r);
    return bad;
}

int replace_finish(replace *r, const char *name, err *e)
{
    char *target = mem_text(r->target, e);
    int bad = !target || replace_settle(r, name, e) || put_in_place(r, name, e) ? -1 : 0;
    replace_discard(r);
    if (!bad)
        bad = replace_store_names(target, name, e);
    free(target);
    return bad;
}

void replace_discard(replace *r)
{
    if (r->target && r->fd >= 0)
        close(r->fd);
    if (r->temporary) {
        unlink(r->temporary);
        temporary_drop(r->temporary);
    }
    free(r->temporary);
    free(r->target);
    *r = (replace){0};
}
