/* A stream of bytes to write to standard output, or to a file that appears whole under its name when out_close()
 * succeeds; where it fails there is no file, unless only the storing of its name failed. Errors stick: write on, and
 * out_close() reports them. A closed pipe ends the process quietly by SIGPIPE.
 */
#ifndef SINEW_OUT_H
#define SINEW_OUT_H

#include "base/err.h"
#include "base/replace.h"

#include <stddef.h>

typedef struct out out;

/* path NULL or "-": standard output. Other paths: a regular or new file is written beside its place and renamed
 * at out_close(); a device or FIFO is written directly. gzip: compress what is written. NULL with e filled. */
out *out_open(const char *path, bool gzip, err *e);

/* The same of a regular file that is not to be in its place before the caller puts it there: out_close() settles it,
 * and it is in *to from then on, to be put in place or discarded (replace.h). */
out *out_open_kept(const char *path, replace *to, err *e);

/* Makes out_close() wait until the file and its name are stored, also where the shell has opened the file: for a caller
 * that removes what the output was made from. */
void out_outlast(out *o);

/* Writes to a descriptor from where it stands, as it is; it is out's from then on,
 * but the caller's where this fails. */
out *out_take(int fd, const char *name, err *e);

/* Keeps what is written in memory (tests, CRCs, spools); out_bytes() shows it until out_discard(). */
out *out_memory(err *e);
const unsigned char *out_bytes(out *o, size_t *size);

void out_write(out *o, const void *bytes, size_t size);
void out_text(out *o, const char *text);
void out_format(out *o, const char *format, ...) SINEW_PRINTF(2, 3);

/* Sends on what is buffered (live streams). */
void out_flush(out *o);

/* Sends on what is buffered, and waits until all that was written is stored. -1 with e filled. */
int out_sync(out *o, err *e);

/* 0, or -1 with e filled where something could not be written: for who writes long and would rather end at once. */
int out_failed(const out *o, err *e);

/* Overwrites size bytes at offset from the start, for headers whose counts come last. Only for files opened by
 * path and not gzip; -1 with e filled elsewhere. */
int out_patch(out *o, int64_t offset, const void *bytes, size_t size, err *e);

/* Bytes written so far, before compression. */
int64_t out_count(const out *o);

bool out_is_file(const out *o);
bool out_is_terminal(const out *o);

/* Finishes: flushes, checks, renames. Frees o in every case. 0, or -1 with e filled and no file left. */
int out_close(out *o, err *e);

/* Gives up: removes what was written to a file. Frees o; o may be NULL. */
void out_discard(out *o);

/* Closes it, or gives up where what was to be written has failed; then, and where o is NULL, -1. */
int out_end(out *o, int failed, err *e);

#endif
