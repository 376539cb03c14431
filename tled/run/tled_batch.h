/* What the jobs of tled-run --batch share: the model, in which materials are as they are to be, and the frames that
 * came with it. Jobs read it and change nothing of it. The main owns it.
 */
#ifndef SINEW_TLED_BATCH_H
#define SINEW_TLED_BATCH_H

#include "cli/batch.h"
#include "tled/run/options.h"
#include "tled/run/tled_session.h"

typedef struct tled_batch {
    stage_shared from;
    bool changed; /* the materials, so frames that came belong to another model */
    card_gate card;
} tled_batch;

/* Reads the model's frames, to the end of the stream. -1 with e filled. */
int tled_batch_read(tled_batch *b, const struct options *o, err *e);
void tled_batch_free(tled_batch *b);

/* Gives the session of a job the model and the frames. -1 with e filled. */
int tled_batch_share(tled_batch *b, session *s, err *e);

/* run_go, for a job or another run. On a card small models go on side by side: the card takes steps of one while others
 * look at theirs, and come and go. Large ones wait for each other, since their states would take its memory. */
int tled_batch_run(session *s, run_end *end, err *e);

/* What is said of a job in the end. */
void tled_batch_words(const run_end *end, char said[BATCH_SAID]);

#endif
