#include "cli/batch_files.h"

#include "base/mem.h"
#include "base/path.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where a file is, or would be. */
static char *where(const char *path, err *e)
{
    char real[PATH_MAX];
    err ignored = {0};
    char *target = path_target(path, &ignored);
    const char *of = target ? target : path;
    const size_t n = path_folder(of);
    char *folder = n ? path_join(of, n, "", e) : path_join(".", 1, "", e), *to = NULL;
    if (folder && realpath(folder, real)) {
        const size_t size = strlen(real) + strlen(of + n) + 2;
        to = mem_array((int64_t)size, 1, "a path", e);
        if (to)
            snprintf(to, size, "%s/%s", real, of + n);
    } else if (folder) {
        to = mem_text(of, e);
    }
    free(folder);
    free(target);
    return to;
}

int batch_files_note(batch_files *f, const char *path, int64_t line, bool is_written, err *e)
{
    struct stat s;
    if (!stat(path, &s) && S_ISCHR(s.st_mode))
        return 0;
    if (MEM_ROOM(&f->file, &f->room, f->files + 1, "the jobs' files", e))
        return -1;
    batch_file *to = &f->file[f->files];
    *to = (batch_file){.where = where(path, e), .line = line, .is_written = is_written};
    f->files += to->where != NULL;
    return to->where ? 0 : -1;
}

typedef struct placed {
    const char *where;
    int64_t file;
} placed;

static int by_place(const void *a, const void *b)
{
    const placed *x = a, *y = b;
    return strcmp(x->where, y->where);
}

int batch_files_sort(batch_files *f, err *e)
{
    int64_t count = 0;
    placed *order = mem_array(f->files + 1, sizeof *order, "the jobs' files", e);
    f->users = mem_array(f->files + 1, sizeof *f->users, "the jobs' files", e);
    for (int64_t i = 0; order && i < f->files; i++)
        order[i] = (placed){f->file[i].where, i};
    if (order)
        qsort(order, (size_t)f->files, sizeof *order, by_place);
    for (int64_t i = 0; order && i < f->files; i++) {
        count += i && strcmp(order[i].where, order[i - 1].where) != 0;
        f->file[order[i].file].users = count;
    }
    const bool failed = !order || !f->users;
    free(order);
    return failed ? -1 : 0;
}

static int check(const batch_files *f, const batch_file *file, err *e)
{
    const batch_users *by = &f->users[file->users];
    const int64_t other = by->writes || !file->is_written ? by->writes : by->reads;
    if (!other)
        return 0;
    return err_set(e, NULL, 0, "%s '%.400s', which the job of line %lld %s; expected another file",
                   file->is_written ? "writes" : "reads", file->where, (long long)other,
                   by->writes ? "writes" : "reads");
}

int batch_files_take(batch_files *f, int64_t line, err *e)
{
    int64_t end = f->next;
    int failed = 0;
    for (; end < f->files && f->file[end].line <= line; end++)
        failed = failed || check(f, &f->file[end], e);
    for (; f->next < end; f->next++) {
        const batch_file *file = &f->file[f->next];
        batch_users *by = &f->users[file->users];
        int64_t *first = file->is_written ? &by->writes : &by->reads;
        if (!failed && !*first)
            *first = line;
    }
    return failed ? -1 : 0;
}

void batch_files_free(batch_files *f)
{
    for (int64_t i = 0; i < f->files; i++)
        free(f->file[i].where);
    free(f->file);
    free(f->users);
    *f = (batch_files){0};
}
