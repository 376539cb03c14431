#include "model/text.h"

#include "base/mem.h"
#include "base/num.h"
#include "model/binary.h"
#include "model/check.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEX_ROW = 32 }; /* bytes of an unknown block on a line */

/* ---- reading ---- */

/* The next line, which must have its end: a cut must show. 1: a line; 0: the end of the stream; -1: e filled. */
static int next_line(item_source *s, char **line, err *e)
{
    bool ended;
    if (s->held) {
        *line = s->held;
        s->held = NULL;
        return 1;
    }
    int64_t n = in_line(s->s, line, &ended, e);
    if (n < 0)
        return n == -1 ? 0 : -1;
    return ended ? 1 : item_cut(s, e);
}

/* The same where the stream may not end. */
static int need_line(item_source *s, char **line, err *e)
{
    int got = next_line(s, line, e);
    return got > 0 ? 0 : got < 0 ? -1 : item_cut(s, e);
}

static int bad_line(const item_source *s, err *e, const char *expected)
{
    return item_error(s, in_lines(s->s), "", e, "expected %s", expected);
}

static bool blank(char c)
{
    return c == ' ' || c == '\t';
}

static char *skip_blanks(char *p)
{
    while (blank(*p))
        p++;
    return p;
}

/* The next word of the line, cut out of it; "" at the end. */
static char *word(char **p)
{
    char *from = skip_blanks(*p), *to = from;
    while (*to && !blank(*to))
        to++;
    *p = *to ? to + 1 : to;
    *to = 0;
    return from;
}

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* The character of an escape sequence that begins behind its backslash, or -1; *p steps past it. */
static int escaped(char **p)
{
    static const char from[] = "\"\\ntr", to[] = "\"\\\n\t\r";
    char c = *(*p)++;
    const char *at = c ? strchr(from, c) : NULL;
    if (at)
        return to[at - from];
    if (c != 'x' || hex_digit((*p)[0]) < 0 || hex_digit((*p)[1]) < 0)
        return -1;
    int value = hex_digit((*p)[0]) * 16 + hex_digit((*p)[1]);
    *p += 2;
    return value > 0 && value < 0x80 ? value : -1;
}

/* A quoted string, unescaped in place; NULL where there is none. */
static char *quoted(char **p)
{
    char *from = skip_blanks(*p), *to;
    if (*from != '"')
        return NULL;
    to = ++from;
    for (*p = from; **p != '"';) {
        int c = (unsigned char)*(*p)++;
        if (c == '\\')
            c = escaped(p);
        if (c <= 0 || (c < ' ' && (*p)[-1] == (char)c))
            return NULL;
        *to++ = (char)c;
    }
    ++*p;
    *to = 0;
    return from;
}

static bool at_end(char *p)
{
    return !*skip_blanks(p);
}

static int read_meta(item_source *s, item *it, char *p, err *e)
{
    char *key = word(&p), *value = quoted(&p);
    if (!value || !at_end(p))
        return bad_line(s, e, "meta KEY \"VALUE\"");
    it->key = mem_text(key, e);
    it->text = mem_text(value, e);
    return it->key && it->text ? 0 : -1;
}

static int read_prov(item_source *s, item *it, char *p, err *e)
{
    char *tool = word(&p), *version = word(&p), *options = quoted(&p);
    if (!options || !at_end(p))
        return bad_line(s, e, "prov TOOL VERSION \"OPTIONS\"");
    size_t size = strlen(tool) + strlen(version) + strlen(options) + 3;
    it->text = mem_array((int64_t)size, 1, "provenance", e);
    if (!it->text)
        return -1;
    snprintf(it->text, size, "%s %s%s%s", tool, version, *options ? " " : "", options);
    return 0;
}

static int read_axis(item_source *s, item *it, char *p, err *e)
{
    char *name = word(&p);
    if (num_int(word(&p), 0, INT64_MAX, &it->number) || !at_end(p))
        return bad_line(s, e, "axis NAME COUNT");
    it->key = mem_text(name, e);
    return it->key ? 0 : -1;
}

