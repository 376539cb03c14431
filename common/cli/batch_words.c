#include "cli/batch_words.h"

#include "base/chars.h"

#include <string.h>

enum { LINE = 65536 }; /* the most bytes of a line */

/* Ends a quoted part. Returns what follows it, or NULL. */
static char *take_quoted(char *from, char **to)
{
    const char quote = *from++;
    for (; *from && *from != quote; from++) {
        if (quote == '"' && from[0] == '\\' && from[1])
            from++;
        *(*to)++ = *from;
    }
    return *from ? from + 1 : NULL;
}

/* Takes the word at *from, in place. Returns what follows it, or NULL where a quote has no end. */
static char *take_word(char *from, char **to)
{
    while (from && *from && !chars_blank(*from)) {
        if (*from == '\'' || *from == '"') {
            from = take_quoted(from, to);
            continue;
        }
        if (from[0] == '\\' && from[1])
            from++;
        *(*to)++ = *from++;
    }
    return from;
}

int batch_words_cut(char *text, char *word[BATCH_WORDS], err *e)
{
    int count = 0;
    for (char *p = text;;) {
        while (chars_blank(*p))
            p++;
        if (!*p || *p == '#')
            return count;
        if (count == BATCH_WORDS)
            return err_set(e, NULL, 0, "more than %d words on a line", BATCH_WORDS);
        char *end = p;
        word[count++] = p;
        p = take_word(p, &end);
        if (!p)
            return err_set(e, NULL, 0, "a quote has no end; expected another on the line");
        const bool ends = !*p;
        *end = '\0';
        if (ends)
            return count;
        p++;
    }
}

int batch_words_check(const char *text, err *e)
{
    if (strlen(text) > LINE)
        return err_set(e, NULL, 0, "a line of %zu bytes; expected at most %d", strlen(text), LINE);
    for (const char *p = text; *p; p++)
        if (((unsigned char)*p < 0x20 && *p != '\t') || *p == 0x7f)
            return err_set(e, NULL, 0, "control character 0x%02x; expected a line of text", (unsigned)*p);
    return 0;
}
