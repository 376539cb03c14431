/* A stream of bytes to read from a file, standard input ("-") or memory; what is compressed by gzip is decompressed on
 * the way. The stream keeps its name and its count of lines for messages. It never seeks, and its memory grows only
 * with the longest line asked for, which has a limit.
 */
#ifndef SINEW_IN_H
#define SINEW_IN_H

#include "base/err.h"

#include <stddef.h>

typedef struct in in;

enum { IN_LINE_MOST = 1 << 28 }; /* the most bytes of a line */

/* Opens path, which from now on no output replaces (see inputs.h); "-" or NULL is standard input, named "stdin". NULL
 * with e filled on failure. */
in *in_open(const char *path, err *e);

/* Opens a file whose bytes are taken as they are, though they may look like gzip. An output may replace it, as a
 * checkpoint is replaced. */
in *in_open_plain(const char *path, err *e);

/* Reads from a descriptor, such as a pipe's; it is the stream's from then on, but the caller's where this fails. */
in *in_take(int fd, const char *name, err *e);

/* Reads from bytes that stay the caller's (for tests and fuzzers). */
in *in_memory(const void *bytes, size_t size, const char *name, err *e);

void in_close(in *s);

const char *in_name(const in *s);

/* Tells whether the stream is decompressed from gzip. Callers whose memory is to grow only with the size of their input
 * refuse data that are compressed once more inside: DEFLATE makes at most 1032 bytes of one, but twice a million. */
bool in_is_gzip(const in *s);

/* Lines taken so far by in_line: the number of the line it gave last. */
int64_t in_lines(const in *s);

/* Bytes taken so far, as they are once gunzipped. */
int64_t in_taken(const in *s);

/* Reads up to size bytes; less only at the end. -1 with e filled where reading or gunzipping fails. */
int64_t in_read(in *s, void *bytes, size_t size, err *e);

/* Takes up to size bytes of those that were read ahead, and reads nothing: for who reads the descriptor on. The stream
 * must not be gzip. */
size_t in_rest(in *s, void *bytes, size_t size);

/* From here on, who waits for bytes of the stream does so only until the descriptor can be read or is hung up: reading
 * then fails. For a thread that reads while another may tell it to end. */
void in_watch(in *s, int descriptor);

/* Looks at the next byte without taking it: 0 to 255, -1 at the end, -2 with e filled on failure. A UTF-8 byte order
 * mark that the stream begins with is stepped over, as by in_line; in_read and in_all, before either of these, give
 * it. */
int in_peek(in *s, err *e);

/* The next line, without its end (LF or CR LF), NUL-terminated, valid until the next call on s.
 * Returns its length, -1 at the end, -2 with e filled on failure. A NUL byte in a line, or a line of more than
 * IN_LINE_MOST bytes, is an error. ended (may be NULL) gets false where the stream stopped before the line's LF. */
int64_t in_line(in *s, char **line, bool *ended, err *e);

/* All that is left, NUL-terminated; the caller frees *bytes. Returns the size, or -1 with e filled. */
int64_t in_all(in *s, char **bytes, err *e);

#endif