static int read_frame(item_source *s, item *it, char *p, err *e)
{
    if (num_int(word(&p), INT64_MIN, INT64_MAX, &it->number) || num_double(word(&p), &it->time) || !at_end(p))
        return bad_line(s, e, "frame INDEX TIME");
    return 0;
}

static int read_fail(item_source *s, item *it, char *p, err *e)
{
    int bad = num_int(word(&p), 0, INT32_MAX, &it->number);
    char *text = bad ? NULL : quoted(&p);
    if (!text || !at_end(p))
        return bad_line(s, e, "fail STATUS \"TEXT\"");
    it->text = mem_text(text, e);
    return it->text ? 0 : -1;
}

static int read_end(item_source *s, item *it, char *p, err *e)
{
    (void)it;
    return at_end(p) ? 0 : bad_line(s, e, "end");
}

/* nan and inf as printf writes them, with or without a sign; NULL where it is neither. */
static char *special(char *p, double *value)
{
    bool minus = *p == '-';
    p += *p == '-' || *p == '+';
    if (strncmp(p, "nan", 3) && strncmp(p, "inf", 3))
        return NULL;
    *value = *p == 'n' ? NAN : minus ? -INFINITY : INFINITY;
    return p + 3;
}

static char *value_f64(char *p, void *to)
{
    double v;
    const char *stop;
    char *end = special(p, &v);
    if (!end) {
        if (num_scan(p, p + strlen(p), &stop, &v))
            return NULL;
        end = p + (stop - p);
    }
    memcpy(to, &v, sizeof v);
    return end;
}

/* Rounding to double and then to float differs from rounding once only where the double lies halfway between two
 * floats; the ends of the range are strtof's too. */
static bool rounds_twice(double v)
{
    uint64_t bits;
    memcpy(&bits, &v, sizeof bits);
    return (bits & 0x1fffffff) == 0x10000000 || fabs(v) < (double)FLT_MIN || fabs(v) >= (double)FLT_MAX;
}

static char *value_f32(char *p, void *to)
{
    double v;
    char *end = value_f64(p, &v);
    if (!end)
        return NULL;
    float f = isfinite(v) && v != 0 && rounds_twice(v) ? strtof(p, NULL) : (float)v;
    if (isfinite(v) && !isfinite(f))
        return NULL;
    memcpy(to, &f, sizeof f);
    return end;
}

/* A decimal integer within [low, high]; NULL where it is none. */
static char *value_int(char *p, int64_t low, int64_t high, int64_t *to)
{
    bool minus = *p == '-';
    uint64_t v = 0, most = minus ? (uint64_t) - (low + 1) + 1 : (uint64_t)high;
    p += *p == '-' || *p == '+';
    char *first = p;
    for (; *p >= '0' && *p <= '9'; p++) {
        unsigned digit = (unsigned)(*p - '0');
        if (v > (most - digit) / 10 || digit > most)
            return NULL;
        v = 10 * v + digit;
    }
    *to = (int64_t)(minus ? 0 - v : v);
    return p > first ? p : NULL;
}

static char *value_i32(char *p, void *to)
{
    int64_t v = 0;
    p = value_int(p, INT32_MIN, INT32_MAX, &v);
    int32_t small = (int32_t)v;
    memcpy(to, &small, sizeof small);
    return p;
}

static char *value_i64(char *p, void *to)
{
    int64_t v = 0;
    p = value_int(p, INT64_MIN, INT64_MAX, &v);
    memcpy(to, &v, sizeof v);
    return p;
}

static char *value_u8(char *p, void *to)
{
    int64_t v = 0;
    p = value_int(p, 0, UINT8_MAX, &v);
    *(uint8_t *)to = (uint8_t)v;
    return p;
}

static char *value_str(char *p, void *to)
{
    char *text = quoted(&p);
    if (!text)
        return NULL;
    text = strdup(text);
    memcpy(to, &text, sizeof text);
    return text ? p : NULL;
}

/* Reads one value at p into memory; the value's end, or NULL. */
typedef char *value_reader(char *p, void *to);

