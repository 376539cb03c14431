/* The data of arrays, of import_xml.h. */
#include "exchange/import_xml.h"
#include "base/mem.h"
#include "base/num.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { RATIO = 1032 }; /* the most that zlib makes of a byte */

/* Bytes that may be written in base64. */
typedef struct bytes {
    const unsigned char *at, *end;
    bool base64;
    unsigned char held[3];
    int held_count;
} bytes;

static int wrong(const xml *x, const xml_array *a, const char *what, const char *expected, err *e)
{
    return err_set(e, x->name, a->line, "array %.100s: %s; expected %s", a->name, what, expected);
}

/* ---- types */

typedef struct type {
    const char *name;
    int size;
    char kind; /* f, i, u */
} type;

static const type *type_of(const char *name)
{
    static const type types[] = {{"Float64", 8, 'f'}, {"Float32", 4, 'f'}, {"Int64", 8, 'i'},  {"Int32", 4, 'i'},
                                 {"Int16", 2, 'i'},   {"Int8", 1, 'i'},    {"UInt64", 8, 'u'}, {"UInt32", 4, 'u'},
                                 {"UInt16", 2, 'u'},  {"UInt8", 1, 'u'},   {"String", 1, 'u'}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (!strcmp(types[i].name, name))
            return &types[i];
    return NULL;
}

static uint64_t bits_of(const unsigned char *p, int size, bool big)
{
    uint64_t bits = 0;
    for (int i = 0; i < size; i++)
        bits = bits << 8 | p[big ? i : size - 1 - i];
    return bits;
}

static double number_of(const unsigned char *p, const type *t, bool big)
{
    const uint64_t bits = bits_of(p, t->size, big);
    float single;
    double whole;
    uint32_t half = (uint32_t)bits;
    if (t->kind == 'f' && t->size == 4) {
        memcpy(&single, &half, sizeof single);
        return (double)single;
    }
    if (t->kind == 'f') {
        memcpy(&whole, &bits, sizeof whole);
        return whole;
    }
    if (t->kind == 'i' && t->size < 8 && bits >> (8 * t->size - 1))
        return (double)(int64_t)(bits | ~UINT64_C(0) << 8 * t->size);
    return t->kind == 'i' ? (double)(int64_t)bits : (double)bits;
}

/* ---- bytes */

static int letter(unsigned char c)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c ? strchr(letters, c) : NULL;
    if (found)
        return (int)(found - letters);
    return c == '=' ? 64 : -1;
}

/* The next four letters: how many bytes they were; 0: there are none. Padding may
 * stand within, where an encoder began anew. */
static int next_group(bytes *b, unsigned char *to)
{
    int value[4], n = 0;
    while (n < 4) {
        while (b->at < b->end && isspace(*b->at))
            b->at++;
        if (b->at == b->end || (value[n++] = letter(*b->at++)) < 0)
            return 0;
    }
    if (value[0] > 63 || value[1] > 63 || (value[2] > 63 && value[3] <= 63))
        return 0;
    const int c = value[2] > 63 ? 0 : value[2];
    const int d = value[3] > 63 ? 0 : value[3];
    to[0] = (unsigned char)(value[0] << 2 | value[1] >> 4);
    to[1] = (unsigned char)((value[1] & 15) << 4 | c >> 2);
    to[2] = (unsigned char)((c & 3) << 6 | d);
    if (value[2] > 63)
        return 1;
    return value[3] > 63 ? 2 : 3;
}

/* Takes size bytes. -1: there are fewer. */
static int take(bytes *b, unsigned char *to, size_t size)
{
    if (!b->base64) {
        if ((size_t)(b->end - b->at) < size)
            return -1;
        memcpy(to, b->at, size);
        b->at += size;
        return 0;
    }
    while (size) {
        if (!b->held_count && !(b->held_count = next_group(b, b->held)))
            return -1;
        const size_t n = size < (size_t)b->held_count ? size : (size_t)b->held_count;
        memcpy(to, b->held, n);
        memmove(b->held, b->held + n, (size_t)b->held_count - n);
        b->held_count -= (int)n;
        to += n;
        size -= n;
    }
    return 0;
}

static int take_header(bytes *b, const xml_style *style, uint64_t *value)
{
    unsigned char head[8];
    if (take(b, head, (size_t)style->header))
        return -1;
    *value = bits_of(head, style->header, style->big);
    return 0;
}

/* ---- data */

/* One block of zlib, `packed` bytes of it, into `room` bytes, which it must fill. */
static int unpack(bytes *b, uint64_t packed, unsigned char *to, size_t room, err *e)
{
    uLongf size = (uLongf)room;
    if (packed > (uint64_t)(b->end - b->at))
        return -1;
    unsigned char *from = mem_array((int64_t)packed, 1, "compressed data", e);
    int code = from && !take(b, from, packed) ? uncompress(to, &size, from, (uLong)packed) : Z_DATA_ERROR;
    free(from);
    return code == Z_OK && size == room ? 0 : -1;
}

