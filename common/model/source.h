/* A model for tools that read one and write none, from a file or standard input. A source owns the body and the last
 * frame read, so one frame is in memory at a time (two while the next is read).
 */
#ifndef SINEW_SOURCE_H
#define SINEW_SOURCE_H

#include "model/stream.h"

typedef struct source {
    in *stream;
    model_reader *reader;
    model body;
    frame frame;    /* the last one read; empty while frames is 0 */
    int64_t frames; /* read so far */
    int64_t first;  /* the index of the first */
    frame spare;
    bool text; /* the encoding */
    bool from_stdin;
    bool names;            /* source_open_names */
    bool offers, salvages; /* --salvage: the tool has it; it was given */
    err lost;              /* what it did not take, and why */
} source;

/* Opens path (NULL or "-": standard input; a terminal there is a usage error) and reads the body. Where the stream
 * ended with `fail`, e is silent only for standard input: who reads a file of yesterday was not told. s is to be
 * closed in every case. */
int source_open(source *s, const char *path, err *e);

/* The same for a tool that has --salvage, and whether that is given: then frames end where the stream is cut, damaged
 * or ends with `fail`, with source_next() 0, and source_end() says so. A body that is not whole is refused all the
 * same. */
int source_open_part(source *s, const char *path, bool salvage, err *e);

/* Opens the body for its names only: see model_reader_names. No frames may be read. */
int source_open_names(source *s, const char *path, err *e);

/* Where not all was taken: fills e (status 1) with how much was and why, once the output is whole; or adds that to an e
 * that is filled. */
void source_end(const source *s, err *e);

/* The next frame, into s->frame. 1: a frame; 0: the end, and s->frame stays the last; -1: e filled. */
int source_next(source *s, err *e);

/* At the end, for `--frame N` of a frame that is not there, or any frame where there is none (asked NULL: the last):
 * says what there is. Always -1. */
int source_no_frame(const source *s, const char *asked, err *e);

/* s may be zeroed or part open. */
void source_close(source *s);

/* "stdin" or the path: for messages. */
const char *source_name(const source *s);

/* An array by name: the frame's, where there is one, else the body's. NULL where neither has it. */
const model_array *source_find(const source *s, const char *name);

/* One number of an array that does not hold strings. */
static inline double source_value(const model_array *a, int64_t at)
{
    switch (a->type) {
    case MODEL_F32:
        return (double)a->f32[at];
    case MODEL_F64:
        return a->f64[at];
    case MODEL_I32:
        return a->i32[at];
    case MODEL_I64:
        return (double)a->i64[at];
    case MODEL_U8:
        return a->u8[at];
    default:
        return 0;
    }
}

/* Writes a row's values between spaces, numbers as short as they read back. quoted: strings stand in quotes, on one
 * line and harmless to a terminal; else as they are. */
void source_put_row(const model_array *a, int64_t row, bool quoted, out *to);

/* Text on one line and harmless to a terminal: control characters become '?'. */
void source_put_text(const char *text, out *to);

#endif
