#include "base/chars.h"

#include <stdint.h>
#include <string.h>
#include <strings.h>

/* How many bytes follow the first of a character of several bytes; 0: none begins so. */
static int utf8_more(unsigned char first)
{
    if (first < 0xc2 || first >= 0xf5)
        return 0;
    if (first < 0xe0)
        return 1;
    return first < 0xf0 ? 2 : 3;
}

/* The length of the well-formed UTF-8 character at p (not NUL), or 0. */
static int utf8_length(const unsigned char *p)
{
    if (p[0] < 0x80)
        return 1;
    int more = utf8_more(p[0]);
    for (int i = 1; i <= more; i++)
        if ((p[i] & 0xc0) != 0x80)
            return 0;
    bool overlong = (p[0] == 0xe0 && p[1] < 0xa0) || (p[0] == 0xf0 && p[1] < 0x90);
    bool surrogate = p[0] == 0xed && p[1] > 0x9f;
    bool past = p[0] == 0xf4 && p[1] > 0x8f;
    return more && !overlong && !surrogate && !past ? more + 1 : 0;
}

bool chars_utf8(const char *text)
{
    const unsigned char *p = (const unsigned char *)text;
    while (*p) {
        int n = utf8_length(p);
        if (!n)
            return false;
        p += n;
    }
    return true;
}

void chars_mend(char *text)
{
    unsigned char *p = (unsigned char *)text;
    while (*p) {
        int n = utf8_length(p);
        if (!n)
            *p = '?';
        p += n ? n : 1;
    }
}

void chars_tame(char *text)
{
    for (unsigned char *p = (unsigned char *)text; *p; p++) {
        const bool c1 = p[0] == 0xc2 && p[1] >= 0x80 && p[1] < 0xa0;
        if (c1)
            p[1] = '?';
        if (c1 || p[0] < 0x20 || p[0] == 0x7f)
            p[0] = '?';
    }
}

/* The number of the character whose n bytes are well-formed UTF-8. */
static uint32_t code_of(const unsigned char *p, int n)
{
    uint32_t code = n == 1 ? p[0] : p[0] & (0x7fu >> n);
    for (int i = 1; i < n; i++)
        code = code << 6 | (p[i] & 0x3fu);
    return code;
}

/* Unicode's blocks of combining marks, and of characters that are wide or full-width. */
static int columns_of(uint32_t code)
{
    static const struct {
        uint32_t from, to;
        int columns;
    } block[] = {{0x300, 0x36f, 0},     {0x1100, 0x115f, 2},  {0x200b, 0x200f, 0}, {0x20d0, 0x20ff, 0},
                 {0x2e80, 0xa4cf, 2},   {0xac00, 0xd7a3, 2},  {0xf900, 0xfaff, 2}, {0xfe00, 0xfe0f, 0},
                 {0xfe20, 0xfe2f, 0},   {0xfe30, 0xfe6f, 2},  {0xff00, 0xff60, 2}, {0xffe0, 0xffe6, 2},
                 {0x1f300, 0x1faff, 2}, {0x20000, 0x3fffd, 2}};
    for (size_t i = 0; i < sizeof block / sizeof *block; i++)
        if (code >= block[i].from && code <= block[i].to)
            return block[i].columns;
    return 1;
}

int chars_width(const char *text)
{
    int width = 0;
    for (const unsigned char *p = (const unsigned char *)text; *p;) {
        const int n = utf8_length(p);
        width += n ? columns_of(code_of(p, n)) : 1;
        p += n ? n : 1;
    }
    return width;
}

int chars_hex(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

int chars_escaped(const char *p)
{
    if (p[0] != '\\' || p[1] != 'x' || chars_hex(p[2]) < 0 || chars_hex(p[3]) < 0)
        return -1;
    return 16 * chars_hex(p[2]) + chars_hex(p[3]);
}

enum { ESCAPED = 4 };

/* What stands for the character at p, at most ESCAPED bytes: *length of them, for *used of p's. own: p is in a file's
 * own bytes; else what is written as \xHH already stays. */
static void escape_one(const char *p, bool own, char *to, size_t *length, size_t *used)
{
    static const char digits[] = "0123456789abcdef";
    unsigned char c = (unsigned char)*p;
    int n = utf8_length((const unsigned char *)p);
    if (n && c >= ' ' && c != 0x7f && !(own && chars_escaped(p) >= 0)) {
        memcpy(to, p, (size_t)n);
        *length = *used = (size_t)n;
        return;
    }
    to[0] = '\\';
    to[1] = 'x';
    to[2] = digits[c >> 4];
    to[3] = digits[c & 15];
    *length = ESCAPED;
    *used = 1;
}

static size_t escape(const char *text, size_t n, bool own, char *to)
{
    size_t size = 0;
    for (size_t at = 0, length, used; at < n; at += used, size += length)
        escape_one(text + at, own, to + size, &length, &used);
    to[size] = 0;
    return size;
}

size_t chars_escape(const char *text, size_t n, char *to)
{
    return escape(text, n, true, to);
}

size_t chars_show(const char *text, size_t n, char *to)
{
    return escape(text, n, false, to);
}

static bool same(const char *a, const char *b, size_t n, int flags)
{
    return flags & CHARS_ANY_CASE ? !strncasecmp(a, b, n) : !strncmp(a, b, n);
}

typedef enum reading { AS_IT_STANDS, OWN_BYTES, DECODED } reading;

/* escape_one of the bytes that what is typed stands for; m: what is left of it. */
static void decode_one(const char *typed, size_t m, char *to, size_t *length, size_t *used)
{
    char byte[ESCAPED + 1] = "";
    size_t end[ESCAPED + 1] = {0}; /* where in `typed` each byte ends */
    int n = 0;
    for (size_t at = 0; n < ESCAPED && at < m; n++) {
        const int value = m - at >= ESCAPED ? chars_escaped(typed + at) : -1;
        byte[n] = value < 0 ? typed[at] : (char)value;
        at += value < 0 ? 1 : ESCAPED;
        end[n + 1] = at;
    }
    escape_one(byte, true, to, length, used);
    *used = end[*used];
}

static bool means(const char *typed, size_t m, const char *name, size_t n, int flags, reading how)
{
    size_t done = 0;
    for (size_t at = 0, length, used; at < m; at += used, done += length) {
        char one[ESCAPED];
        if (how == DECODED)
            decode_one(typed + at, m - at, one, &length, &used);
        else
            escape_one(typed + at, how == OWN_BYTES, one, &length, &used);
        if (length > n - done || !same(one, name + done, length, flags))
            return false;
    }
    return done == n || flags & CHARS_BEGINS;
}

bool chars_means(const char *typed, size_t m, const char *name, size_t n, int flags)
{
    return means(typed, m, name, n, flags, AS_IT_STANDS) || means(typed, m, name, n, flags, OWN_BYTES) ||
           means(typed, m, name, n, flags, DECODED);
}

bool chars_mean(const char *typed, const char *name)
{
    return chars_means(typed, strlen(typed), name, strlen(name), 0);
}
