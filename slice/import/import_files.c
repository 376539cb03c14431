#include "slice/import/import_files.h"

#include "base/in.h"
#include "base/mem.h"
#include "base/path.h"
#include "slice/import/dicom_image.h"
#include "slice/import/dicom_inflate.h"
#include "slice/import/sweep.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { DICOM_HEAD = 132, HEADER = 65536 };

const char *import_base(const char *path)
{
    return path + path_folder(path);
}

/* A file or folder that is still to be looked at. */
typedef struct found {
    char *path; /* owned */
    bool named;
    int depth, operand;
} found;

typedef struct pending {
    found *one;
    int64_t count, capacity;
} pending;

/* path becomes the list's. */
static int push(pending *p, char *path, bool named, int depth, int operand, err *e)
{
    if (!path || MEM_ROOM(&p->one, &p->capacity, p->count + 1, "files", e)) {
        free(path);
        return -1;
    }
    p->one[p->count++] = (found){path, named, depth, operand};
    return 0;
}

/* What is taken last is looked at first, so names are in falling order. */
static int by_name(const void *a, const void *b)
{
    return strcmp(((const found *)b)->path, ((const found *)a)->path);
}

static char *join(const char *folder, const char *name, err *e)
{
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = mem_array((int64_t)size, 1, "a path", e);
    if (path)
        snprintf(path, size, "%s/%s", folder, name);
    return path;
}

static int push_folder(pending *p, const found *folder, err *e)
{
    const char *place = import_base(folder->path);
    int64_t first = p->count;
    if (folder->depth == IMPORT_DEPTH)
        return err_set(e, place, 0, "folders more than %d deep", IMPORT_DEPTH);
    DIR *d = opendir(folder->path);
    if (!d)
        return err_system(e, place, errno, "cannot read the folder");
    int failed = 0;
    for (struct dirent *one = readdir(d); one && !failed; one = readdir(d))
        if (one->d_name[0] != '.')
            failed = push(p, join(folder->path, one->d_name, e), false, folder->depth + 1, folder->operand, e);
    closedir(d);
    if (p->count > first)
        qsort(p->one + first, (size_t)(p->count - first), sizeof *p->one, by_name);
    return failed;
}

static int add(import_files *f, const found *one, err *e)
{
    int64_t room = f->capacity;
    if (MEM_ROOM(&f->path, &f->capacity, f->count + 1, "files", e) ||
        (f->capacity != room && mem_grow(&f->named, &room, f->capacity, sizeof *f->named, "files", e)))
        return -1;
    f->path[f->count] = mem_text(one->path, e);
    if (!f->path[f->count])
        return -1;
    f->named[f->count++] = one->named;
    return 0;
}

/* Links are followed only where they are named. */
static int look_at(import_files *f, pending *p, const found *one, err *e)
{
    struct stat s;
    if (one->named ? stat(one->path, &s) : lstat(one->path, &s))
        return err_system(e, import_base(one->path), errno, "cannot read");
    if (S_ISDIR(s.st_mode))
        return push_folder(p, one, e);
    return one->named || S_ISREG(s.st_mode) ? add(f, one, e) : 0;
}

int import_find(import_files *f, char *const *operand, int count, err *e)
{
    pending p = {0};
    int failed = 0;
    for (int i = count - 1; i >= 0 && !failed; i--)
        failed = push(&p, mem_text(operand[i], e), true, 0, i, e);
    while (p.count && !failed) {
        found one = p.one[--p.count];
        f->operand = one.operand;
        failed = look_at(f, &p, &one, e);
        free(one.path);
    }
    while (p.count)
        free(p.one[--p.count].path);
    free(p.one);
    if (!failed && !f->count)
        return err_set(e, NULL, 0, "no files; expected DICOM, NRRD or MetaImage");
    return failed;
}

void import_free(import_files *f)
{
    for (int64_t i = 0; i < f->count; i++)
        free(f->path[i]);
    free(f->path);
    free(f->named);
    *f = (import_files){0};
}

int import_kind_of(const import_files *f, import_kind *kind, err *e)
{
    char head[HEADER];
    *kind = IMPORT_DICOM;
    if (f->count != 1 || !f->named[0])
        return 0;
    in *s = in_open(f->path[0], e);
    int64_t got = s ? in_read(s, head, sizeof head, e) : -1;
    in_close(s);
    if (got < 0)
        return -1;
    if (!dicom_is(head, (size_t)got))
        *kind = sweep_is(head, (size_t)got) ? IMPORT_SWEEP : IMPORT_VOLUME;
    return 0;
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
        if (got > 0 && in_is_gzip(s) && dicom_is_deflated((const unsigned char *)*bytes, (size_t)got)) {
            free(*bytes);
            *bytes = NULL;
            got = err_set(e, import_base(f->path[i]), 0,
                          "compressed twice, its elements and by gzip around them; expected once");
        }
    }
    in_close(s);
    return got;
}
