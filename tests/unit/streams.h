/* Whole models as bytes in memory, read and written again: for the tests of the format. */
#ifndef SINEW_STREAMS_H
#define SINEW_STREAMS_H

#include "base/in.h"
#include "base/out.h"
#include "model/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bytes {
    unsigned char *at;
    size_t size;
} bytes;

/* Reads all of a stream, and writes it into w (NULL: nowhere). */
static inline int pass(in *s, model_writer *w, err *e)
{
    model m = {0};
    frame f = {0};
    model_reader *r = model_reader_open(s, e);
    int got = r && !model_read(r, &m, e) && (!w || !model_write(w, &m, e)) ? 1 : -1;
    while (got > 0) {
        got = model_read_frame(r, &m, &f, e);
        if (got > 0 && w && model_write_frame(w, &f, e))
            got = -1;
    }
    if (!got && w)
        got = model_write_end(w, e);
    frame_free(&f);
    model_free(&m);
    model_reader_close(r);
    return got;
}

static inline int refused(const void *from, size_t size, err *e)
{
    *e = (err){0};
    in *s = in_memory(from, size, "stdin", e);
    int status = s ? pass(s, NULL, e) : -1;
    in_close(s);
    return status;
}

static inline bytes convert(const void *from, size_t size, bool text, err *e)
{
    bytes b = {0};
    in *s = in_memory(from, size, "stdin", e);
    out *o = out_memory(e);
    model_writer *w = o ? model_writer_open(o, text, e) : NULL;
    if (s && w && !pass(s, w, e)) {
        const unsigned char *got = out_bytes(o, &b.size);
        b.at = malloc(b.size ? b.size : 1);
        if (b.at)
            memcpy(b.at, got, b.size);
    }
    model_writer_close(w);
    out_discard(o);
    in_close(s);
    return b;
}

static inline bool says(const err *e, const char *part)
{
    if (e->status && strstr(e->text, part))
        return true;
    printf("# got '%s', wanted '%s'\n", e->text, part);
    return false;
}

#endif
