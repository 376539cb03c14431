#include "volume/voxels_in.h"

#include "base/mem.h"
#include "base/num.h"
#include "base/path.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { PIECE = 1 << 20, WORD = 64 }; /* bytes read at a time; of a number as text */

/* ---- where the bytes come from */

typedef struct bytes {
    in *s;
    bool inflating, ended; /* ended: what was compressed has come to its end */
    z_stream z;
    unsigned char *raw; /* PIECE compressed bytes */
} bytes;

static int bytes_open(bytes *b, in *s, bool inflating, err *e)
{
    *b = (bytes){.s = s};
    if (!inflating)
        return 0;
    if (in_is_gzip(s))
        return err_set(e, in_name(s), 0, "compressed twice, by its encoding and by gzip around it; expected once");
    b->raw = mem_array(PIECE, 1, "compressed data", e);
    if (!b->raw)
        return -1;
    if (inflateInit2(&b->z, 15 + 32) != Z_OK) /* zlib's header or gzip's */
        return err_memory(e, "compressed data");
    b->inflating = true;
    return 0;
}

static void bytes_close(bytes *b)
{
    if (b->inflating)
        inflateEnd(&b->z);
    free(b->raw);
}

static int64_t inflate_some(bytes *b, void *to, size_t size, err *e)
{
    b->z.next_out = to;
    b->z.avail_out = (uInt)size;
    while (b->z.avail_out && !b->ended) {
        if (!b->z.avail_in) {
            int64_t n = in_read(b->s, b->raw, PIECE, e);
            if (n < 0)
                return -1;
            if (!n)
                return err_set(e, in_name(b->s), 0, "compressed data is cut short; expected its end");
            b->z.next_in = b->raw;
            b->z.avail_in = (uInt)n;
        }
        int code = inflate(&b->z, Z_NO_FLUSH);
        b->ended = code == Z_STREAM_END;
        if (code != Z_OK && code != Z_STREAM_END)
            return err_set(e, in_name(b->s), 0, "compressed data is damaged (%s)",
                           b->z.msg ? b->z.msg : "no reason given");
    }
    return (int64_t)(size - b->z.avail_out);
}

/* Up to `size` bytes, at most PIECE; fewer only at the end. -1: e filled. */
static int64_t bytes_some(bytes *b, void *to, size_t size, err *e)
{
    return b->inflating ? inflate_some(b, to, size, e) : in_read(b->s, to, size, e);
}

/* Whether anything is left, after what was compressed too. -1: e filled. */
static int bytes_left(bytes *b, err *e)
{
    unsigned char one;
    int64_t n = bytes_some(b, &one, 1, e);
    b->z.next_out = NULL;
    if (n || !b->inflating)
        return n < 0 ? -1 : n > 0;
    int next = in_peek(b->s, e);
    return next == -2 ? -1 : b->z.avail_in || next >= 0;
}

/* ---- what they hold */

/* What v's type and sizes need, or -1 with e filled. */
static int64_t bytes_needed(const volume *v, const char *name, err *e)
{
    int64_t need = (int64_t)volume_type_size(v->type);
    for (int a = 0; a < 3; a++) {
        if (v->size[a] > INT64_MAX / need)
            return err_set(e, name, 0, "%" PRId64 " x %" PRId64 " x %" PRId64 " voxels are more than can be counted",
                           v->size[0], v->size[1], v->size[2]);
        need *= v->size[a];
    }
    if (need > mem_available())
        return err_set(e, name, 0, "voxels of %" PRId64 " bytes; expected at most the memory there is, %" PRId64, need,
                       mem_available());
    return need;
}

static int wrong_length(const volume *v, const char *name, const char *what, int64_t got, err *e)
{
    return err_set(e, name, 0,
                   "%s %" PRId64 " of %" PRId64 " x %" PRId64 " x %" PRId64 " voxels; expected exactly these", what,
                   got, v->size[0], v->size[1], v->size[2]);
}

static int take_binary(volume *v, bytes *b, int64_t need, err *e)
{
    int64_t room = 0, got = 0;
    char *data = NULL;
    while (got < need) {
        int64_t piece = need - got < PIECE ? need - got : PIECE;
        if (MEM_ROOM(&data, &room, got + piece, "a volume's voxels", e))
            return -1;
        v->data = data;
        int64_t n = bytes_some(b, data + got, (size_t)piece, e);
        if (n < 0)
            return -1;
        got += n;
        if (n < piece)
            return wrong_length(v, in_name(b->s), "data for only", got / (int64_t)volume_type_size(v->type), e);
    }
    return 0;
}

/* One number of text into v->data[at]. */
static int take_number(const volume *v, int64_t at, const char *text, const char *name, err *e)
{
    int64_t whole = 0;
    double number = 0;
    bool bad = true;
    switch (v->type) {
#define TAKE(name, of, nrrd, meta, low, high)                                                                          \
    case VOLUME_##name:                                                                                                \
        bad = (low) < (high) ? num_int(text, low, high, &whole) : num_double(text, &number);                           \
        ((of *)v->data)[at] = (low) < (high) ? (of)whole : (of)number;                                                 \
        break;
        VOLUME_TYPES(TAKE)
    default:
        break;
    }
    if (!bad)
        return 0;
    return err_set(e, name, 0, "voxel %" PRId64 ": '%s'; expected a number of the type, finite", at, text);
}

