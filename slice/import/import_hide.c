#include "slice/import/import_hide.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char way[] = " (-v says all)", left_out[] = "...";

/* Puts `instead` in the place of `length` bytes at `at`; what no longer fits is cut. */
static void put(err *e, size_t at, size_t length, const char *instead)
{
    char rest[sizeof e->text];
    snprintf(rest, sizeof rest, "%s", e->text + at + length);
    snprintf(e->text + at, sizeof e->text - at, "%s%s", instead, rest);
}

/* From the first quote to the last, so that a quote in a name ends nothing; to the end of the text where it has none,
 * or where the text was cut, so that the last may be one of the name's. An apostrophe stands between letters, a quote
 * does not. */
static bool hide_quoted(err *e, size_t from, bool cut)
{
    char *first = strchr(e->text + from, '\''), *last = strrchr(e->text + from, '\'');
    while (first && first > e->text + from && first[-1] != ' ' && first[-1] != '(')
        first = strchr(first + 1, '\'');
    if (!first)
        return false;
    if (cut || last == first)
        last = e->text + strlen(e->text);
    put(e, (size_t)(first + 1 - e->text), (size_t)(last - first - 1), left_out);
    return true;
}

/* Whether "file 3" or the like is in the text. */
static bool numbers_a_file(const char *text)
{
    for (const char *at = text; (at = strstr(at, "file ")); at++)
        if (isdigit((unsigned char)at[5]))
            return true;
    return false;
}

void import_hide(err *e, const char *of)
{
    const bool placed = e->place && *of, cut = strlen(e->text) == sizeof e->text - 1;
    if (placed)
        put(e, 0, (size_t)e->place, of);
    const bool quoted = hide_quoted(e, placed ? strlen(of) : 0, cut);
    const size_t n = strlen(e->text);
    if (placed || quoted || numbers_a_file(e->text))
        snprintf(e->text + n, sizeof e->text - n, "%s", way);
}

void import_hide_word(err *e, const char *word)
{
    const size_t n = strlen(word);
    char *at = n ? strstr(e->text, word) : NULL;
    while (at && !(at > e->text && at[-1] == '\'' && at[n] == '\''))
        at = strstr(at + 1, word);
    if (at)
        put(e, (size_t)(at - e->text), n, left_out);
}
