#include "model/text.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/num.h"
#include "model/binary.h"
#include "model/text_value.h"

#include <inttypes.h>
#include <stdarg.h>
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
    s->stopped = n == -1 || (n >= 0 && !ended);
    if (n < 0)
        return n == -1 ? 0 : -1;
    return ended ? 1 : item_cut(s, e);
}

/* The same where the stream may not end. */
static int need_line(item_source *s, char **line, err *e)
{
    int got = next_line(s, line, e);
    if (got == 0)
        return item_cut(s, e);
    return got < 0 ? -1 : 0;
}

SINEW_PRINTF(3, 4) static int line_error(const item_source *s, err *e, const char *format, ...)
{
    char text[800];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return err_set(e, in_name(s->s), in_lines(s->s), "%s", text);
}

static int bad_line(const item_source *s, err *e, const char *expected)
{
    return line_error(s, e, "expected %s", expected);
}

static int read_meta(item_source *s, item *it, char *p, err *e)
{
    char *key = text_word(&p), *value = text_quoted(&p);
    if (!value || !text_ended(p))
        return bad_line(s, e, "meta KEY \"VALUE\"");
    it->key = mem_text(key, e);
    it->text = mem_text(value, e);
    return it->key && it->text ? 0 : -1;
}

static int read_prov(item_source *s, item *it, char *p, err *e)
{
    char *tool = text_word(&p), *version = text_word(&p), *options = text_quoted(&p);
    if (!options || !text_ended(p))
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
    char *name = text_word(&p);
    if (num_int(text_word(&p), 0, INT64_MAX, &it->number) || !text_ended(p))
        return bad_line(s, e, "axis NAME COUNT");
    it->key = mem_text(name, e);
    return it->key ? 0 : -1;
}

static int read_frame(item_source *s, item *it, char *p, err *e)
{
    if (num_int(text_word(&p), INT64_MIN, INT64_MAX, &it->number) || num_double(text_word(&p), &it->time) ||
        !text_ended(p))
        return bad_line(s, e, "frame INDEX TIME");
    return 0;
}

static int read_fail(item_source *s, item *it, char *p, err *e)
{
    int bad = num_int(text_word(&p), 0, INT32_MAX, &it->number);
    char *text = bad ? NULL : text_quoted(&p);
    if (!text || !text_ended(p))
        return bad_line(s, e, "fail STATUS \"TEXT\"");
    it->text = mem_text(text, e);
    return it->text ? 0 : -1;
}

static int read_end(item_source *s, item *it, char *p, err *e)
{
    (void)it;
    return text_ended(p) ? 0 : bad_line(s, e, "end");
}

/* The values of an array while they come. */
typedef struct rows_read {
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
        p = text_blanks(p);
        p = *p ? text_value(a->type, p, r->data + (size_t)r->count * each) : NULL;
        r->count += p != NULL;
        if (!p || (*p && !chars_blank(*p)))
            return line_error(s, e, "array %s, row %" PRId64 " (of %" PRId64 ", from 0), value %d: expected %d %s",
                              a->name, row, a->rows, (int)c + 1, (int)a->columns, text_value_what(a->type));
    }
    if (!text_ended(p))
        return line_error(s, e, "array %s, row %" PRId64 " has too many values; expected %d %s", a->name, row,
                          (int)a->columns, text_value_what(a->type));
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

/* Takes the rows of an array, which are not kept. */
static int pass_over(item_source *s, item *it, err *e)
{
    char *line;
    it->passed = true;
    for (int64_t row = 0; row < it->array.rows; row++)
        if (need_line(s, &line, e) || item_hurries(s, e))
            return -1;
    return 0;
}

