#include "exchange/import_tokens.h"

#include "base/num.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

int tokens_wrong(const tokens *t, err *e, const char *wrong, const char *expected)
{
    if (t->binary)
        return err_set(e, t->name, 0, "%s: %.200s; expected %s", t->section, wrong, expected);
    return err_set(e, t->name, in_lines(t->s), "%.200s; expected %s", wrong, expected);
}

int tokens_line(tokens *t, char **line, err *e)
{
    int64_t n;
    t->at = NULL;
    while ((n = in_line(t->s, line, NULL, e)) >= 0) {
        while (isspace((unsigned char)**line))
            ++*line;
        n = (int64_t)strlen(*line);
        while (n && isspace((unsigned char)(*line)[n - 1]))
            (*line)[--n] = '\0';
        if (n)
            return 0;
    }
    return (int)n;
}

/* The next word of text, cut out of its line: 0, or -1 with e filled. */
static int next_word(tokens *t, char **word, err *e)
{
    while (t->at && isspace((unsigned char)*t->at))
        t->at++;
    if (!t->at || !*t->at) {
        char *line;
        int got = tokens_line(t, &line, e);
        if (got)
            return got < -1 ? -1 : tokens_wrong(t, e, "the file ends in the middle", "more numbers");
        t->at = line;
    }
    *word = t->at;
    while (*t->at && !isspace((unsigned char)*t->at))
        t->at++;
    if (*t->at)
        *t->at++ = '\0';
    return 0;
}

static int take_bytes(tokens *t, unsigned char *bytes, int size, err *e)
{
    int64_t got = in_read(t->s, bytes, (size_t)size, e);
    if (got < 0)
        return -1;
    return got == size ? 0 : tokens_wrong(t, e, "the file ends in the middle", "more numbers");
}

static int take_binary(tokens *t, int size, uint64_t *bits, err *e)
{
    unsigned char bytes[8];
    if (take_bytes(t, bytes, size, e))
        return -1;
    *bits = 0;
    for (int i = size - 1; i >= 0; i--)
        *bits = *bits << 8 | bytes[i];
    return 0;
}

int tokens_int(tokens *t, int size, int64_t low, int64_t high, int64_t *value, err *e)
{
    char *word = NULL, text[64], expected[80];
    uint64_t bits = 0;
    bool bad;
    if (t->binary ? take_binary(t, size, &bits, e) : next_word(t, &word, e))
        return -1;
    if (t->binary) {
        *value = size == 4 ? (int64_t)(int32_t)(uint32_t)bits : (int64_t)bits;
        bad = *value < low || *value > high;
    } else {
        bad = num_int(word, low, high, value) != 0;
    }
    if (!bad)
        return 0;
    if (t->binary)
        snprintf(text, sizeof text, "%lld", (long long)*value);
    else
        snprintf(text, sizeof text, "%.40s", word);
    snprintf(expected, sizeof expected, "a whole number from %lld to %lld", (long long)low, (long long)high);
    return tokens_wrong(t, e, text, expected);
}

int tokens_real(tokens *t, double *value, err *e)
{
    char *word, text[64];
    if (t->binary) {
        uint64_t bits;
        if (take_binary(t, 8, &bits, e))
            return -1;
        memcpy(value, &bits, sizeof bits);
        return isfinite(*value) ? 0 : tokens_wrong(t, e, "a number that is not finite", "a finite number");
    }
    if (next_word(t, &word, e))
        return -1;
    if (!num_double(word, value))
        return 0;
    snprintf(text, sizeof text, "%.40s", word);
    return tokens_wrong(t, e, text, "a number");
}

int tokens_skip(tokens *t, int64_t count, int size, err *e)
{
    char *word;
    unsigned char bytes[4096];
    if (!t->binary) {
        for (; count > 0; count--)
            if (next_word(t, &word, e))
                return -1;
        return 0;
    }
    if (count > INT64_MAX / size)
        return tokens_wrong(t, e, "a count beyond any file", "fewer");
    for (int64_t left = count * size; left > 0;) {
        int now = left < (int64_t)sizeof bytes ? (int)left : (int)sizeof bytes;
        if (take_bytes(t, bytes, now, e))
            return -1;
        left -= now;
    }
    return 0;
}
