#include "model/text_value.h"

#include "base/chars.h"
#include "base/num.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

char *text_blanks(char *p)
{
    while (chars_blank(*p))
        p++;
    return p;
}

char *text_word(char **p)
{
    char *from = text_blanks(*p), *to = from;
    while (*to && !chars_blank(*to))
        to++;
    *p = *to ? to + 1 : to;
    *to = 0;
    return from;
}

/* The character of an escape sequence that begins behind its backslash, or -1; *p steps past it. */
static int escaped(char **p)
{
    static const char from[] = "\"\\ntr", to[] = "\"\\\n\t\r";
    char c = *(*p)++;
    const char *at = c ? strchr(from, c) : NULL;
    if (at)
        return to[at - from];
    if (c != 'x' || chars_hex((*p)[0]) < 0 || chars_hex((*p)[1]) < 0)
        return -1;
    int value = chars_hex((*p)[0]) * 16 + chars_hex((*p)[1]);
    *p += 2;
    return value > 0 && value < 0x80 ? value : -1;
}

char *text_quoted(char **p)
{
    char *from = text_blanks(*p), *to;
    if (*from != '"')
        return NULL;
    to = ++from;
    for (*p = from; **p != '"';) {
        int c = (unsigned char)*(*p)++;
        if (c == '\\')
            c = escaped(p);
        else if (c < ' ')
            c = -1;
        if (c < 0)
            return NULL;
        *to++ = (char)c;
    }
    ++*p;
    *to = 0;
    return from;
}

bool text_ended(char *p)
{
    return !*text_blanks(p);
}

/* nan and inf as printf writes them, with or without a sign; NULL where it is neither. */
static char *special(char *p, double *value)
{
    bool minus = *p == '-';
    p += *p == '-' || *p == '+';
    if (strncmp(p, "nan", 3) && strncmp(p, "inf", 3))
        return NULL;
    if (*p == 'n')
        *value = NAN;
    else
        *value = minus ? -INFINITY : INFINITY;
    return p + 3;
}

static char *value_f64(char *p, void *to)
{
    double v;
    const char *stop;
    char *end = special(p, &v);
    if (!end) {
        if (num_scan(p, p + strcspn(p, " \t"), &stop, &v))
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
    char *text = text_quoted(&p);
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
} readers[MODEL_TYPES] = {
    [MODEL_F32] = {value_f32, "numbers of f32, nan or inf"}, [MODEL_F64] = {value_f64, "numbers of f64, nan or inf"},
    [MODEL_I32] = {value_i32, "whole numbers of i32"},       [MODEL_I64] = {value_i64, "whole numbers of i64"},
    [MODEL_U8] = {value_u8, "whole numbers from 0 to 255"},  [MODEL_STR] = {value_str, "quoted strings"},
};

char *text_value(model_type type, char *p, void *to)
{
    return readers[type].read(p, to);
}

const char *text_value_what(model_type type)
{
    return readers[type].what;
}

void text_put_quoted(out *o, const char *text)
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

void text_put_value(out *o, const model_array *a, int64_t i)
{
    if (a->narrow) {
        out_format(o, isnan(a->f64[i]) ? "nan" : "%.9g", (double)(float)a->f64[i]);
        return;
    }
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
        text_put_quoted(o, a->str[i]);
        break;
    case MODEL_TYPES:
        break;
    }
}
