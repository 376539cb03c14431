#include "volume/header.h"

#include "base/chars.h"
#include "base/num.h"

#include <stdio.h>
#include <string.h>

char *header_trim(char *text)
{
    while (chars_blank(*text))
        text++;
    for (char *end = text + strlen(text); end > text && chars_blank(end[-1]);)
        *--end = '\0';
    return text;
}

char *header_word(char **p)
{
    char *word = *p;
    while (chars_blank(*word))
        word++;
    if (!*word)
        return NULL;
    char *end = word;
    while (*end && !chars_blank(*end))
        end++;
    *p = *end ? end + 1 : end;
    *end = '\0';
    return word;
}

int header_bad(const in *s, err *e, const char *key, const char *word, const char *expected)
{
    if (!*word)
        return header_wrong(s, e, key, "nothing", expected);
    return err_set(e, in_name(s), in_lines(s), "%.60s: '%.100s'; expected %s", key, word, expected);
}

int header_wrong(const in *s, err *e, const char *key, const char *what, const char *expected)
{
    return err_set(e, in_name(s), in_lines(s), "%.60s: %s; expected %s", key, what, expected);
}

int header_numbers(const in *s, const char *key, char *value, double *to, int count, err *e)
{
    char expected[64];
    int got = 0;
    snprintf(expected, sizeof expected, "%d finite number%s", count, count == 1 ? "" : "s");
    for (char *word; (word = header_word(&value)); got++)
        if (got == count || num_double(word, &to[got]))
            return header_bad(s, e, key, word, expected);
    return got == count ? 0 : header_wrong(s, e, key, "too few", expected);
}

int header_integers(const in *s, const char *key, char *value, int64_t low, int64_t high, int64_t *to, int count,
                    err *e)
{
    char expected[120];
    int got = 0;
    snprintf(expected, sizeof expected, "%d whole number%s from %lld to %lld", count, count == 1 ? "" : "s",
             (long long)low, (long long)high);
    for (char *word; (word = header_word(&value)); got++)
        if (got == count || num_int(word, low, high, &to[got]))
            return header_bad(s, e, key, word, expected);
    return got == count ? 0 : header_wrong(s, e, key, "too few", expected);
}
