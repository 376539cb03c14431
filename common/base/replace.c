#include "base/replace.h"

#include "base/path.h"
#include "base/temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAMES = 1000 }; /* to try, at most */

/* The permissions that a file made by open(2) would have, or those of the file that it replaces. */
static mode_t wanted_mode(const char *target)
{
    struct stat s;
    if (!stat(target, &s))
        return s.st_mode & 07777;
    mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

/* Gives the file a name beside its place that nothing else has: a new file (nameless NULL) or the nameless one. */
static int take_name(replace *r, const char *nameless, const char *path, err *e)
{
    char name[64];
    for (int i = 0; i < NAMES; i++) {
        snprintf(name, sizeof name, ".sinew-%ld-%d.tmp", (long)getpid(), i);
        r->temporary = path_join(r->target, path_folder(r->target), name, e);
        if (!r->temporary)
            return -1;
        int done = nameless ? linkat(AT_FDCWD, nameless, AT_FDCWD, r->temporary, AT_SYMLINK_FOLLOW)
                            : (r->fd = open(r->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
        if (done >= 0)
            return temporary_add(r->temporary, e);
        int code = errno;
        free(r->temporary);
        r->temporary = NULL;
        if (code != EEXIST)
            return err_system(e, path, code, "cannot create");
    }
    return err_system(e, path, EEXIST, "cannot create");
}

/* A file without a name where the system can: a killed process then leaves nothing. -1: it cannot. */
static int open_nameless(const char *target)
{
    int fd = -1;
#ifdef O_TMPFILE
    err ignored = {0};
    size_t n = path_folder(target);
    char *folder = path_join(n ? target : "./", n ? n : 2, "", &ignored);
    if (folder && !access("/proc/self/fd", X_OK))
        fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    free(folder);
#else
    (void)target;
#endif
    return fd;
}

int replace_open(replace *r, const char *path, err *e)
{
    *r = (replace){.fd = -1, .target = path_target(path, e)};
    if (!r->target)
        return -1;
    r->fd = open_nameless(r->target);
    if (r->fd < 0 && take_name(r, NULL, path, e)) {
        replace_discard(r);
        return -1;
    }
    fchmod(r->fd, wanted_mode(r->target));
    return 0;
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
    snprintf(folder, sizeof folder, "%.*s", n ? (int)n : 1, n ? at : ".");
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

int replace_finish(replace *r, const char *name, err *e)
{
    char self[64];
    snprintf(self, sizeof self, "/proc/self/fd/%d", r->fd);
    int bad = !replace_store(r->fd) ? 0 : err_system(e, name, errno, "cannot write");
    if (!bad && !r->temporary)
        bad = take_name(r, self, name, e);
    int fd = r->fd;
    r->fd = -1;
    if (close(fd) && errno != EINTR && !bad)
        bad = err_system(e, name, errno, "cannot write");
    if (!bad && rename(r->temporary, r->target))
        bad = err_system(e, name, errno, "cannot rename into place");
    if (!bad) {
        temporary_drop(r->temporary);
        free(r->temporary);
        r->temporary = NULL;
        if (!r->passing)
            bad = replace_store_names(r->target, name, e);
    }
    replace_discard(r);
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
