/* Lines on a pipe whose reader may be slow: each line is one write, and none waits. While the reader is behind, the
 * newest line waits and those before it are dropped. Or lines in a file, all of them. The owner opens and closes it.
 */
#ifndef SINEW_TRACK_LINES_H
#define SINEW_TRACK_LINES_H

#include "base/out.h"
#include "base/pose.h"

enum { TRACK_LINE = 256 };

typedef struct track_lines {
    out *file; /* a regular one; else NULL */
    int fd;    /* else; -1: none */
    bool is_pipe;
    char line[TRACK_LINE]; /* that waits */
    int size;              /* 0: none does */
    int64_t written, dropped;
    bool gone; /* the reader is */
} track_lines;

/* NULL or "-": standard output. A regular file appears when it is closed; a FIFO is opened when it has a reader. -1
 * with e filled. */
int track_lines_open(track_lines *l, const char *path, err *e);

/* Writes a line, or has it wait. -1 with e filled: not for a reader that is gone. */
int track_lines_put(track_lines *l, double time, const pose *at, err *e);

/* Writes what waits, where that can be. */
int track_lines_flush(track_lines *l, err *e);

/* Writes what waits, for at most so many s, and closes. failed: a file is not to appear. */
int track_lines_close(track_lines *l, bool failed, double seconds, err *e);

#endif
