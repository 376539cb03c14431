#include "base/near.h"

#include "base/chars.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { NAME_MOST = 64, SUGGESTIONS = 3, SUGGESTION_MOST = 100 };

static bool same_letter(char a, char b)
{
    return tolower((unsigned char)a) == tolower((unsigned char)b);
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Edits from a to b: letters added, dropped, changed or swapped with their neighbour (optimal string alignment), those
 * of either case alike. Names are cut at NAME_MOST. */
static int distance(const char *a, const char *b)
{
    int rows[3][NAME_MOST + 1];
    int na = (int)strnlen(a, NAME_MOST), nb = (int)strnlen(b, NAME_MOST);
    for (int j = 0; j <= nb; j++)
        rows[0][j] = j;
    for (int i = 1; i <= na; i++) {
        int *now = rows[i % 3], *last = rows[(i + 2) % 3], *before = rows[(i + 1) % 3];
        now[0] = i;
        for (int j = 1; j <= nb; j++) {
            now[j] = least(last[j - 1] + !same_letter(a[i - 1], b[j - 1]), least(last[j], now[j - 1]) + 1);
            if (i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) && same_letter(a[i - 2], b[j - 1]))
                now[j] = least(now[j], before[j - 2] + 1);
        }
    }
    return rows[na % 3][nb];
}

int near_name(const char *name, const char *const *names, int count)
{
    int limit = (int)strlen(name) / 3, best = -1;
    if (limit < 1)
        limit = 1;
    for (int i = 0; i < count; i++) {
        int d = distance(name, names[i]);
        if (d <= limit) {
            best = i;
            limit = d - 1;
        }
    }
    return best;
}

static bool begins_so(const char *name, const char *with)
{
    while (*with && same_letter(*name, *with))
        name++, with++;
    return !*with;
}

/* "'a' or 'b'": what may be meant: the nearest, or else those that begin with the name, a few of them. */
static void suggest(char *to, size_t size, const char *name, const char *const *names, int count)
{
    int near = near_name(name, names, count), found = 0;
    size_t at = 0;
    to[0] = '\0';
    for (int i = 0; i < count && *name && found < SUGGESTIONS; i++)
        if (near < 0 ? begins_so(names[i], name) : i == near) {
            snprintf(to + at, size - at, "%s'%.*s'", found++ ? " or " : "", SUGGESTION_MOST, names[i]);
            at += strlen(to + at);
        }
}

void near_list(char *to, size_t size, const char *const *names, int count)
{
    static const char more[] = ", ...", comma[] = ", ";
    size_t at = 0;
    to[0] = '\0';
    for (int i = 0; i < count; i++) {
        bool fits = at + sizeof comma + strlen(names[i]) + sizeof more <= size;
        const char *next = fits ? names[i] : "...";
        snprintf(to + at, size - at, "%s%s", at ? comma : "", next);
        if (!fits)
            return;
        at += strlen(to + at);
    }
}

/* "did you mean 'near'? expected one of: a, b, c". */
static void offer(char *to, size_t size, const char *name, const char *const *names, int count)
{
    char list[320], meant[SUGGESTIONS * (SUGGESTION_MOST + 8)];
    near_list(list, sizeof list, names, count);
    suggest(meant, sizeof meant, name, names, count);
    if (!count)
        snprintf(to, size, "there are none here");
    else if (*meant)
        snprintf(to, size, "did you mean %s? expected one of: %s", meant, list);
    else
        snprintf(to, size, "expected one of: %s", list);
}

enum { OFFER = 800, SHOWN_MOST = 200 };

/* The first of a name, whatever its bytes are. */
static void show(char *to, const char *name)
{
    chars_show(name, strnlen(name, SHOWN_MOST), to);
}

int near_unknown(err *e, const char *place, int64_t line, const char *what, const char *name, const char *const *names,
                 int count)
{
    char text[OFFER], shown[4 * SHOWN_MOST + 1];
    show(shown, name);
    offer(text, sizeof text, name, names, count);
    return err_set(e, place, line, "unknown %s '%.200s'; %s", what, shown, text);
}

int near_option(err *e, const char *option, const char *what, const char *name, const char *const *names, int count)
{
    char text[OFFER], shown[4 * SHOWN_MOST + 1];
    show(shown, name);
    offer(text, sizeof text, name, names, count);
    return err_option(e, option, "unknown %s '%.200s'; %s", what, shown, text);
}
