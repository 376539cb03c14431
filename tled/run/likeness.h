/* What decides a run's bytes, in few numbers: the options and what ran, by name; a checksum each of numbers that those round, of the model's arrays and
 * metadata, of the script, the probe and its poses, and of the state that it begins from. A run may go on only from what a run like
 * it has left. The caller owns a likeness, zeroed to begin with.
 */
#ifndef SINEW_LIKENESS_H
#define SINEW_LIKENESS_H

#include "model/model.h"
#include "tled/problem/collider.h"
#include "tled/run/run.h"

typedef struct likeness_part {
    char *name; /* "array element.node", "script", ...; owned */
    uint32_t crc;
} likeness_part;

typedef struct likeness {
    char *options; /* the version, what changes the result, and what ran; owned */
    likeness_part *part;
    int64_t parts, room;
} likeness;

/* A run that is about to begin. */
typedef struct likeness_run {
    const char *options; /* as for provenance, before them the version */
    const model *m;
    const run_setup *setup;
    const tled_problem *p;
    int64_t next_frame; /* the index of the first frame that it writes */
} likeness_run;

/* -1 with e filled, and to be freed all the same. */
int likeness_make(likeness *l, const likeness_run *run, err *e);
void likeness_free(likeness *l);

/* Puts it into a model that has none. -1 with e filled. */
int likeness_put(const likeness *l, model *to, err *e);

/* Whether the one in a model is the same. -1 with e filled: what differs. place: for the message. */
int likeness_compare(const likeness *l, const model *from, const char *place, err *e);

#endif
