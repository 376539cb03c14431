/* Messages of pages on their way to the one thread that acts on them. Of poses the newest counts: one that waits is
 * replaced by the next of the same client. Who puts waits while the box is full. The caller owns it.
 */
#ifndef SINEW_INBOX_H
#define SINEW_INBOX_H

#include "console/message.h"

typedef struct inbox inbox;

inbox *inbox_make(err *e);
void inbox_free(inbox *b); /* which no thread uses any more */

/* Nothing is taken any more, and nobody waits. */
void inbox_end(inbox *b);

void inbox_put(inbox *b, int client, const message *m);

/* Wakes who waits in inbox_take. */
void inbox_wake(inbox *b);

/* The oldest message and its client; waits at most so many seconds. False: there was none. */
bool inbox_take(inbox *b, double seconds, int *client, message *m);

#endif
