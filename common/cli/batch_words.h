/* The words of a line of --batch: between blanks, or quoted, as a shell would have them, but that nothing in them
 * stands for anything else. A comment ends a line. Owns nothing.
 */
#ifndef SINEW_BATCH_WORDS_H
#define SINEW_BATCH_WORDS_H

#include "base/err.h"

enum { BATCH_WORDS = 64 }; /* the most of a line */

/* Refuses a line that is too long, or has control characters. -1 with e filled. */
int batch_words_check(const char *text, err *e);

/* Cuts a line into words, in place. Returns how many, or -1 with e filled. */
int batch_words_cut(char *text, char *word[BATCH_WORDS], err *e);

#endif
