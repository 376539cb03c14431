/* One client: what it asks for, and what it is sent. Of each device at most one message waits for it, the newest; one
 * of which a part is sent is finished first. Answers are sent before all else, in their order; a client that does not
 * take them is not read on. The caller owns a client, and calls all of this from one thread.
 */
#ifndef SINEW_SERVE_CLIENT_H
#define SINEW_SERVE_CLIENT_H

#include "link/address.h"
#include "link/serve_board.h"
#include "link/serve_us.h"

enum { SERVE_FROM = ADDRESS_MOST + 24 };

typedef struct serve_client serve_client;

/* What clients share; all borrowed. */
typedef struct serve_common {
    serve_board *board;
    serve_us *us;
    double interval; /* s: the least between two messages of a device; 0: none */
} serve_common;

/* fd is the client's from then on, in any case. It begins with what is newest. NULL with e filled. */
serve_client *serve_client_make(int fd, const char *from, const serve_common *common, err *e);
void serve_client_free(serve_client *c); /* closes the connection */

int serve_client_fd(const serve_client *c);
const char *serve_client_from(const serve_client *c); /* as "client 127.0.0.1:53210" */

/* Reads what came, and acts on it. 0; 1: the client has gone away; -1: e says why it is to be dropped. */
int serve_client_read(serve_client *c, err *e);

/* Sends what can be sent at once. last: whatever waits, however soon after the one before. As serve_client_read. */
int serve_client_write(serve_client *c, bool last, err *e);

/* What to poll its descriptor for; whether it waits for the connection to take more; and when, by clock_now, a message
 * is due that waits for its interval (infinite: none does). */
short serve_client_events(const serve_client *c);
bool serve_client_is_full(const serve_client *c);
double serve_client_due(const serve_client *c);

/* s for which the connection has taken nothing though something waits. */
double serve_client_stuck(const serve_client *c);

/* Messages sent, and messages that newer ones took the place of. */
int64_t serve_client_sent(const serve_client *c);
int64_t serve_client_lost(const serve_client *c);

#endif
