/* The kinds of families of fibres that any law may have beside it: a table, as that of laws (law.h), with the keys of
 * law.h. Files of materials, assignments, models, messages and manuals take kinds and their keys from here. Owns
 * nothing; all is constant.
 */
#ifndef SINEW_FIBRE_KIND_H
#define SINEW_FIBRE_KIND_H

#include "physics/fibre_numbers.h"
#include "physics/law.h"

/* Bits 1 << (LAW_eta - LAW_FIBRE_KEYS_FIRST) and so on: keys that must be given, and those that may be. */
typedef struct fibre_kind {
    const char *name;
    unsigned needs, takes;
    /* value: LAW_FIBRE_KEYS_COUNT, nan where none */
    void (*fill)(const double *value, fibre_numbers *to);
    const char *meaning, *energy, *source; /* for the manual, a line each */
} fibre_kind;

/* What a material has that names no kind, or this: no families. */
extern const char fibre_kind_none[];

/* Row i, or NULL past the last. */
const fibre_kind *fibre_kind_at(int i);

/* NULL: there is none of that name. */
const fibre_kind *fibre_kind_find(const char *name);

/* "none", and of all rows, in order; returns how many. */
enum { FIBRE_KIND_MOST = 8 };
int fibre_kind_names(const char *to[FIBRE_KIND_MOST]);

/* Whether a kind, or NULL, has a key of law.h. */
bool fibre_kind_takes(const fibre_kind *of, int key);

/* "k1, k2, kappa, angle": the keys in such bits. */
void fibre_kind_words(unsigned keys, char to[LAW_WORDS]);

#endif
