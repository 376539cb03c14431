/* Numbers one after the other, as text between blanks on any number of lines, or as little-endian
 * binary: what Gmsh's two encodings are. Lines and binary data may alternate. The creator owns the
 * stream; what is here holds no memory of its own.
 */
#ifndef SINEW_IMPORT_TOKENS_H
#define SINEW_IMPORT_TOKENS_H

#include "base/in.h"

typedef struct tokens {
    in *s;
    const char *name; /* for messages; borrowed */
    char section[64]; /* likewise */
    bool binary;
    char *at; /* what is left of the line, or NULL */
} tokens;

/* -1 with e filled: what is wrong, with its line (text) or section (binary). */
int tokens_wrong(const tokens *t, err *e, const char *wrong, const char *expected);

/* size: of the binary number, 4 or 8. -1 with e filled where there is none, or it is outside of low to high. */
int tokens_int(tokens *t, int size, int64_t low, int64_t high, int64_t *value, err *e);
int tokens_real(tokens *t, double *value, err *e);

/* Passes over so many bytes of binary, or numbers of text. */
int tokens_skip(tokens *t, int64_t count, int size, err *e);

/* The next line that is not empty; -1 at the end, -2 with e filled. What was left of the one before is dropped. */
int tokens_line(tokens *t, char **line, err *e);

#endif
