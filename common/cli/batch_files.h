/* The files that the jobs of --batch read and write. Jobs run in any order, so what one of them writes no other may
 * write or read: of two such jobs, the later line is wrong. Links are followed. Devices, such as /dev/null, are
 * anyone's. The creator owns it, zeroed to begin with.
 */
#ifndef SINEW_BATCH_FILES_H
#define SINEW_BATCH_FILES_H

#include "base/err.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct batch_file {
    char *where; /* links followed; owned */
    int64_t line;
    bool is_written;
    int64_t users; /* its place among these; of batch_files_sort */
} batch_file;

/* The lines that may use a file: the first that writes it, and the first that reads it; 0: none. */
typedef struct batch_users {
    int64_t writes, reads;
} batch_users;

typedef struct batch_files {
    batch_file *file; /* line by line; owned, as is users */
    int64_t files, room;
    batch_users *users;
    int64_t next; /* the first file of the lines that have not been checked */
} batch_files;

/* Notes a file of a line; lines come in their order. -1 with e filled: no memory. */
int batch_files_note(batch_files *f, const char *path, int64_t line, bool is_written, err *e);

/* Finds which are the same, once all are noted. -1 with e filled: no memory. */
int batch_files_sort(batch_files *f, err *e);

/* Takes the files of a line for it, after those of the lines before. -1 with e filled where one of those has a file
 * that this one may not; then the line has taken none. */
int batch_files_take(batch_files *f, int64_t line, err *e);

void batch_files_free(batch_files *f);

#endif