static const struct {
    value_reader *read;
    const char *what;
} values[MODEL_TYPES] = {
    [MODEL_F32] = {value_f32, "numbers of f32, nan or inf"}, [MODEL_F64] = {value_f64, "numbers of f64, nan or inf"},
    [MODEL_I32] = {value_i32, "whole numbers of i32"},       [MODEL_I64] = {value_i64, "whole numbers of i64"},
    [MODEL_U8] = {value_u8, "whole numbers from 0 to 255"},  [MODEL_STR] = {value_str, "quoted strings"},
};

/* The values of an array while they come. */
typedef struct column_reader {
    char *data;
    int64_t capacity, count;
} rows_read;

static int read_row(item_source *s, const model_array *a, int64_t row, rows_read *r, err *e)
{
    size_t each = model_type_size(a->type);
    char *p;
    if (need_line(s, &p, e))
        return -1;
    for (int32_t c = 0; c < a->columns; c++) {
        if (mem_grow(&r->data, &r->capacity, r->count + 1, each, a->name, e))
            return -1;
        p = skip_blanks(p);
        p = *p ? values[a->type].read(p, r->data + (size_t)r->count * each) : NULL;
        r->count += p != NULL;
        if (!p || (*p && !blank(*p)))
            return item_error(s, in_lines(s->s), "", e,
                              "row %" PRId64 " of %" PRId64 " of array %s, column %d: expected %d %s", row, a->rows,
                              a->name, (int)c + 1, (int)a->columns, values[a->type].what);
    }
    if (!at_end(p))
        return item_error(s, in_lines(s->s), "", e,
                          "row %" PRId64 " of %" PRId64 " of array %s has too many values; expected %d %s", row,
                          a->rows, a->name, (int)a->columns, values[a->type].what);
    return 0;
}

static void drop_rows(const model_array *a, rows_read *r)
{
    char **list = (char **)(void *)r->data;
    for (int64_t i = 0; a->type == MODEL_STR && i < r->count; i++)
        free(list[i]);
    free(r->data);
}

static int read_rows(item_source *s, model_array *a, err *e)
{
    size_t each = model_type_size(a->type);
    rows_read r = {0};
    int status = mem_grow(&r.data, &r.capacity, 1, each, a->name, e);
    for (int64_t row = 0; !status && row < a->rows; row++)
        status = read_row(s, a, row, &r, e);
    if (status) {
        drop_rows(a, &r);
        return -1;
    }
    void *fitted = realloc(r.data, r.count ? (size_t)r.count * each : 1);
    a->data = fitted ? fitted : r.data;
    item_canonical(a->type, a->data, r.count);
    return 0;
}

static int read_hex8(const char *text, uint32_t *value)
{
    *value = 0;
    for (int i = 0; i < 8; i++) {
        int digit = hex_digit(text[i]);
        if (digit < 0)
            return -1;
        *value = *value << 4 | (uint32_t)digit;
    }
    return text[8] ? -1 : 0;
}

/* The checksum that may follow what was read; another line is held for the next item. */
static int read_crc(item_source *s, const item *it, err *e)
{
    char *line;
    uint32_t crc, want;
    int got = next_line(s, &line, e);
    if (got <= 0)
        return got;
    char *p = skip_blanks(line);
    if (strncmp(p, "crc", 3) || !(blank(p[3]) || !p[3])) {
        s->held = line;
        return 0;
    }
    p += 3;
    if (read_hex8(word(&p), &crc) || !at_end(p))
        return bad_line(s, e, "crc and 8 hexadecimal digits");
    want = binary_crc(it);
    if (crc == want)
        return 0;
    return item_error(s, in_lines(s->s), "", e,
                      "crc %08" PRIx32 " does not fit %s %s; expected %08" PRIx32 ", or no crc line after an edit", crc,
                      it->kind == ITEM_ARRAY ? "array" : "block",
                      it->kind == ITEM_ARRAY ? it->array.name : it->block.type, want);
}

