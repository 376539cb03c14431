/* Characters of text that people and programs write: blanks, UTF-8. Nothing is allocated.
 */
#ifndef SINEW_CHARS_H
#define SINEW_CHARS_H

#include <stdbool.h>
#include <stddef.h>

static inline bool chars_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Well-formed UTF-8: no overlong forms, no surrogates, nothing past U+10FFFF. */
bool chars_utf8(const char *text);

/* Replaces each byte that is not part of well-formed UTF-8 by '?'. */
void chars_mend(char *text);

/* Replaces each control character by '?': C0, DEL, and both bytes of C1 in UTF-8. What is left steers no terminal. */
void chars_tame(char *text);

/* How many columns of a terminal the text takes: two for each wide character of East Asia, none for a combining accent,
 * one for any other, and for a byte that is not part of well-formed UTF-8. */
int chars_width(const char *text);

/* Names in files of any encoding, as UTF-8: a byte that is not part of well-formed UTF-8, or is a control character,
 * stands as \xHH (two hexadecimal digits, lower case), and a backslash before an x and two such digits as \x5c; all
 * else stands as it is. So different names stay different, and each can be had back. */

/* Writes so what n bytes of text are to `to`, which has room for 4 n + 1. Returns its length. */
size_t chars_escape(const char *text, size_t n, char *to);

/* The same of what somebody typed, to show it: what is written as \xHH already stays. */
size_t chars_show(const char *text, size_t n, char *to);

/* The value of a hexadecimal digit of either case, or -1. */
int chars_hex(char c);

/* The byte that the \xHH at p stands for, or -1 where there is none. */
int chars_escaped(const char *p);

enum { CHARS_ANY_CASE = 1, CHARS_BEGINS = 2 };

/* Whether somebody who typed so (m bytes) means this name (n bytes; CHARS_BEGINS: one that begins so): as it stands
 * here, in the bytes of the file that it comes from, or with \xHH for any of these, in digits of either case. */
bool chars_means(const char *typed, size_t m, const char *name, size_t n, int flags);

/* The same, of whole strings and with the case that they have. */
bool chars_mean(const char *typed, const char *name);

#endif
