/* What the headers of NRRD and MetaImage have in common: lines of a key and a value, values that are words, numbers and
 * sizes. Texts are cut in place, in the stream's line. Errors say file:line.
 */
#ifndef SINEW_HEADER_H
#define SINEW_HEADER_H

#include "volume/volume.h"

/* Text without the blanks at its ends. */
char *header_trim(char *text);

/* The next word, cut out; NULL at the end. *p steps past it. */
char *header_word(char **p);

/* err_set at the stream's last line: "key: 'word'; expected ...", of a word that stands there; or what is wrong, in
 * words of ours, which get no quotes. Return -1. */
int header_bad(const in *s, err *e, const char *key, const char *word, const char *expected);
int header_wrong(const in *s, err *e, const char *key, const char *what, const char *expected);

/* Exactly `count` finite numbers between blanks, or whole numbers within low to high. */
int header_numbers(const in *s, const char *key, char *value, double *to, int count, err *e);
int header_integers(const in *s, const char *key, char *value, int64_t low, int64_t high, int64_t *to, int count,
                    err *e);

#endif