static int read_array(item_source *s, item *it, char *p, err *e)
{
    model_array *a = &it->array;
    int64_t columns;
    char *name = word(&p), *type = word(&p), *unit = word(&p), *axis = word(&p);
    a->type = model_type_of(type);
    if (a->type == MODEL_TYPES || num_int(word(&p), 1, INT32_MAX, &columns) || !at_end(p)) {
        a->type = MODEL_U8;
        return bad_line(s, e, "array NAME TYPE UNIT AXIS COLUMNS, the type f32 f64 i32 i64 u8 or str");
    }
    a->columns = (int32_t)columns;
    a->name = mem_text(name, e);
    a->unit = mem_text(unit, e);
    a->axis = mem_text(axis, e);
    if (!a->name || !a->unit || !a->axis || item_heading(s, it, e) < 0)
        return -1;
    return read_rows(s, a, e) || read_crc(s, it, e);
}

static int read_hex(item_source *s, model_block *b, err *e)
{
    int64_t capacity = 0;
    uint64_t done = 0;
    while (done < b->length) {
        char *line;
        if (need_line(s, &line, e))
            return -1;
        for (char *p = skip_blanks(line); done < b->length && !at_end(p); p += 2) {
            int high = hex_digit(p[0]), low = high < 0 ? -1 : hex_digit(p[1]);
            if (low < 0)
                return bad_line(s, e, "pairs of hexadecimal digits");
            if (mem_grow(&b->payload, &capacity, (int64_t)done + 1, 1, "a block", e))
                return -1;
            b->payload[done++] = (unsigned char)(high * 16 + low);
        }
    }
    return 0;
}

