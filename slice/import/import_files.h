/* The files that us-import is given: those of folders, in the order of their names, and what kind
 * they are. The list is the caller's to free.
 */
#ifndef SINEW_IMPORT_FILES_H
#define SINEW_IMPORT_FILES_H

#include "base/err.h"

typedef enum import_kind { IMPORT_DICOM, IMPORT_SWEEP, IMPORT_VOLUME } import_kind;

typedef struct import_files {
    char **path;                    /* owned */
    bool *named;                    /* on the command line, so that it must be an image */
    int64_t count, capacity, other; /* other: in folders, and no DICOM */
    int operand;                    /* that import_find looked at last, from 0 */
} import_files;

/* Every regular file of the folders among the operands, and of the folders in these
 * (IMPORT_DEPTH deep), and the files. */
enum { IMPORT_DEPTH = 16 };
int import_find(import_files *f, char *const *operand, int count, err *e);
void import_free(import_files *f);

/* A path's last part: all of it that a message may show. */
const char *import_base(const char *path);

/* One file that is none of DICOM is a volume or a sweep; all else is DICOM. -1 with
 * e filled where it cannot be read. */
int import_kind_of(const import_files *f, import_kind *kind, err *e);

/* The bytes of file i, which the caller frees. Their count; 0: it is no DICOM, was in a folder, and is counted in
 * f->other; -1 with e filled. */
int64_t import_read(import_files *f, int64_t i, char **bytes, err *e);

#endif
