#include "surface/obj_words.h"

#include "base/chars.h"

#include <string.h>

bool obj_seek_word(obj_words *w)
{
    for (;;) {
        if (obj_line_ends(w->p, w->end))
            return false;
        int n = obj_continues(w->p);
        w->line += n > 0;
        if (!n && !obj_is_blank(*w->p))
            return *w->p != '#';
        w->p += n ? n : 1;
    }
}

const char *obj_word_end(const obj_words *w)
{
    const char *p = w->p;
    while (!obj_word_ends(w, p))
        p++;
    return p;
}

/* The LF that ends the line, or the end of the text. */
static const char *line_end(const char *p, const char *end)
{
    const char *lf = memchr(p, '\n', (size_t)(end - p));
    return lf ? lf : end;
}

/* Whether a comment begins between two places of one line. */
static bool has_comment(const char *from, const char *to)
{
    for (const char *p = from; p < to; p++)
        if (*p == '#' && (p == from || obj_is_blank(p[-1])))
            return true;
    return false;
}

/* Most of a large OBJ may be texture coordinates: only the bytes about each line end are looked at. */
void obj_skip_words(obj_words *w)
{
    for (;;) {
        const char *from = w->p;
        w->p = line_end(from, w->end);
        const char *last = w->p - 1;
        last -= *last == '\r' && last > w->line_start;
        if (w->p == w->end || *last != '\\' || has_comment(from, last))
            return;
        w->p++;
        w->line++;
    }
}

void obj_next_line(obj_words *w)
{
    w->p = line_end(w->p, w->end);
    w->p += w->p < w->end;
    w->line++;
    w->line_start = w->p;
}

int obj_bad_word(const obj_words *w, const char *what, const char *expected)
{
    char word[60];
    size_t n = (size_t)(obj_word_end(w) - w->p), most = sizeof word - 1;
    bool cut = n > most;
    for (n = cut ? most : n; cut && n && ((unsigned char)w->p[n] & 0xc0) == 0x80;)
        n--; /* a character stays whole */
    memcpy(word, w->p, n);
    word[n] = 0;
    for (char *c = word; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127)
            *c = '?';
    chars_mend(word);
    return err_set(w->e, w->name, w->line, "%s '%s'%s; expected %s", what, word, cut ? "..." : "", expected);
}
