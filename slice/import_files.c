#include "slice/import_files.h"

#include "base/in.h"
#include "base/mem.h"
#include "base/path.h"
#include "slice/dicom.h"
#include "slice/sweep.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { DICOM_HEAD = 132, HEADER = 65536 };

const char *import_base(const char *path)
{
    return path + path_folder(path);
}

/* path becomes the list's. */
static int add(import_files *f, char *path, bool named, err *e)
{
    int64_t room = f->capacity;
    if (!path || MEM_ROOM(&f->path, &f->capacity, f->count + 1, "files", e) ||
        (f->capacity != room && mem_grow(&f->named, &room, f->capacity, sizeof *f->named, "files", e))) {
        free(path);
        return -1;
    }
    f->path[f->count] = path;
    f->named[f->count++] = named;
    return 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int find_in(import_files *f, const char *folder, int depth, err *e);

static int find_at(import_files *f, char *path, bool named, int depth, err *e)
{
    struct stat s;
    if ((named ? stat(path, &s) : lstat(path, &s))) {
        int code = errno;
        err_system(e, import_base(path), code, "cannot read");
    } else if (S_ISDIR(s.st_mode)) {
        int code = find_in(f, path, depth + 1, e);
        free(path);
        return code;
    } else if (named || S_ISREG(s.st_mode)) {
        return add(f, path, named, e);
    }
    free(path);
    return e->status ? -1 : 0;
}

static char *join(const char *folder, const char *name, err *e)
{
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = mem_array((int64_t)size, 1, "a path", e);
    if (path) {
        memcpy(path, folder, strlen(folder));
        path[strlen(folder)] = '/';
        memcpy(path + strlen(folder) + 1, name, strlen(name));
    }
    return path;
}

static int find_in(import_files *f, const char *folder, int depth, err *e)
{
    char **path = NULL;
    int64_t count = 0, capacity = 0;
    if (depth > IMPORT_DEPTH)
        return err_set(e, import_base(folder), 0, "folders more than %d deep", IMPORT_DEPTH);
    DIR *d = opendir(folder);
    if (!d)
        return err_system(e, import_base(folder), errno, "cannot read the folder");
    for (struct dirent *one = readdir(d); one && !e->status; one = readdir(d)) {
        if (one->d_name[0] == '.' || MEM_ROOM(&path, &capacity, count + 1, "files", e))
            continue;
        path[count] = join(folder, one->d_name, e);
        count += path[count] != NULL;
    }
    closedir(d);
    if (count)
        qsort(path, (size_t)count, sizeof *path, by_name);
    for (int64_t i = 0; i < count; i++)
        if (e->status)
            free(path[i]);
        else
            find_at(f, path[i], false, depth, e);
    free(path);
    return e->status ? -1 : 0;
}

int import_find(import_files *f, char *const *operand, int count, err *e)
{
    for (int i = 0; i < count; i++) {
        char *path = mem_text(operand[i], e);
        if (!path || find_at(f, path, true, 0, e))
            return -1;
    }
    return f->count ? 0 : err_set(e, NULL, 0, "no files; expected DICOM, NRRD or MetaImage");
}

void import_free(import_files *f)
{
    for (int64_t i = 0; i < f->count; i++)
        free(f->path[i]);
    free(f->path);
    free(f->named);
    *f = (import_files){0};
}

import_kind import_kind_of(const import_files *f, err *e)
{
    char head[HEADER];
    if (f->count != 1 || !f->named[0])
        return IMPORT_DICOM;
    in *s = in_open(f->path[0], e);
    int64_t got = s ? in_read(s, head, sizeof head, e) : -1;
    in_close(s);
    if (got < 0 || dicom_is(head, (size_t)got))
        return IMPORT_DICOM;
    return sweep_is(head, (size_t)got) ? IMPORT_SWEEP : IMPORT_VOLUME;
}

int64_t import_read(import_files *f, int64_t i, char **bytes, err *e)
{
    char head[DICOM_HEAD];
    in *s = in_open(f->path[i], e);
    int64_t got = s ? in_read(s, head, sizeof head, e) : -1, rest = 0;
    char *more = NULL;
    if (got >= 0 && !dicom_is(head, (size_t)got)) {
        f->other++;
        got = 0;
        if (f->named[i])
            got = err_set(e, import_base(f->path[i]), 0, "not a DICOM file; expected DICM after 128 bytes");
    } else if (got > 0) {
        rest = in_all(s, &more, e);
        *bytes = rest < 0 ? NULL : realloc(more, (size_t)rest + DICOM_HEAD);
        if (*bytes) {
            memmove(*bytes + got, *bytes, (size_t)rest);
            memcpy(*bytes, head, (size_t)got);
            got += rest;
        } else {
            free(more);
            got = rest < 0 ? -1 : err_memory(e, "a file");
        }
    }
    in_close(s);
    return got;
}