/* The blocks' heading, and their sum: -1 where it cannot be. *packed is the caller's to free. */
static int take_blocks(bytes *b, const xml_style *style, uint64_t head[3], uint64_t **packed, uint64_t *sum, err *e)
{
    const uint64_t left = (uint64_t)(b->end - b->at);
    for (int i = 0; i < 3; i++)
        if (take_header(b, style, &head[i]))
            return -1;
    const uint64_t last = head[2] ? head[2] : head[1], most = left * RATIO;
    if (head[0] > left || head[2] > head[1] || last > most || (head[0] > 1 && head[1] > most / (head[0] - 1)))
        return -1;
    *packed = mem_array((int64_t)head[0], sizeof **packed, "compressed data", e);
    if (!*packed)
        return -1;
    for (uint64_t i = 0; i < head[0]; i++)
        if (take_header(b, style, &(*packed)[i]))
            return -1;
    if (b->base64)
        b->held_count = 0; /* the data begins anew */
    *sum = head[0] ? (head[0] - 1) * head[1] + last : 0;
    return 0;
}

static unsigned char *take_zlib(bytes *b, const xml_style *style, uint64_t *size, err *e)
{
    uint64_t head[3], *packed = NULL;
    unsigned char *all = NULL;
    const uint64_t most = (uint64_t)(b->end - b->at) * RATIO;
    int bad = take_blocks(b, style, head, &packed, size, e);
    if (!bad && *size <= most)
        all = mem_array((int64_t)*size + 1, 1, "an array", e);
    for (uint64_t i = 0, at = 0; all && i < head[0]; i++) {
        const uint64_t room = i + 1 == head[0] && head[2] ? head[2] : head[1];
        if (unpack(b, packed[i], all + at, room, e)) {
            free(all);
            all = NULL;
        }
        at += room;
    }
    free(packed);
    return all;
}

/* All bytes of an array that is not ASCII, the caller's to free, with a NUL after them. NULL: e is filled. */
static unsigned char *take_all(const xml *x, const xml_style *style, const xml_array *a, uint64_t *size, err *e)
{
    bytes b = {(const unsigned char *)a->begin, (const unsigned char *)a->end, true, {0}, 0};
    unsigned char *all = NULL;
    if (!strcmp(a->format, "appended")) {
        if (!style->appended || a->offset < 0 || a->offset > style->appended_end - style->appended) {
            wrong(x, a, "its place in the appended data is not there", "an offset into it", e);
            return NULL;
        }
        b = (bytes){(const unsigned char *)style->appended + a->offset,
                    (const unsigned char *)style->appended_end,
                    style->base64,
                    {0},
                    0};
    }
    if (style->zlib)
        all = take_zlib(&b, style, size, e);
    else if (!take_header(&b, style, size) && *size <= (uint64_t)(b.end - b.at) + 2) {
        all = mem_array((int64_t)*size + 1, 1, "an array", e);
        if (all && take(&b, all, *size)) {
            free(all);
            all = NULL;
        }
    }
    if (!all)
        wrong(x, a, "its data is cut or damaged", "as many bytes as it says", e);
    return all;
}

/* Numbers between blanks. */
static int take_ascii(const xml *x, const xml_array *a, int64_t count, double *to, err *e)
{
    const char *p = a->begin;
    for (int64_t i = 0; i < count; i++) {
        while (p < a->end && isspace((unsigned char)*p))
            p++;
        if (p < a->end && *p == '+')
            p++;
        if (num_scan(p, a->end, &p, &to[i]))
            return err_set(e, x->name, xml_line(x, p), "array %.100s: no number; expected %lld of them", a->name,
                           (long long)count);
    }
    return 0;
}

double *xml_numbers(const xml *x, const xml_style *style, const xml_array *a, int64_t count, err *e)
{
    const type *t = type_of(a->type);
    const bool ascii = !strcmp(a->format, "ascii");
    unsigned char *all = NULL;
    uint64_t size = 0;
    if (!t) {
        wrong(x, a, "of a type that is not known", "Float64, Int32 or the like", e);
        return NULL;
    }
    if (ascii && count > (a->end - a->begin) / 2 + 1) {
        wrong(x, a, "too few numbers", "one for each", e);
        return NULL;
    }
    if (!ascii && !(all = take_all(x, style, a, &size, e)))
        return NULL;
    if (!ascii && (count < 0 || (uint64_t)count > size || size != (uint64_t)count * (uint64_t)t->size)) {
        free(all);
        err_set(e, x->name, a->line, "array %.100s has %llu bytes; expected %lld numbers of %d", a->name,
                (unsigned long long)size, (long long)count, t->size);
        return NULL;
    }
    double *to = mem_array(count, sizeof *to, "an array", e);
    if (to && ascii && take_ascii(x, a, count, to, e)) {
        free(to);
        to = NULL;
    }
    for (int64_t i = 0; to && !ascii && i < count; i++)
        to[i] = number_of(all + i * t->size, t, style->big);
    free(all);
    return to;
}

char *xml_strings(const xml *x, const xml_style *style, const xml_array *a, size_t *size, err *e)
{
    uint64_t count = 0;
    char *text;
    if (strcmp(a->format, "ascii") != 0) {
        text = (char *)take_all(x, style, a, &count, e);
        *size = (size_t)count;
        return text;
    }
    text = mem_array((a->end - a->begin) / 2 + 2, 1, "an array", e);
    double code;
    for (const char *p = a->begin; text && p < a->end;) {
        while (p < a->end && isspace((unsigned char)*p))
            p++;
        if (p == a->end)
            break;
        if (num_scan(p, a->end, &p, &code) || !(code >= 0 && code < 256)) {
            free(text);
            wrong(x, a, "an invalid character code", "codes from 0 to 255", e);
            return NULL;
        }
        text[count++] = (char)(unsigned char)code;
    }
    *size = (size_t)count;
    return text;
}