static int read_hex8(const char *text, uint32_t *value)
{
    *value = 0;
    for (int i = 0; i < 8; i++) {
        int digit = chars_hex(text[i]);
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
    char *p = text_blanks(line);
    if (strncmp(p, "crc", 3) || !(chars_blank(p[3]) || !p[3])) {
        s->held = line;
        return 0;
    }
    p += 3;
    if (read_hex8(text_word(&p), &crc) || !text_ended(p))
        return bad_line(s, e, "crc and 8 hexadecimal digits");
    want = it->passed ? crc : binary_crc(it);
    if (crc == want)
        return 0;
    const char *kind = it->kind == ITEM_ARRAY ? "array" : "block";
    const char *name = it->kind == ITEM_ARRAY ? it->array.name : it->block.type;
    return line_error(s, e,
                      "crc %08" PRIx32 " does not fit %s %s; expected %08" PRIx32 ", or no crc line after an edit", crc,
                      kind, name, want);
}

static int read_array(item_source *s, item *it, char *p, err *e)
{
    model_array *a = &it->array;
    int64_t columns;
    char *name = text_word(&p), *type = text_word(&p), *unit = text_word(&p), *axis = text_word(&p);
    a->type = model_type_of(type);
    if (a->type == MODEL_TYPES || num_int(text_word(&p), 1, INT32_MAX, &columns) || !text_ended(p)) {
        a->type = MODEL_U8;
        return bad_line(s, e, "array NAME TYPE UNIT AXIS COLUMNS, the type f32 f64 i32 i64 u8 or str");
    }
    a->columns = (int32_t)columns;
    a->name = mem_text(name, e);
    a->unit = mem_text(unit, e);
    a->axis = mem_text(axis, e);
    const int64_t n = a->name && a->unit && a->axis ? item_heading(s, it, e) : -1;
    if (n < 0)
        return -1;
    const int bad = item_passes(s, it, n) ? pass_over(s, it, e) : read_rows(s, a, e);
    return bad || read_crc(s, it, e);
}

/* The bytes of one line, at most what is left of the block. */
static int read_hex_line(item_source *s, model_block *b, uint64_t *done, int64_t *capacity, err *e)
{
    char *p;
    if (need_line(s, &p, e))
        return -1;
    for (p = text_blanks(p); !text_ended(p); p += 2) {
        int high = chars_hex(p[0]), low = high < 0 ? -1 : chars_hex(p[1]);
        if (low < 0 || *done == b->length)
            return line_error(s, e, "expected pairs of hexadecimal digits, %" PRIu64 " bytes in all", b->length);
        if (mem_grow(&b->payload, capacity, (int64_t)*done + 1, 1, "a block", e))
            return -1;
        b->payload[(*done)++] = (unsigned char)(high * 16 + low);
    }
    return 0;
}

static int read_hex(item_source *s, model_block *b, err *e)
{
    int64_t capacity = 0;
    uint64_t done = 0;
    /* An empty block is a block all the same: its payload is not NULL. */
    if (mem_grow(&b->payload, &capacity, 1, 1, "a block", e))
        return -1;
    while (done < b->length)
        if (read_hex_line(s, b, &done, &capacity, e))
            return -1;
    return 0;
}

static int read_block(item_source *s, item *it, char *p, err *e)
{
    model_block *b = &it->block;
    int64_t length;
    const char *type = text_word(&p);
    size_t n = strspn(type, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789");
    if (n != 4 || type[n] || type[0] < 'a' || read_hex8(text_word(&p), &b->flags) ||
        num_int(text_word(&p), 0, INT64_MAX, &length) || !text_ended(p))
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
    char none[] = "", *line = none;
    const int cut = need_line(s, &line, e);
    s->within = *text_blanks(line);
    if (cut)
        return -1;
    it->at = in_lines(s->s);
    const char *key = text_word(&line);
    for (int k = 0; k < KEYWORDS; k++)
        if (!strcmp(key, keywords[k].word)) {
            it->kind = (item_kind)k;
            return keywords[k].read(s, it, line, e);
        }
    if (!*key)
        return item_error(s, it, e, "an empty line; expected meta, prov, axis, array, block, frame, end or fail");
    return item_error(s, it, e, "'%.40s'; expected meta, prov, axis, array, block, frame, end or fail", key);
}

static int text_begin(item_source *s, err *e)
{
    char *line;
    int64_t major, minor = 0;
    if (need_line(s, &line, e))
        return -1;
    const char *name = text_word(&line);
    char *version = text_word(&line), *point = strchr(version, '.');
    if (point)
        *point++ = 0;
    if (strcmp(name, "%sinew") || num_int(version, 0, INT32_MAX, &major) ||
        (point && num_int(point, 0, INT32_MAX, &minor)) || strcmp(text_word(&line), "text") || !text_ended(line))
        return bad_line(s, e, "%sinew 1 text");
    if (major != ITEM_MAJOR)
        return line_error(s, e, "is a model of format version %" PRId64 "; expected %d", major, ITEM_MAJOR);
    return 0;
}

/* ---- writing ---- */

static void put_array(out *o, const model_array *a)
{
    out_format(o, "array %s %s %s %s %" PRId32 "\n", a->name, model_type_name(model_stored(a)), a->unit, a->axis,
               a->columns);
    for (int64_t row = 0; row < a->rows; row++)
        for (int32_t c = 0; c < a->columns; c++) {
            text_put_value(o, a, row * a->columns + c);
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
    text_put_quoted(o, text[head] ? text + head + 1 : "");
    out_text(o, "\n");
}

static void text_write(out *o, const item *it)
{
    switch (it->kind) {
    case ITEM_META:
        out_format(o, "meta %s ", it->key);
        text_put_quoted(o, it->text);
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
        text_put_quoted(o, it->text);
        out_text(o, "\n");
        break;
    }
}

static void text_write_begin(out *o)
{
    out_format(o, "%%sinew %d text\n", ITEM_MAJOR);
}

const encoding text_encoding = {true, text_begin, text_read, text_write_begin, text_write};
