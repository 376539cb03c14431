/* Files that people write (volumes, materials, scripts): one thing a line, words between blanks, a comment from a word
 * that begins with '#' to the line's end, key=value. A keyfile reads lines from a stream that stays the caller's;
 * its words are valid until the next line is read. Every error says file:line.
 */
#ifndef SINEW_KEYFILE_H
#define SINEW_KEYFILE_H

#include "base/in.h"

enum { KEYFILE_WORDS = 64, KEYFILE_LINE = 65536 }; /* the most words and bytes that a line may have */

typedef struct keyfile {
    in *source;       /* borrowed; NULL where lines are given to keyfile_take alone */
    const char *name; /* the source's, for messages */
    int64_t line;     /* the number of the line whose words these are */
    int count;
    char *word[KEYFILE_WORDS];
    const char *comment; /* of the line, without its '#' and the blanks around it, of any bytes; NULL: none */
} keyfile;

void keyfile_open(keyfile *k, in *source);

/* Reads on to the next line that has words. 1: there is one; 0: the end; -1: e filled (too many words, control
 * characters, what is not text). */
int keyfile_next(keyfile *k, err *e);

/* Takes a line that the caller has, NUL-terminated and of `length` bytes, which is cut into words in place. 1: it has
 * words; 0: none; -1: e filled, as above. */
int keyfile_take(keyfile *k, char *text, int64_t length, int64_t line, err *e);

/* Takes word `at` as key=value: returns the key's index among `keys` (fewer than 64) and its value, never empty.
 * -1 with e filled where it is not key=value, the key is unknown (the keys are listed, the nearest offered) or has its
 * bit set in *seen. Sets that bit. A value may hold '='. */
int keyfile_pair(keyfile *k, int at, const char *const *keys, int count, uint64_t *seen, char **value, err *e);

/* err_set at the line read last. Returns -1. */
int keyfile_error(const keyfile *k, err *e, const char *format, ...) SINEW_PRINTF(3, 4);

#endif
