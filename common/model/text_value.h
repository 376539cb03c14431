/* Words, strings and numbers of the text encoding, both ways. What is read is cut and unescaped in place, in the line
 * that holds it. Nothing here says where an error is: that is text.c's.
 */
#ifndef SINEW_TEXT_VALUE_H
#define SINEW_TEXT_VALUE_H

#include "base/out.h"
#include "model/model.h"

/* The first character at p that is not blank. */
char *text_blanks(char *p);

/* Whether only blanks are left. */
bool text_ended(char *p);

/* The next word, cut out of the line; "" at its end. *p steps past it. */
char *text_word(char **p);

/* A quoted string, unescaped; NULL where there is none. *p steps past it. */
char *text_quoted(char **p);

/* Reads one value of the type at p into memory; returns where it ends, or NULL. A string is the
 * caller's to free (NULL: out of memory). */
char *text_value(model_type type, char *p, void *to);

/* "numbers of f64, nan or inf": what text_value wants. */
const char *text_value_what(model_type type);

void text_put_quoted(out *o, const char *text);
/* The i-th value of a. */
void text_put_value(out *o, const model_array *a, int64_t i);

#endif
