/* The muscles of a model by the words that people name them with. A list is its owner's, zeroed to begin with.
 */
#ifndef SINEW_MUSCLES_H
#define SINEW_MUSCLES_H

#include "model/model.h"

typedef struct muscle_list {
    int32_t *volume; /* indices of volumes, ascending; owned */
    int32_t count;
    int64_t room;
} muscle_list;

/* The muscles that a word names, in place of what the list had: a name, muscle_ before it or not; or the beginning of
 * names and '*' for any rest. -1 with e filled at place:line where it names none. line 0: place is an option of the
 * command line. */
int muscles_named(muscle_list *to, const model *m, const char *word, const char *place, int64_t line, err *e);
void muscles_free(muscle_list *l);

/* A level: a number from 0 to 1. Returns 0 or -1. */
int muscles_level(const char *text, double *level);

#endif
