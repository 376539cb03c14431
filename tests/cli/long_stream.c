/* Streams too large to store, for tests of what tools keep of them.
 *     stream frames N < MODEL    the model's body and its last frame N times, the displacements a little more each time
 *     stream large ROWS [AT] < MODEL the model (binary) with an axis x-rows and an array x-large of
 *     as many u8, AT's one more than it would be
 * Neither is ever held: frames are written one at a time, the large array a piece at a time.
 */
#include "base/checksum.h"
#include "base/num.h"
#include "model/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- frames */

static void scale(frame *f, double by)
{
    for (int i = 0; i < f->arrays.count; i++) {
        model_array *a = &f->arrays.v[i];
        for (int64_t k = 0; a->type == MODEL_F64 && k < a->rows * a->columns; k++)
            a->f64[k] *= by;
    }
}

static int write_frames(model_writer *w, frame *f, int64_t count, err *e)
{
    for (int64_t i = 0; i < count; i++) {
        f->index = i;
        f->time = .01 * (double)i;
        if (model_write_frame(w, f, e))
            return -1;
        scale(f, 1 + 1. / 4096);
    }
    return model_write_end(w, e);
}

static int frames(int64_t count, err *e)
{
    in *s = in_open(NULL, e);
    out *o = out_open(NULL, false, e);
    model m = {0};
    frame f[2] = {{0}, {0}};
    model_reader *r = s ? model_reader_open(s, e) : NULL;
    model_writer *w = o ? model_writer_open(o, false, e) : NULL;
    int got = r && w && !model_read(r, &m, e) && !model_write(w, &m, e) ? 1 : -1, last = 0;
    while (got > 0) {
        got = model_read_frame(r, &m, &f[!last], e);
        last = got > 0 ? !last : last;
    }
    if (!got)
        got = write_frames(w, &f[last], count, e);
    frame_free(&f[0]);
    frame_free(&f[1]);
    model_free(&m);
    model_reader_close(r);
    model_writer_close(w);
    in_close(s);
    return o && !got ? out_close(o, e) : -1;
}

/* ---- a large array */

typedef struct block {
    uint32_t crc;
} block;

static void put(block *b, const void *bytes, size_t size)
{
    b->crc = checksum_add(b->crc, bytes, size);
    if (fwrite(bytes, 1, size, stdout) != size)
        exit(1);
}

static void put_text(block *b, const char *text)
{
    uint32_t n = (uint32_t)strlen(text);
    put(b, &n, sizeof n);
    put(b, text, n);
}

static void begin(block *b, const char *type, uint64_t length)
{
    const uint32_t flags = 0;
    b->crc = 0;
    put(b, type, 4);
    put(b, &flags, sizeof flags);
    put(b, &length, sizeof length);
}

static void end(const block *b)
{
    if (fwrite(&b->crc, sizeof b->crc, 1, stdout) != 1)
        exit(1);
}

static void put_rows(block *b, int64_t rows, int64_t more)
{
    enum { PIECE = 251 * 4096 };
    static unsigned char piece[PIECE];
    for (int64_t i = 0; i < PIECE; i++)
        piece[i] = (unsigned char)(i % 251);
    for (int64_t at = 0; at < rows; at += PIECE) {
        int64_t n = rows - at < PIECE ? rows - at : PIECE;
        bool here = more >= at && more < at + n;
        if (here)
            piece[more - at]++;
        put(b, piece, (size_t)n);
        if (here)
            piece[more - at]--;
    }
}

static int large(int64_t rows, int64_t more)
{
    static const char axis[] = "x-rows", name[] = "x-large", unit[] = "1";
    enum { MAGIC = 16, LENGTHS = 3 * 4 + 2 * 4 };
    const uint32_t type = MODEL_U8, columns = 1;
    char copy[4096];
    block b;
    size_t n = fread(copy, 1, MAGIC, stdin);
    if (n != MAGIC || copy[1] != 's' || fwrite(copy, 1, MAGIC, stdout) != MAGIC)
        return -1;
    begin(&b, "AXIS", 4 + strlen(axis) + 8);
    put_text(&b, axis);
    put(&b, &rows, sizeof rows);
    end(&b);
    begin(&b, "ARRY", LENGTHS + strlen(name) + strlen(unit) + strlen(axis) + (uint64_t)rows);
    put_text(&b, name);
    put_text(&b, unit);
    put_text(&b, axis);
    put(&b, &type, sizeof type);
    put(&b, &columns, sizeof columns);
    put_rows(&b, rows, more);
    end(&b);
    while ((n = fread(copy, 1, sizeof copy, stdin)))
        if (fwrite(copy, 1, n, stdout) != n)
            return -1;
    return fflush(stdout);
}

int main(int argc, char **argv)
{
    int64_t count = 0, at = -1;
    err e = {0};
    if (argc < 3 || argc > 4 || num_int(argv[2], 1, INT64_MAX, &count) ||
        (argc == 4 && num_int(argv[3], 0, count - 1, &at)))
        return 2;
    int bad = 2;
    if (!strcmp(argv[1], "frames"))
        bad = frames(count, &e);
    else if (!strcmp(argv[1], "large"))
        bad = large(count, at);
    if (bad)
        fprintf(stderr, "stream: %s\n", *e.text ? e.text : "cannot write");
    return bad != 0;
}
