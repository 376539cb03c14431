#include "base/path.h"

#include "base/inputs.h"
#include "base/mem.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINKS = 40 }; /* the most to follow */

bool path_is_obj(const char *path)
{
    static const char *const ends[] = {".obj", ".obj.gz"};
    const size_t size = strlen(path);
    for (int i = 0; i < 2; i++)
        if (size >= strlen(ends[i]) && !strcasecmp(path + size - strlen(ends[i]), ends[i]))
            return true;
    return false;
}

size_t path_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

char *path_join(const char *folder, size_t n, const char *name, err *e)
{
    size_t size = n + strlen(name) + 1;
    char *path = mem_array((int64_t)size, 1, "a path", e);
    if (path)
        snprintf(path, size, "%.*s%s", (int)n, folder, name);
    return path;
}

/* What the link at path says, seen from here; the caller's. */
static char *read_link(const char *path, err *e)
{
    char to[PATH_MAX];
    ssize_t n = readlink(path, to, sizeof to - 1);
    if (n < 0) {
        err_system(e, path, errno, "cannot read the link");
        return NULL;
    }
    to[n] = 0;
    return path_join(path, to[0] == '/' ? 0 : path_folder(path), to, e);
}

char *path_target(const char *path, err *e)
{
    struct stat s;
    char *at = mem_text(path, e);
    int links = 0;
    while (at && !lstat(at, &s) && S_ISLNK(s.st_mode)) {
        char *next = NULL;
        if (links++ == LINKS)
            err_system(e, path, ELOOP, "cannot create");
        else
            next = read_link(at, e);
        free(at);
        at = next;
    }
    if (!at)
        return NULL;
    size_t n = strlen(at);
    int code = 0;
    if (!n || at[n - 1] == '/')
        code = EISDIR;
    else if (lstat(at, &s) && errno != ENOENT)
        code = errno;
    if (!code)
        return at;
    err_system(e, path, code, "cannot create");
    free(at);
    return NULL;
}

/* The folder that a path's file is in. */
static bool stat_folder(const char *path, struct stat *s)
{
    err ignored = {0};
    const size_t n = path_folder(path);
    char *folder = n ? path_join(path, n, "", &ignored) : path_join(".", 1, "", &ignored);
    bool found = folder && !stat(folder, s);
    free(folder);
    return found;
}

int path_look(const char *path, struct stat *s, err *e)
{
    if (!stat(path, s))
        return 1;
    return errno == ENOENT ? 0 : err_system(e, path, errno, "cannot create");
}

static bool is_one(const struct stat *s, const struct stat *t)
{
    return s->st_dev == t->st_dev && s->st_ino == t->st_ino;
}

/* Whether two names, of which neither is there, would be of one file. */
static bool would_be_one(const char *a, const char *b)
{
    struct stat s, t;
    err ignored = {0};
    char *x = path_target(a, &ignored), *y = path_target(b, &ignored);
    bool same = x && y && !strcmp(x + path_folder(x), y + path_folder(y)) && stat_folder(x, &s) && stat_folder(y, &t) &&
                is_one(&s, &t);
    free(x);
    free(y);
    return same;
}

bool path_is_same(const char *a, const char *b)
{
    struct stat s, t;
    const bool is_a = !stat(a, &s), is_b = !stat(b, &t);
    if (is_a && is_b)
        return S_ISREG(s.st_mode) && is_one(&s, &t);
    return !is_a && !is_b && would_be_one(a, b);
}

bool path_is_open(const char *path, int fd)
{
    struct stat s, t;
    return !stat(path, &s) && (S_ISREG(s.st_mode) || S_ISFIFO(s.st_mode) || S_ISSOCK(s.st_mode)) && !fstat(fd, &t) &&
           is_one(&s, &t);
}

static bool is_within(const char *folder, const char *file)
{
    size_t n = strlen(folder);
    return !strncmp(folder, file, n) && (n == 1 || file[n] == '/');
}

char *path_beside(const char *path, const char *name, const char *place, err *e)
{
    char root[PATH_MAX], real[PATH_MAX];
    struct stat about;
    size_t n = path_folder(path);
    char *folder = path_join(path, n, n ? "" : ".", e);
    if (name[0] == '/')
        n = 0;
    char *file = folder ? path_join(path, n, name, e) : NULL;
    int failed = file ? 0 : -1;
    if (file && (!realpath(folder, root) || !realpath(file, real)))
        failed = err_system(e, file, errno, "cannot open");
    else if (file && !is_within(root, real))
        failed = err_set(e, place, 0, "names '%.200s', outside its folder; expected a file beside it", name);
    else if (file && (stat(real, &about) || !S_ISREG(about.st_mode)))
        failed = err_set(e, file, 0, "is not a regular file; expected one that '%.200s' names", place);
    else if (file)
        failed = inputs_note_path(real, e);
    free(folder);
    if (!failed)
        return file;
    free(file);
    return NULL;
}
