#include "base/keyfile.h"

#include "base/chars.h"
#include "base/near.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void keyfile_open(keyfile *k, in *source)
{
    *k = (keyfile){.source = source, .name = in_name(source)};
}

int keyfile_error(const keyfile *k, err *e, const char *format, ...)
{
    char text[900];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return err_set_as(e, format, k->name, k->line, text);
}

static int check_characters(const keyfile *k, const char *text, err *e)
{
    for (const char *p = text; *p; p++)
        if (((unsigned char)*p < 0x20 && *p != '\t') || *p == 0x7f)
            return keyfile_error(k, e, "control character 0x%02x; expected a line of text", (unsigned)*p);
    return 0;
}

/* What stands after the '#', without the blanks around it. */
static const char *trim(char *text)
{
    char *end = text + strlen(text);
    while (end > text && chars_blank(end[-1]))
        *--end = '\0';
    while (chars_blank(*text))
        text++;
    return text;
}

/* Cuts the line into words, and a comment, in place. */
static int split(keyfile *k, char *text, err *e)
{
    k->count = 0;
    k->comment = NULL;
    for (char *p = text; *p;) {
        if (chars_blank(*p)) {
            *p++ = '\0';
            continue;
        }
        if (*p == '#') {
            k->comment = trim(p + 1);
            break;
        }
        if (k->count == KEYFILE_WORDS)
            return keyfile_error(k, e, "more than %d words on a line", KEYFILE_WORDS);
        k->word[k->count++] = p;
        while (*p && !chars_blank(*p))
            p++;
    }
    return 0;
}

static int not_utf8(const keyfile *k, int word, err *e)
{
    enum { MOST = 60 };
    char text[4 * MOST + 1];
    size_t n = strlen(k->word[word]);
    chars_escape(k->word[word], n < MOST ? n : MOST, text);
    return keyfile_error(k, e, "word %d is not UTF-8; expected text in UTF-8, where a name's bytes stand so: %s%s",
                         word + 1, text, n > MOST ? "..." : "");
}

/* What is in a comment does not matter. */
static int check_words(const keyfile *k, err *e)
{
    for (int i = 0; i < k->count; i++)
        if (!chars_utf8(k->word[i]))
            return not_utf8(k, i, e);
    return 0;
}

int keyfile_take(keyfile *k, char *text, int64_t length, int64_t line, err *e)
{
    k->line = line;
    if (length > KEYFILE_LINE)
        return keyfile_error(k, e, "a line of %lld bytes; expected at most %d", (long long)length, KEYFILE_LINE);
    if (check_characters(k, text, e) || split(k, text, e) || check_words(k, e))
        return -1;
    return k->count ? 1 : 0;
}

int keyfile_next(keyfile *k, err *e)
{
    for (;;) {
        char *text;
        int64_t length = in_line(k->source, &text, NULL, e);
        if (length < 0)
            return length == -1 ? 0 : -1;
        const int got = keyfile_take(k, text, length, in_lines(k->source), e);
        if (got)
            return got;
    }
}

static int index_of(const char *const *names, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(names[i], name))
            return i;
    return -1;
}

int keyfile_pair(keyfile *k, int at, const char *const *keys, int count, uint64_t *seen, char **value, err *e)
{
    char *key = k->word[at], *equals = strchr(key, '=');
    if (!equals || equals == key)
        return keyfile_error(k, e, "'%.200s'; expected KEY=VALUE", key);
    *equals = '\0';
    *value = equals + 1;
    int i = index_of(keys, count, key);
    if (i < 0)
        return near_unknown(e, k->name, k->line, "key", key, keys, count);
    if (!**value)
        return keyfile_error(k, e, "'%s=' without a value; expected %s=VALUE, no blank at the '='", key, key);
    if (*seen >> i & 1)
        return keyfile_error(k, e, "'%s' is given twice; expected once", key);
    *seen |= UINT64_C(1) << i;
    return i;
}
