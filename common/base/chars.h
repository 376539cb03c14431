/* Characters of text that people and programs write: blanks, UTF-8. Nothing is allocated.
 */
#ifndef SINEW_CHARS_H
#define SINEW_CHARS_H

#include <stdbool.h>

static inline bool chars_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Well-formed UTF-8: no overlong forms, no surrogates, nothing past U+10FFFF. */
bool chars_utf8(const char *text);

/* Replaces each byte that is not part of well-formed UTF-8 by '?'. */
void chars_mend(char *text);

#endif