static int read_block(item_source *s, item *it, char *p, err *e)
{
    model_block *b = &it->block;
    int64_t length;
    const char *type = word(&p);
    size_t n = strspn(type, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789");
    if (n != 4 || type[n] || type[0] < 'a' || read_hex8(word(&p), &b->flags) ||
        num_int(word(&p), 0, INT64_MAX, &length) || !at_end(p))
        return bad_line(s, e, "block TYPE FLAGS LENGTH, the type 4 letters or digits, the first a lower-case letter");
    memcpy(b->type, type, sizeof b->type);
    b->length = (uint64_t)length;
    return read_hex(s, b, e) || read_crc(s, it, e);
}

static const struct {
    const char *word;
    int (*read)(item_source *s, item *it, char *p, err *e);
} keywords[] = {
    [ITEM_META] = {"meta", read_meta},    [ITEM_PROV] = {"prov", read_prov},    [ITEM_AXIS] = {"axis", read_axis},
    [ITEM_ARRAY] = {"array", read_array}, [ITEM_BLOCK] = {"block", read_block}, [ITEM_FRAME] = {"frame", read_frame},
    [ITEM_END] = {"end", read_end},       [ITEM_FAIL] = {"fail", read_fail},
};

enum { KEYWORDS = sizeof keywords / sizeof *keywords };

static int text_read(item_source *s, item *it, err *e)
{
    char *line;
    if (need_line(s, &line, e))
        return -1;
    it->at = in_lines(s->s);
    const char *key = word(&line);
    for (int k = 0; k < KEYWORDS; k++)
        if (!strcmp(key, keywords[k].word)) {
            it->kind = (item_kind)k;
            return keywords[k].read(s, it, line, e);
        }
    return item_error(s, it->at, "", e, "'%.40s'; expected meta, prov, axis, array, block, frame, end or fail", key);
}

static int text_begin(item_source *s, err *e)
{
    char *line;
    int64_t major, minor = 0;
    if (need_line(s, &line, e))
        return -1;
    const char *name = word(&line);
    char *version = word(&line), *point = strchr(version, '.');
    if (point)
        *point++ = 0;
    if (strcmp(name, "%sinew") || num_int(version, 0, INT32_MAX, &major) ||
        (point && num_int(point, 0, INT32_MAX, &minor)) || strcmp(word(&line), "text") || !at_end(line))
        return bad_line(s, e, "%sinew 1 text");
    if (major != ITEM_MAJOR)
        return item_error(s, 1, "", e, "is a model of format version %" PRId64 "; expected %d", major, ITEM_MAJOR);
    return 0;
}

/* ---- writing ---- */

static void put_quoted(out *o, const char *text)
{
    static const char from[] = "\"\\\n\t\r", to[] = "\"\\ntr";
    out_write(o, "\"", 1);
    while (*text) {
        size_t n = 0;
        while ((unsigned char)text[n] >= ' ' && text[n] != '"' && text[n] != '\\' && text[n] != 0x7f)
            n++;
        out_write(o, text, n);
        text += n;
        if (!*text)
            break;
        const char *at = strchr(from, *text);
        if (at)
            out_format(o, "\\%c", to[at - from]);
        else
            out_format(o, "\\x%02x", *text);
        text++;
    }
    out_write(o, "\"", 1);
}

static void put_value(out *o, const model_array *a, int64_t i)
{
    switch (a->type) {
    case MODEL_F32:
        out_format(o, isnan(a->f32[i]) ? "nan" : "%.9g", (double)a->f32[i]);
        break;
    case MODEL_F64:
        out_format(o, isnan(a->f64[i]) ? "nan" : "%.17g", a->f64[i]);
        break;
    case MODEL_I32:
        out_format(o, "%" PRId32, a->i32[i]);
        break;
    case MODEL_I64:
        out_format(o, "%" PRId64, a->i64[i]);
        break;
    case MODEL_U8:
        out_format(o, "%d", a->u8[i]);
        break;
    case MODEL_STR:
        put_quoted(o, a->str[i]);
        break;
    case MODEL_TYPES:
        break;
    }
}

static void put_array(out *o, const model_array *a)
{
    out_format(o, "array %s %s %s %s %" PRId32 "\n", a->name, model_type_name(a->type), a->unit, a->axis, a->columns);
    for (int64_t row = 0; row < a->rows; row++)
        for (int32_t c = 0; c < a->columns; c++) {
            put_value(o, a, row * a->columns + c);
            out_write(o, c + 1 < a->columns ? " " : "\n", 1);
        }
}

static void put_hex(out *o, const model_block *b)
{
    static const char digits[] = "0123456789abcdef";
    char line[2 * HEX_ROW + 1];
    out_format(o, "block %s %08" PRIx32 " %" PRIu64 "\n", b->type, b->flags, b->length);
    for (uint64_t at = 0; at < b->length; at += HEX_ROW) {
        size_t n = b->length - at < HEX_ROW ? b->length - at : HEX_ROW;
        for (size_t i = 0; i < n; i++) {
            line[2 * i] = digits[b->payload[at + i] >> 4];
            line[2 * i + 1] = digits[b->payload[at + i] & 15];
        }
        line[2 * n] = '\n';
        out_write(o, line, 2 * n + 1);
    }
}

/* "TOOL VERSION OPTIONS" as prov TOOL VERSION "OPTIONS". */
static void put_prov(out *o, const char *text)
{
    size_t tool = strcspn(text, " ");
    size_t head = tool + (text[tool] ? 1 + strcspn(text + tool + 1, " ") : 0);
    out_text(o, "prov ");
    out_write(o, text, head);
    out_text(o, " ");
    put_quoted(o, text[head] ? text + head + 1 : "");
    out_text(o, "\n");
}

static void text_write(out *o, const item *it)
{
    switch (it->kind) {
    case ITEM_META:
        out_format(o, "meta %s ", it->key);
        put_quoted(o, it->text);
        out_text(o, "\n");
        break;
    case ITEM_PROV:
        put_prov(o, it->text);
        break;
    case ITEM_AXIS:
        out_format(o, "axis %s %" PRId64 "\n", it->key, it->number);
        break;
    case ITEM_ARRAY:
        put_array(o, &it->array);
        out_format(o, "crc %08" PRIx32 "\n", binary_crc(it));
        break;
    case ITEM_BLOCK:
        put_hex(o, &it->block);
        out_format(o, "crc %08" PRIx32 "\n", binary_crc(it));
        break;
    case ITEM_FRAME:
        out_format(o, "frame %" PRId64 " %.17g\n", it->number, it->time);
        break;
    case ITEM_END:
        out_text(o, "end\n");
        break;
    case ITEM_FAIL:
        out_format(o, "fail %" PRId64 " ", it->number);
        put_quoted(o, it->text);
        out_text(o, "\n");
        break;
    }
}

static void text_write_begin(out *o)
{
    out_format(o, "%%sinew %d text\n", ITEM_MAJOR);
}

const encoding text_encoding = {true, text_begin, text_read, text_write_begin, text_write};
