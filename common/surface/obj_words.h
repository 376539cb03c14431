/* The text of an OBJ as words on logical lines: a backslash before the line end joins a line to the next, and a
 * word that begins with '#' begins a comment, which joins nothing (its last byte may be a path's backslash).
 * Borrows the text, which ends with a NUL.
 */
#ifndef SINEW_OBJ_WORDS_H
#define SINEW_OBJ_WORDS_H

#include "base/err.h"

typedef struct obj_words {
    const char *name;       /* of the file, for messages */
    const char *p, *end;    /* the next byte of the text, and past its last */
    const char *line_start; /* of the logical line */
    int64_t line;           /* number of the line that p is on */
    err *e;
} obj_words;

/* The length of a continuation (backslash, line end) at p, or 0. */
static inline int obj_continues(const char *p)
{
    if (*p != '\\')
        return 0;
    if (p[1] == '\n')
        return 2;
    return p[1] == '\r' && p[2] == '\n' ? 3 : 0;
}

static inline bool obj_is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static inline bool obj_line_ends(const char *p, const char *end)
{
    return p >= end || *p == '\n' || (*p == '\r' && (p + 1 == end || p[1] == '\n'));
}

/* Whether a word ends at p. */
static inline bool obj_word_ends(const obj_words *w, const char *p)
{
    return obj_is_blank(*p) || obj_line_ends(p, w->end) || obj_continues(p);
}

/* Steps to the line's next word; false where there is none. */
bool obj_seek_word(obj_words *w);

/* The same, quick where only blanks stand before it. */
static inline bool obj_next_word(obj_words *w)
{
    while (obj_is_blank(*w->p))
        w->p++;
    return (*w->p > '#' && *w->p != '\\') || obj_seek_word(w);
}

/* The end of the word that begins at p. */
const char *obj_word_end(const obj_words *w);

/* Steps over the words that are left on the line. */
void obj_skip_words(obj_words *w);

/* Steps to the next line; from a comment too. */
void obj_next_line(obj_words *w);

/* An error about the word at p: "what 'word'; expected ...". Returns -1. */
int obj_bad_word(const obj_words *w, const char *what, const char *expected);

#endif
