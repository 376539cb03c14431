/* Errors that come again and again in a live run, as warnings: the first of each kind is told. Errors are of one kind
 * where their texts are of the same format (err.form). The caller owns it, zeroed to begin with, and its lock.
 */
#ifndef SINEW_KINDS_H
#define SINEW_KINDS_H

#include "base/err.h"

enum { KINDS_MOST = 64 }; /* that are told apart; of more none is told */

typedef struct kinds {
    const char *form[KINDS_MOST];
    int count;
    notes told; /* since they were taken last */
} kinds;

/* what: was skipped for it, a "line" or an "event". */
void kinds_add(kinds *k, const err *e, const char *what);

/* Moves what is told into the warnings. */
void kinds_take(kinds *k, notes *warnings);

#endif