/* The next number between blanks and ends of lines. Its length, 0 at the end, -1. */
static int next_word(bytes *b, char word[WORD], err *e)
{
    int length = 0;
    for (;;) {
        char c;
        int64_t n = bytes_some(b, &c, 1, e);
        if (n < 0)
            return -1;
        bool blank = !n || c == ' ' || c == '\t' || c == '\n' || c == '\r';
        if (blank && (length || !n)) {
            word[length] = '\0';
            return length;
        }
        if (blank)
            continue;
        if (length == WORD - 1 || c <= ' ' || c > '~')
            return err_set(e, in_name(b->s), 0,
                           "data that is not text, or has no blanks; expected numbers between blanks");
        word[length++] = c;
    }
}

static int take_text(volume *v, bytes *b, int64_t need, err *e)
{
    char word[WORD];
    size_t size = volume_type_size(v->type);
    int64_t count = need / (int64_t)size, room = 0;
    for (int64_t at = 0; at < count; at++) {
        char *data = v->data;
        int length = next_word(b, word, e);
        if (!length)
            return wrong_length(v, in_name(b->s), "data for only", at, e);
        if (length < 0 || mem_grow(&data, &room, (at + 1) * (int64_t)size, 1, "a volume's voxels", e))
            return -1;
        v->data = data;
        if (take_number(v, at, word, in_name(b->s), e))
            return -1;
    }
    int more = next_word(b, word, e);
    return more <= 0 ? more : wrong_length(v, in_name(b->s), "data for more than", count, e);
}

static int take_voxels(volume *v, const voxels_in *x, in *s, int64_t need, err *e)
{
    bytes b;
    int status = bytes_open(&b, s, x->encoding == VOXELS_DEFLATED, e);
    if (!status && x->encoding == VOXELS_TEXT)
        status = take_text(v, &b, need, e);
    else if (!status) {
        status = take_binary(v, &b, need, e);
        int more = status ? 0 : bytes_left(&b, e);
        if (more > 0)
            wrong_length(v, in_name(s), "data for more than", volume_count(v), e);
        status |= more;
    }
    bytes_close(&b);
    return status ? -1 : 0;
}

static void reverse(char *from, char *to)
{
    for (; from < --to; from++) {
        const char one = *from;
        *from = *to;
        *to = one;
    }
}

/* The last bytes of all that comes are the voxels: a ring of so many as are needed. */
static int take_last(volume *v, in *s, int64_t need, err *e)
{
    int64_t room = 0, at = 0, n = 1;
    bool full = false;
    char *data = NULL;
    while (n > 0) {
        const int64_t piece = need - at < PIECE ? need - at : PIECE;
        if (!full && MEM_ROOM(&data, &room, at + piece, "a volume's voxels", e))
            return -1;
        v->data = data;
        n = in_read(s, data + at, (size_t)piece, e);
        at += n > 0 ? n : 0;
        full |= at == need;
        at = at == need ? 0 : at;
    }
    if (n < 0)
        return -1;
    if (!full)
        return wrong_length(v, in_name(s), "data for only", at / (int64_t)volume_type_size(v->type), e);
    reverse(data, data + at); /* the ring's oldest byte comes first */
    reverse(data + at, data + need);
    reverse(data, data + need);
    return 0;
}

static int skip(const voxels_in *x, in *s, err *e)
{
    char piece[4096];
    for (int64_t n = 0; n < x->lines;) {
        int64_t got = in_read(s, piece, 1, e);
        if (got <= 0)
            return got < 0 ? -1 : err_set(e, in_name(s), 0, "fewer than the %" PRId64 " lines to skip", x->lines);
        n += piece[0] == '\n';
    }
    for (int64_t left = x->bytes; left > 0;) {
        int64_t want = left < (int64_t)sizeof piece ? left : (int64_t)sizeof piece,
                got = in_read(s, piece, (size_t)want, e);
        if (got < want)
            return got < 0 ? -1 : err_set(e, in_name(s), 0, "fewer than the %" PRId64 " bytes to skip", x->bytes);
        left -= got;
    }
    return 0;
}

/* This machine's byte order. */
static bool is_big(void)
{
    const uint16_t one = 1;
    return !*(const unsigned char *)&one;
}

static void swap(volume *v)
{
    size_t size = volume_type_size(v->type), count = (size_t)volume_count(v);
    unsigned char *p = v->data;
    for (size_t n = 0; n < count; n++, p += size)
        for (size_t i = 0; i < size / 2; i++) {
            unsigned char one = p[i];
            p[i] = p[size - 1 - i];
            p[size - 1 - i] = one;
        }
}

/* ---- files beside the header */

/* The path of the data's file, which has to be one, in the header's folder; the caller frees it. */
static char *find_file(const char *name, const char *header, const char *path, err *e)
{
    if (path)
        return path_beside(path, name, header, e);
    err_set(e, header, 0, "its data are in a file of their own, '%.200s', and it is in no folder; expected a path",
            name);
    return NULL;
}

int voxels_in_read(volume *v, const voxels_in *x, in *s, const char *path, const volume_budget *b, err *e)
{
    char *file = x->file ? find_file(x->file, in_name(s), path, e) : NULL;
    in *own = file ? in_open_plain(file, e) : NULL;
    in *from = x->file ? own : s;
    int status = -1;
    int64_t need = from ? bytes_needed(v, in_name(from), e) : -1;
    if (need >= 0 && !volume_afford(b, v, in_name(from), e) && !skip(x, from, e))
        status = x->bytes < 0 ? take_last(v, from, need, e) : take_voxels(v, x, from, need, e);
    if (!status && x->encoding != VOXELS_TEXT && x->big != is_big())
        swap(v);
    in_close(own);
    free(file);
    return status;
}
