/* Both encodings of a model. What is taken must come out the same from every way round: as binary, as text, and again.
 * A binary input is tried as it is and with its checksums put right, or nothing would get past them.
 */
#include "base/in.h"
#include "base/out.h"
#include "model/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int pass(in *s, model_writer *w, err *e)
{
    model m = {0};
    frame f = {0};
    model_reader *r = model_reader_open(s, e);
    int got = r && !model_read(r, &m, e) && !model_write(w, &m, e) ? 1 : -1;
    while (got > 0) {
        got = model_read_frame(r, &m, &f, e);
        if (got > 0 && model_write_frame(w, &f, e))
            got = -1;
    }
    if (!got)
        got = model_write_end(w, e);
    frame_free(&f);
    model_free(&m);
    model_reader_close(r);
    return got;
}

/* The model in data, written anew; NULL where it is refused. */
static out *convert(const unsigned char *data, size_t size, bool text, err *e)
{
    in *s = in_memory(data, size, "input", e);
    out *o = out_memory(e);
    model_writer *w = o ? model_writer_open(o, text, e) : NULL;
    if (!s || !w || pass(s, w, e)) {
        out_discard(o);
        o = NULL;
    }
    model_writer_close(w);
    in_close(s);
    return o;
}

static out *again(out *o, bool text)
{
    err e = {0};
    size_t size;
    const unsigned char *bytes = out_bytes(o, &size);
    out *p = convert(bytes, size, text, &e);
    if (!p) {
        fprintf(stderr, "what was written is refused: %s\n", e.text);
        abort();
    }
    return p;
}

static void must_be_same(out *a, out *b)
{
    size_t n, m;
    const unsigned char *p = out_bytes(a, &n), *q = out_bytes(b, &m);
    if (n != m || memcmp(p, q, n)) {
        fprintf(stderr, "two ways round differ\n");
        abort();
    }
}

/* Names alone: what is passed over may be anything; what is kept stands as in the model that is read whole. */
static void read_names(const unsigned char *data, size_t size)
{
    err e = {0};
    model m = {0};
    in *s = in_memory(data, size, "input", &e);
    model_reader *r = s ? model_reader_open(s, &e) : NULL;
    if (r)
        model_reader_names(r);
    if (r && !model_read(r, &m, &e))
        for (int i = 0; i < m.arrays.count; i++)
            if (m.arrays.v[i].type == MODEL_STR && m.arrays.v[i].rows && !m.arrays.v[i].data)
                abort();
    model_free(&m);
    model_reader_close(r);
    in_close(s);
}

static void try(const unsigned char *data, size_t size)
{
    err e = {0};
    read_names(data, size);
    out *text = convert(data, size, true, &e);
    if (!text) {
        if (!e.status || (!*e.text && !e.silent))
            abort();
        return;
    }
    out *binary = again(text, false), *text2 = again(binary, true), *binary2 = again(binary, false);
    must_be_same(text, text2);
    must_be_same(binary, binary2);
    out_discard(text);
    out_discard(binary);
    out_discard(text2);
    out_discard(binary2);
}

static void put_crc(unsigned char *to, const unsigned char *from, size_t size)
{
    uint32_t crc = (uint32_t)crc32(0, from, (uInt)size);
    memcpy(to, &crc, sizeof crc);
}

static void mend(unsigned char *b, size_t size)
{
    size_t at = 16;
    uint64_t length;
    put_crc(b + 12, b, 12);
    while (size - at >= 20) {
        memcpy(&length, b + at + 8, sizeof length);
        if (length > size - at - 20)
            break;
        put_crc(b + at + 16 + length, b + at, 16 + length);
        at += 20 + length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    try(data, size);
    if (size < 16 || data[0] != 0x89)
        return 0;
    unsigned char *copy = malloc(size);
    if (copy) {
        memcpy(copy, data, size);
        mend(copy, size);
        try(copy, size);
    }
    free(copy);
    return 0;
}
