#include "base/outs.h"

#include "base/mem.h"
#include "base/path.h"
#include "base/replace.h"
#include "base/temporary.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What path stands for, which is the caller's; NULL with e filled where no file can be put there. */
static char *find_target(const char *path, err *e)
{
    struct stat s;
    bool there = !stat(path, &s);
    if (there && !S_ISREG(s.st_mode)) {
        err_set(e, path, 0, "is no regular file; expected one, or a new name");
        return NULL;
    }
    if (there && access(path, W_OK)) {
        err_system(e, path, errno, "cannot write");
        return NULL;
    }
    return path_target(path, e);
}

/* A short name in the target's folder that nothing has. */
static char *name_part(outs *o, const char *target, err *e)
{
    char name[64], *part = NULL;
    struct stat s;
    do {
        free(part);
        snprintf(name, sizeof name, ".sinew-%ld-%" PRId64 ".part", (long)getpid(), o->number++);
        part = path_join(target, path_folder(target), name, e);
    } while (part && !lstat(part, &s));
    return part;
}

static int check_folder(const char *path, const char *target, err *e)
{
    size_t n = path_folder(target);
    char *folder = path_join(n ? target : ".", n ? n : 1, "", e);
    if (!folder)
        return -1;
    int bad = access(folder, W_OK | X_OK) ? err_system(e, path, errno, "cannot create") : 0;
    free(folder);
    return bad;
}

out *outs_open(outs *s, const char *path, err *e)
{
    if (mem_grow(&s->file, &s->capacity, s->count + 1, sizeof *s->file, "files", e))
        return NULL;
    outs_file f = {.target = find_target(path, e)};
    if (f.target && !check_folder(path, f.target, e))
        f.part = name_part(s, f.target, e);
    out *o = f.part && !temporary_add(f.part, e) ? out_open_passing(f.part, e) : NULL;
    if (!o) {
        if (f.part)
            temporary_drop(f.part);
        free(f.part);
        free(f.target);
        return NULL;
    }
    s->file[s->count++] = f;
    return o;
}

/* A file that is replaced hands its permissions on. */
static void keep_mode(const outs_file *f)
{
    struct stat s;
    if (!stat(f->target, &s))
        (void)!chmod(f->part, s.st_mode & 07777);
}

/* Waits for the names of files, once for each run of them in one folder. */
static int store_names(const outs *s, err *e)
{
    for (int64_t i = 0; i < s->count; i++) {
        const char *at = s->file[i].target, *next = i + 1 < s->count ? s->file[i + 1].target : NULL;
        const size_t n = path_folder(at);
        if ((!next || n != path_folder(next) || memcmp(at, next, n) != 0) && replace_store_names(at, at, e))
            return -1;
    }
    return 0;
}

int outs_commit(outs *s, err *e)
{
    for (int64_t i = 0; i < s->count; i++) {
        outs_file *f = &s->file[i];
        keep_mode(f);
        if (rename(f->part, f->target))
            return err_system(e, f->target, errno, "cannot rename into place");
        temporary_drop(f->part);
        free(f->part);
        f->part = NULL;
    }
    return store_names(s, e);
}

void outs_free(outs *s)
{
    for (int64_t i = 0; i < s->count; i++) {
        if (s->file[i].part) {
            unlink(s->file[i].part);
            temporary_drop(s->file[i].part);
        }
        free(s->file[i].part);
        free(s->file[i].target);
    }
    free(s->file);
    *s = (outs){0};
}
