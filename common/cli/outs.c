#include "cli/outs.h"

#include "base/mem.h"
#include "base/path.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

struct outs_file {
    replace file; /* once it is closed */
    char *target; /* its place; owned */
    outs_file *next;
};

enum { FEW = 16, MANY = 1 << 16 }; /* descriptors */

/* Where something else than a regular file is, none can be put. */
static int check_place(const char *path, err *e)
{
    struct stat s;
    const int there = path_look(path, &s, e);
    if (there < 0)
        return -1;
    if (there && !S_ISREG(s.st_mode))
        return err_set(e, path, 0, "is not a regular file; expected one, or a new name");
    return there && access(path, W_OK) ? err_system(e, path, errno, "cannot write") : 0;
}

/* Half of the descriptors that the process may have, once it may have all that it can. */
static int64_t most_descriptors(void)
{
    struct rlimit r;
    if (getrlimit(RLIMIT_NOFILE, &r))
        return FEW;
    const rlim_t most = r.rlim_max < MANY ? r.rlim_max : MANY;
    if (r.rlim_cur < most && !setrlimit(RLIMIT_NOFILE, &(struct rlimit){most, r.rlim_max}))
        r.rlim_cur = most;
    return r.rlim_cur < MANY ? (int64_t)r.rlim_cur / 2 : MANY / 2;
}

/* Leaves a descriptor for one more. */
static int park_one(outs *s, err *e)
{
    s->most = s->most ? s->most : most_descriptors();
    while (s->open && s->descriptors >= s->most) {
        outs_file *f = s->open;
        s->open = f->next;
        s->descriptors--;
        if (f->file.target)
            return replace_park(&f->file, f->target, e);
    }
    return 0;
}

static void add(outs *s, outs_file *f)
{
    *(s->last ? &s->last->next : &s->first) = f;
    s->last = f;
    s->open = s->open ? s->open : f;
    s->descriptors++;
}

out *outs_open(outs *s, const char *path, err *e)
{
    if (check_place(path, e) || park_one(s, e))
        return NULL;
    outs_file *f = mem_array(1, sizeof *f, "files", e);
    if (!f)
        return NULL;
    f->target = path_target(path, e);
    out *o = f->target ? out_open_kept(path, &f->file, e) : NULL;
    if (o) {
        add(s, f);
        return o;
    }
    free(f->target);
    free(f);
    return NULL;
}

/* Waits for the names of files, once for each run of them in one folder. */
static int store_names(const outs *s, err *e)
{
    for (const outs_file *f = s->first; f; f = f->next) {
        const size_t n = path_folder(f->target);
        const bool goes_on = f->next && n == path_folder(f->next->target) && !memcmp(f->target, f->next->target, n);
        if (!goes_on && replace_store_names(f->target, f->target, e))
            return -1;
    }
    return 0;
}

int outs_commit(outs *s, err *e)
{
    for (outs_file *f = s->first; f; f = f->next)
        if (replace_place(&f->file, f->target, e))
            return -1;
    return store_names(s, e);
}

void outs_free(outs *s)
{
    while (s->first) {
        outs_file *f = s->first;
        s->first = f->next;
        replace_discard(&f->file);
        free(f->target);
        free(f);
    }
    *s = (outs){0};
}
