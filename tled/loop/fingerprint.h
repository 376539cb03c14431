/* The fingerprint of a run: what decides its bytes, in few numbers. It has the options and what ran, by name, and a
 * checksum for each number that the options round, for each of the model's arrays and metadata, for the script, the
 * probe and its poses, and for the state that the run begins from. A run goes on only from the checkpoint of a run with
 * the same fingerprint. The caller owns a fingerprint, zeroed to begin with.
 */
#ifndef SINEW_FINGERPRINT_H
#define SINEW_FINGERPRINT_H

#include "model/model.h"
#include "tled/contact/self_contact.h"
#include "tled/contact/sliding.h"
#include "tled/loop/run.h"
#include "tled/problem/collider.h"

typedef struct fingerprint_part {
    char *name; /* "array element.node", "script", ...; owned */
    uint32_t crc;
} fingerprint_part;

typedef struct fingerprint {
    char *options; /* the version, what changes the result, and what ran; owned */
    fingerprint_part *part;
    int64_t parts, room;
} fingerprint;

/* A run that is about to begin. */
typedef struct fingerprint_run {
    const char *options; /* as for provenance, before them the version */
    const model *m;
    const run_setup *setup;
    const tled_problem *p;
    int64_t next_frame; /* the index of the first frame that it writes */
} fingerprint_run;

/* -1 with e filled, and to be freed all the same. */
int fingerprint_make(fingerprint *f, const fingerprint_run *run, err *e);
void fingerprint_free(fingerprint *f);

/* Puts it into a model that has none. -1 with e filled. */
int fingerprint_put(const fingerprint *f, model *to, err *e);

/* Whether the one in a model is the same. -1 with e filled: what differs. place: for the message. */
int fingerprint_compare(const fingerprint *f, const model *from, const char *place, err *e);

#endif
